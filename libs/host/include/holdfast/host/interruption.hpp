// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

/// Long work that can be given up half way, by an exception of whoever asked for it.
namespace holdfast::host {

/// While it lives, long work on this thread calls `ask` now and then, many times a second. What
/// that throws ends the work and is thrown by it, once the threads that took part have ended too.
/// Nothing is left half done but what the caller holds. `ask` is called on this thread alone. Of
/// several the newest is asked.
class Interruptible {
 public:
  explicit Interruptible(std::function<void()> ask);
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;
  ~Interruptible();

 private:
  friend void ask_whether_to_go_on();
  friend bool is_interruptible();

  std::function<void()> ask_;
  const Interruptible* before_;
};

/// Asks, if there is anybody to be asked; else it takes no time that matters. What takes long calls
/// it every millisecond or so.
void ask_whether_to_go_on();

/// Whether there is anybody to be asked on this thread.
bool is_interruptible();

}  // namespace holdfast::host
