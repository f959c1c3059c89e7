// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>

namespace holdfast::plan {

/// How long somebody waits for a search, from now on: so many seconds, or until they interrupt it.
/// May be asked by several threads.
class Patience {
 public:
  /// Keeps a reference; an empty function interrupts nothing.
  Patience(double seconds_max, const std::function<bool()>& is_interrupted)
      : seconds_max_(seconds_max), is_interrupted_(is_interrupted) {}

  bool is_over() const {
    const std::chrono::duration<double> passed = Clock::now() - begin_;
    return passed.count() >= seconds_max_ || (is_interrupted_ && is_interrupted_());
  }

 private:
  using Clock = std::chrono::steady_clock;

  double seconds_max_;
  const std::function<bool()>& is_interrupted_;
  Clock::time_point begin_ = Clock::now();
};

}  // namespace holdfast::plan
