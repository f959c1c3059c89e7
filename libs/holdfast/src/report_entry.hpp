// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <sstream>
#include <string>
#include <utility>

#include "holdfast/holdfast.hpp"

namespace holdfast {

/// The views of a checked structure that a report needs.
io::ReportEntry entry_of(const Structure& structure, const CheckResult& result);

/// Adds the reader's notes to a text report, if they belong there.
void add_notes(std::string& text, std::span<const std::string> notes, const TextOptions& options);

/// The text that a function writes to a stream.
template <class Write>
std::string text_of(const Write& write) {
  std::ostringstream out;
  write(out);
  return std::move(out).str();
}

}  // namespace holdfast
