// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/batch_bound.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "holdfast/base/check.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/plan/robot_state.hpp"
#include "holdfast/solver/dense.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "own_solution.hpp"

namespace holdfast::plan {

void BatchBound::Span::add(const Vec& more) {
  for (std::size_t i = 0; i < more.size(); ++i) {
    (more[i] > 0 ? high : low)[i] += more[i];
  }
}

/// The energy of the part that has the most of it.
double BatchBound::Span::energy(const Vec& stiffness) const {
  double energy = 0;
  for (std::size_t i = 0; i < stiffness.size(); ++i) {
    const double most = std::max(high[i], -low[i]);
    energy += most * most / stiffness[i];
  }
  return energy;
}

BatchBound::BatchBound(const model::RobotSpec& spec, const model::Robot& target,
                       const LocalAdjoints& nearby)
    : spec_(spec), target_(target), bound_(target, nearby, {}, EnergyBound::Use::kTrying) {}

bool BatchBound::begin(const ElementSet& core, const verdict::Assessment& solved) {
  core_ = core;
  batch_ = {};
  prepared_.clear();
  followed_.clear();
  answers_.reset();
  balance_.reset();
  const std::vector<Element> elements = core.elements();
  if (verdict::is_on_flat_floor(target_) && target_.fixed_count() == 0) {
    balance_.emplace(target_);
    std::ranges::for_each(elements, [&](Element element) { balance_->add(element); });
  }
  const bool is_safe = solved.verdict == verdict::Verdict::kSafe;
  const bool is_polygon = solved.stability_rule == verdict::StabilityRule::kPolygon;
  has_core_ = is_safe && !needs_own_solution(target_) && (balance_ || !is_polygon) &&
              bound_.begin(elements, solved);
  if (!has_core_) {
    return false;
  }
  batch_.own_room = std::numeric_limits<double>::infinity();
  core_place_.assign(target_.modules().size(), -1);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    core_place_[base::at(elements[i])] = static_cast<std::int32_t>(i);
  }
  answers_ = CoreAnswers::make(spec_, core);
  if (answers_) {
    const model::Robot& robot = answers_->robot();
    for (const model::Connection& pair : robot.connections()) {
      const Vec force = bound_.beam().middle_force(
          pair.direction, bound_.displacement(base::at(elements[base::at(pair.a)])),
          bound_.displacement(base::at(elements[base::at(pair.b)])));
      batch_.ratios.push_back(model::load_ratio(robot.connector(pair), force).ratio);
    }
  }
  return true;
}

/// A module in balance with the robot before, and what its beams and facets carry then.
BatchBound::Footprint BatchBound::placed(Element module) {
  const std::size_t index = base::at(module);
  bound_.place(index);
  Footprint print{.module = module,
                  .u = bound_.displacement(index),
                  .own_room = std::numeric_limits<double>::infinity(),
                  .root = bound_.root_of(index)};
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const std::int32_t other = target_.connected()[index][base::at(base::index(direction))];
    if (other != model::Robot::kNoNeighbour && core_.contains(other)) {
      print.hosts.push_back(base::at(other));
    }
  }
  const double sway = bound_.sway_of(print.root);
  bound_.take_back();
  print.sway = sway - bound_.sway_of(print.root);
  return print;
}

/// Finds how the hosts of each move by loads on each other.
void BatchBound::find_inverse(std::span<const Footprint> prints) {
  std::vector<std::size_t> modules;
  std::vector<solver::Edge> pairs;
  for (const Footprint& print : prints) {
    for (const std::size_t a : print.hosts) {
      modules.push_back(base::at(core_place_[a]));
      for (const std::size_t b : print.hosts) {
        if (a < b) {
          pairs.push_back({.a = core_place_[a], .b = core_place_[b]});
        }
      }
    }
  }
  std::ranges::sort(modules);
  modules.erase(std::unique(modules.begin(), modules.end()), modules.end());
  answers_->find_inverse(modules, pairs);
}

