// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The paper's contact law may have several solutions. Which one is the answer must not depend on
// how the robot lies, in which order its modules are listed, or which solver is used; and where
// there are several the report says so. Gravity knows no north: the expected values are the same
// robot's, turned back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "holdfast/holdfast.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "standing_robot.hpp"

namespace holdfast {
namespace {

/// Makes a robot so stiff that bending leaves the centre of mass where it is; loads are the same to
/// the last bit.
model::RobotSpec stiff(model::RobotSpec spec) {
  spec.material.elastic_modulus_mpa *= 1 << 20;
  return spec;
}

using solver::Method;
using Vec = base::Vec6<double>;

model::Robot make_robot(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec);
  HOLDFAST_CHECK(robot.has_value());
  return std::move(robot).value();
}

/// The foot's corner of this tower is so near to tilting that multigrid, with the error that it had
/// while it sought contact states, saw it tilt in some of the eight ways and not in others: two
/// solutions, with 0.1196 and 0.0707 on one connection.
model::RobotSpec two_paths() {
  const auto structure = load_file(HOLDFAST_TWO_PATHS_FILE);
  HOLDFAST_CHECK(structure.has_value());
  model::RobotSpec spec;
  for (const model::Module& module : structure.value().robot.modules()) {
    (module.is_planned ? spec.planned : spec.existing).push_back(module.cell);
  }
  return spec;
}

/// Load ratios by the cells that a connection joins, in the robot's own frame.
using Ratios = std::map<std::pair<base::Cell, base::Cell>, double>;

Ratios load_ratios(const model::RobotSpec& spec, int turn, Method method) {
  const int half = test::kTurnCount / 2;
  const int back = turn < half ? (half - turn) % half : turn;
  const model::Robot robot = make_robot(test::turned(spec, turn, static_cast<std::uint64_t>(turn)));
  // So exactly that what is left cannot hide another solution.
  const auto assessment = verdict::assess(robot, {.method = method, .tolerance = 1e-7});
  EXPECT_EQ(assessment.contact_model, verdict::ContactModel::kRegularised);
  Ratios ratios;
  for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
    const auto [a, b] = model::ends(robot, i);
    const base::Cell p = test::turned(a, back);
    const base::Cell q = test::turned(b, back);
    ratios[{std::min(p, q), std::max(p, q)}] = assessment.connections[i].load_ratio;
  }
  return ratios;
}

void expect_equal_in_all_ways(const model::RobotSpec& spec) {
  const Ratios expected = load_ratios(spec, 0, Method::kDirect);
  ASSERT_FALSE(expected.empty());
  double largest = 1;
  for (const auto& [ends, ratio] : expected) {
    largest = std::max(largest, ratio);
  }
  for (int turn = 0; turn < test::kTurnCount; ++turn) {
    for (const Method method : {Method::kDirect, Method::kMultigrid}) {
      SCOPED_TRACE(::testing::Message() << "turn " << turn << ", method " << int(method));
      for (const auto& [ends, ratio] : load_ratios(spec, turn, method)) {
        ASSERT_NEAR(ratio, expected.at(ends), 1e-6 * largest);
      }
    }
  }
}

TEST(SeveralSolutions, one_is_the_answer_in_all_eight_ways_a_robot_can_lie) {
  expect_equal_in_all_ways(two_paths());
}

TEST(SeveralSolutions, robots_that_have_some_have_one_answer) {
  for (const std::uint64_t seed : {127U, 228U, 342U}) {
    SCOPED_TRACE(::testing::Message() << "standing_robot(" << seed << ")");
    expect_equal_in_all_ways(test::standing_robot(seed));
  }
}

/// The largest force, N, or torque at half a width, that misses from equilibrium (Eq. 5) under the
/// law of Eqs. (9)-(12), for the states that the displacements themselves prescribe.
double missing_force(const model::Robot& robot, const std::vector<Vec>& u) {
  const model::Material& material = robot.material();
  const auto section = model::beam_section(material);
  const auto beam = mechanics::beam_stiffness(section);
  const auto facet = mechanics::ground_facet(section, material.facet_mm, material.contact_gamma,
                                             mechanics::ContactLaw::kRegularised);
  std::vector<Vec> force(u.size(), Vec{0, 0, model::module_weight_n(material), 0, 0, 0});
  for (const model::Connection& pair : robot.connections()) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    base::add_to(force[a], mechanics::end_force(beam, pair.direction, u[a], u[b]));
    base::add_to(force[b], mechanics::end_force(beam, base::opposite(pair.direction), u[b], u[a]));
  }
  double largest = 0;
  for (std::size_t i = 0; i < u.size(); ++i) {
    if (robot.modules()[i].support == model::Support::kGround) {
      const auto state = mechanics::contact_state(facet, mechanics::trial_force(facet, u[i]));
      base::add_to(force[i], mechanics::contact_force(facet, state, true, u[i]));
    }
    for (std::size_t k = 0; k < 6; ++k) {
      largest = std::max(largest, std::abs(force[i][k]) / (k < 3 ? 1 : material.facet_mm / 2));
    }
  }
  return largest;
}

