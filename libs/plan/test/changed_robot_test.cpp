// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// A changed robot moves as the same robot does whose equations are made and solved from nothing,
// whatever states its facets and those of its core are in.

#include "equilibria/changed_robot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <string>
#include <utility>

#include "equilibria/core_response.hpp"
#include "equilibria/solved_core.hpp"
#include "general_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Cell;
using base::Vec6;
using mechanics::ContactState;

/// Weak springs that keep every system well conditioned.
constexpr double kGamma = 0.1;

const solver::EquilibriumOptions kDirect{.method = solver::Method::kDirect, .thread_count = 1};

std::unique_ptr<solver::LinearSystem> system_of(const model::Robot& robot,
                                                const std::vector<ContactState>& states) {
  auto system = solver::make_linear_system(robot, kDirect);
  system->set_law({.law = mechanics::ContactLaw::kRegularised, .gamma = kGamma});
  for (std::size_t i = 0; i < states.size(); ++i) {
    system->set_facet(i, states[i], true);
  }
  return system;
}

std::vector<Vec6<double>> solved(solver::LinearSystem& system) {
  EXPECT_EQ(system.solve(0), solver::LinearOutcome::kSolved);
  return system.displacement();
}

/// Displacements and turns are compared with the largest of their own.
void expect_near(const std::vector<Vec6<double>>& a, const std::vector<Vec6<double>>& b,
                 const std::string& what) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t first : {0U, 3U}) {
    double size = 0;
    double change = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      for (std::size_t k = first; k < first + 3; ++k) {
        size = std::max(size, std::abs(b[i][k]));
        change = std::max(change, std::abs(a[i][k] - b[i][k]));
      }
    }
    EXPECT_LE(change, 1e-8 * size) << what << ' ' << first;
  }
}

/// Memory for all columns, bytes.
constexpr std::size_t kEnough = std::size_t{1} << 29U;

std::vector<std::size_t> all_modules(const model::Robot& robot) {
  std::vector<std::size_t> modules(robot.modules().size());
  std::iota(modules.begin(), modules.end(), std::size_t{0});
  return modules;
}

/// A robot, and the same with up to four modules more and another load.
struct Pair {
  model::Robot core;
  model::Robot grown;
  std::vector<std::size_t> place;  ///< By module of the grown one: in the core, or behind it.
};

std::optional<Pair> pair_of(const base::Lattice& lattice, std::uint64_t seed) {
  model::RobotSpec spec = test::held_robot(lattice, seed, test::Fixed::kFirst);
  const std::vector<Cell> planned = std::exchange(spec.planned, {});
  spec.material.contact_gamma = kGamma;
  auto core = model::Robot::create(spec, 1);
  const std::size_t more = std::min(planned.size(), seed % (kNewMax + 1));
  spec.existing.insert(spec.existing.end(), planned.begin(),
                       planned.begin() + static_cast<std::ptrdiff_t>(more));
  spec.payloads.push_back({.cell = spec.existing[seed % 2], .force_n = {0.1, 0.2, -0.4}});
  auto grown = model::Robot::create(spec, 1);
  if (!core || !grown) {
    return std::nullopt;
  }
  Pair pair{.core = std::move(core).value(), .grown = std::move(grown).value(), .place = {}};
  std::map<Cell, std::size_t> known;
  for (const model::Module& module : pair.core.modules()) {
    known.emplace(module.cell, known.size());
  }
  for (const model::Module& module : pair.grown.modules()) {
    pair.place.push_back(known.try_emplace(module.cell, known.size()).first->second);
  }
  return pair;
}

std::vector<ContactState> random_states(const model::Robot& robot, base::Rng& rng) {
  std::vector<ContactState> states;
  for (const model::Facet& facet : robot.facets()) {
    const int code = static_cast<int>(rng.below(ContactState::kCodeCount));
    states.push_back(facet.is_bonded() ? ContactState() : ContactState::from_code(code));
  }
  return states;
}

/// What the grown robot of a pair has more, and its facets' states.
class Growth {
 public:
  Growth(const Pair& pair, const SolvedCore& core, const std::vector<ContactState>& states)
      : pair_(pair), core_(core), core_count_(pair.core.modules().size()) {
    add_loads();
    add_beams();
    add_facets(states);
  }

  const Change& change() const { return change_; }

  const ContactStates& states() const { return states_; }

  /// Where the state of a facet of the grown robot is.
  std::size_t index_of(std::size_t facet) const { return index_of_[facet]; }

  bool has_new() const { return !change_.new_loads.empty(); }