/// What a module that is placed puts on its hosts, which give way: f = f_0 + A G f, f_0 being that
/// where they are, G how they move by loads, and A what their moving makes of the module's beams.
std::vector<PointLoad> BatchBound::loads_of(const Footprint& print) {
  const std::size_t module = base::at(print.module);
  bound_.place(module);
  const std::vector<LoadSpread::Load> first = bound_.loads_beside(module);
  bound_.take_back();
  const std::size_t count = 6 * first.size();
  solver::DenseSystem system(count);
  std::vector<double> loads(count);
  for (std::size_t column = 0; column < count; ++column) {  // A G of a unit load.
    const std::size_t loaded = base::at(core_place_[first[column / 6].module]);
    const auto moved = [&](std::size_t host) {
      const base::Mat6<double> block = answers_->between(base::at(core_place_[host]), loaded);
      Vec u{};
      std::copy_n(block.values.begin() + static_cast<std::ptrdiff_t>(6 * (column % 6)), 6,
                  u.begin());
      return u;
    };
    const Vec u = bound_.follow(module, moved);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const auto direction =
          model::direction_between(target_.lattice(), target_.modules()[first[i].module].cell,
                                   target_.modules()[module].cell)
              .value();
      const Vec force = bound_.beam().end_force(direction, moved(first[i].module), u);
      for (std::size_t k = 0; k < 6; ++k) {
        system.at(6 * i + k, column) = force[k] + (6 * i + k == column ? 1 : 0);
      }
    }
    loads[column] = first[column / 6].force[column % 6];
  }
  std::vector<PointLoad> settled;
  HOLDFAST_CHECK(system.factor());  // Stiffer by what is positive.
  system.solve(loads);
  for (std::size_t i = 0; i < first.size(); ++i) {
    PointLoad& load =
        settled.emplace_back(PointLoad{.module = base::at(core_place_[first[i].module])});
    std::copy_n(loads.begin() + static_cast<std::ptrdiff_t>(6 * i), 6, load.load.begin());
  }
  return settled;
}

/// The module goes with the robot before, which its loads move.
void BatchBound::settle(Footprint& print, CoreAnswers::Vecs answer) {
  print.answer = std::move(answer);
  const std::size_t module = base::at(print.module);
  const auto moved = [&](std::size_t other) { return print.answer[base::at(core_place_[other])]; };
  base::add_to(print.u, bound_.follow(module, moved));
  print.beams.clear();
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const std::int32_t other = target_.connected()[module][base::at(base::index(direction))];
    if (other != model::Robot::kNoNeighbour && core_.contains(other)) {
      Vec u = bound_.displacement(base::at(other));
      base::add_to(u, moved(base::at(other)));
      print.beams.push_back(
          bound_.changes().gap_between(module, base::index(direction), print.u, u));
      print.beams.back().change = print.beams.back().gap;
    }
  }
}

void BatchBound::prepare(std::span<const Element> modules) {
  std::vector<Footprint> prints;
  for (const Element module : modules) {
    const bool is_fixed = target_.modules()[base::at(module)].support == model::Support::kFixed;
    if (answers_ && !is_fixed && !prepared_.contains(module)) {
      prints.push_back(placed(module));
    }
  }
  if (prints.empty()) {
    return;
  }
  find_inverse(prints);
  std::vector<std::vector<PointLoad>> loads;
  std::ranges::transform(prints, std::back_inserter(loads),
                         [&](const Footprint& print) { return loads_of(print); });
  auto answers = answers_->answers(loads);
  for (std::size_t i = 0; i < prints.size(); ++i) {
    settle(prints[i], std::move(answers[i]));
    prepared_.emplace(prints[i].module, std::move(prints[i]));
  }
}

