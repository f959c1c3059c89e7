// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/changed_robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "dense.hpp"
#include "equilibria/carried_force.hpp"
#include "holdfast/solver/second_state.hpp"

namespace holdfast::plan {
namespace {

using base::Mat6;
using base::Vec6;
using mechanics::ContactState;
using solver::FacetState;

/// Steps of Newton's path, as many as the solver's.
constexpr std::size_t kStepCountMax = 100;

/// Trial forces nearer than this share to another state may be looked up otherwise by a check,
/// which rounds otherwise.
constexpr double kStateShare = 1e-8;
constexpr double kStateRounding = 1e-12;

Vec6<double> row_of(const Mat6<double>& matrix, int row) {
  Vec6<double> numbers{};
  for (int k = 0; k < 6; ++k) {
    numbers[static_cast<std::size_t>(k)] = matrix.at(row, k);
  }
  return numbers;
}

}  // namespace

std::optional<ContactState> certain_state(const solver::FacetLaw<double>& law,
                                          const FacetState& facet, const Vec6<double>& trial,
                                          double scale_n) {
  double force = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    force += std::abs(trial[k]) + std::abs(trial[k + 3]) / law.ground().lever;
  }
  const double error = kStateShare * force + kStateRounding * scale_n;
  Vec6<double> more = trial;
  Vec6<double> less = trial;
  more[2] -= error;
  less[2] += error;
  const ContactState state = law.state_for(facet, more);
  return state == law.state_for(facet, less) ? std::optional(state) : std::nullopt;
}

/// The dense system. Its *places* are the modules that forces act on: the hosts of links, and those
/// of facets in other states than the core's.
class ChangedRobot::System {
 public:
  System(const SolvedCore& core, const Change& change, const NewModules& new_modules)
      : core_(core), find_answers_(change.find_answers), known_(change.loads) {
    if (new_modules.is_load()) {
      if (!change.links.empty()) {
        known_.push_back({.module = change.links.front().host, .load = new_modules.load(0)});
      }
      return;
    }
    for (std::size_t i = 0; i < change.links.size(); ++i) {
      const std::size_t place = place_of(change.links[i].host);
      std::vector<Unknown> six(6);
      for (std::size_t k = 0; k < 6; ++k) {
        six[k] = {.pushes = {{.place = place, .by = base::unit<double>(static_cast<int>(k))}},
                  .constant = new_modules.load(i)[k]};
      }
      for (std::size_t j = 0; j < change.links.size(); ++j) {
        const Mat6<double> stiffness = new_modules.stiffness(i, j);
        for (std::size_t k = 0; k < 6; ++k) {
          six[k].pulls.push_back({.place = place_of(change.links[j].host),
                                  .by = row_of(stiffness, static_cast<int>(k))});
        }
      }
      std::ranges::move(six, std::back_inserter(unknowns_));
    }
  }

  /// A beam of the core that is lost: what it would carry is put on its ends once more.
  void add_lost(const model::Connection& beam) {
    const auto& law = core_.beam();
    const std::array places = {place_of(base::at(beam.a)), place_of(base::at(beam.b))};
    const Vec6<double> stiffness = middle_stiffness(law);
    const std::array along = {base::matrix_of<double>([&](const Vec6<double>& u) {
                                return law.middle_force(beam.direction, u, {});
                              }),
                              base::matrix_of<double>([&](const Vec6<double>& u) {
                                return law.middle_force(beam.direction, {}, u);
                              })};
    for (int row = 0; row < 6; ++row) {
      Unknown unknown;
      for (std::size_t end = 0; end < 2; ++end) {
        Vec6<double> push = row_of(along[end], row);
        Vec6<double> pull{};
        base::add_times(pull, -1, push);
        for (double& component : push) {
          component /= stiffness[base::at(row)];
        }
        unknown.pushes.push_back({.place = places[end], .by = push});
        unknown.pulls.push_back({.place = places[end], .by = pull});
      }
      unknowns_.push_back(std::move(unknown));
    }
  }

