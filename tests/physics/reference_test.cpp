// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Every connection of 220 structures against numbers that were computed independently of this
// project (tests/reference/README.md).
#include "reference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "holdfast/verdict/assessment.hpp"

namespace holdfast {
namespace {

using test::Reference;
using test::ReferenceLoad;

std::vector<Reference> read_references() { return test::read_references(HOLDFAST_REFERENCE_FILE); }

/// The largest difference of a quantity, relative to the largest value in the structure. Below
/// `floor` a structure has none of it, and what either side shows is rounding.
class Comparison {
 public:
  explicit Comparison(double floor) : largest_(floor) {}

  void add(double expected, double actual) {
    largest_ = std::max(largest_, std::abs(expected));
    difference_ = std::max(difference_, std::abs(expected - actual));
  }

  double relative() const { return difference_ / largest_; }

 private:
  double largest_;
  double difference_ = 0;
};

void expect_same_loads(const Reference& reference, const model::Robot& robot,
                       const verdict::Assessment& assessment) {
  std::map<std::pair<base::Cell, base::Cell>, std::size_t> found;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const model::Connection& pair = robot.connections()[i];
    found[{robot.modules()[static_cast<std::size_t>(pair.a)].cell,
           robot.modules()[static_cast<std::size_t>(pair.b)].cell}] = i;
  }
  ASSERT_EQ(found.size(), reference.loads.size());
  Comparison ratio(1e-6);
  Comparison axial(1e-6);
  Comparison bending(1e-6);
  for (const ReferenceLoad& load : reference.loads) {
    const auto place = found.find({load.a, load.b});
    ASSERT_NE(place, found.end());
    const verdict::ConnectionResult& result = assessment.connections[place->second];
    ratio.add(load.result.load_ratio, result.load_ratio);
    axial.add(load.result.axial_n, result.axial_n);
    bending.add(load.result.bending_nmm, result.bending_nmm);
  }
  EXPECT_LT(ratio.relative(), 1e-6);
  EXPECT_LT(axial.relative(), 1e-6);
  EXPECT_LT(bending.relative(), 1e-6);
}

TEST(Reference, has_all_structures) { EXPECT_EQ(read_references().size(), 220U); }

TEST(Reference, loads_margins_and_verdicts_agree) {
  for (const Reference& reference : read_references()) {
    SCOPED_TRACE(reference.name);
    const auto robot = model::Robot::create(reference.spec);
    ASSERT_TRUE(robot) << robot.error().message;
    const verdict::Assessment assessment = verdict::assess(robot.value());

    // The reference rounds margins to 1e-6 mm.
    EXPECT_NEAR(*assessment.simplified.margin_mm, reference.margin_mm, 1e-6);
    EXPECT_EQ(*assessment.simplified.margin_mm == 0, reference.is_tie);
    EXPECT_EQ(assessment.is_stable, reference.is_stable && !reference.is_tie);
    ASSERT_TRUE(assessment.model.is_settled);
    if (!reference.is_tie) {
      EXPECT_EQ(assessment.model.is_stable, reference.is_stable);
    }
    if (reference.is_settled) {
      EXPECT_EQ(assessment.contact_model, verdict::ContactModel::kRegularised);
      expect_same_loads(reference, robot.value(), assessment);
    }

    double largest = 0;
    for (const ReferenceLoad& load : reference.loads) {
      largest = std::max(largest, load.result.load_ratio);
    }
    if (!assessment.is_stable) {
      EXPECT_EQ(assessment.verdict, verdict::Verdict::kUnstable);
    } else if (reference.is_settled) {
      EXPECT_EQ(assessment.verdict,
                largest >= 1 ? verdict::Verdict::kOverload : verdict::Verdict::kSafe);
    } else {
      EXPECT_NE(assessment.verdict, verdict::Verdict::kUndecided);
    }
  }
}

/// The solver of large robots on these small ones: what it promises is 1e-4 of the largest load
/// ratio, or of 1 if that is smaller.
TEST(Reference, load_ratios_agree_by_multigrid_too) {
  int count = 0;
  for (const Reference& reference : read_references()) {
    SCOPED_TRACE(reference.name);
    const auto robot = model::Robot::create(reference.spec);
    const verdict::Assessment assessment =
        verdict::assess(robot.value(), {.method = solver::Method::kMultigrid});
    EXPECT_EQ(assessment.is_stable, reference.is_stable && !reference.is_tie);
    if (!assessment.is_stable) {
      EXPECT_EQ(assessment.verdict, verdict::Verdict::kUnstable);
    } else if (reference.is_settled) {
      EXPECT_EQ(assessment.contact_model, verdict::ContactModel::kRegularised);
      std::map<std::pair<base::Cell, base::Cell>, double> found;
      for (std::size_t i = 0; i < robot.value().connections().size(); ++i) {
        const auto [a, b] = model::ends(robot.value(), i);
        found[{a, b}] = assessment.connections[i].load_ratio;
      }
      Comparison ratio(1);
      for (const ReferenceLoad& load : reference.loads) {
        ratio.add(load.result.load_ratio, found.at({load.a, load.b}));
      }
      EXPECT_LT(ratio.relative(), 1e-4);
      ++count;
    }
  }
  EXPECT_GT(count, 100);
}

}  // namespace
}  // namespace holdfast