  /// Displacements by module of the grown robot.
  std::vector<Vec6<double>> displacements(const Changed& changed) const {
    const auto of_core = [&](std::size_t module) {
      Vec6<double> u = core_.displacement(module);
      for (const PointLoad& load : changed.loads) {
        base::add_to(u, core_.answer(module, load));
      }
      return u;
    };
    std::vector<Vec6<double>> hosts;
    for (const Link& link : change_.links) {
      hosts.push_back(of_core(link.host));
    }
    const auto moved = changed.new_modules.displacements(hosts);
    std::vector<Vec6<double>> all;
    for (const std::size_t place : pair_.place) {
      all.push_back(place < core_count_ ? of_core(place) : moved[place - core_count_]);
    }
    return all;
  }

 private:
  void add_loads() {
    change_.new_loads.resize(pair_.grown.modules().size() - core_count_);
    for (std::size_t i = 0; i < pair_.place.size(); ++i) {
      Vec6<double> load = pair_.grown.loads()[i];
      const std::size_t place = pair_.place[i];
      if (place >= core_count_) {
        change_.new_loads[place - core_count_] = load;
      } else {
        base::add_times(load, -1, pair_.core.loads()[place]);
        change_.loads.push_back({.module = place, .load = load});
      }
    }
  }

  void add_beams() {
    for (const model::Connection& joint : pair_.grown.connections()) {
      const std::size_t a = pair_.place[at(joint.a)];
      const std::size_t b = pair_.place[at(joint.b)];
      if (a >= core_count_ && b >= core_count_) {
        change_.beams.push_back({.a = static_cast<std::int32_t>(a - core_count_),
                                 .b = static_cast<std::int32_t>(b - core_count_),
                                 .direction = joint.direction});
      } else if (b >= core_count_) {
        change_.links.push_back({.host = a, .direction = joint.direction, .to = b - core_count_});
      } else if (a >= core_count_) {
        change_.links.push_back(
            {.host = b, .direction = base::opposite(joint.direction), .to = a - core_count_});
      }
    }
  }

  void add_facets(const std::vector<ContactState>& states) {
    states_.resize(core_.facets().size());
    for (std::size_t i = 0; i < states.size(); ++i) {
      const model::Facet& facet = pair_.grown.facets()[i];
      const std::size_t place = pair_.place[at(facet.module)];
      if (place >= core_count_) {
        index_of_.push_back(states_.size());
        states_.push_back(states[i]);
        change_.facets.push_back({.module = place - core_count_,
                                  .direction = facet.direction,
                                  .is_bonded = facet.is_bonded(),
                                  .state = {}});
        continue;
      }
      const auto same = std::ranges::find_if(core_.facets(), [&](const solver::FacetState& other) {
        return other.module == place && other.direction == facet.direction;
      });
      index_of_.push_back(static_cast<std::size_t>(same - core_.facets().begin()));
      states_[index_of_.back()] = states[i];
    }
  }

  const Pair& pair_;
  const SolvedCore& core_;
  std::size_t core_count_;
  std::vector<std::size_t> index_of_;
  ContactStates states_;
  Change change_;
};

TEST(ChangedRobot, moves_as_one_that_is_solved_from_nothing) {
  std::size_t grown_count = 0;
  std::size_t facet_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(200U); ++seed) {
    const auto pair = pair_of(test::kLattices[seed % 4], seed);
    if (!pair) {
      continue;
    }
    const auto influence = solver::Influence::make(pair->core, kDirect);
    if (!influence) {
      continue;
    }
    base::Rng rng(seed);
    SolvedCore core(*influence);
    ASSERT_TRUE(core.find_columns(all_modules(pair->core), kEnough));
    const auto states = random_states(pair->grown, rng);
    const auto system = system_of(pair->grown, states);
    const std::vector<Vec6<double>> expected = solved(*system);
    const Growth growth(*pair, core, states);
    const auto changed = ChangedRobot(core, growth.change(), 1).solve(growth.states());
    ASSERT_TRUE(changed) << seed;
    expect_near(growth.displacements(*changed), expected, std::to_string(seed));
    for (std::size_t i = 0; i < states.size(); ++i) {
      const solver::FacetState& facet = system->facets()[i];
      const auto trial = system->law().trial_force(facet, expected[facet.module]);
      expect_near({changed->trials[growth.index_of(i)]}, {trial}, std::to_string(seed) + " facet");
    }
    grown_count += growth.has_new() ? 1 : 0;
    facet_count += states.size();
  }
  EXPECT_GE(grown_count, test::least(60U));
  EXPECT_GE(facet_count, test::least(200U));
}

