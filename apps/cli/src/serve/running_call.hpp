// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "program.hpp"
#include "serve/call.hpp"

namespace holdfast::cli {

/// What a call printed and wrote, and how it ended.
struct Finished {
  enum class End : std::uint8_t { kByItself, kCancelled, kTooLong, kBySignal };

  End end = End::kByItself;
  int exit_code = 0;
  std::string text;                ///< Standard output.
  std::vector<std::string> notes;  ///< Of the reader and others.
  std::string errors;              ///< Whatever else was on standard error and is no progress.
  std::string report;              ///< JSON in one line; empty if there is none.
  std::vector<std::pair<std::string, std::string>> outputs;  ///< Name and content.
};

/// A command that runs in a process of its own, so that whatever becomes of it nothing else does.
/// The process that starts it must have no other thread.
class RunningCall {
 public:
  using Clock = std::chrono::steady_clock;

  struct Limits {
    double seconds_max = 0;  ///< 0: none.
    double memory_gb = 0;    ///< 0: none.
  };

  /// Begins, in a copy of the program, which has not been used. Throws std::system_error if there
  /// can be no further process.
  RunningCall(Call call, Program& program, const Limits& limits);
  RunningCall(RunningCall&& other) noexcept;
  RunningCall& operator=(RunningCall&&) = delete;
  RunningCall(const RunningCall&) = delete;

  /// Ends the process at once if it still runs, and removes its files.
  ~RunningCall();

  /// The descriptors to be polled; -1 where there is nothing more to come.
  int output() const { return output_; }

  int errors() const { return errors_; }

  /// Takes what there is to read from a descriptor. Returns lines of progress that came.
  std::vector<std::string> take(int descriptor);

  /// Whether it has closed its outputs; it is to be finished then.
  bool is_over() const { return output_ < 0 && errors_ < 0; }

  /// Waits for the process, which is over, and returns all.
  Finished finish();

  /// Asks it to end; who does not within a second is ended by tick().
  void cancel() { stop(Finished::End::kCancelled); }

  /// Ends what takes too long; called several times a second.
  void tick();

 private:
  [[noreturn]] void run_as_child(Program& program, int output, int errors, double memory_gb);
  std::vector<std::string> take_error_lines(std::string_view text);
  void stop(Finished::End reason);
  void close_outputs();

  Call call_;
  pid_t process_ = -1;
  int output_ = -1;
  int errors_ = -1;
  Clock::time_point ends_ = Clock::time_point::max();
  Clock::time_point killed_ = Clock::time_point::max();
  std::string line_;  ///< The beginning of a line of standard error.
  std::vector<std::string> lines_;
  Finished finished_;
};

}  // namespace holdfast::cli
