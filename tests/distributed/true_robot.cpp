// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "true_robot.hpp"

#include <algorithm>
#include <array>

namespace holdfast::test {
namespace {

using sim::Fault;
using verdict::Verdict;

std::uint8_t bit(std::size_t face) { return static_cast<std::uint8_t>(1U << face); }

}  // namespace

TrueRobot::TrueRobot(const model::Robot& robot, const model::RobotSpec& spec)
    : robot_(robot), spec_(spec), modules_(spec.existing.size()) {}

std::int32_t TrueRobot::neighbour(std::int32_t module, std::size_t face) const {
  const std::int32_t other = robot_.neighbours()[at(module)][face];
  return other < static_cast<std::int32_t>(modules_.size()) ? other : -1;
}

void TrueRobot::set_link(const Fault& fault) {
  const auto face = static_cast<std::size_t>(base::index(fault.face));
  const auto other_face = static_cast<std::size_t>(base::index(base::opposite(fault.face)));
  const bool is_on = fault.kind == Fault::Kind::kCut || fault.kind == Fault::Kind::kUnplug;
  const bool is_cut = fault.kind == Fault::Kind::kCut || fault.kind == Fault::Kind::kMend;
  const auto set = [&](Module& module, std::size_t side) {
    std::uint8_t& faces = is_cut ? module.cut : module.open;
    faces = static_cast<std::uint8_t>(is_on ? faces | bit(side) : faces & ~bit(side));
  };
  set(modules_[at(fault.module)], face);
  set(modules_[at(neighbour(fault.module, face))], other_face);
  end_plans();
}

void TrueRobot::happen(const Fault& fault) {
  Module& module = modules_[at(fault.module)];
  if (sim::is_of_link(fault.kind)) {
    return set_link(fault);
  }
  if (fault.kind == Fault::Kind::kAttach && module.is_attached) {
    return;  // Nobody puts on what is there, silent or not.
  }
  // Its plans are lost with its memory; those of a silent one nobody knows.
  std::erase_if(plans_, [&](const Plan& plan) { return plan.holder == fault.module; });
  module.is_silent = fault.kind == Fault::Kind::kKill;
  if (fault.kind == Fault::Kind::kDetach || fault.kind == Fault::Kind::kAttach) {
    module.is_attached = fault.kind == Fault::Kind::kAttach;
  }
  end_plans();
}

/// Plans of cells in which a module sits that their holders are connected with.
void TrueRobot::end_plans() {
  const std::vector<std::int32_t> all = parts(false);
  std::erase_if(plans_, [&](const Plan& plan) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (spec_.existing[i] == plan.cell && all[i] >= 0 && all[i] == all[at(plan.holder)]) {
        return true;
      }
    }
    return false;
  });
}

void TrueRobot::happen(const sim::Announcement& announcement) {
  std::erase_if(plans_, [&](const Plan& plan) { return plan.cell == announcement.cell; });
  if (!announcement.is_withdrawal && is_alive(announcement.module)) {
    plans_.push_back({.cell = announcement.cell, .holder = announcement.module});
  }
}

std::vector<std::int32_t> TrueRobot::parts(bool by_word) const {
  std::vector<std::int32_t> parts(modules_.size(), -1);
  std::vector<std::int32_t> open;
  for (std::int32_t first = 0; first < static_cast<std::int32_t>(modules_.size()); ++first) {
    const auto is_in = [&](std::int32_t module) {
      return (by_word ? is_alive(module) : is_attached(module)) && parts[at(module)] < 0;
    };
    if (!is_in(first)) {
      continue;
    }
    parts[at(first)] = first;
    open.push_back(first);
    while (!open.empty()) {
      const std::int32_t module = open.back();
      open.pop_back();
      const Module& here = modules_[at(module)];
      for (std::size_t face = 0; face < base::kDirectionCount; ++face) {
        const std::int32_t other = neighbour(module, face);
        const int broken = by_word ? here.open | here.cut : here.open;
        if (other >= 0 && (broken & bit(face)) == 0 && is_in(other)) {
          parts[at(other)] = first;
          open.push_back(other);
        }
      }
    }
  }
  return parts;
}

