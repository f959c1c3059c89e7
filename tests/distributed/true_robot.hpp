// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "holdfast/model/robot.hpp"
#include "holdfast/sim/simulation.hpp"
#include "holdfast/sim/trace.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Knows what is true of a simulated robot while modules come and go and plans are told: the exact
/// verdict beside what modules say.
namespace holdfast::test {

/// The robot as an observer sees it: which modules are attached and connected, what is planned. A
/// module that is silent, or whose link is cut, still carries and weighs.
class TrueRobot {
 public:
  /// All modules that are ever there; the planned ones are told of by announcements.
  TrueRobot(const model::Robot& robot, const model::RobotSpec& spec);

  void happen(const sim::Fault& fault);
  void happen(const sim::Announcement& announcement);

  bool is_attached(std::int32_t module) const { return modules_[at(module)].is_attached; }

  bool is_alive(std::int32_t module) const {
    return modules_[at(module)].is_attached && !modules_[at(module)].is_silent;
  }

  /// Whether the connection at a face of a module is opened.
  bool is_open(std::int32_t module, base::Direction face) const {
    return ((modules_[at(module)].open >> static_cast<unsigned>(base::index(face))) & 1U) != 0;
  }

  /// The part of the robot that each module is connected with, by the lowest index in it; -1 if the
  /// module is not attached. `by_word`: over living modules and links that carry.
  std::vector<std::int32_t> parts(bool by_word) const;

  /// The exact verdict of each module's part; kUndecided if the module is not attached.
  std::vector<verdict::Verdict> verdicts() const;

  /// Whether no module is silent, no link cut, nothing apart.
  bool is_whole() const;

  /// Faults and announcements that make a fresh robot what this one is.
  void add_to(sim::SimulationOptions& options) const;

 private:
  struct Module {
    bool is_attached = true;
    bool is_silent = false;
    std::uint8_t cut = 0;   ///< By face.
    std::uint8_t open = 0;  ///< By face.
  };

  struct Plan {
    base::Cell cell;
    std::int32_t holder = 0;
  };

  static std::size_t at(std::int32_t module) { return static_cast<std::size_t>(module); }

  std::int32_t neighbour(std::int32_t module, std::size_t face) const;
  void set_link(const sim::Fault& fault);
  void end_plans();
  verdict::Verdict verdict_of(const std::vector<std::int32_t>& parts, std::int32_t part) const;

  const model::Robot& robot_;
  const model::RobotSpec& spec_;
  std::vector<Module> modules_;
  std::vector<Plan> plans_;
};

/// Records from when to when each module shows `safe`.
class SafeTimes : public sim::TraceSink {
 public:
  struct Stretch {
    std::int32_t module = 0;
    sim::Time from = 0;
    sim::Time to = agent::kNever;
  };

  void verdict_known(sim::Time time, std::int32_t module, const agent::Answer& answer) override;
  void fault_happened(const sim::Fault& fault) override;

  const std::vector<Stretch>& stretches() const { return stretches_; }

  /// The time of the last change to another verdict. It does not count modules that hear no module
  /// that knows its cell, and wait for one as long as docs/distributed.md says.
  sim::Time last_verdict() const { return last_verdict_; }

 private:
  void close(sim::Time time, std::int32_t module);

  std::vector<Stretch> stretches_;
  sim::Time last_verdict_ = 0;
};

}  // namespace holdfast::test