/// Three modules in a row on one host: their weight, at an arm of 1, 2 and 3 pitches.
TEST(ChangedRobot, has_new_modules_on_one_link_for_a_load) {
  const auto robot =
      model::Robot::create({.existing = {{0, 0, 0}}, .fixed = {{0, 0, 0}}}, 1).value();
  const auto influence = solver::Influence::make(robot, kDirect);
  const SolvedCore core(*influence);
  const std::vector<Link> links = {{.host = 0, .direction = base::Direction::kPlusX}};
  const std::vector<model::Connection> beams = {
      {.a = 0, .b = 1, .direction = base::Direction::kPlusX},
      {.a = 1, .b = 2, .direction = base::Direction::kPlusX}};
  const std::vector<Vec6<double>> loads(3, Vec6<double>{0, 0, -2, 0, 0, 0});
  const NewModules modules(core, links, beams, loads, {});
  EXPECT_TRUE(modules.is_load());
  const double pitch = robot.material().pitch_mm;
  const Vec6<double> expected = {0, 0, -6, 0, 2 * (1 + 2 + 3) * pitch, 0};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(modules.load(0)[k], expected[k], 1e-9 * pitch) << k;
  }
  for (const double value : modules.stiffness(0, 0).values) {
    EXPECT_NEAR(value, 0, 1e-9 * core.beam().block_11(base::Direction::kPlusX).at(4, 4));
  }
}

TEST(SolvedCore, answers_as_the_equations_do) {
  std::size_t answer_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(12U); ++seed) {
    const auto robot = model::Robot::create(
        test::on_a_floor(test::general_robot(test::kLattices[seed % 4], seed), false));
    const auto influence = robot ? solver::Influence::make(robot.value(), kDirect) : nullptr;
    if (!influence) {
      continue;
    }
    SolvedCore core(*influence);
    std::vector<std::size_t> modules;
    for (const solver::FacetState& facet : core.facets()) {
      modules.push_back(facet.module);
    }
    EXPECT_EQ(core.find_columns(modules, 1), modules.empty());
    ASSERT_TRUE(core.find_columns(modules, kEnough));
    const auto system = solver::make_linear_system(robot.value(), kDirect);
    system->set_law({.law = mechanics::ContactLaw::kRegularised,
                     .gamma = robot.value().material().contact_gamma});
    const std::size_t count = robot.value().modules().size();
    for (const solver::FacetState& facet : core.facets()) {
      const std::size_t other = (facet.module + seed) % count;
      const PointLoad load{.module = facet.module, .load = {1, 2, 3, 40, 50, 60}};
      const PointLoad back{.module = other, .load = load.load};
      for (const auto& [module, each] : {std::pair(other, load), std::pair(facet.module, back)}) {
        std::vector<Vec6<double>> loads(count);
        loads[each.module] = each.load;
        system->set_loads(model::Loads(loads));
        expect_near({core.answer(module, each)}, {solved(*system)[module]}, std::to_string(seed));
        ++answer_count;
      }
    }
  }
  EXPECT_GE(answer_count, test::least(24U));
}

/// The solver goes by Newton's method on the whole robot, and then finds no other solutions either.
TEST(CoreResponse, finds_the_equilibrium_that_a_solver_does) {
  std::size_t found_count = 0;
  std::size_t yielding_count = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(200U); ++seed) {
    const auto pair = pair_of(test::kLattices[seed % 4], seed);
    auto core = pair ? CoreResponse::make(pair->core, kDirect) : nullptr;
    const auto found = core ? core->solve(pair->grown) : std::nullopt;
    if (!found) {
      continue;
    }
    solver::EquilibriumSolver whole(pair->grown, kDirect);
    auto expected = whole.solve({.law = mechanics::ContactLaw::kRegularised,
                                 .gamma = pair->grown.material().contact_gamma});
    ASSERT_EQ(expected.outcome, solver::Outcome::kSettled) << seed;
    whole.seek_others(expected);
    EXPECT_TRUE(expected.others.empty()) << seed;
    EXPECT_EQ(found->contact, expected.contact) << seed;
    expect_near(found->displacement, expected.displacement, std::to_string(seed));
    ++found_count;
    yielding_count +=
        std::ranges::count(found->contact, mechanics::kStuck) < std::ssize(found->contact) ? 1 : 0;
  }
  EXPECT_GE(found_count, test::least(60U));
  EXPECT_GE(yielding_count, test::least(4U));
}

}  // namespace
}  // namespace holdfast::plan
