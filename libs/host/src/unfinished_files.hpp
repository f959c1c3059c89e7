// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

/// The names of temporary files, where a signal handler can read them.
namespace holdfast::host::unfinished_files {

/// Keeps a name. Returns its slot; -1 if there is no room, for it or for further ones: then only a
/// signal leaves the file behind.
int add(std::string_view name);

/// Forgets it; -1 does nothing.
void remove(int slot);

/// Signals that end the process remove the files first.
void watch_signals();

}  // namespace holdfast::host::unfinished_files
