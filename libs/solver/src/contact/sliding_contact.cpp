// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact/sliding_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "holdfast/solver/second_state.hpp"

namespace holdfast::solver {
namespace {

/// More facets are not let slip: each takes three solutions and a share of a dense matrix.
constexpr std::size_t kActiveMax = 128;

/// Other states are tried of so many facets.
constexpr std::size_t kDoubtfulMax = 24;

/// Rounds of solving for given slips, and of states.
constexpr int kSlipRoundMax = 20;
constexpr int kStateRoundMax = 30;

/// The law is fulfilled to this share of the largest force.
constexpr double kSettledShare = 1e-10;

/// Less friction than this share of the pressure is none.
constexpr double kNoTurnShare = 1e-9;

constexpr std::array<std::size_t, kSlipSize> kAlong = {0, 1, 5};

}  // namespace

SlidingContact::SlidingContact(LinearSystem& system, const EquilibriumOptions& options)
    : ContactIteration(system, options),
      slips_(system.facets().size()),
      turns_(system.facets().size()) {
  for (const model::Facet& facet : system.robot().facets()) {
    friction_.push_back(facet.is_bonded() ? -1.0 : facet.touch.friction.value_or(-1.0));
  }
}

bool SlidingContact::is_friction(std::size_t facet) const {
  return friction_[facet] >= 0 && system().facets()[facet].state.pressed;
}

base::Vec6<double> SlidingContact::slip_force(const LinearSystem& system, std::size_t facet,
                                              const SlipVector& slip) {
  const mechanics::GroundFacet<double>& ground = system.ground(system.facets()[facet].direction);
  Vec local{};
  for (std::size_t c = 0; c < kSlipSize; ++c) {
    local[kAlong[c]] = ground.stiffness[kAlong[c]] * slip[c];
  }
  local[3] += local[1] * ground.lever;
  local[4] -= local[0] * ground.lever;
  return system.beam().to_global(system.facets()[facet].direction, local);
}

SlidingContact::Force SlidingContact::force_of(std::size_t facet, const Vec& u) const {
  const FacetState& state = system().facets()[facet];
  const Vec local = system().beam().to_local(state.direction, system().law().force(state, u));
  Force force{.press_n = std::max(-local[2], 0.0)};
  for (std::size_t c = 0; c < kSlipSize; ++c) {
    force.along[c] =
        local[kAlong[c]] - system().ground(state.direction).stiffness[kAlong[c]] * slips_[facet][c];
  }
  return force;
}

/// Takes the robot's loads and the slips' as those of the system.
bool SlidingContact::set_slip_loads() {
  const model::Robot& robot = system().robot();
  std::vector<Vec> loads(robot.modules().size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    loads[i] = robot.loads()[i];
  }
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    base::add_to(loads[system().facets()[i].module], slip_force(system(), i, slips_[i]));
  }
  system().set_loads(model::Loads(std::move(loads)));
  return solve() == Outcome::kSettled;
}

/// The influence of the active facets that have none yet.
bool SlidingContact::find_columns() {
  std::vector<model::Loads> loads;
  for (std::size_t i = columns_.size() / kSlipSize; i < active_.size(); ++i) {
    for (std::size_t c = 0; c < kSlipSize; ++c) {
      SlipVector unit{};
      unit[c] = 1;
      std::vector<Vec> load(system().robot().modules().size());
      load[system().facets()[active_[i]].module] = slip_force(system(), active_[i], unit);
      loads.emplace_back(std::move(load));
    }
  }
  const auto found = system().solve_each(loads, 0);
  for (std::size_t i = 0; found && i < found->size(); ++i) {
    columns_.push_back(at_facets((*found)[i]));
  }
  return found.has_value();
}