/// What a module does, its load going down a way; none if it may not be safe alone.
std::optional<BatchBound::Footprint> BatchBound::footprint(Element module) {
  const std::size_t index = base::at(module);
  if (target_.modules()[index].support == model::Support::kFixed) {
    return std::nullopt;
  }
  Footprint print = placed(module);
  const bool is_safe = bound_.add(module).has_value();
  print.beams = bound_.changes().beams();
  std::vector<std::size_t> facets = bound_.changes().facets();
  std::ranges::sort(facets);
  facets.erase(std::unique(facets.begin(), facets.end()), facets.end());
  for (const std::size_t facet : facets) {
    if (target_.facets()[facet].module == module) {
      print.own_energy += bound_.changes().facet_energy(facet);
      print.own_room = std::min(print.own_room, bound_.room(facet));
    } else {
      print.feet.emplace_back(facet, bound_.changes().facet_change(facet));
    }
  }
  bound_.take_back();
  return is_safe ? std::optional(print) : std::nullopt;
}

/// Adds what a module does to springs, and the beams between it and those of the batch.
void BatchBound::add_springs(const Footprint& print, Batch& batch) const {
  const ChangedForces& changes = bound_.changes();
  const auto weigh = [&](const ChangedForces::Spring& spring) {
    Beam& beam = batch.beams[spring.index];
    beam.lack.add(base::sum_of<double>(spring.change, -1, spring.gap));
    beam.load_ratio += std::max(0.0, changes.half_ratio(spring));
  };
  std::ranges::for_each(print.beams, weigh);
  for (const auto& [facet, change] : print.feet) {
    batch.feet[facet].add(change);
  }
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[base::at(print.module)][base::at(d)];
    const auto mate = std::ranges::find(batch.members, other, &Footprint::module);
    if (other != model::Robot::kNoNeighbour && mate != batch.members.end()) {
      weigh(changes.gap_between(base::at(print.module), d, print.u, mate->u));
      batch.pairs.push_back({.later = batch.members.size(),
                             .earlier = static_cast<std::size_t>(mate - batch.members.begin()),
                             .direction = d});
    }
  }
}

/// Adds what a module does to the connections of the robot before, if its answer is known.
void BatchBound::add_ratios(const Footprint& print, Batch& batch) const {
  for (std::size_t i = 0; i < batch.ratios.size(); ++i) {
    const model::Robot& robot = answers_->robot();
    const model::Connection& pair = robot.connections()[i];
    const Vec force = bound_.beam().middle_force(pair.direction, print.answer[base::at(pair.a)],
                                                 print.answer[base::at(pair.b)]);
    batch.ratios[i] += std::max(0.0, model::load_ratio(robot.connector(pair), force).ratio);
  }
}

/// Adds how the robot before moves by a module.
void BatchBound::add_answer(const Footprint& print, Batch& batch) const {
  const model::Robot& robot = answers_->robot();
  for (const std::size_t facet : bound_.facets()) {
    const model::Facet& foot = target_.facets()[facet];
    const Vec& u = print.answer[base::at(core_place_[base::at(foot.module)])];
    // Half of s and h w together, where both change alike.
    const Vec force = bound_.trial_force(foot, u);
    batch.feet[facet].add(base::sum_of<double>(force, 1, force));
  }
  Vec moved{};
  for (std::size_t i = 0; i < print.answer.size(); ++i) {
    moved[0] += robot.mass(i) * print.answer[i][0];
    moved[1] += robot.mass(i) * print.answer[i][1];
  }
  batch.moved.add(moved);
}

/// How a module goes with the robot before where another one moves that.
const base::Vec6<double>& BatchBound::followed(const Footprint& print, const Footprint& moving) {
  const auto [found, is_first] = followed_.try_emplace({print.module, moving.module});
  if (is_first && print.module != moving.module) {
    found->second = bound_.follow(base::at(print.module), [&](std::size_t other) {
      return moving.answer[base::at(core_place_[other])];
    });
  }
  return found->second;
}

/// Adds a gap that a beam may have, or not.
void BatchBound::add_gap(const ChangedForces::Spring& spring, Batch& batch) const {
  Beam& beam = batch.beams[spring.index];
  beam.lack.add(spring.gap);
  beam.load_ratio += std::max(0.0, bound_.changes().half_ratio(spring));
}