/// One with a foot that stays on the ground or off it (94: off it on the path), one that tilts or
/// is off, one with two such feet.
TEST(SeveralSolutions, all_that_are_found_fulfil_the_law) {
  for (const std::uint64_t seed : {94U, 127U, 342U}) {
    SCOPED_TRACE(::testing::Message() << "standing_robot(" << seed << ")");
    const model::Robot robot = make_robot(test::standing_robot(seed));
    for (const Method method : {Method::kDirect, Method::kMultigrid}) {
      const auto assessment = verdict::assess(robot, {.method = method, .tolerance = 1e-7});
      const solver::Equilibrium& equilibrium = assessment.equilibrium;
      ASSERT_TRUE(assessment.several);
      ASSERT_FALSE(equilibrium.others.empty());
      EXPECT_EQ(assessment.several->found_count, equilibrium.others.size() + 1);
      // Feet bear up to 100 N; the solver leaves a millionth of that.
      EXPECT_LT(missing_force(robot, equilibrium.displacement), 1e-3);
      for (const solver::Solution& other : equilibrium.others) {
        EXPECT_LT(missing_force(robot, other.displacement), 1e-3);
        double apart = 0;
        for (std::size_t i = 0; i < other.displacement.size(); ++i) {
          apart =
              std::max(apart, std::abs(other.displacement[i][2] - equilibrium.displacement[i][2]));
        }
        EXPECT_GT(apart, 1e-5);  // mm; the solver's error is a hundredth of it.
      }
    }
  }
}

/// Load ratios go with one over the strength, so a strength can be chosen for each case.
TEST(SeveralSolutions, give_a_verdict_only_where_they_agree) {
  model::RobotSpec spec = stiff(test::standing_robot(94));
  const auto first = verdict::assess(make_robot(spec));
  ASSERT_TRUE(first.several && first.several->unilateral);
  const verdict::LoadRange paper = first.several->regularised;
  const verdict::LoadRange exact = *first.several->unilateral;
  ASSERT_LT(paper.low, paper.high);
  ASSERT_LT(paper.high, exact.low);
  const model::Material material = spec.material;
  const auto with_strength = [&](double factor) {
    spec.material.strength_vertical_n = factor * material.strength_vertical_n;
    spec.material.strength_lateral_n = factor * material.strength_lateral_n;
    return verdict::assess(make_robot(spec));
  };
  const auto has = [](const verdict::Assessment& assessment, verdict::ReasonCode code) {
    return std::ranges::find(assessment.reasons, code, &verdict::Reason::code) !=
           assessment.reasons.end();
  };
  for (const double strength : {(paper.low + paper.high) / 2, (paper.high + exact.low) / 2}) {
    const auto torn = with_strength(strength);
    EXPECT_EQ(torn.verdict, verdict::Verdict::kUndecided);
    EXPECT_TRUE(has(torn, verdict::ReasonCode::kSolutionsDisagree));
    EXPECT_EQ(torn.equilibrium.method, Method::kDirect);  // With all digits; none are given up.
  }
  EXPECT_EQ(with_strength(paper.low / 1.01).verdict, verdict::Verdict::kOverload);
  EXPECT_EQ(with_strength(exact.high * 1.01).verdict, verdict::Verdict::kSafe);
  EXPECT_TRUE(has(with_strength(exact.high * 1.01), verdict::ReasonCode::kSolutionsAgree));
}

/// A robot that bends half a million times as easily moves so far that displacements in double have
/// no more than ten digits of the loads.
TEST(SeveralSolutions, are_known_to_all_digits_where_the_answer_is) {
  model::RobotSpec spec = test::standing_robot(342);
  spec.material.moment_x_mm4 *= 2e-6;
  spec.material.moment_y_mm4 *= 2e-6;
  const auto assessment =
      verdict::assess(make_robot(spec), {.method = Method::kDirect, .is_precise = true});
  ASSERT_TRUE(assessment.several);
  const verdict::SeveralSolutions& several = *assessment.several;
  EXPECT_LT(several.error, 1e-11);
  EXPECT_LE(several.regularised.low - several.error, *assessment.load_ratio_max);
  EXPECT_GE(several.regularised.high + several.error, *assessment.load_ratio_max);
}

/// A proof is of one solution, and decides nothing about the others.
TEST(SeveralSolutions, that_do_not_agree_are_not_decided_by_a_proof) {
  model::RobotSpec spec = stiff(test::standing_robot(94));
  const auto first = verdict::assess(make_robot(spec));
  ASSERT_TRUE(first.several && first.several->unilateral);
  const double strength = (first.several->regularised.high + first.several->unilateral->low) / 2;
  spec.material.strength_vertical_n *= strength;
  spec.material.strength_lateral_n *= strength;
  const model::Robot robot = make_robot(spec);
  auto assessment = verdict::assess(robot);
  const proof::Proof proof = proof::prove(robot, assessment);
  ASSERT_TRUE(proof.is_proved()) << proof.verification.reason;
  proof::apply(robot, proof, assessment);
  EXPECT_EQ(assessment.verdict, verdict::Verdict::kUndecided);
  EXPECT_EQ(assessment.reasons.front().code, verdict::ReasonCode::kSolutionsDisagree);
}

TEST(SeveralSolutions, stand_in_the_report) {
  for (const auto& [seed, text] : {std::pair{94U, "\"several_solutions\": {\n    \"found\": 2,"},
                                   std::pair{93U, "\"several_solutions\": null"}}) {
    const model::Robot robot = make_robot(test::standing_robot(seed));
    const auto assessment = verdict::assess(robot);
    const std::string json = io::write_report_json(
        {.name = "standing", .robot = &robot, .assessment = &assessment, .warnings = {}});
    EXPECT_NE(json.find(text), std::string::npos) << json.substr(json.find("several"), 200);
  }
}

}  // namespace
}  // namespace holdfast