SlidingFoot SlidingContact::foot_at(std::size_t facet, const Force& force) const {
  SlidingFoot foot{.friction = friction_[facet],
                   .turns = turns_[facet],
                   .slip = slips_[facet],
                   .force = force.along,
                   .press_n = force.press_n};
  for (std::size_t c = 0; c < kSlipSize; ++c) {
    foot.stiffness[c] = system().ground(system().facets()[facet].direction).stiffness[kAlong[c]];
  }
  return foot;
}

/// The active facets at the present slips, which the system has been solved for.
std::optional<SlidingFeet> SlidingContact::feet(const std::vector<Vec>& displacement) {
  std::vector<SlidingFoot> list;
  for (const std::size_t facet : active_) {
    list.push_back(foot_at(facet, force_of(facet, displacement[facet])));
  }
  SlidingFeet all(std::move(list));
  if (!find_columns()) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < active_.size(); ++i) {
    const FacetState& facet = system().facets()[active_[i]];
    for (std::size_t column = 0; column < columns_.size(); ++column) {
      const std::size_t other = column / kSlipSize;
      const std::size_t k = column % kSlipSize;
      const Vec local = system().beam().to_local(
          facet.direction, system().law().force(facet, columns_[column][active_[i]]));
      all.press_by_slip(i, other, k) = -local[2];
      for (std::size_t c = 0; c < kSlipSize; ++c) {
        const double own =
            other == i && c == k ? system().ground(facet.direction).stiffness[kAlong[c]] : 0.0;
        all.force_by_slip(i, c, other, k) = local[kAlong[c]] - own;
      }
    }
  }
  return all;
}

/// Makes those active that carry more than their friction. Returns whether the law is not yet
/// fulfilled.
bool SlidingContact::add_those_beyond(const std::vector<Vec>& displacement) {
  std::vector<double> left(slips_.size());
  double largest = 0;
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    if (is_friction(i)) {
      const Force force = force_of(i, displacement[i]);
      left[i] = SlidingFeet::residual(foot_at(i, force));
      largest = std::max({largest, force.press_n, std::hypot(force.along[0], force.along[1])});
    }
  }
  bool is_any_left = false;
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    if (left[i] > kSettledShare * largest) {
      is_any_left = true;
      if (std::ranges::find(active_, i) == active_.end()) {
        active_.push_back(i);
      }
    }
  }
  return is_any_left;
}

/// Seeks slips for the present states.
Outcome SlidingContact::settle_slips() {
  columns_.clear();
  std::erase_if(active_, [&](std::size_t facet) { return !is_friction(facet); });
  for (int round = 0; round < kSlipRoundMax; ++round) {
    if (!set_slip_loads()) {
      return Outcome::kSingular;
    }
    const std::vector<Vec> displacement = system().facet_displacement();
    if (!add_those_beyond(displacement)) {
      return Outcome::kSettled;
    }
    const auto known = active_.size() <= kActiveMax ? feet(displacement) : std::nullopt;
    const auto slips = known ? known->solve() : std::nullopt;
    if (!slips) {
      return Outcome::kNotSettled;
    }
    for (std::size_t i = 0; i < active_.size(); ++i) {
      slips_[active_[i]] = (*slips)[i];
    }
  }
  return Outcome::kNotSettled;
}

/// Whether no other start leads to other forces of the facets, in the present states. Then slips
/// are found once more, to see how far the first may be off.
bool SlidingContact::is_only_one(const std::vector<Vec>& displacement) {
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    if (is_friction(i) && std::ranges::find(active_, i) == active_.end()) {
      active_.push_back(i);
    }
  }
  const auto known = active_.size() <= kActiveMax ? feet(displacement) : std::nullopt;
  std::vector<SlipVector> slips;
  for (const std::size_t facet : active_) {
    slips.push_back(slips_[facet]);
  }
  if (!known || known->has_others(slips)) {
    return false;
  }
  const auto finer = known->solve();
  for (std::size_t i = 0; finer && i < active_.size(); ++i) {
    slips_[active_[i]] = (*finer)[i];
  }
  return finer.has_value();
}

