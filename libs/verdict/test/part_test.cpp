// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "general_robot.hpp"
#include "hard_robot.hpp"
#include "holdfast/verdict/assessment.hpp"

/// Parts of robots go through code that robots in one piece skip. Where the only part is the whole
/// robot all of it must come to the same.
namespace holdfast::verdict {
namespace {

/// The only rank of a problem that others might share.
class OnlyRank final : public host::Ranks {
 public:
  int rank() const override { return single_.rank(); }

  int count() const override { return single_.count(); }

  double sum(double mine) override { return single_.sum(mine); }

  double max(double mine) override { return single_.max(mine); }

  void sum(std::span<double> mine) override { single_.sum(mine); }

  std::vector<std::byte> gather(std::span<const std::byte> mine) override {
    return single_.gather(mine);
  }

  std::unique_ptr<host::Halo> make_halo(std::size_t own_count,
                                        std::span<const host::Copy> copies) override {
    return single_.make_halo(own_count, copies);
  }

  void log(host::Work, bool) override {}

  bool is_own_method(const host::KrylovTask&) override { return true; }

  void watch(const host::KrylovTask& task) override { single_.watch(task); }

  bool solve(const host::KrylovTask&, std::span<const double>, std::span<double>) override {
    return false;
  }

 private:
  host::Ranks& single_ = host::single_rank();
};

void expect_alike(const RigidBody& a, const RigidBody& b) {
  EXPECT_EQ(a.is_stable, b.is_stable);
  EXPECT_EQ(a.margin_mm, b.margin_mm);
  EXPECT_EQ(a.centre_of_mass.x, b.centre_of_mass.x);
  EXPECT_EQ(a.centre_of_mass.y, b.centre_of_mass.y);
  EXPECT_EQ(a.polygon.size(), b.polygon.size());
}

/// The whole and the parts say the same to the last digit but for the iterations' error, on which
/// it may depend whether further solutions are found.
void expect_same(model::RobotSpec spec) {
  spec.existing.insert(spec.existing.end(), spec.planned.begin(), spec.planned.end());
  spec.planned.clear();
  const auto whole = model::Robot::create(spec, 1);
  if (!whole) {
    return;
  }
  OnlyRank rank;
  const auto part =
      model::Robot::create_part(spec, {.ranks = rank, .own_count = spec.existing.size()});
  ASSERT_TRUE(part);
  EXPECT_EQ(model::whole_module_count(part.value()), whole.value().modules().size());
  EXPECT_EQ(part.value().facets().size(), whole.value().facets().size());
  const solver::EquilibriumOptions options = {.method = solver::Method::kMultigrid,
                                              .thread_count = 1};
  const Assessment expected = verdict::assess(whole.value(), options);
  const Assessment found = verdict::assess(part.value(), options);
  expect_alike(found.simplified, expected.simplified);
  EXPECT_EQ(found.stability_rule, expected.stability_rule);
  EXPECT_EQ(found.rigid.answer, expected.rigid.answer);
  EXPECT_EQ(found.rigid.tilt_margin_deg, expected.rigid.tilt_margin_deg);
  EXPECT_EQ(found.contact_model, expected.contact_model);
  EXPECT_EQ(found.model.is_settled, expected.model.is_settled);
  if (found.equilibrium.others.size() == expected.equilibrium.others.size()) {
    EXPECT_EQ(found.verdict, expected.verdict);
    EXPECT_EQ(found.reasons.front().code, expected.reasons.front().code);
  }
  ASSERT_EQ(found.load_ratio_max.has_value(), expected.load_ratio_max.has_value());
  if (found.load_ratio_max) {
    EXPECT_NEAR(*found.load_ratio_max, *expected.load_ratio_max,
                1e-4 * std::max(1.0, *expected.load_ratio_max));
    ASSERT_TRUE(found.whole);
    EXPECT_EQ(found.whole->connection_count, whole.value().connections().size());
  }
}

TEST(Part, that_is_the_whole_robot_has_its_verdict) {
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < 30; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + " of " +
                   std::to_string(lattice.direction_count) + " directions");
      expect_same(test::general_robot(lattice, seed));
      expect_same(test::on_a_floor(test::general_robot(lattice, seed), seed % 2 == 0));
      expect_same(test::with_friction(test::general_robot(lattice, seed), seed));
      expect_same(test::hard_robot(lattice, seed));
    }
  }
}

}  // namespace
}  // namespace holdfast::verdict
