// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The contact iteration on an interface alone: a system that solves exactly, says that it does not,
// and remembers what it was asked for. States beside the energy that they belong to; tolerances
// beside their rules; the journal beside what was written.
#include "../src/contact/contact_iteration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../src/contact/regularised_contact.hpp"
#include "../src/contact/unilateral_contact.hpp"
#include "holdfast/model/families.hpp"

namespace holdfast::solver {
namespace {

using mechanics::ContactLaw;
using mechanics::ContactState;

/// Forwards to the direct system.
class Recorder final : public LinearSystem {
 public:
  explicit Recorder(const model::Robot& robot)
      : LinearSystem(robot), inner_(make_linear_system(robot, {.method = Method::kDirect})) {}

  LinearOutcome solve(double tolerance) override {
    tolerances.push_back(tolerance);
    return outcome == LinearOutcome::kSolved ? inner_->solve(0) : outcome;
  }

  LinearOutcome approach() override { return solve(1); }

  std::vector<Vec> displacement() override { return inner_->displacement(); }

  bool refine(Solution& solution) override { return inner_->refine(solution); }

  bool is_exact() const override { return false; }

  /// `error` until it has been solved to `certain_from`.
  std::vector<double> facet_errors() const override {
    return std::vector<double>(facets().size(), tolerances.back() > certain_from ? error : 0);
  }

  double energy_error() const override { return 0; }

  LinearReport report() const override { return inner_->report(); }

  std::vector<double> tolerances;
  LinearOutcome outcome = LinearOutcome::kSolved;
  double error = 0;
  double certain_from = 0;

 private:
  void take_law() override { inner_->set_law({.law = ground().law, .gamma = ground().gamma}); }

  void take_facet(std::size_t facet) override {
    inner_->set_facet(facet, facets()[facet].state, facets()[facet].is_held);
  }

  void take_loads() override { inner_->set_loads(loads()); }

  std::unique_ptr<LinearSystem> inner_;
};

/// More than the share of the weight on one foot of four, 3 N, less than half the weight.
constexpr double kLifting = 5;

/// A table of four legs, one pulled up.
model::Robot table(double pull_n) {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x < 4; ++x) {
    for (std::int32_t y = 0; y < 4; ++y) {
      spec.existing.push_back({x, y, 1});
      if (x % 3 == 0 && y % 3 == 0) {
        spec.existing.push_back({x, y, 0});
      }
    }
  }
  spec.payloads = {{.cell = {0, 0, 1}, .force_n = {0, 0, pull_n}}};
  return model::Robot::create(spec).value();
}

/// Every facet's state is what its displacement prescribes.
void expect_consistent(LinearSystem& system) {
  const std::vector<base::Vec6<double>> u = system.facet_displacement();
  for (std::size_t i = 0; i < u.size(); ++i) {
    EXPECT_EQ(system.law().state_at(system.facets()[i], u[i]), system.facets()[i].state) << i;
  }
}

TEST(BondedContact, solves_once_as_tightly_as_is_asked_for) {
  const model::Robot robot = table(0);
  Recorder system(robot);
  system.set_law({});
  EXPECT_EQ(BondedContact(system, {.tolerance = 1e-5}).run(), Outcome::kSettled);
  ASSERT_EQ(system.tolerances.size(), 1);
  EXPECT_NEAR(system.tolerances[0], 1e-4, 1e-10);  // Ten times that: the first of two answers.
}

TEST(RegularisedContact, ends_in_states_that_displacements_prescribe) {
  for (const double pull : {0.0, 0.5, kLifting}) {
    const model::Robot robot = table(pull);
    Recorder system(robot);
    system.set_law({});
    ASSERT_EQ(RegularisedContact(system, {}).run(), Outcome::kSettled);
    expect_consistent(system);
    const bool is_any_lifted = std::ranges::any_of(
        system.facets(), [](const FacetState& facet) { return !facet.state.pressed; });
    EXPECT_EQ(is_any_lifted, pull > 1);
  }
}

TEST(RegularisedContact, seeks_states_loosely_and_ends_tightly) {
  const model::Robot robot = table(kLifting);
  Recorder system(robot);
  system.set_law({});
  ASSERT_EQ(RegularisedContact(system, {.tolerance = 1e-5}).run(), Outcome::kSettled);
  ASSERT_GE(system.tolerances.size(), 3);
  EXPECT_EQ(system.tolerances.front(), 1e-3);
  EXPECT_NEAR(system.tolerances.back(), 1e-4, 1e-10);
}

/// The step goes on, a factor of ten at a time, as long as an error could decide a state.
TEST(RegularisedContact, goes_on_until_states_are_certain) {
  const model::Robot robot = table(kLifting);
  Recorder system(robot);
  system.set_law({});
  system.error = 1e3;
  system.certain_from = 1.5e-6;
  ASSERT_EQ(RegularisedContact(system, {}).run(), Outcome::kSettled);
  ASSERT_GE(system.tolerances.size(), 4);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(system.tolerances[i] * std::pow(10, i), 1e-3, 1e-12);
  }
  expect_consistent(system);
}

