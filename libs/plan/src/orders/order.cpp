// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_set>

#include "bounds/robot_growth.hpp"
#include "holdfast/plan/part_of.hpp"
#include "orders/time_steps.hpp"
#include "patience.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using States = std::unordered_set<ElementSet, ElementSetHash>;

ElementSet whole_of(const OrderTask& task) {
  ElementSet whole(task.target.existing.size());
  for (std::size_t i = 0; i < task.target.existing.size(); ++i) {
    whole.insert(static_cast<Element>(i));
  }
  return whole;
}

base::Error bad_start(std::string message) {
  return {.code = base::ErrorCode::kBadInput, .message = std::move(message), .where = kAtStart};
}

/// The modules in these cells.
base::Result<ElementSet> find_modules(const OrderTask& task, const std::vector<Cell>& cells) {
  model::CellIndex index(task.target.existing.size());
  for (std::size_t i = 0; i < task.target.existing.size(); ++i) {
    index.insert(task.target.existing[i], static_cast<std::int32_t>(i));
  }
  ElementSet modules(task.target.existing.size());
  for (const Cell& cell : cells) {
    const std::int32_t found = index.find(cell);
    if (found == model::CellIndex::kNone) {
      return bad_start(fmt::format(
          "the start has a module in {}, where the target has none: it must be a part of it",
          model::text(cell)));
    }
    if (!modules.contains(found)) {
      modules.insert(found);
    }
  }
  return modules;
}

/// Single modules with a support, those nearest to the middle of the target first.
std::vector<ElementSet> single_starts(const OrderTask& task, const model::Robot& target) {
  std::vector<std::pair<double, Element>> ranked;
  const auto place_of = [&](std::size_t i) {
    return base::place_of(target.lattice(),
                          base::axial_of(target.lattice(), target.modules()[i].cell));
  };
  std::array<double, 2> middle{};
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    middle[0] += place_of(i)[0] / static_cast<double>(target.modules().size());
    middle[1] += place_of(i)[1] / static_cast<double>(target.modules().size());
  }
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    if (target.modules()[i].support != model::Support::kNone) {
      const double x = place_of(i)[0] - middle[0];
      const double y = place_of(i)[1] - middle[1];
      ranked.emplace_back(x * x + y * y, static_cast<Element>(i));
    }
  }
  std::ranges::sort(ranked);
  std::vector<ElementSet> starts;
  for (const auto& [distance, element] : ranked) {
    starts.emplace_back(task.target.existing.size()).insert(element);
  }
  return starts;
}

/// Adds the rest of every body of which a state has a part.
void complete_bodies(const model::Robot& target, ElementSet& state) {
  for (const auto& [body, modules] : target.modules_by_body()) {
    const auto is_there = [&](Element module) { return state.contains(module); };
    if (std::ranges::any_of(modules, is_there)) {
      for (const Element module : modules) {
        if (!state.contains(module)) {
          state.insert(module);
        }
      }
    }
  }
}

/// What is wrong with a start that has a part of a body.
std::optional<base::Error> find_body_fault(const model::Robot& target, const ElementSet& start) {
  for (const auto& [body, modules] : target.modules_by_body()) {
    const auto is_there = [&](Element module) { return start.contains(module); };
    const auto there = std::ranges::find_if(modules, is_there);
    const auto missing = std::find_if_not(modules.begin(), modules.end(), is_there);
    if (there != modules.end() && missing != modules.end()) {
      const auto cell = [&](Element module) { return target.modules()[base::at(module)].cell; };
      return bad_start(
          fmt::format("the start has {} of body {}, but not {}: a body comes as a whole",
                      model::text(cell(*there)), body, model::text(cell(*missing))));
    }
  }
  return std::nullopt;
}

/// Single modules, or bodies, with a support; see single_starts().
std::vector<ElementSet> unit_starts(const OrderTask& task, const model::Robot& target) {
  std::vector<ElementSet> starts = single_starts(task, target);
  States seen;
  if (target.has_bodies()) {
    std::erase_if(starts, [&](ElementSet& start) {
      complete_bodies(target, start);
      return !seen.insert(start).second;
    });
  }
  return starts;
}