/// Adds what a module goes by with the robot before where another one moves that.
void BatchBound::add_following(const Footprint& print, const Footprint& moving, Batch& batch) {
  const std::size_t module = base::at(print.module);
  const Vec& u = followed(print, moving);
  batch.moved.add({target_.mass(module) * u[0], target_.mass(module) * u[1], 0, 0, 0, 0});
  for (const base::Direction direction : base::directions(target_.lattice())) {
    const int d = base::index(direction);
    const std::int32_t other = target_.connected()[module][base::at(d)];
    if (other != model::Robot::kNoNeighbour && core_.contains(other)) {
      add_gap(bound_.changes().gap_between(module, d, u,
                                           moving.answer[base::at(core_place_[base::at(other)])]),
              batch);
    }
  }
  for (auto& [facet, foot] : batch.own_feet) {
    if (target_.facets()[facet].module == print.module) {
      foot.change.add(bound_.trial_force(target_.facets()[facet], u));
    }
  }
}

/// Adds what the last module moves others by, and these that one; and what beams between two that
/// come gain by any third.
void BatchBound::add_followings(Batch& batch) {
  const std::size_t last = batch.members.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    add_following(batch.members[last], batch.members[i], batch);
    add_following(batch.members[i], batch.members[last], batch);
  }
  for (const Pair& pair : batch.pairs) {
    const Footprint& a = batch.members[pair.later];
    const Footprint& b = batch.members[pair.earlier];
    for (std::size_t i = pair.later == last ? 0 : last; i <= last; ++i) {
      const Footprint& moving = batch.members[i];
      add_gap(bound_.changes().gap_between(base::at(a.module), pair.direction, followed(a, moving),
                                           followed(b, moving)),
              batch);
    }
  }
}

void BatchBound::take(Footprint print, Batch& batch) {
  add_springs(print, batch);
  const double mass = target_.mass(base::at(print.module));
  batch.moved.add({mass * print.u[0], mass * print.u[1], 0, 0, 0, 0});
  batch.own_energy += print.own_energy;
  batch.own_room = std::min(batch.own_room, print.own_room);
  batch.sway[print.root] += print.sway;
  batch.hosts.insert(batch.hosts.end(), print.hosts.begin(), print.hosts.end());
  batch.members.push_back(std::move(print));
  if (!answers_) {
    return;
  }
  const Footprint& last = batch.members.back();
  add_answer(last, batch);
  for (std::size_t facet = 0; facet < target_.facets().size(); ++facet) {
    if (target_.facets()[facet].module == last.module) {
      batch.own_feet[facet].u = last.u;
    }
  }
  add_followings(batch);
}

/// How far bending moves the centre of mass of any part, in plan, at most.
double BatchBound::shift_mm(const Batch& batch, double error) const {
  double sway_square = bound_.sway_square();
  for (const auto& [root, more] : batch.sway) {
    sway_square += more * (2 * bound_.sway_of(root) + more);
  }
  verdict::MovedMass moved = bound_.still_moved();
  moved.x_kg_mm = std::max(std::abs(moved.x_kg_mm + batch.moved.high[0]),
                           std::abs(moved.x_kg_mm + batch.moved.low[0]));
  moved.y_kg_mm = std::max(std::abs(moved.y_kg_mm + batch.moved.high[1]),
                           std::abs(moved.y_kg_mm + batch.moved.low[1]));
  return moved.shift_mm(std::sqrt(sway_square) * (error + bound_.solved_error()));
}

