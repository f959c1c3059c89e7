// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace holdfast::host {

/// Makes this process take its memory in pages of 2 MB where the system has them, and keep what it
/// frees: without that a robot of a million modules spends a third of its time waiting for pages.
/// For programs, at their start, not for libraries. Does nothing where the C library is not glibc.
void use_large_pages();

}  // namespace holdfast::host
