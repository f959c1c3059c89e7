// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

namespace holdfast::cli {

/// Lines on standard error that say how far a long run is: the first after a second, then one a
/// second, none if it is quiet.
class Progress {
 public:
  explicit Progress(bool is_quiet) : is_quiet_(is_quiet) {}

  /// Prints what `line()` returns, which is asked only when a line is due.
  template <class Line>
  void show(const Line& line) {
    const auto now = Clock::now();
    if (!is_quiet_ && now - shown_ >= std::chrono::seconds(1)) {
      shown_ = now;
      fmt::print(stderr, "holdfast: {}\n", line());
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_quiet_;
  Clock::time_point shown_ = Clock::now();
};

}  // namespace holdfast::cli
