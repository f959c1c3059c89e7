// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace holdfast::cli {

/// The most bytes of a request.
inline constexpr std::size_t kRequestBytesMax = std::size_t{1} << 28U;

/// Lines of a stream as it comes in. One that is too long is left out up to its end.
class LineReader {
 public:
  explicit LineReader(std::size_t bytes_max = kRequestBytesMax) : bytes_max_(bytes_max) {}

  struct Lines {
    std::vector<std::string> complete = {};
    int too_long = 0;  ///< So many were left out.
  };

  /// Takes what came.
  Lines take(std::string_view bytes);

  /// What stands behind the last line feed, at the end of the stream.
  std::string rest() { return is_too_long_ ? std::string() : std::move(line_); }

 private:
  std::size_t bytes_max_;
  std::string line_;
  bool is_too_long_ = false;
};

}  // namespace holdfast::cli
