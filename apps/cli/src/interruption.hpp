// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <csignal>

namespace holdfast::cli {

/// Notes the first SIGINT or SIGTERM while this object lives; the next one does what it always
/// does.
class Interruption {
 public:
  Interruption() {
    struct sigaction action {};

    action.sa_handler = [](int signal) {
      is_here_ = 1;
      ::sigaction(signal, &before_[signal == SIGINT ? 0 : 1], nullptr);
    };
    ::sigaction(SIGINT, &action, &before_[0]);
    ::sigaction(SIGTERM, &action, &before_[1]);
  }

  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  ~Interruption() {
    ::sigaction(SIGINT, before_.data(), nullptr);
    ::sigaction(SIGTERM, &before_[1], nullptr);
  }

  static bool is_here() { return is_here_ != 0; }

 private:
  static inline volatile std::sig_atomic_t is_here_ = 0;
  static inline std::array<struct sigaction, 2> before_{};
};

}  // namespace holdfast::cli
