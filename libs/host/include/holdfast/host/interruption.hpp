// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

/// Long work that can be given up half way, by an exception of whoever asked for it.
namespace holdfast::host {

/// Lets long work on this thread call `ask` now and then, many times a second, while this object
/// lives. An exception of `ask` ends the work, which throws it once the threads that took part have
/// ended; only what the caller holds may be left half done. `ask` is called on this thread alone;
/// if there are several objects, only the newest one's is.
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

/// Calls `ask`, if there is any; else the call takes no time that matters. Long work calls this
/// every millisecond or so.
void ask_whether_to_go_on();

/// Whether there is anybody to be asked on this thread.
bool is_interruptible();

}  // namespace holdfast::host
