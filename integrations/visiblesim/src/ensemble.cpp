// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ensemble.hpp"

#include <algorithm>
#include <utility>

#include "block.hpp"
#include "holdfast/sim/simulation.hpp"

namespace holdfast::visiblesim {

Ensemble::Ensemble(Structure structure, sim::SimulationOptions options)
    : structure_(std::move(structure)),
      options_(std::move(options)),
      setup_(sim::make_setup(structure_.robot, options_)),
      recorder_(nullptr) {
  for (const model::Module& module : structure_.robot.modules()) {
    if (module.is_planned) {
      planned_.push_back(module.cell);
    }
  }
}

agent::Identity Ensemble::identity_of(std::uint32_t id, const base::Cell& cell) const {
  const auto& modules = structure_.document.modules;
  const auto found = std::ranges::find(modules, cell, &io::ModuleEntry::cell);
  return {.id = id,
          .is_fixed = found != modules.end() && found->is_fixed,
          .is_anchor = found == modules.begin(),
          .cell = cell};
}

std::vector<base::Cell> Ensemble::plans_told_to(const base::Cell& cell) const {
  return cell == first_cell() ? planned_ : std::vector<base::Cell>();
}

std::int32_t Ensemble::add(const Block& block) {
  blocks_.push_back(&block);
  ++part_count_;
  return static_cast<std::int32_t>(blocks_.size() - 1);
}

void Ensemble::remove(std::int32_t index) { blocks_[static_cast<std::size_t>(index)] = nullptr; }

void Ensemble::leave(agent::Verdict verdict) {
  --part_count_;
  knowing_count_ -= verdict != agent::Verdict::kNone ? 1 : 0;
}

void Ensemble::verdict_changed(agent::Verdict from, agent::Verdict to) {
  if (from == to) {
    return;
  }
  knowing_count_ += (to != agent::Verdict::kNone ? 1 : 0) - (from != agent::Verdict::kNone ? 1 : 0);
  if (to != agent::Verdict::kNone) {
    tell_verdict();
  }
}

void Ensemble::tell_verdict() const {
  if (on_verdict_ && knows_verdict()) {
    on_verdict_();
  }
}

bool Ensemble::is_at_rest(agent::Time now) const {
  if (work_count_ > 0 || pending_count_ > 0) {
    return false;
  }
  const agent::Time verdict_at = recorder_.result().verdict_time;
  agent::Time until = options_.watch_for == 0               ? 0
                      : options_.watch_for == agent::kNever ? agent::kNever
                                                            : verdict_at + options_.watch_for;
  if (break_at_ != agent::kNever) {
    // Twice: each side of the break may have to hear of the other's new round.
    for (const Block* block : blocks_) {
      if (block != nullptr && block->takes_part()) {
        until = std::max(until, break_at_ + 2 * block->agent().watch_time());
      }
    }
  }
  return now > until;
}

sim::SimulationResult Ensemble::result() const {
  sim::Outcome outcome(recorder_.result());
  std::int32_t index = 0;
  for (const Block* block : blocks_) {
    if (block != nullptr && block->is_attached()) {
      outcome.add(index++, block->outcome());
    }
  }
  return outcome.result();
}

/// The document with the modules that are there and, if the module that was told of the plans is
/// there, those plans whose cells are free.
base::Result<Structure> Ensemble::structure_now() const {
  io::Document document = structure_.document;
  std::vector<io::ModuleEntry> modules;
  for (const Block* block : blocks_) {
    if (block == nullptr || !block->is_attached()) {
      continue;
    }
    const auto found = std::ranges::find(document.modules, block->cell(), &io::ModuleEntry::cell);
    modules.push_back(found != document.modules.end() ? *found : io::ModuleEntry{});
    modules.back().cell = block->cell();
  }
  document.modules = std::move(modules);
  io::Step step;
  const auto is_there = [&](const base::Cell& cell) {
    return std::ranges::find(document.modules, cell, &io::ModuleEntry::cell) !=
           document.modules.end();
  };
  for (const base::Cell& cell : planned_) {
    if (is_there(first_cell()) && !is_there(cell)) {
      step.emplace_back().cell = cell;
    }
  }
  document.steps = {std::move(step)};
  auto robot = io::make_robot(document);
  if (!robot) {
    return robot.error();
  }
  return Structure{.name = structure_.name,
                   .document = std::move(document),
                   .robot = std::move(robot).value(),
                   .warnings = {}};
}

base::Result<EnsembleReport> Ensemble::report() const {
  auto structure = structure_now();
  if (!structure) {
    return structure.error();
  }
  std::vector<const Block*> attached;
  std::ranges::copy_if(blocks_, std::back_inserter(attached),
                       [](const Block* block) { return block != nullptr && block->is_attached(); });
  const Agents agents{.at = [&](std::int32_t index) -> const agent::Agent& {
                        return attached[static_cast<std::size_t>(index)]->agent();
                      },
                      .count = static_cast<std::int32_t>(attached.size())};
  CheckResult exact = check(structure.value());
  DistributedRun run = describe_run(structure.value().robot, exact, options_, agents, result());
  return EnsembleReport{std::move(structure).value(), std::move(exact), std::move(run)};
}

}  // namespace holdfast::visiblesim