/// Whether all facets stay stuck if |s - h w| / 2 is no more than `radius` in any part.
bool BatchBound::are_pressed(const Batch& batch, double radius) {
  const auto room_of = [&](std::size_t facet, const Vec& u, const Span& change) {
    const Vec& high = change.high;
    const Vec& low = change.low;
    return std::min(bound_.room_with(facet, u, {0, 0, high[2], high[3], high[4], 0}),
                    bound_.room_with(facet, u, {0, 0, high[2], low[3], low[4], 0}));
  };
  const auto room = [&](std::size_t facet) {
    const auto change = batch.feet.find(facet);
    const Vec& u = bound_.displacement(base::at(target_.facets()[facet].module));
    return change == batch.feet.end() ? bound_.room(facet) : room_of(facet, u, change->second);
  };
  const double reach = radius + bound_.solved_error() / 2;
  if (!(reach < batch.own_room)) {
    return false;
  }
  const auto moved = [&](std::size_t facet) {
    EnergyBound::Changes changes;
    const auto change = batch.feet.find(facet);
    if (answers_ && change != batch.feet.end()) {
      base::add_times(changes.low, 0.5, change->second.low);
      base::add_times(changes.high, 0.5, change->second.high);
    }
    return changes;
  };
  return bound_.are_pressed_with(batch.hosts, radius, room, moved) &&
         std::ranges::all_of(batch.own_feet, [&](const auto& foot) {
           return reach < room_of(foot.first, foot.second.u, foot.second.change);
         });
}

/// |s - h w| of any part, errors included.
double BatchBound::error_of(const Batch& batch) const {
  const Vec& stiffness = bound_.changes().stiffness();
  double energy = batch.own_energy;
  for (const auto& [index, beam] : batch.beams) {
    energy += beam.lack.energy(stiffness);
  }
  for (const auto& [facet, foot] : batch.own_feet) {
    energy += foot.change.energy(stiffness);
  }
  for (const auto& [facet, change] : batch.feet) {
    energy += answers_ ? 0 : change.energy(stiffness);
  }
  return std::sqrt(energy) + bound_.solved_error();
}

/// What no load ratio of any part exceeds.
double BatchBound::ratio_of(const Batch& batch) const {
  double beam_ratio = 0;
  for (const auto& [index, beam] : batch.beams) {
    beam_ratio = std::max(beam_ratio, beam.load_ratio);
  }
  double ratio = bound_.solved_ratio() + beam_ratio;
  if (answers_) {
    ratio = beam_ratio;
    for (const double known : batch.ratios) {
      ratio = std::max(ratio, known);
    }
    ratio += bound_.ratio_per_norm() * bound_.solved_error();
  }
  return ratio + bound_.ratio_per_norm() * error_of(batch) / 2;
}

/// The smallest margin of any part, if they all stand with all their facets stuck; infinite where
/// no polygon decides.
std::optional<double> BatchBound::find_margin_mm(const Batch& batch) {
  double margin_mm = std::numeric_limits<double>::infinity();
  const double pitch = target_.material().pitch_mm;
  if (balance_) {
    std::vector<Element> modules;
    std::ranges::transform(batch.members, std::back_inserter(modules), &Footprint::module);
    margin_mm = balance_->margin_with_parts(modules) * pitch;
  }
  const double error = error_of(batch);
  const bool stands = shift_mm(batch, error) < margin_mm - Balance::kMarginDoubt * pitch &&
                      are_pressed(batch, error / 2);
  return stands ? std::optional(margin_mm) : std::nullopt;
}

std::optional<Judgement> BatchBound::add(Element module) {
  if (!has_core_) {
    return std::nullopt;
  }
  prepare({&module, 1});
  const auto known = prepared_.find(module);
  auto print = known != prepared_.end() ? std::optional(known->second)
               : answers_               ? std::nullopt
                                        : footprint(module);
  if (!print) {
    return std::nullopt;
  }
  Batch next = batch_;
  take(*std::move(print), next);
  const auto margin_mm = find_margin_mm(next);
  if (!margin_mm) {
    return std::nullopt;
  }
  add_ratios(next.members.back(), next);
  const double ratio = ratio_of(next);
  if (!(ratio < EnergyBound::kRatioMax)) {
    return std::nullopt;
  }
  batch_ = std::move(next);
  return Judgement{.verdict = verdict::Verdict::kSafe,
                   .load_ratio_max = ratio,
                   .load_ratio_high = ratio,
                   .margin_mm = balance_ ? margin_mm : std::nullopt,
                   .is_bound = true};
}

}  // namespace holdfast::plan
