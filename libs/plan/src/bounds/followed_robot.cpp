// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/followed_robot.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <unordered_set>
#include <utility>

#include "block_product.hpp"
#include "dense.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/facet_starts.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Mat6;
using base::Vec6;

/// The tolerance of solutions for the core: a share of a module's weight on a beam, in the energy
/// norm. Facets that carry little more than their own modules lack about as much to tilting.
constexpr double kTolerance = 0.03;

/// What a solution says of its own error counts, but no less than this share of that tolerance: it
/// may be rounding.
constexpr double kErrorShareMin = 0.1;

/// A solution that leaves a larger gap, of the same unit, is improved at once: what it leaves room
/// for is soon used up. In a sheet of 1,024 modules 66 and as many improvements do instead of 293.
constexpr double kGapMax = 0.3;

/// What closing a gap leaves of it is a tenth or more. So the solution for that may be off by so
/// many times its tolerance for each unit of the gap; one iteration then does nearly always, and
/// mostly comes nearer, which counts. With 1 growth takes two iterations three times out of five,
/// and as many solutions; with 30 one is too few.
constexpr double kGapShare = 3;

/// The coarseness of a solution whose error need not be known.
constexpr double kRoughly = std::numeric_limits<double>::infinity();

/// What the first solution begins with: by it one learns what the tolerance is of the whole.
constexpr double kToleranceFirst = 0.03;

/// New modules move one after another, there and back, so many times at most, or until what they
/// gain is this share of what they have gained first. What is then out of balance is carried to the
/// core.
constexpr int kSweepMax = 12;
constexpr double kGainShare = 1e-4;

/// Modules of the core at most so many steps from new ones move with them at first.
constexpr int kNear = 2;

Direction direction_of(int index) { return static_cast<Direction>(index); }

Vec6<double> difference_of(const Vec6<double>& a, const Vec6<double>& b) {
  return base::sum_of(a, -1.0, b);
}

}  // namespace

FollowedRobot::FollowedRobot(const model::RobotSpec& spec, const model::Robot& target,
                             const ElementSet& state, const verdict::Assessment& solved)
    : spec_(spec),
      target_(target),
      beam_(model::beam_section(target.material()), target.lattice()),
      stiffness_(middle_stiffness(beam_)),
      ratio_per_norm_(model::load_ratio_per_energy_norm(target)),
      local_(target),
      first_facet_(model::facet_starts(target)),
      place_(target.modules().size(), kAbsent),
      core_(state),
      elements_(state.elements()),
      u_(target.modules().size()),
      given_(elements_.size()),
      moved_(elements_.size()),
      core_error_(verdict::kEnergyFactor * solved.equilibrium.energy_error) {
  for (std::size_t i = 0; i < 6; ++i) {
    flexibility_[i] = 1 / stiffness_[i];
  }
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    const Vec& load = target.loads()[i];
    unit_ = std::max(unit_, std::hypot(load[0], load[1], load[2]) / std::sqrt(stiffness_[2]));
  }
  local_.assign(elements_);
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    place_[at(elements_[i])] = static_cast<std::int32_t>(i);
    u_[at(elements_[i])] = solved.equilibrium.displacement[i];
  }
}

/// Chooses the way to the core, or a facet, through as few new modules as can be.
void FollowedRobot::choose_way(NewModule& added) const {
  if (first_facet_[added.module] < first_facet_[added.module + 1]) {
    return;
  }
  added.depth = std::numeric_limits<int>::max();
  local_.for_each_neighbour(added.module, [&](Direction direction, std::size_t other) {
    const int depth = is_new(other) ? new_[place_in_new(other)].depth + 1 : 1;
    if (depth < added.depth) {
      added.depth = depth;
      added.way = base::index(direction);
    }
  });
}

void FollowedRobot::add(Element element) {
  NewModule added{.module = at(element)};
  choose_way(added);
  place_[added.module] = kAbsent - 1 - static_cast<std::int32_t>(new_.size());
  local_.insert(added.module);
  u_[added.module] = {};
  new_.push_back(added);
}