/// The verdict on a part. A plan counts in the part of the module that knows of it. A part in the
/// air stands if the plan makes it stand: its verdict is that of the robot with the planned
/// modules.
Verdict TrueRobot::verdict_of(const std::vector<std::int32_t>& parts, std::int32_t part) const {
  model::RobotSpec spec = spec_;
  spec.existing.clear();
  spec.planned.clear();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i] == part) {
      spec.existing.push_back(spec_.existing[i]);
    }
  }
  std::erase_if(spec.fixed, [&](const base::Cell& cell) {
    return std::ranges::find(spec.existing, cell) == spec.existing.end();
  });
  for (const Plan& plan : plans_) {
    const bool is_taken = std::ranges::find(spec.existing, plan.cell) != spec.existing.end();
    if (parts[at(plan.holder)] == part && !is_taken) {
      spec.planned.push_back(plan.cell);
    }
  }
  auto robot = model::Robot::create(spec);
  if (!robot) {
    spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
    spec.planned.clear();
    robot = model::Robot::create(spec);
  }
  return robot ? verdict::assess(robot.value()).verdict : Verdict::kUndecided;
}

std::vector<Verdict> TrueRobot::verdicts() const {
  const std::vector<std::int32_t> all = parts(false);
  std::vector<Verdict> verdicts(all.size(), Verdict::kUndecided);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i] >= 0) {
      const auto first = at(all[i]);
      verdicts[i] = first == i ? verdict_of(all, all[i]) : verdicts[first];
    }
  }
  return verdicts;
}

bool TrueRobot::is_whole() const {
  const std::vector<std::int32_t> all = parts(true);
  std::int32_t part = -1;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Module& module = modules_[i];
    if (!module.is_attached) {
      continue;
    }
    part = part < 0 ? all[i] : part;
    if (module.is_silent || module.cut != 0 || all[i] != part) {
      return false;
    }
  }
  return true;
}

void TrueRobot::add_to(sim::SimulationOptions& options) const {
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    const Module& module = modules_[i];
    const auto index = static_cast<std::int32_t>(i);
    if (!module.is_attached) {
      options.absent.push_back(index);
    }
    if (module.is_silent) {
      options.faults.push_back({.kind = Fault::Kind::kKill, .module = index});
    }
    for (std::size_t face = 0; face < base::kDirectionCount; ++face) {
      for (const auto& [faces, kind] : {std::pair{module.cut, Fault::Kind::kCut},
                                        std::pair{module.open, Fault::Kind::kUnplug}}) {
        if ((faces & bit(face)) != 0 && neighbour(index, face) > index) {
          options.faults.push_back(
              {.kind = kind, .module = index, .face = static_cast<base::Direction>(face)});
        }
      }
    }
  }
  for (const Plan& plan : plans_) {
    options.announcements.push_back({.at = 0, .module = plan.holder, .cell = plan.cell});
  }
}

void SafeTimes::verdict_known(sim::Time time, std::int32_t module, const agent::Answer& answer) {
  if (answer.verdict != agent::Verdict::kNone && answer.reason != agent::Reason::kNoAnchor) {
    last_verdict_ = time;
  }
  close(time, module);
  if (answer.verdict == agent::Verdict::kSafe) {
    stretches_.push_back({.module = module, .from = time});
  }
}

void SafeTimes::fault_happened(const Fault& fault) {
  if (!sim::is_of_link(fault.kind)) {
    close(fault.at, fault.module);
  }
}

void SafeTimes::close(sim::Time time, std::int32_t module) {
  for (Stretch& stretch : stretches_) {
    if (stretch.module == module && stretch.to == agent::kNever) {
      stretch.to = time;
    }
  }
}

}  // namespace holdfast::test