/// All states that an order may begin with.
base::Result<std::vector<ElementSet>> find_starts(const OrderTask& task,
                                                  const model::Robot& target) {
  const std::vector<Cell>& cells = task.start.empty() ? task.target.fixed : task.start;
  if (cells.empty()) {
    return unit_starts(task, target);
  }
  auto found = find_modules(task, cells);
  if (!found) {
    return found.error();
  }
  ElementSet modules = std::move(found).value();
  if (task.start.empty()) {
    complete_bodies(target, modules);
  } else if (auto fault = find_body_fault(target, modules)) {
    return *std::move(fault);
  }
  for (const Cell& cell : task.target.fixed) {
    if (std::ranges::find(cells, cell) == cells.end()) {
      return bad_start(
          fmt::format("the fixed module {} is not in the start: no step attaches a fixed module",
                      model::text(cell)));
    }
  }
  for (const ElementSet& piece :
       task.in_pieces ? pieces_of(target, modules) : std::vector{modules}) {
    const auto start = model::Robot::create(part_of(task.target, piece));
    if (!start) {
      return bad_start(
          fmt::format("the start: {}{}", start.error().message,
                      task.start.empty() ? "; give one that connects the fixed modules" : ""));
    }
  }
  return std::vector<ElementSet>{std::move(modules)};
}

/// Modules that are in all starts.
ElementSet core_of(const std::vector<ElementSet>& starts, std::size_t module_count) {
  return starts.size() == 1 ? starts.front() : ElementSet(module_count);
}

bool touches_target(const OrderTask& task, const Cell& cell) {
  for (const base::Direction side : base::directions(task.target.lattice)) {
    const Cell beside = base::neighbour(task.target.lattice, cell, side);
    if (std::ranges::find(task.target.existing, beside) != task.target.existing.end()) {
      return true;
    }
  }
  return false;
}

std::optional<base::Error> find_source_fault(const OrderTask& task) {
  const bool is_surface = task.rule.reach == Reach::kSurface;
  if (is_surface != task.rule.source.has_value()) {
    return base::bad_input(is_surface
                               ? "along the surface modules come from a source: give its cell"
                               : "a source is for ways along the surface only");
  }
  if (!is_surface) {
    return std::nullopt;
  }
  const std::vector<Cell>& start = task.start.empty() ? task.target.fixed : task.start;
  if (std::ranges::find(start, *task.rule.source) != start.end()) {
    return base::bad_input(fmt::format("the source {} is taken by a module of the start",
                                       model::text(*task.rule.source)));
  }
  if (!ReachFinder(task.target, task.rule).has_room(*task.rule.source)) {
    return base::bad_input(fmt::format(
        "the source {} lies in an obstacle or below the floor: nothing comes from there",
        model::text(*task.rule.source)));
  }
  if (task.target.existing.size() > 1 && !touches_target(task, *task.rule.source)) {
    return base::bad_input(
        fmt::format("the source {} touches no module of the target: nothing that comes "
                    "from there gets to the robot",
                    model::text(*task.rule.source)));
  }
  return std::nullopt;
}

std::optional<base::Error> find_avoid_fault(const OrderTask& task) {
  if (task.rule.avoid.empty()) {
    return std::nullopt;
  }
  if (task.rule.reach == Reach::kFree) {
    return base::bad_input(
        "cells to be avoided bar ways, and modules that get anywhere have none: choose line or "
        "surface for how modules reach their cells");
  }
  const std::set<Cell> modules(task.target.existing.begin(), task.target.existing.end());
  for (const Cell& cell : task.rule.avoid) {
    if (modules.contains(cell)) {
      return base::bad_input(fmt::format(
          "the cell {} is to be avoided, but the target has a module there", model::text(cell)));
    }
    if (cell == task.rule.source) {
      return base::bad_input(fmt::format(
          "the cell {} is to be avoided, but modules come from there", model::text(cell)));
    }
  }
  return std::nullopt;
}

/// What both search and replay need, checked.
struct Setting {
  model::Robot target;
  std::vector<ElementSet> starts;
  ElementSet core;
};

base::Result<Setting> make_setting(const OrderTask& task, int thread_count) {
  if (task.parallel_max == 0 || (task.parallel_max > 1 && task.group_size > 1)) {
    return base::bad_input(
        "modules come in any order, up to one number of them at a time, or several at the same "
        "instant: expected at least one module at a time, and no groups beside several");
  }
  if (task.in_pieces && (task.parallel_max > 1 || task.group_size > 1)) {
    return base::bad_input("a robot that grows in pieces does so by one module at a time");
  }
  if (!task.target.planned.empty()) {
    return base::bad_input("the target has planned modules: all of an order's modules exist in it");
  }
  auto target = model::Robot::create(task.target, thread_count);
  if (!target) {
    return target.error();
  }
  if (target.value().has_bodies() &&
      (task.parallel_max > 1 || task.in_pieces || task.rule.reach != Reach::kFree)) {
    return base::bad_input(
        "the target has bodies, which come as wholes: expected one step after another in one "
        "piece, and no ways to cells, which are those of single modules");
  }
  for (const auto& find_fault : {find_avoid_fault, find_source_fault}) {
    if (const auto fault = find_fault(task)) {
      return *fault;
    }
  }
  auto starts = find_starts(task, target.value());
  if (!starts) {
    return starts.error();
  }
  ElementSet core = core_of(starts.value(), task.target.existing.size());
  return Setting{.target = std::move(target).value(),
                 .starts = std::move(starts).value(),
                 .core = std::move(core)};
}