void FollowedRobot::take_back(const verdict::Assessment& solved) {
  for (const NewModule& added : new_) {
    place_[added.module] = kAbsent;
    local_.erase(added.module);
    u_[added.module] = {};
  }
  new_.clear();
  springs_.clear();
  solved_count_ = 0;
  motion_error_ = 0;
  std::ranges::fill(given_, Vec{});
  std::ranges::fill(moved_, Vec{});
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    u_[at(elements_[i])] = solved.equilibrium.displacement[i];
  }
}

/// Block Gauss-Seidel, there and back. What is beside each module is looked up once for all sweeps.
void FollowedRobot::relax(const std::vector<std::size_t>& modules) {
  struct Place {
    const LocalBalance::Stiffness* stiffness = nullptr;
    std::size_t beam_end = 0;
  };

  std::vector<Place> places;
  std::vector<LocalBalance::Beam> beams;
  for (const std::size_t module : modules) {
    local_.add_beams(module, beams);
    places.push_back({.stiffness = &local_.stiffness(module), .beam_end = beams.size()});
  }
  double first_gain = 0;
  for (int sweep = 0; sweep < kSweepMax; ++sweep) {
    double gain = 0;
    const auto move = [&](std::size_t i) {
      const std::size_t begin = i == 0 ? 0 : places[i - 1].beam_end;
      const auto own = std::span(beams).subspan(begin, places[i].beam_end - begin);
      const Vec next =
          block_product(places[i].stiffness->inverse, local_.pull(modules[i], own, u_));
      const Vec step = difference_of(next, u_[modules[i]]);
      gain += base::dot(step, block_product(places[i].stiffness->sum, step));
      u_[modules[i]] = next;
    };
    for (std::size_t i = 0; i < modules.size(); ++i) {
      move(i);
    }
    for (std::size_t i = modules.size(); i-- > 0;) {
      move(i);
    }
    first_gain = sweep == 0 ? gain : first_gain;
    if (!(gain > kGainShare * first_gain)) {
      break;
    }
  }
}

/// All new modules but the first so many.
std::vector<std::size_t> FollowedRobot::modules_from(std::size_t first) const {
  std::vector<std::size_t> modules;
  for (std::size_t i = first; i < new_.size(); ++i) {
    modules.push_back(new_[i].module);
  }
  return modules;
}

/// The modules at most kNear steps away from these that can move, without these.
std::vector<std::size_t> FollowedRobot::modules_near(std::vector<std::size_t> modules) const {
  const std::size_t count = modules.size();
  std::unordered_set<std::size_t> seen(modules.begin(), modules.end());
  std::size_t begin = 0;
  for (int step = 0; step < kNear; ++step) {
    const std::size_t end = modules.size();
    for (; begin < end; ++begin) {
      local_.for_each_neighbour(modules[begin], [&](Direction /*direction*/, std::size_t other) {
        if (seen.insert(other).second) {
          modules.push_back(other);
        }
      });
    }
  }
  modules.erase(modules.begin(), modules.begin() + static_cast<std::ptrdiff_t>(count));
  std::erase_if(modules, [&](std::size_t module) {
    return target_.modules()[module].support == model::Support::kFixed;
  });
  return modules;
}

/// h w of a spring.
FollowedRobot::Vec FollowedRobot::gap_force(const Spring& spring) const {
  const Direction direction = direction_of(spring.direction);
  if (spring.other >= 0) {
    return beam_.middle_force(direction, u_[spring.module], u_[at(spring.other)]);
  }
  return force_in_middle(beam_, direction, local_.facet_force(direction, u_[spring.module]),
                         target_.material().pitch_mm);
}

