// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "holdfast/distributed.hpp"
#include "holdfast/trial.hpp"

/// Finds the next places by the robot itself: a simulated robot judges all its free faces together,
/// after its verdict (holdfast/agent/free_faces/free_faces.hpp). The same robot can plan, judge and
/// withdraw the cells that this leaves undecided, one after the other.
namespace holdfast {

/// The effort that something took the robot.
struct RobotEffort {
  sim::Time time = 0;
  std::uint64_t rounds = 0;  ///< By how much the longest chain of packets has grown.
  std::uint64_t packets = 0;
};

struct SimulatedNext {
  sim::LinkModel link = {};
  agent::Answer answer = {};  ///< Of the robot as it is.
  bool all_agree = false;
  std::uint16_t depth = 0;  ///< Of its tree: a sweep is twice as many rounds.
  /// The answers of the modules beside all free cells, best first.
  NextResult next;
  std::size_t hanging_count = 0;        ///< Candidates with one neighbour, above the ground.
  std::size_t shown_count = 0;          ///< Candidates that were decided all together.
  std::size_t hanging_shown_count = 0;  ///< The hanging ones of them.
  RobotEffort verdict = {};             ///< Up to the verdict, had it not been for the faces.
  RobotEffort faces = {};               ///< Beyond that, for all free faces together.
  /// The effort for each cell that was left, from its plan to the verdict after its withdrawal.
  std::vector<RobotEffort> trials = {};

  /// Rounds in sweeps of this robot.
  double sweeps(std::uint64_t rounds) const {
    return depth == 0 ? 0 : static_cast<double>(rounds) / (2.0 * depth);
  }
};

/// The options of the simulation.
struct SimulatedNextOptions {
  sim::SimulationOptions simulation = {};
  bool tries_others = true;  ///< Whether cells that stay undecided are planned in turn.
  /// A function that is called with the number of cells that have been planned, and of all.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

/// Simulates a robot whose planned modules are attached. If it goes beyond [Piranda 2021], see
/// model::find_beyond_paper(), nothing is decided all together: all cells are planned in turn.
/// Errors: options that do not fit; the robot is what the modules' program does not know.
base::Result<SimulatedNext> simulate_next(const model::RobotSpec& spec,
                                          const SimulatedNextOptions& options = {});
base::Result<SimulatedNext> simulate_next(const Structure& structure,
                                          const SimulatedNextOptions& options = {});

/// The report for people: what took how many sweeps, then the table of next_text().
std::string simulated_next_text(const Structure& structure, const SimulatedNext& simulated,
                                const NextReportOptions& options = {});

/// Writes the keys of write_next_json() and "distributed", what it took.
void write_simulated_next_json(std::ostream& out, const Structure& structure,
                               const SimulatedNext& simulated,
                               const NextReportOptions& options = {});

}  // namespace holdfast