/// Puts facets into the states that the displacements prescribe. Returns whether any changed.
bool SlidingContact::takes_next_states() {
  const std::vector<mechanics::ContactState> states = next_states();
  const bool is_exact_law = system().ground().law == mechanics::ContactLaw::kUnilateral;
  bool is_changed = false;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const bool is_held = !is_exact_law || states[i].pressed;
    is_changed = system().set_facet(i, states[i], is_held) || is_changed;
    if (!states[i].pressed) {
      slips_[i] = {};
      turns_[i] = false;
    }
  }
  return is_changed;
}

/// Facets that might as well be in another state, by their forces.
std::vector<std::size_t> SlidingContact::doubtful_facets(
    const std::vector<Vec>& displacement) const {
  std::vector<std::size_t> doubtful;
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const FacetState& facet = system().facets()[i];
    Vec trial = system().law().trial_force(facet, displacement[i]);
    for (std::size_t c = 0; c < 2; ++c) {
      trial[c] -= system().ground(facet.direction).stiffness[c] * slips_[i][c];
    }
    if (!facet.is_bonded && may_have_second_state(facet.state, trial)) {
      doubtful.push_back(i);
    }
  }
  return doubtful;
}

/// Whether the search, from where it has settled but for one facet that presses now or does not,
/// settles in other states than these. Leaves those in which it began.
bool SlidingContact::has_other_states(std::size_t facet) {
  const std::vector<FacetState> before(system().facets().begin(), system().facets().end());
  const std::vector<SlipVector> slips = slips_;
  const bool was_pressed = before[facet].state.pressed;
  slips_[facet] = {};
  system().set_facet(facet, {.pressed = !was_pressed}, true);
  const bool stays =
      settle_slips() == Outcome::kSettled && next_states()[facet].pressed != was_pressed;
  const bool is_other = stays && settle() == Outcome::kSettled &&
                        !std::equal(before.begin(), before.end(), system().facets().begin());
  for (std::size_t i = 0; i < before.size(); ++i) {
    system().set_facet(i, before[i].state, before[i].is_held);
  }
  slips_ = slips;
  columns_.clear();
  return is_other;
}

/// Seeks slips and states that belong together.
Outcome SlidingContact::settle() {
  for (int round = 0; round < kStateRoundMax; ++round) {
    const Outcome outcome = settle_slips();
    if (outcome != Outcome::kSettled) {
      return outcome;
    }
    if (!takes_next_states()) {
      return Outcome::kSettled;
    }
  }
  return Outcome::kNotSettled;
}

Outcome SlidingContact::run() {
  const Outcome outcome = settle();
  if (outcome != Outcome::kSettled) {
    return outcome;
  }
  const std::vector<Vec> displacement = system().facet_displacement();
  const std::vector<std::size_t> doubtful = doubtful_facets(displacement);
  before_last_ = system().displacement();
  const bool is_certain =
      is_only_one(displacement) && doubtful.size() <= kDoubtfulMax &&
      std::ranges::none_of(doubtful, [&](std::size_t facet) { return has_other_states(facet); });
  return is_certain && set_slip_loads() && !add_those_beyond(system().facet_displacement())
             ? Outcome::kSettled
             : Outcome::kNotSettled;
}

bool SlidingContact::is_any_held() {
  const std::vector<Vec> displacement = system().facet_displacement();
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    const Force force = force_of(i, displacement[i]);
    const double held =
        std::abs(force.along[2]) / system().ground(system().facets()[i].direction).lever;
    if ((slips_[i][0] != 0 || slips_[i][1] != 0) && held > kNoTurnShare * force.press_n) {
      return true;
    }
  }
  return false;
}

void SlidingContact::let_turn() {
  for (std::size_t i = 0; i < slips_.size(); ++i) {
    turns_[i] = slips_[i][0] != 0 || slips_[i][1] != 0;
  }
}

}  // namespace holdfast::solver