/// The springs of new modules but for the first so many, each once, with h w for s.
std::vector<FollowedRobot::Spring> FollowedRobot::find_springs(std::size_t first) const {
  std::vector<Spring> springs;
  for (const std::size_t module : modules_from(first)) {
    for (std::size_t i = first_facet_[module]; i < first_facet_[module + 1]; ++i) {
      springs.push_back(
          {.module = module, .direction = base::index(target_.facets()[i].direction)});
    }
    local_.for_each_neighbour(module, [&](Direction direction, std::size_t other) {
      const bool is_later = is_new(other) && place_[other] < place_[module];
      if (!is_later) {
        springs.push_back({.module = module,
                           .other = static_cast<std::int32_t>(other),
                           .direction = base::index(direction)});
      }
    });
  }
  for (Spring& spring : springs) {
    spring.force = gap_force(spring);
  }
  return springs;
}

/// Makes the forces balance at all new modules, of which those from `first` on have these springs
/// as they are, and others the ones in springs_, in balance before. Returns what they put on the
/// core.
std::vector<FollowedRobot::Vec> FollowedRobot::balance(std::size_t first,
                                                       std::vector<Spring>& springs) {
  std::vector<Vec> given(elements_.size());
  std::vector<Vec> rest(new_.size());
  const auto put = [&](std::size_t module, const Vec& force) {
    base::add_to(is_new(module) ? rest[place_in_new(module)] : given[at(place_[module])], force);
  };
  for (const Spring& spring : springs) {
    const auto back = direction_of(spring.direction ^ 1);
    if (spring.other >= 0 &&
        !(is_new(at(spring.other)) && place_in_new(at(spring.other)) >= first)) {
      put(at(spring.other),
          difference_of({}, beam_.end_force(back, u_[at(spring.other)], u_[spring.module])));
    }
  }
  const double pitch = target_.material().pitch_mm;
  auto own = springs.end();
  auto old = springs_.end();
  for (std::size_t i = new_.size(); i-- > 0;) {
    const NewModule& added = new_[i];
    const std::size_t module = added.module;
    if (i >= first) {
      base::add_to(rest[i], difference_of(local_.pull(module, u_),
                                          block_product(local_.stiffness(module).sum, u_[module])));
    }
    const auto begin = i >= first ? springs.begin() : springs_.begin();
    auto& next = i >= first ? own : old;
    auto way = next;
    while (next != begin && std::prev(next)->module == module) {
      --next;
      const bool is_way =
          added.depth == 0 ? next->other < 0 : next->other >= 0 && next->direction == added.way;
      way = is_way ? next : way;
    }
    base::add_to(way->force, force_in_middle(beam_, direction_of(way->direction), rest[i], pitch));
    if (way->other >= 0) {
      const auto step =
          base::place_of(target_.lattice(), target_.lattice().steps[at(way->direction)]);
      put(at(way->other),
          force_at(rest[i], {pitch * step[0], pitch * step[1], pitch * step[2], 0, 0, 0}));
    }
  }
  return given;
}

/// Moves new modules but for the first so many, and for now those near them, until they are in
/// balance; finds their springs and what they put on the core.
std::vector<FollowedRobot::Vec> FollowedRobot::find_forces(std::size_t first,
                                                           std::vector<Spring>& springs) {
  std::vector<std::size_t> moving = modules_from(first);
  const std::vector<std::size_t> near = modules_near(moving);
  moving.insert(moving.end(), near.begin(), near.end());
  std::vector<Vec> before;
  for (const std::size_t module : near) {
    before.push_back(u_[module]);
  }
  relax(moving);
  springs = find_springs(first);
  std::vector<Vec> given = balance(first, springs);
  for (std::size_t i = 0; i < near.size(); ++i) {
    u_[near[i]] = before[i];
  }
  return given;
}

