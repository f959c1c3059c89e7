// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/line_reader.hpp"

#include <utility>

namespace holdfast::cli {

LineReader::Lines LineReader::take(std::string_view bytes) {
  Lines lines;
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::string_view part = bytes.substr(0, end);
    is_too_long_ = is_too_long_ || line_.size() + part.size() > bytes_max_;
    if (is_too_long_) {
      line_.clear();
    } else {
      line_ += part;
    }
    if (end == std::string_view::npos) {
      break;
    }
    if (std::exchange(is_too_long_, false)) {
      ++lines.too_long;
    } else {
      lines.complete.push_back(std::exchange(line_, {}));
    }
    bytes.remove_prefix(end + 1);
  }
  return lines;
}

}  // namespace holdfast::cli
