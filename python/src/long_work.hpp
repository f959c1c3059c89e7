// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cxxabi.h>

#include <chrono>
#include <thread>
#include <utility>

#include "common.hpp"

namespace holdfast::python {

/// Returns what `act` does. When Python ends it unwinds the stack of a thread that asks for the
/// GIL, which takes the process down where destructors wait in C++. Such a thread sleeps here until
/// the process has ended, as Python itself lets it from 3.14 on.
template <class Act>
auto sleep_when_python_ends(const Act& act) {
  try {
    return act();
  } catch (const abi::__forced_unwind&) {
    for (;;) {
      std::this_thread::sleep_for(std::chrono::hours(1));
    }
  }
}

/// The GIL is for others while this lives.
class GilReleased {
 public:
  GilReleased() : thread_(PyEval_SaveThread()) {}

  GilReleased(const GilReleased&) = delete;
  GilReleased& operator=(const GilReleased&) = delete;

  ~GilReleased() {
    sleep_when_python_ends([this] { PyEval_RestoreThread(thread_); });
  }

 private:
  PyThreadState* thread_;
};

/// Lets long work find out now and then, without the GIL, from the thread that was called, whether
/// the user has pressed Ctrl-C. It also tells Python how far the work is. What Python raises is
/// thrown here, through the work, which is given up.
class Watch {
 public:
  /// The function `progress`, or None, is called with the numbers of the work; with the GIL.
  explicit Watch(py::object progress) : progress_(std::move(progress)) {}

  template <class... Number>
  void operator()(Number... numbers) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ >= kPeriod) {
      last_ = now;
      tell(numbers...);
    }
  }

  /// Asks only whether to go on.
  void ask() {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_asked_ >= kPeriod) {
      last_asked_ = now;
      with_gil([] {});
    }
  }

  /// Calls the progress function at once.
  template <class... Number>
  void tell(Number... numbers) {
    with_gil([&] {
      if (!progress_.is_none()) {
        call(py::make_tuple(numbers...));
      }
    });
  }

 private:
  template <class Act>
  static void with_gil(const Act& act) {
    sleep_when_python_ends([&] {
      const py::gil_scoped_acquire gil;
      if (PyErr_CheckSignals() != 0) {
        throw py::error_already_set();
      }
      act();
    });
  }

  /// Calls Python code, which gives the GIL away now and then, and may not get it back.
  void call(const py::tuple& numbers) {
    PyObject* const result =
        sleep_when_python_ends([&] { return PyObject_CallObject(progress_.ptr(), numbers.ptr()); });
    if (result == nullptr) {
      throw py::error_already_set();
    }
    Py_DECREF(result);
  }

  static constexpr std::chrono::milliseconds kPeriod{20};

  py::object progress_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_asked_ = last_;
};

/// Does work without the GIL, so that other threads of Python run meanwhile, and lets it ask.
template <class Work>
auto without_gil(Watch& watch, const Work& work) {
  const GilReleased released;
  const host::Interruptible interruptible([&watch] { watch.ask(); });
  return work();
}

/// Does work that does not report its progress, without the GIL.
template <class Work>
auto without_gil(const Work& work) {
  Watch watch((py::none()));
  return without_gil(watch, work);
}

}  // namespace holdfast::python