/// Single precision, or where the core is too slender for it double; solved for these loads.
bool FollowedRobot::make_system(const std::vector<Vec>& loads) {
  for (const auto precision : {solver::Precision::kSingle, solver::Precision::kDouble}) {
    stuck_ = StuckCore::make(spec_, core_, precision);
    const auto first = stuck_ ? stuck_->answer(loads, kToleranceFirst) : std::nullopt;
    if (first) {
      const double whole = std::sqrt(std::max(0.0, work_of(loads, first->displacement)));
      tolerance_ = std::min(kToleranceFirst, kTolerance * unit_ / whole);
      return stuck_->system().solve(tolerance_) == solver::LinearOutcome::kSolved;
    }
  }
  stuck_.reset();
  return false;
}

/// How far the last solution, which was to be so coarse, is off in the energy norm, at most.
double FollowedRobot::solution_error(double coarseness) const {
  const double error_min = kErrorShareMin * kTolerance * unit_;
  return coarseness == kRoughly
             ? kRoughly
             : verdict::kEnergyFactor * std::max(stuck_->system().energy_error(), error_min);
}

/// How the core moves if it takes these loads besides: to so many times the tolerance, or, if that
/// is kRoughly, only about.
bool FollowedRobot::find_motion(std::vector<Vec> change, double coarseness) {
  std::vector<Vec> loads = given_;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    base::add_to(loads[i], change[i]);
  }
  if (!stuck_) {
    if (!make_system(loads)) {
      return false;
    }
    coarseness = 1;
  } else {
    stuck_->system().change_loads(model::Loads(std::move(loads)));
    const auto outcome = coarseness == kRoughly ? stuck_->system().approach()
                                                : stuck_->system().solve(coarseness * tolerance_);
    if (outcome != solver::LinearOutcome::kSolved) {
      stuck_.reset();
      return false;
    }
  }
  solution_error_ = stuck_->system().is_exact() ? 0 : solution_error(coarseness);
  iteration_count_ = stuck_->system().report().iteration_count;
  change_ = std::move(change);
  motion_ = stuck_->system().displacement();
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    motion_[i] = difference_of(motion_[i], moved_[i]);
  }
  return true;
}

/// Moves the core so many times as far as was found last.
void FollowedRobot::move_core(double factor) {
  if (factor == 0) {
    return;
  }
  for (std::size_t i = 0; i < motion_.size(); ++i) {
    base::add_times(moved_[i], factor, motion_[i]);
    base::add_times(given_[i], factor, change_[i]);
    base::add_times(u_[at(elements_[i])], factor, motion_[i]);
  }
}

/// h w of all springs.
std::vector<FollowedRobot::Vec> FollowedRobot::gaps() const {
  std::vector<Vec> forces;
  for (const Spring& spring : springs_) {
    forces.push_back(gap_force(spring));
  }
  return forces;
}

double FollowedRobot::energy_of(const Vec& a, const Vec& b) const {
  double energy = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    energy += a[i] * b[i] / stiffness_[i];
  }
  return energy;
}

/// The larger of what is known and the load ratio of a connection by the displacements.
double FollowedRobot::ratio_of(std::size_t module, std::size_t other, int direction,
                               double known) const {
  const Vec force = beam_.middle_force(direction_of(direction), u_[module], u_[other]);
  double energy = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    energy += force[i] * force[i] * flexibility_[i];
  }
  if (ratio_per_norm_ * ratio_per_norm_ * energy <= known * known) {
    return known;
  }
  return std::max(known, connection_ratio(target_, module, other, direction, force));
}

/// The load ratio that no connection's exceeds, if the displacements are off by `error`.
double FollowedRobot::load_ratio(double error) const {
  double largest = 0;
  for (const Element element : elements_) {
    const std::size_t module = at(element);
    local_.for_each_neighbour(module, [&](Direction direction, std::size_t other) {
      if (base::index(direction) % 2 == 0 && !is_new(other)) {
        largest = ratio_of(module, other, base::index(direction), largest);
      }
    });
  }
  for (const Spring& spring : springs_) {
    if (spring.other >= 0) {
      largest = ratio_of(spring.module, at(spring.other), spring.direction, largest);
    }
  }
  return largest + ratio_per_norm_ * error;
}

