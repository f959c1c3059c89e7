// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/remedies.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>
#include <utility>

#include "holdfast/base/check.hpp"
#include "holdfast/plan/candidates.hpp"
#include "holdfast/plan/part_of.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;

/// The cosine to gravity from which a neighbour counts as below: those of every lattice that bear
/// part of the weight, none of those beside.
constexpr double kBelow = 0.5;

/// Indices of all modules, those first that are most connections away from a supported one.
std::vector<std::size_t> farthest_first(const model::Robot& robot) {
  std::vector<std::size_t> order;
  std::vector<bool> is_found(robot.modules().size(), false);
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (robot.modules()[i].support != model::Support::kNone) {
      order.push_back(i);
      is_found[i] = true;
    }
  }
  for (std::size_t next = 0; next < order.size(); ++next) {
    for (const std::int32_t beside : robot.connected()[order[next]]) {
      if (beside != model::Robot::kNoNeighbour && !is_found[static_cast<std::size_t>(beside)]) {
        is_found[static_cast<std::size_t>(beside)] = true;
        order.push_back(static_cast<std::size_t>(beside));
      }
    }
  }
  std::ranges::reverse(order);
  return order;
}

/// The robot with all its connections stronger by a factor, as stiff as they are.
model::RobotSpec stronger(model::RobotSpec spec, double factor) {
  if (spec.kinds.empty()) {
    spec.material.strength_vertical_n *= factor;
    spec.material.strength_lateral_n *= factor;
  }
  const auto scale = [&](model::ConnectorLaw& law) {
    law.strength_n *= factor;
    law.shear_strength_n *= factor;
    law.torsion_strength_nmm *= factor;
  };
  for (model::ModuleKind& kind : spec.kinds) {
    std::ranges::for_each(kind.connectors, scale);
  }
  std::ranges::for_each(spec.own_connectors, scale, &model::OwnConnector::law);
  return spec;
}

/// Tries changes of one robot.
class RemedySearch {
 public:
  RemedySearch(const model::RobotSpec& spec, const model::Robot& robot,
               const RemedyOptions& options)
      : spec_(spec), robot_(robot), options_(options), order_(farthest_first(robot)) {}

  Remedies find() {
    const std::vector<Cell> free = free_cells(spec_);
    const std::vector<Cell> props = prop_cells(free);
    const std::vector<Cell> fixings = fixing_cells();
    const std::vector<Cell> removals = removal_cells();
    all_ = free.size();
    for (const std::size_t count : {props.size(), fixings.size(), removals.size()}) {
      all_ += std::min(count, options_.trials_max);
    }
    Remedies found;
    list(found, RemedyKind::kModule) = with_module(free);
    list(found, RemedyKind::kProp) = each(props, [&](const Cell& cell) { return propped(cell); });
    list(found, RemedyKind::kFixing) = each(fixings, [&](const Cell& cell) { return fixed(cell); });
    list(found, RemedyKind::kRemoval) =
        each(removals, [&](const Cell& cell) { return without(cell); });
    return found;
  }

 private:
  static RemedyList& list(Remedies& remedies, RemedyKind kind) {
    return remedies.lists[static_cast<std::size_t>(kind)];
  }

  std::vector<Cell> fixing_cells() const {
    std::vector<Cell> cells;
    for (const std::size_t i : order_) {
      const model::Module& module = robot_.modules()[i];
      if (module.support != model::Support::kFixed) {
        cells.push_back(module.cell);
      }
    }
    return cells;
  }

  /// The cells of modules that may go by themselves: those of bodies may not.
  std::vector<Cell> removal_cells() const {
    const std::vector<std::int32_t> bodies = robot_.bodies();
    std::vector<Cell> cells;
    for (const std::size_t i : order_) {
      if (bodies[i] == model::OwnConnector::kNoBody) {
        cells.push_back(robot_.modules()[i].cell);
      }
    }
    return cells;
  }

