// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sstream>
#include <string>
#include <utility>

#include "holdfast/holdfast.hpp"

namespace holdfast {

/// What a report needs of a checked structure: views of both.
io::ReportEntry entry_of(const Structure& structure, const CheckResult& result);

/// What a function writes to a stream, as a text.
template <class Write>
std::string text_of(const Write& write) {
  std::ostringstream out;
  write(out);
  return std::move(out).str();
}

}  // namespace holdfast
