// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/agent.hpp"
#include "holdfast/module/configuration.hpp"
#include "holdfast/module/port.hpp"

/// The program of a module around its agent: from what a port offers to events, and from actions
/// back to the port. No algorithm.
///
///     Module module(configuration.setup, configuration.identity, plans, port);
///     for (;;) module.run_once();
///
/// A neighbour that is heard for the first time, or again after it was gone, is a link that comes
/// up. One that is no longer heard is left to the agent's link: whether it has been taken off or
/// has only failed cannot be known here, and a module that is still attached still weighs. So
/// the verdict is `undecided` then, never `safe`.
namespace holdfast::module {

/// What a module has been told of plans and withdrawals, in memory that a reset leaves alone: a
/// module that starts again must not think of a robot without them. What has ended is no longer in
/// it. Of the two copies the sound one with the later number holds; the other is written next, so
/// that a reset in the midst of writing loses nothing but what was about to be written.
struct PlanMemory {
  struct Copy {
    std::uint32_t magic = 0;
    std::uint32_t number = 0;
    agent::Announcements told;
    std::uint32_t checksum = 0;
  };

  std::array<Copy, 2> copies;
};

/// What the module has come to, for a debugger.
struct Status {
  std::uint32_t step_count = 0;
  std::uint32_t plan_count = 0;  ///< Announced to this module and not ended.
  agent::Verdict verdict = agent::Verdict::kNone;
  agent::Reason reason{};
  std::uint8_t phase = 0;
  base::Direction worst_direction{};
  float load_ratio_max = 0;
  base::Cell worst_cell;
  float own_load_ratio = 0;
  agent::Colour colour;
  std::uint32_t epoch = 0;
};

#ifndef __AVR__
static_assert(sizeof(Status) == 40);
#endif

class Module {
 public:
  /// Keeps references to all but the identity.
  Module(const agent::Setup& setup, const agent::Identity& identity, PlanMemory& plans, Port& port);

  /// Does what there is to do, then waits for more.
  void run_once();

  /// Takes word from outside that a module is planned at a cell, or no more; agent::kEveryCell
  /// withdraws all.
  void plan(const base::Cell& cell) { tell(agent::EventKind::kPlan, cell); }

  void withdraw(const base::Cell& cell) { tell(agent::EventKind::kWithdraw, cell); }

  const Status& status() const { return status_; }

  const agent::Agent& agent() const { return agent_; }

 private:
  void tell(agent::EventKind kind, const base::Cell& cell);
  void step(agent::EventKind kind, int face = 0);
  void recall_plans();
  void keep_plans();
  void take_plan(std::span<const std::uint8_t> payload);
  void watch_neighbours();
  bool take_incoming();
  void send();
  void show();

  Port& port_;
  PlanMemory& plans_;
  std::size_t kept_ = 0;  ///< The copy that holds.
  Status status_;
  agent::Event event_;
  agent::Actions actions_;
  std::uint8_t connected_ = 0;  ///< Faces with a neighbour, by bit.
  Time wake_at_ = agent::kNever;
  agent::Agent agent_;
};

}  // namespace holdfast::module
