// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <utility>

#include "common.hpp"

namespace holdfast::python {

/// What long work asks now and then, without the GIL, from the thread that was called: has the user
/// pressed Ctrl-C? It also tells Python how far the work is. What Python raises is thrown here,
/// through the work, which is given up.
class Watch {
 public:
  /// `progress` is None or what is called with the numbers of the work; with the GIL.
  explicit Watch(py::object progress) : progress_(std::move(progress)) {}

  template <class... Number>
  void operator()(Number... numbers) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ >= kPeriod) {
      last_ = now;
      tell(numbers...);
    }
  }

  /// Only whether to go on.
  void ask() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_asked_ >= kPeriod) {
      last_asked_ = now;
      const py::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
      }
    }
  }

  /// At once.
  template <class... Number>
  void tell(Number... numbers) {
    const py::gil_scoped_acquire gil;
    if (PyErr_CheckSignals() != 0) {
      throw py::error_already_set();
    }
    if (!progress_.is_none()) {
      progress_(numbers...);
    }
  }

 private:
  static constexpr std::chrono::milliseconds kPeriod{20};

  py::object progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_asked_ = last_;
};

/// Does work without the GIL, so that other threads of Python run meanwhile, and lets it ask.
template <class Work>
auto without_gil(Watch& watch, const Work& work) {
  const py::gil_scoped_release released;
  const host::Interruptible interruptible([&watch] { watch.ask(); });
  return work();
}

/// The same for work that does not say how far it is.
template <class Work>
auto without_gil(const Work& work) {
  Watch watch((py::none()));
  return without_gil(watch, work);
}

}  // namespace holdfast::python
