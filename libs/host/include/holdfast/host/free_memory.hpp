// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace holdfast::host {

/// Gives the system what is free between the things that the allocator keeps, where it can. Worth
/// its time, some milliseconds for each GB, before much is asked for in one piece, for which the
/// holes are too small.
void give_back_free_memory();

}  // namespace holdfast::host