  /// Returns those of the free cells that are below modules that nothing supports, each once.
  std::vector<Cell> prop_cells(std::span<const Cell> free) const {
    const auto& gravity = robot_.gravity();
    const double size = std::hypot(gravity[0], gravity[1], gravity[2]);
    std::vector<Cell> cells;
    std::set<Cell> known;
    for (const std::size_t i : order_) {
      const model::Module& module = robot_.modules()[i];
      if (module.support != model::Support::kNone) {
        continue;
      }
      for (const base::Direction direction : base::directions(robot_.lattice())) {
        const auto unit = base::heading(robot_.lattice(), direction);
        const Cell cell = base::neighbour(robot_.lattice(), module.cell, direction);
        const double down = unit[0] * gravity[0] + unit[1] * gravity[1] + unit[2] * gravity[2];
        if (down > kBelow * size && std::ranges::binary_search(free, cell) &&
            known.insert(cell).second) {
          cells.push_back(cell);
        }
      }
    }
    return cells;
  }

  model::RobotSpec propped(const Cell& cell) const {
    model::RobotSpec changed = spec_;
    changed.obstacles.push_back({.from = cell, .to = cell});
    return changed;
  }

  model::RobotSpec fixed(const Cell& cell) const {
    model::RobotSpec changed = spec_;
    if (std::erase(changed.planned, cell) > 0) {
      changed.existing.push_back(cell);
    }
    changed.fixed.push_back(cell);
    return changed;
  }

  model::RobotSpec without(const Cell& cell) const {
    model::RobotSpec changed = spec_;
    std::erase(changed.existing, cell);
    std::erase(changed.planned, cell);
    model::forget_absent(changed);
    return changed;
  }

  void count_one() {
    ++done_;
    if (options_.progress) {
      options_.progress(done_, all_);
    }
  }

  RemedyList with_module(std::span<const Cell> cells) {
    CandidateReport report = judge_candidates(
        spec_, cells,
        {.equilibrium = options_.equilibrium, .progress = [&](std::size_t done, std::size_t) {
           if (options_.progress) {
             options_.progress(done, all_);
           }
         }});
    sort_candidates(report.candidates);
    RemedyList found{.tried_count = report.candidates.size()};
    for (const Candidate& candidate : report.candidates) {
      if (candidate.judgement.is_safe()) {
        found.safe.push_back({candidate.cell, candidate.judgement});
      }
    }
    done_ = cells.size();
    return found;
  }

  template <class Change>
  RemedyList each(std::span<const Cell> cells, const Change& change) {
    const std::size_t count = std::min(cells.size(), options_.trials_max);
    RemedyList found{.untried_count = cells.size() - count};
    for (const Cell& cell : cells.first(count)) {
      count_one();
      const auto robot = model::Robot::create(change(cell), options_.equilibrium.thread_count);
      if (!robot) {
        continue;  // It falls apart, or nothing holds it.
      }
      ++found.tried_count;
      const Judgement judgement = judge(robot.value(), options_.equilibrium);
      if (judgement.is_safe()) {
        found.safe.push_back({cell, judgement});
      }
    }
    std::ranges::sort(found.safe, [](const Remedy& a, const Remedy& b) {
      return std::pair(a.judgement.load_ratio_max, a.cell) <
             std::pair(b.judgement.load_ratio_max, b.cell);
    });
    return found;
  }

  const model::RobotSpec& spec_;
  const model::Robot& robot_;
  const RemedyOptions& options_;
  std::vector<std::size_t> order_;
  std::size_t done_ = 0;
  std::size_t all_ = 0;
};

}  // namespace

std::string_view name(RemedyKind kind) {
  constexpr std::array<std::string_view, kRemedyKindCount> kNames = {"module", "prop", "fixing",
                                                                     "removal"};
  return kNames[static_cast<std::size_t>(kind)];
}

Remedies find_remedies(const model::RobotSpec& spec, const Judgement& judgement,
                       const RemedyOptions& options) {
  const auto robot = model::Robot::create(spec, options.equilibrium.thread_count);
  HOLDFAST_CHECK(robot.has_value());
  Remedies found = RemedySearch(spec, robot.value(), options).find();
  if (judgement.verdict == verdict::Verdict::kOverload && judgement.load_ratio_high) {
    const double factor = std::floor(100 * *judgement.load_ratio_high + 1) / 100;
    const auto strong =
        model::Robot::create(stronger(spec, factor), options.equilibrium.thread_count);
    if (strong && judge(strong.value(), options.equilibrium).is_safe()) {
      found.strength_factor = factor;
    }
  }
  return found;
}

}  // namespace holdfast::plan
