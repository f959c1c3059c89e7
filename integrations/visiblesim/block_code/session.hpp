// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include "ensemble.hpp"
#include "settings.hpp"

/// Holds what there is once in a run of VisibleSim: the options, the robot as a whole, what is
/// printed.
namespace holdfast::visiblesim {

class Session {
 public:
  /// The one of this process.
  static Session& instance();

  Settings settings;

  /// Reads the configuration. Says why and exits if it cannot be run.
  void open(const std::string& path);

  Ensemble& ensemble() { return *ensemble_; }

  /// A cell as the file's writer counted: VisibleSim counts from 0.
  base::Cell own_cell(const base::Cell& cell) const;
  base::Cell visiblesim_cell(const base::Cell& cell) const;

  /// The first module starts. Endless runs watch over their verdict for ever.
  void start(bool is_endless);

  /// Prints the report, and writes it if that is asked for.
  void finish();

  /// The state of the run for the window, which may ask from another thread.
  std::string status();

  /// 0 safe, 1 overload or unstable, 2 undecided.
  int exit_code() const;

 private:
  void take_verdict();

  std::unique_ptr<Ensemble> ensemble_;
  base::Cell shift_;
  std::chrono::steady_clock::time_point started_at_;
  double verdict_wall_seconds_ = 0;
  bool is_started_ = false;
  bool is_endless_ = false;
  std::mutex status_mutex_;
  std::string status_;
};

}  // namespace holdfast::visiblesim