FollowedRobot::Result FollowedRobot::finish(double gap_energy) {
  const double solved = core_error_ + motion_error_;
  const double error = std::sqrt(gap_energy + solved * solved);
  const double moved = std::sqrt(std::max(0.0, work_of(given_, moved_))) + motion_error_;
  return {.energy_error = error, .load_ratio = load_ratio(error), .moved = moved};
}

/// Gives loads to the core; new modules follow it. False: it cannot be solved.
bool FollowedRobot::move(std::vector<Vec> change, double coarseness) {
  if (!find_motion(std::move(change), coarseness)) {
    return false;
  }
  move_core(1);
  motion_error_ = solution_error_;
  relax(modules_from(0));
  return true;
}

/// The square of |d| for these h w.
double FollowedRobot::gap_energy(const std::vector<Vec>& gap) const {
  double energy = 0;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    const Vec lack = difference_of(springs_[i].force, gap[i]);
    energy += energy_of(lack, lack);
  }
  return energy;
}

std::optional<FollowedRobot::Result> FollowedRobot::solve() {
  std::vector<Spring> springs;
  std::vector<Vec> given = find_forces(solved_count_, springs);
  springs_.insert(springs_.end(), springs.begin(), springs.end());
  solved_count_ = new_.size();
  if (!move(std::move(given), kRoughly)) {
    return std::nullopt;
  }
  if (std::sqrt(gap_energy(gaps())) > kGapMax * unit_) {
    return improve();
  }
  if (!std::isfinite(motion_error_) && !move(std::vector<Vec>(elements_.size()), 1)) {
    return std::nullopt;
  }
  return finish(gap_energy(gaps()));
}

std::optional<FollowedRobot::Result> FollowedRobot::improve() {
  const std::vector<Vec> gap = gaps();
  std::vector<Vec> still;
  for (const NewModule& added : new_) {
    still.push_back(u_[added.module]);
  }
  std::vector<Spring> springs;
  std::vector<Vec> change = find_forces(0, springs);
  for (std::size_t i = 0; i < new_.size(); ++i) {
    u_[new_[i].module] = still[i];
  }
  for (std::size_t i = 0; i < change.size(); ++i) {
    change[i] = difference_of(change[i], given_[i]);
  }
  const double coarseness = std::max(1.0, kGapShare * std::sqrt(gap_energy(gap)) / unit_);
  if (!find_motion(std::move(change), coarseness)) {
    return std::nullopt;
  }
  move_core(1);
  relax(modules_from(0));
  // d = lack + factor * more.
  const std::vector<Vec> moved = gaps();
  std::vector<Vec> lack;
  std::vector<Vec> more;
  double along = 0;
  double length = 0;
  for (std::size_t i = 0; i < gap.size(); ++i) {
    lack.push_back(difference_of(springs_[i].force, gap[i]));
    more.push_back(difference_of(difference_of(springs[i].force, springs_[i].force),
                                 difference_of(moved[i], gap[i])));
    along += energy_of(lack[i], more[i]);
    length += energy_of(more[i], more[i]);
  }
  const bool was_rough = !std::isfinite(motion_error_);
  const double factor = was_rough ? 1 : length > 0 ? -along / length : 0;
  move_core(factor - 1);
  motion_error_ =
      std::abs(factor) * solution_error_ + (was_rough ? 0 : std::abs(1 - factor) * motion_error_);
  for (std::size_t i = 0; i < new_.size(); ++i) {
    Vec& u = u_[new_[i].module];
    base::add_times(u, factor - 1, difference_of(u, still[i]));
  }
  double energy = 0;
  for (std::size_t i = 0; i < springs.size(); ++i) {
    base::add_times(springs_[i].force, factor, difference_of(springs[i].force, springs_[i].force));
    base::add_times(lack[i], factor, more[i]);
    energy += energy_of(lack[i], lack[i]);
  }
  return finish(energy);
}

}  // namespace holdfast::plan