/// Whether the modules of each step of an order in pieces are connected to none that is there.
std::vector<bool> steps_apart(const model::Robot& target, const Order& order) {
  std::vector<bool> are_apart;
  ElementSet there = order.start;
  for (const Batch& group : order.steps) {
    are_apart.push_back(
        std::ranges::none_of(target.connected()[base::at(group.front())], [&](std::int32_t other) {
          return other != model::Robot::kNoNeighbour && there.contains(other);
        }));
    std::ranges::for_each(group, [&](Element element) { there.insert(element); });
  }
  return are_apart;
}

/// Solves the states on the way that a bound has certified, as long as there is time.
class CertifiedStates {
 public:
  /// Keeps references.
  CertifiedStates(RobotGrowth& growth, Order& order, const Patience& patience)
      : growth_(growth), order_(order), patience_(patience) {}

  /// `tell` is called now and then with a state's number of modules.
  void solve(const std::function<void(std::size_t)>& tell) {
    ElementSet state = order_.start;
    for (std::size_t i = 0; i < order_.judgements.size() && !patience_.is_over(); ++i) {
      if (i > 0) {
        state = changed(std::move(state), Sense::kGrowing, order_.steps[i - 1]);
      }
      if (order_.judgements[i].is_bound) {
        places_.push_back(i);
        states_.push_back(state);
      }
      if (states_.size() == kTogether || i + 1 == order_.judgements.size()) {
        tell(state.size());
        solve_together();
      }
    }
  }

 private:
  /// Sets of all modules take memory.
  static constexpr std::size_t kTogether = 64;

  void solve_together() {
    const auto solved = growth_.judge_each(states_, [&] { return patience_.is_over(); });
    for (std::size_t k = 0; k < solved.size(); ++k) {
      if (solved[k] && solved[k]->is_safe()) {
        order_.judgements[places_[k]] = *solved[k];
      }
    }
    places_.clear();
    states_.clear();
  }

  RobotGrowth& growth_;
  Order& order_;
  const Patience& patience_;
  std::vector<std::size_t> places_;  ///< In the judgements,
  std::vector<ElementSet> states_;   ///< and what they are of.
};

void raise(std::optional<double>& largest, double value) {
  largest = std::max(largest.value_or(value), value);
}

}  // namespace

base::Result<OrderTask> with_kept(OrderTask task, std::span<const CellBox> keep) {
  const auto kept = kept_modules(keep, task.target.existing);
  if (!kept) {
    return kept.error();
  }
  std::set<Cell> start(task.start.begin(), task.start.end());
  for (const Cell& cell : kept.value()) {
    if (start.insert(cell).second && !task.start.empty()) {
      return bad_start(fmt::format(
          "the module {} is to be kept, and is not in the start: no step attaches or detaches it",
          model::text(cell)));
    }
  }
  if (task.start.empty() && !kept.value().empty()) {
    start.insert(task.target.fixed.begin(), task.target.fixed.end());
    task.start = {start.begin(), start.end()};
  }
  return task;
}

