// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "holdfast/distributed.hpp"

namespace holdfast {
namespace {

using Modules = std::vector<io::ModuleEntry>;

bool is_occupied(const Modules& modules, const base::Cell& cell) {
  return std::ranges::find(modules, cell, &io::ModuleEntry::cell) != modules.end();
}

/// Updates what is planned after a change. Returns a note where the change has no effect.
std::optional<std::string> follow(const Change& change, const Modules& modules, io::Step& step) {
  const bool is_all = change.kind == Change::Kind::kWithdraw && change.cell == agent::kEveryCell;
  const std::size_t withdrawn = std::erase_if(
      step, [&](const io::PlannedEntry& entry) { return is_all || entry.cell == change.cell; });
  if (change.kind == Change::Kind::kWithdraw && withdrawn == 0) {
    return is_all ? "there is no plan to withdraw when all are withdrawn"
                  : fmt::format("there is no plan to withdraw at {} when it is withdrawn",
                                model::text(change.cell));
  }
  if (change.kind != Change::Kind::kPlan) {
    return std::nullopt;
  }
  if (is_occupied(modules, change.cell)) {
    return fmt::format("a module is at {} already when one is planned there: nothing is judged",
                       model::text(change.cell));
  }
  step.emplace_back().cell = change.cell;
  return std::nullopt;
}

}  // namespace

base::Result<ChangedStructure> with_changes(const Structure& structure,
                                            std::vector<Change> changes) {
  if (const auto beyond = model::find_beyond_paper(structure.robot)) {
    return base::Error{
        .code = base::ErrorCode::kUnsupported,
        .message = fmt::format("the robot has {}, and changes on the way are simulated "
                               "of cubes on a floor only",
                               *beyond),
        .where = {}};
  }
  io::Document document = structure.document;
  document.extension.own.clear();  // Says nothing, or the robot would be beyond the paper.
  if (document.steps.empty()) {
    document.steps.emplace_back();
  }
  io::Step& step = document.steps.front();
  std::vector<std::string> warnings = structure.warnings;
  std::vector<sim::Announcement> announcements;
  std::vector<sim::Fault> attachments;
  for (const io::PlannedEntry& planned : step) {
    announcements.push_back({.at = 0, .module = 0, .cell = planned.cell});
  }
  // What happens at the same time happens in this order: attached, planned, withdrawn.
  std::ranges::stable_sort(changes, [](const Change& a, const Change& b) {
    return a.at != b.at ? a.at < b.at : a.kind < b.kind;
  });
  for (const Change& change : changes) {
    if (change.kind == Change::Kind::kAttach) {
      if (is_occupied(document.modules, change.cell)) {
        return base::Error{.code = base::ErrorCode::kBadInput,
                           .message = fmt::format("a module cannot be attached at {}: one is there",
                                                  model::text(change.cell)),
                           .where = {}};
      }
      attachments.push_back({.kind = sim::Fault::Kind::kAttach,
                             .at = change.at,
                             .module = static_cast<std::int32_t>(document.modules.size())});
      document.modules.emplace_back().cell = change.cell;
    } else {
      announcements.push_back({.at = change.at,
                               .module = 0,
                               .cell = change.cell,
                               .is_withdrawal = change.kind == Change::Kind::kWithdraw});
    }
    if (auto note = follow(change, document.modules, step)) {
      warnings.push_back(std::move(*note));
    }
  }
  document.may_be_in_pieces = false;  // Modules that compute a verdict are one robot.
  auto robot = io::make_robot(document);
  if (!robot) {
    return robot.error();
  }
  return ChangedStructure{.structure = {.name = structure.name,
                                        .document = std::move(document),
                                        .robot = std::move(robot).value(),
                                        .warnings = std::move(warnings),
                                        .origin = structure.origin},
                          .announcements = std::move(announcements),
                          .attachments = std::move(attachments)};
}

}  // namespace holdfast