  /// A facet of the core in another state, or in none if it is lost. Only some components of its
  /// force change by that.
  void add_facet(const FacetState& facet, const std::optional<ContactState>& state) {
    const std::size_t place = place_of(facet.module);
    const auto& ground = core_.law().ground();
    const Mat6<double> before = mechanics::corrector(ground, facet.state, true);
    const Mat6<double> after = state ? mechanics::corrector(ground, *state, true) : Mat6<double>{};
    const Mat6<double> trial = base::matrix_of<double>(
        [&](const Vec6<double>& u) { return core_.law().trial_force(facet, u); });
    for (int row = 0; row < 6; ++row) {
      Vec6<double> along = row_of(trial, row);
      for (double& component : along) {
        component /= ground.stiffness[static_cast<std::size_t>(row)];
      }
      Vec6<double> by{};
      for (int k = 0; k < 6; ++k) {
        base::add_times(by, after.at(row, k) - before.at(row, k), row_of(trial, k));
      }
      if (by != Vec6<double>{}) {
        unknowns_.push_back(
            {.pushes = {{.place = place, .by = along}}, .pulls = {{.place = place, .by = by}}});
        ++yielding_count_;
      }
    }
  }

  /// Finds the unknowns. False if the core does not know enough, or the system is singular.
  [[nodiscard]] bool solve() {
    if (!is_known()) {
      return false;
    }
    const std::size_t size = unknowns_.size();
    DenseSystem system(size);
    std::vector<Vec6<double>> moved(places_.size());
    for (std::size_t column = 0; column < size; ++column) {
      const Unknown& unknown = unknowns_[column];
      for (std::size_t i = 0; i < places_.size(); ++i) {
        moved[i] = {};
        for (const AtPlace& push : unknown.pushes) {
          base::add_to(moved[i],
                       core_.answer(places_[i], {.module = places_[push.place], .load = push.by}));
        }
      }
      for (std::size_t row = 0; row < size; ++row) {
        system.at(row, column) = (row == column ? 1 : 0) + pull(unknowns_[row], moved);
      }
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      moved[i] = core_.displacement(places_[i]);
      for (const PointLoad& load : known_) {
        base::add_to(moved[i], core_.answer(places_[i], load));
      }
    }
    for (const Unknown& unknown : unknowns_) {
      forces_.push_back(unknown.constant - pull(unknown, moved));
    }
    if (!system.factor()) {
      return false;
    }
    system.solve(forces_);
    return true;
  }

  /// All forces on the core's modules, after solve().
  std::vector<PointLoad> loads() const {
    std::vector<PointLoad> loads = known_;
    for (const std::size_t module : places_) {
      loads.push_back({.module = module, .load = {}});
    }
    for (std::size_t i = 0; i < forces_.size(); ++i) {
      for (const AtPlace& push : unknowns_[i].pushes) {
        base::add_times(loads[known_.size() + push.place].load, forces_[i], push.by);
      }
    }
    return loads;
  }

  std::size_t yielding_count() const { return yielding_count_; }

 private:
  struct AtPlace {
    std::size_t place = 0;
    Vec6<double> by{};
  };

  struct Unknown {
    std::vector<AtPlace> pushes = {};  ///< What a unit of the force is on modules.
    double constant = 0;
    std::vector<AtPlace> pulls = {};  ///< What the force loses by how far places move.
  };

  std::size_t place_of(std::size_t module) {
    const auto found = std::ranges::find(places_, module) - places_.begin();
    if (found == std::ssize(places_)) {
      places_.push_back(module);
    }
    return static_cast<std::size_t>(found);
  }

  static double pull(const Unknown& unknown, const std::vector<Vec6<double>>& moved) {
    double sum = 0;
    for (const AtPlace& pull : unknown.pulls) {
      sum += base::dot(pull.by, moved[pull.place]);
    }
    return sum;
  }

  bool is_known() const {
    if (!find_answers_) {
      return true;
    }
    std::vector<std::size_t> modules = places_;
    for (const PointLoad& load : known_) {
      modules.push_back(load.module);
    }
    std::ranges::sort(modules);
    modules.erase(std::unique(modules.begin(), modules.end()), modules.end());
    return find_answers_(modules);
  }