base::Result<RobotOrder> find_robot_order(const OrderTask& task, const RobotOrderOptions& options) {
  const auto setting = make_setting(task, options.thread_count);
  if (!setting) {
    return setting.error();
  }
  const Setting& made = setting.value();
  RobotGrowth growth(task.target, made.target, made.core, task.rule, task.in_pieces,
                     options.thread_count);
  if (!task.start.empty()) {
    const Judgement start = growth.judge(made.starts.front());
    if (!start.is_safe()) {
      return bad_start(fmt::format("the start is not safe: {}", verdict_text(start)));
    }
  }
  const Patience patience(options.seconds_max, options.is_interrupted);
  RobotOrder result;
  result.order = find_order(growth, made.starts,
                            {.group_size = task.group_size,
                             .seed = options.seed,
                             .seconds_max = options.seconds_max,
                             .state_count_max = options.state_count_max,
                             .is_interrupted = options.is_interrupted,
                             .told_end = options.told_end,
                             .progress = options.progress});
  if (task.in_pieces) {
    result.order.is_apart = steps_apart(made.target, result.order);
  }
  const bool is_parallel = task.parallel_max > 1;
  const bool is_told_on_the_way = is_parallel && options.told_end == Sense::kGrowing;
  if (is_parallel && result.order.outcome == OrderOutcome::kFound) {
    TimeSteps steps(task, made.target, options, patience);
    steps.replace(result.order);
    result.load_ratio_max = steps.solved_ratio();
    result.step_count_least = step_count_least(made.target, result.order.start, task.parallel_max);
  }
  if (options.certified && !is_told_on_the_way && result.order.outcome == OrderOutcome::kFound) {
    tell_steps(result.order, options.told_end, options.certified);
  }
  if (options.is_exact && !is_parallel) {
    CertifiedStates(growth, result.order, patience).solve([&](std::size_t module_count) {
      if (options.progress) {
        options.progress(result.order.state_count, module_count, module_count);
      }
    });
  }
  take_extremes(result);
  if (result.order.closure) {
    result.certificate = {.task = task, .closure = *std::move(result.order.closure)};
    result.order.closure.reset();
  }
  return result;
}

void take_extremes(RobotOrder& result) {
  for (const Judgement& judged : result.order.judgements) {
    if (judged.load_ratio_high) {
      raise(result.load_ratio_bound, *judged.load_ratio_high);
    }
    if (judged.load_ratio_max && !judged.is_bound) {
      raise(result.load_ratio_max, *judged.load_ratio_max);
    }
    if (judged.margin_mm) {
      result.margin_min_mm =
          std::min(result.margin_min_mm.value_or(*judged.margin_mm), *judged.margin_mm);
    }
  }
}

void tell_steps(const Order& order, Sense told_end, const StepListener& certified) {
  const std::size_t count = order.steps.size();
  const bool is_reversed = told_end == Sense::kShrinking;
  Batch first = order.start.elements();
  for (std::size_t i = 0; is_reversed && i < count; ++i) {
    first.insert(first.end(), order.steps[i].begin(), order.steps[i].end());
  }
  certified(first, order.judgements[is_reversed ? count : 0]);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t step = is_reversed ? count - 1 - i : i;
    certified(order.steps[step], order.judgements[is_reversed ? step : step + 1]);
  }
}

base::Result<CertificateCheck> verify(const OrderCertificate& certificate, int thread_count) {
  const OrderTask& task = certificate.task;
  const Closure& closure = certificate.closure;
  const auto setting = make_setting(task, thread_count);
  if (!setting) {
    return setting.error();
  }
  const Setting& made = setting.value();
  RobotGrowth growth(task.target, made.target, made.core, task.rule, task.in_pieces, thread_count);
  const States inside(closure.states.begin(), closure.states.end());
  States beyond;
  const std::vector<ElementSet> whole = {whole_of(task)};
  const bool is_growing = closure.sense == Sense::kGrowing;
  const std::vector<ElementSet>& near = is_growing ? made.starts : whole;
  const std::vector<ElementSet>& far = is_growing ? whole : made.starts;
  for (const ElementSet& state : far) {
    if (inside.contains(state)) {
      return base::bad_input("the other end is inside the cut: the certificate proves nothing");
    }
  }
  const auto look_at = [&](const ElementSet& state) {
    if (inside.contains(state) || !beyond.insert(state).second) {
      return true;
    }
    const Judgement judged = growth.judge(state);
    return !judged.is_safe() && judged.verdict != verdict::Verdict::kUndecided;
  };
  const auto leaves = [](const ElementSet& state) {
    return base::bad_input(
        fmt::format("a state of {} modules outside the cut is safe, or undecided: the "
                    "certificate proves nothing",
                    state.size()));
  };
  for (const ElementSet& state : near) {
    if (!look_at(state)) {
      return leaves(state);
    }
  }
  for (const ElementSet& state : closure.states) {
    for (const Batch& group : successors(growth, state, closure.sense, task.group_size)) {
      const ElementSet next = changed(state, closure.sense, group);
      if (!look_at(next)) {
        return leaves(next);
      }
    }
  }
  return CertificateCheck{.state_count = inside.size(), .blocked_count = beyond.size()};
}

}  // namespace holdfast::plan
