// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace holdfast::web {

/// What a call of the core leaves for the page: a text of JSON, integers and numbers.
struct Reply {
  std::string text;
  std::vector<std::int32_t> integers;
  std::vector<double> numbers;
};

}  // namespace holdfast::web