TEST(RegularisedContact, says_what_its_system_says) {
  const model::Robot robot = table(0);
  Recorder system(robot);
  system.set_law({});
  system.outcome = LinearOutcome::kSingular;
  EXPECT_EQ(RegularisedContact(system, {}).run(), Outcome::kSingular);
  system.outcome = LinearOutcome::kTooSlow;
  EXPECT_EQ(RegularisedContact(system, {}).run(), Outcome::kTooSlow);
}

TEST(RegularisedContact, does_not_settle_in_fewer_steps_than_it_takes) {
  const model::Robot robot = table(kLifting);
  Recorder system(robot);
  system.set_law({});
  EXPECT_EQ(RegularisedContact(system, {.step_count_max = 1}).run(), Outcome::kNotSettled);
}

/// The exact law has no weak springs: what does not press, pulls nothing.
TEST(UnilateralContact, ends_without_pulling_facets) {
  const model::Robot robot = table(kLifting);
  Recorder system(robot);
  system.set_law({.law = ContactLaw::kUnilateral, .gamma = 0});
  ASSERT_EQ(UnilateralContact(system, {}).run(), Outcome::kSettled);
  const std::vector<base::Vec6<double>> u = system.facet_displacement();
  double sum = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    const double up = -system.law().force(system.facets()[i], u[i])[2];
    EXPECT_GE(up, -1e-9);
    sum += up;
  }
  // Weight and pull are what the ground carries.
  const double weight = 20 * model::module_weight_n(model::Material{});
  EXPECT_NEAR(sum, weight - kLifting, 1e-6 * weight);
}

/// Keeps the last states, and counts searches.
class Journal final : public ContactJournal {
 public:
  std::vector<std::uint8_t> begin(ContactLaw, double) override {
    ++begun;
    return states;
  }

  void keep(std::span<const std::uint8_t> kept) override {
    states.assign(kept.begin(), kept.end());
    ++told;
  }

  std::vector<std::uint8_t> states;
  int begun = 0;
  int told = 0;
};

TEST(ContactIteration, goes_on_from_what_its_journal_has_kept) {
  const model::Robot robot = table(kLifting);
  Journal journal;
  const EquilibriumOptions options = {.journal = &journal};
  const ContactOptions contact;
  std::size_t first_count = 0;
  std::vector<FacetState> first;
  for (const bool is_again : {false, true}) {
    Recorder system(robot);
    system.set_law(contact);
    RegularisedContact iteration(system, options);
    iteration.go_on(contact);
    ASSERT_EQ(iteration.run(), Outcome::kSettled);
    if (is_again) {
      EXPECT_LT(system.tolerances.size(), first_count);
      EXPECT_TRUE(std::ranges::equal(system.facets(), first));
    } else {
      first_count = system.tolerances.size();
      first.assign(system.facets().begin(), system.facets().end());
      EXPECT_GT(journal.told, 0);
    }
  }
  EXPECT_EQ(journal.begun, 2);
}

}  // namespace
}  // namespace holdfast::solver
