// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "holdfast/move.hpp"
#include "holdfast/order.hpp"

namespace holdfast {
namespace {

/// A line of the robot that something is proved of; an order's planned modules are its target's.
std::string robot_line(const char* label, const std::string& name, const model::RobotSpec& spec) {
  return fmt::format(
      "  {:<12}{}\n", label,
      certificate::robot_words(io::one_line(name), spec.existing.size() + spec.planned.size(),
                               spec.planned.size()));
}

std::string avoid_words(const std::vector<base::Cell>& avoid) {
  return avoid.empty() ? "" : fmt::format(", {} avoided", host::counted(avoid.size(), "cell"));
}

std::string step_words_of(const plan::OrderTask& task) {
  std::string steps = fmt::format("{} at a time", host::counted(task.group_size, "module"));
  if (task.group_size > 1) {
    steps = "up to " + steps;
  }
  if (task.rule.reach == plan::Reach::kLine) {
    steps += ", each straight in";
  } else if (task.rule.reach == plan::Reach::kSurface && task.rule.source) {
    steps += ", each along the surface from " + model::text(*task.rule.source);
  }
  if (task.in_pieces) {
    steps += ", in one piece or in several";
  }
  return steps + avoid_words(task.rule.avoid);
}

std::string step_words_of(const plan::MoveTask& task) {
  std::string steps = "1 module at a time, ";
  steps += task.motions ? fmt::format("by the motions \"{}\"", io::one_line(task.motions->name))
                        : "along its neighbours";
  if (task.within) {
    steps += fmt::format(", within {} to {}", model::text(task.within->low),
                         model::text(task.within->high));
  }
  if (!task.keep.empty()) {
    steps += fmt::format(", {} kept", host::counted(task.keep.size(), "module"));
  }
  return steps + avoid_words(task.avoid) + (task.ignores_mechanics ? ", safe or not" : "");
}

std::string what_is_proved(const ProvedMoves& proved) {
  const plan::MoveCertificateCheck& check = proved.check;
  if (check.target) {
    return fmt::format("the target itself is not safe: {}", verdict::name(*check.target));
  }
  const char* safe = proved.task.ignores_mechanics ? "" : "safe ";
  const char* none = proved.task.ignores_mechanics ? "possible" : "safe";
  return fmt::format(
      "no {}moves lead there: {} {}, {} {} {} judged again, none {}", safe,
      host::counted(check.shape_count, "shape"),
      proved.is_backward ? "from which the target is reached" : "that can be reached",
      host::counted(check.unsafe_count, "move"), proved.is_backward ? "into" : "out of",
      check.shape_count == 1 ? "it" : "them", none);
}

}  // namespace

std::string proved_text(const ProvedOrder& proved) {
  const plan::OrderTask& task = proved.task;
  const std::size_t blocked_count = proved.check.blocked_count;
  const std::string start =
      task.start.empty() ? (task.target.fixed.empty() ? "any single module" : "the fixed modules")
                         : fmt::format("{} of it", host::counted(task.start.size(), "module"));
  return fmt::format(
      "PROVED      there is no safe order that keeps the robot in one piece: {} replayed, and {}\n"
      "{}  from        {}\n  steps       {}\n",
      host::counted(proved.check.state_count, "state"),
      blocked_count == 0 ? "no step leads any further"
                         : fmt::format("{} just beyond, none of which is safe", blocked_count),
      robot_line("robot", proved.name, task.target), start, step_words_of(task));
}

std::string proved_text(const ProvedMoves& proved) {
  const plan::MoveTask& task = proved.task;
  return fmt::format("PROVED      {}\n{}{}  steps       {}\n", what_is_proved(proved),
                     robot_line("robot", proved.start_name, task.start),
                     robot_line("to", proved.target_name, task.target), step_words_of(task));
}

}  // namespace holdfast