  const SolvedCore& core_;
  const std::function<bool(std::span<const std::size_t>)>& find_answers_;
  std::vector<PointLoad> known_;
  std::vector<std::size_t> places_;
  std::vector<Unknown> unknowns_;
  std::vector<double> forces_;
  std::size_t yielding_count_ = 0;
};

std::optional<Changed> ChangedRobot::solve(const ContactStates& states) const {
  const std::size_t core_count = core_.facets().size();
  std::vector<FacetState> own = change_.facets;
  for (std::size_t i = 0; i < own.size() && !states.empty(); ++i) {
    own[i].state = states[core_count + i];
  }
  Changed changed{
      .states = states,
      .new_modules = NewModules(core_, change_.links, change_.beams, change_.new_loads, own)};
  System system(core_, change_, changed.new_modules);
  for (const model::Connection& beam : change_.lost_beams) {
    system.add_lost(beam);
  }
  for (const std::size_t lost : change_.lost_facets) {
    system.add_facet(core_.facets()[lost], std::nullopt);
  }
  for (std::size_t i = 0; i < core_count && !states.empty(); ++i) {
    if (states[i] != core_.facets()[i].state && !is_lost(i)) {
      system.add_facet(core_.facets()[i], states[i]);
    }
  }
  if (!system.solve()) {
    return std::nullopt;
  }
  changed.loads = system.loads();
  changed.yielding_count = system.yielding_count();
  if (!states.empty()) {
    changed.trials = trial_forces(changed);
  }
  return changed;
}

Vec6<double> ChangedRobot::displacement(std::size_t module,
                                        const std::vector<PointLoad>& loads) const {
  Vec6<double> u = core_.displacement(module);
  for (const PointLoad& load : loads) {
    base::add_to(u, core_.answer(module, load));
  }
  return u;
}

std::vector<Vec6<double>> ChangedRobot::trial_forces(const Changed& changed) const {
  std::vector<Vec6<double>> trials;
  for (const FacetState& facet : core_.facets()) {
    trials.push_back(core_.law().trial_force(facet, displacement(facet.module, changed.loads)));
  }
  if (change_.facets.empty()) {
    return trials;
  }
  std::vector<Vec6<double>> hosts;
  for (const Link& link : change_.links) {
    hosts.push_back(displacement(link.host, changed.loads));
  }
  const std::vector<Vec6<double>> moved = changed.new_modules.displacements(hosts);
  for (const FacetState& facet : change_.facets) {
    trials.push_back(core_.law().trial_force(facet, moved[facet.module]));
  }
  return trials;
}

std::optional<ContactStates> ChangedRobot::prescribed(const Changed& changed) const {
  ContactStates states;
  for (std::size_t i = 0; i < changed.trials.size(); ++i) {
    if (is_lost(i)) {
      states.push_back(changed.states[i]);
      continue;
    }
    const auto state = certain_state(core_.law(), facet(i), changed.trials[i], scale_n_);
    if (!state) {
      return std::nullopt;
    }
    states.push_back(*state);
  }
  return states;
}

std::optional<Changed> ChangedRobot::settle() const {
  std::optional<Changed> changed;
  const ContactStates stuck(core_.facets().size() + change_.facets.size());
  const auto states = settled_states(stuck, kStepCountMax, [&](const ContactStates& tried) {
    changed = solve(tried);
    return changed ? prescribed(*changed) : std::nullopt;
  });
  return states ? std::move(changed) : std::nullopt;
}

bool ChangedRobot::may_have_others(const Changed& settled) const {
  for (std::size_t i = 0; i < settled.states.size(); ++i) {
    if (facet(i).is_bonded || is_lost(i) ||
        !solver::may_have_second_state(settled.states[i], settled.trials[i], kForceShare)) {
      continue;
    }
    ContactStates other = settled.states;
    other[i] = {.pressed = !settled.states[i].pressed};
    const auto next = solve(other);
    const auto state =
        next ? certain_state(core_.law(), facet(i), next->trials[i], scale_n_) : std::nullopt;
    if (!state || state->pressed == other[i].pressed) {
      return true;
    }
  }
  return false;
}

}  // namespace holdfast::plan
