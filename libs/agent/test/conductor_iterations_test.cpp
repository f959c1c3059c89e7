// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The root's decisions with the one-sweep methods, and how it seeks further solutions, as
// conductor_test.cpp has all others.
#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "drive.hpp"
#include "holdfast/agent/equilibrium/deflation.hpp"
#include "holdfast/base/rng.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using wire::Operation;

TEST(Conductor, few_loops_are_eliminated_many_are_left_to_a_polynomial) {
  Drive tree = one_sweep_drive(false);
  EXPECT_EQ(tree.order.count, 0);
  ASSERT_EQ(tree.next().operation, Operation::kFactor);
  ASSERT_EQ(tree.next().operation, Operation::kTreeIterate);
  EXPECT_EQ(tree.next(iteration_report(1e-6F)).operation, Operation::kLoads);

  Drive loops = one_sweep_drive(true);
  EXPECT_EQ(loops.order.count, 6);  // One and a half times the depth of 4.
  ASSERT_EQ(loops.next().operation, Operation::kIterate);
  EXPECT_EQ(loops.order.flags, kRestart);
  EXPECT_EQ(loops.order.count, 6);
}

/// Up to the report of the first iteration with fronts.
Drive fronts_drive() {
  Drive drive(Method::kFronts);
  drive.to_mass();
  drive.next({.flags = kAnyFixed | kManyLoops, .extent = 5, .count = kCensus, .number = kCensus});
  EXPECT_EQ(drive.order.operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kOneSweep | kWithFronts);
  EXPECT_EQ(drive.next().operation, Operation::kFactor);
  EXPECT_EQ(drive.next().operation, Operation::kTreeIterate);
  return drive;
}

TEST(Conductor, fronts_without_room_give_way_to_the_polynomial) {
  Drive drive = fronts_drive();
  Report report = iteration_report(1);
  report.flags = kNoRoom;
  ASSERT_EQ(drive.next(report).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kOneSweep | kWithIterations);
}

/// While others want to let go there may yet be a state; then the other law, then another method.
TEST(Conductor, fronts_without_a_contact_state_take_the_unilateral_law) {
  Drive drive = fronts_drive();
  Report report = iteration_report(1, {}, 2);
  report.flags = kNoState;
  ASSERT_EQ(drive.next(report).operation, Operation::kFactor);
  drive.next();
  report.extent = 0;
  ASSERT_EQ(drive.next(report).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kUnilateralLaw | kOneSweep | kWithFronts);
  drive.next();
  drive.next();
  ASSERT_EQ(drive.next(report).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kUnilateralLaw | kOneSweep | kWithIterations);
}

TEST(Conductor, a_change_of_contact_states_is_factored_or_starts_directions_anew) {
  Drive tree = one_sweep_drive(false);
  tree.next();
  tree.next();
  EXPECT_EQ(tree.next(iteration_report(1e-6F, {}, 1)).operation, Operation::kFactor);
  EXPECT_EQ(tree.conductor.effort().contact_iterations, 1U);

  Drive loops = one_sweep_drive(true);
  loops.next();
  loops.next(iteration_report(100, {1, 1, 0}));
  ASSERT_EQ(loops.order.flags, 0);
  loops.next(iteration_report(1, {1, 1, 0}, 2));
  EXPECT_EQ(loops.order.flags, kRestart);
  EXPECT_EQ(loops.conductor.effort().contact_iterations, 1U);
}

/// A tilting facet makes the tangent unsymmetric, so that there is no energy.
TEST(Conductor, minimises_the_residual_while_a_facet_tilts) {
  Drive drive = one_sweep_drive(true);
  drive.next();
  Report report = iteration_report(1, {1, 1, 0}, 2);
  report.flags = kAnyTilting;
  drive.next(report);
  EXPECT_EQ(drive.order.flags, kRestart | kLeastResidual);
  report.extent = 0;
  drive.next(report);
  EXPECT_EQ(drive.order.flags, kLeastResidual);
}

/// K = diag(1, 2, 4), u = 0, f = (4, 4, 4), M = 2. The full correction p = (2, 2, 2) has q = (2, 4,
/// 8) and leaves r = (2, 0, -4): (r, p) = -4, (p, q) = 28, so a = -1/7: the energy is least at 6/7
/// p, where r^ = (16, 4, -20) / 7. The next p = r^ / 2 = (8, 2, -10) / 7 has q = (8, 4, -40) / 7
/// and leaves r = (8, 0, 20) / 7: (r, p) = -136 / 49, (p, q) = 472 / 49, (p, q_older) = -8.
TEST(Conductor, minimises_the_energy_over_two_directions) {
  Drive drive = one_sweep_drive(true);
  drive.next();
  drive.next(iteration_report(100, {-4, 28, 0}));
  ASSERT_EQ(drive.order.operation, Operation::kIterate);
  EXPECT_FLOAT_EQ(drive.order.reals[0], 0);
  EXPECT_FLOAT_EQ(drive.order.reals[1], -1.F / 7);
  EXPECT_FLOAT_EQ(drive.order.reals[2], 0);
  drive.next(iteration_report(100, {-136. / 49, 472. / 49, -8}));
  // c = -2/7, (r, p_older) = 8: p - c older = (12, 6, -6) / 7 has (p, q) = 360 / 49 and
  // (r, p) = -24 / 49.
  EXPECT_FLOAT_EQ(drive.order.reals[0], -2.F / 7);
  EXPECT_FLOAT_EQ(drive.order.reals[1], -24.F / 360);
  EXPECT_FLOAT_EQ(drive.order.reals[2], 2.F / 7);
}

/// Up to the begin of the equilibrium of a deep robot with many loops.
Drive deep_drive(std::uint16_t depth) {
  Drive drive(Method::kElimination, depth);
  drive.to_mass();
  drive.next({.flags = kAnyFixed | kManyLoops, .extent = 5, .count = kCensus, .number = kCensus});
  return drive;
}

TEST(Conductor, deep_robots_take_iterations_with_clusters) {
  EXPECT_EQ(deep_drive(63).order.operation, Operation::kBegin);
  Drive drive = deep_drive(200);
  ASSERT_EQ(drive.order.operation, Operation::kClusters);
  EXPECT_EQ(drive.order.count, 300);  // The first iteration is that of the polynomial.
  drive.next({.count = 100, .number = 49});
  ASSERT_EQ(drive.order.operation, Operation::kIterate);
  EXPECT_EQ(drive.order.flags, kRestart | kWithClusters);
  EXPECT_EQ(drive.order.count, 40);  // A fifth of the depth.
  drive.next(iteration_report(100, {1, 1, 0}));
  EXPECT_EQ(drive.order.flags, kRestart | kWithClusters) << "the iteration before had another M^-1";
  drive.next(iteration_report(100, {1, 1, 0}));
  EXPECT_EQ(drive.order.flags, kWithClusters);
}

TEST(Conductor, clusters_with_many_stray_beams_are_left_alone) {
  Drive drive = deep_drive(200);
  drive.next({.count = 100, .number = 50});
  EXPECT_EQ(drive.order.flags, kRestart);
  EXPECT_EQ(drive.order.count, 300);
  drive.next(iteration_report(100, {1, 1, 0}));
  EXPECT_EQ(drive.order.flags, 0);
}

/// Iterations are full ones when contact states have changed, but for what was too long.
TEST(Conductor, takes_back_what_is_too_long_of_an_iteration_with_clusters) {
  Drive drive = deep_drive(200);
  drive.next({.count = 100});
  drive.next(iteration_report(100, {1, 1, 0}));
  drive.next(iteration_report(100, {0.5, 1, 0}, 3));
  EXPECT_EQ(drive.order.flags, kRestart | kWithClusters);
  drive.next(iteration_report(100, {-0.5, 1, 0}, 3));
  EXPECT_EQ(drive.order.flags, kWithClusters);
  EXPECT_EQ(drive.order.reals, (std::array<float, 3>{0, -0.5F, 0}));
}

// ---- Further solutions.

constexpr std::uint32_t kFoundHash = 17;

/// The report of an iteration of elimination that ends in these states.
Report settled_report(float ratio, std::uint32_t hash, std::uint16_t changed = 0) {
  return {.flags = kMayDiffer, .extent = changed, .number = hash, .reals = {1e-6F, ratio}};
}

/// A robot that is held, up to behind its first solution.
Drive seeking_drive(float ratio) {
  Drive drive = one_sweep_drive(false);
  drive.next();
  drive.next();
  drive.next(settled_report(ratio, kFoundHash));
  return drive;
}

/// Behind the last trial: back to what was found first, and its loads.
void return_to_found(Drive& drive, float ratio) {
  ASSERT_EQ(drive.order.operation, Operation::kSeek);
  EXPECT_EQ(drive.order.key(), 0U);
  ASSERT_EQ(drive.next({.count = 2, .number = 5}).operation, Operation::kFactor);
  ASSERT_EQ(drive.next().operation, Operation::kTreeIterate);
  ASSERT_EQ(drive.next(settled_report(ratio, kFoundHash)).operation, Operation::kLoads);
  drive.next({.number = kCensus, .reals = {ratio}});
}

TEST(Conductor, puts_one_facet_after_the_other_into_its_second_state) {
  Drive drive = seeking_drive(0.9F);
  ASSERT_EQ(drive.order.operation, Operation::kSeek);
  EXPECT_EQ(drive.order.flags, kRemember);
  EXPECT_EQ(drive.order.key(), 0U);
  Report last{.count = 2, .number = 5};
  for (const std::uint32_t key : {5U, 9U}) {
    ASSERT_EQ(drive.next(last).operation, Operation::kSeek);
    EXPECT_EQ(drive.order.flags, 0);
    EXPECT_EQ(drive.order.key(), key);
    const std::uint32_t after = key == 5 ? 9 : 0;
    ASSERT_EQ(drive.next({.count = 2, .number = after}).operation, Operation::kFactor);
    ASSERT_EQ(drive.next().operation, Operation::kTreeIterate);
    last = settled_report(0.9F, kFoundHash, 1);  // It wants to go back.
  }
  drive.next(last);
  return_to_found(drive, 0.9F);
  drive.expect_finished(Verdict::kSafe, Reason::kHolds);
}

TEST(Conductor, is_not_safe_where_another_solution_breaks) {
  for (const float other : {1.1F, 0.95F}) {
    Drive drive = seeking_drive(0.9F);
    drive.next({.count = 1, .number = 5});
    drive.next({.count = 1});
    drive.next();
    drive.next(settled_report(other, kFoundHash + 1));
    return_to_found(drive, 0.9F);
    drive.expect_finished(other > 1 ? Verdict::kUndecided : Verdict::kSafe,
                          other > 1 ? Reason::kAmbiguousFeet : Reason::kHolds);
  }
}

TEST(Conductor, seeks_no_other_solution_of_what_is_far_from_breaking_or_breaks) {
  for (const float ratio : {0.7F, 1.1F}) {
    EXPECT_EQ(seeking_drive(ratio).order.operation, Operation::kLoads);
  }
}

/// Up to the first solution of a trial.
Drive trial_drive() {
  Drive drive = seeking_drive(0.9F);
  drive.next({.count = 1, .number = 5});
  drive.next({.count = 1});
  drive.next();
  return drive;
}

TEST(Conductor, a_trial_that_goes_round_in_circles_says_nothing) {
  Drive drive = trial_drive();
  for (const std::uint32_t state : {1U, 2U, 1U}) {
    ASSERT_EQ(drive.order.operation, Operation::kTreeIterate);
    drive.next(iteration_report(0.01F));  // Accurate enough to look at states.
    drive.next(settled_report(1.1F, kFoundHash + state, 1));
    if (drive.order.operation == Operation::kFactor) {
      drive.next();
    }
  }
  return_to_found(drive, 0.9F);
  drive.expect_finished(Verdict::kSafe, Reason::kHolds);
}

TEST(Conductor, a_safer_method_seeks_once_more_where_a_trial_does_not_converge) {
  Drive drive = trial_drive();
  ASSERT_EQ(drive.next(iteration_report(kNan)).operation, Operation::kSeek);
  EXPECT_EQ(drive.order.key(), 0U);
  drive.next({.count = 2, .number = 5});
  drive.next();
  ASSERT_EQ(drive.next(settled_report(0.9F, kFoundHash)).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kOneSweep | kWithIterations);
  drive.settle(settled_report(0.9F, kFoundHash));
  ASSERT_EQ(drive.order.operation, Operation::kSeek);
  EXPECT_EQ(drive.order.flags, kRemember);
}

/// All want to go back at once. With more than can be tried nobody knows what the others lead to.
TEST(Conductor, tries_every_facet_that_may_differ_or_is_not_safe) {
  for (const std::uint32_t count : {17U, 250U, 251U}) {
    Drive drive = seeking_drive(0.9F);
    Report last{.count = count, .number = 1};
    std::uint32_t tried = 0;
    while (drive.next(last).operation == Operation::kSeek && drive.order.key() != 0) {
      ASSERT_EQ(drive.order.key(), ++tried);
      drive.next({.count = count, .number = tried < count ? tried + 1 : 0});
      drive.next();
      last = settled_report(0.9F, kFoundHash, 1);
    }
    EXPECT_EQ(tried, count == 251 ? 250 : count);
    return_to_found(drive, 0.9F);
    drive.expect_finished(count == 251 ? Verdict::kUndecided : Verdict::kSafe,
                          count == 251 ? Reason::kAmbiguousFeet : Reason::kHolds);
  }
}

// ---- All states of few feet.

using States = std::array<int, 3>;

/// Three facets as they answer kSeek, and in which states the robot stands: in all those that hold
/// one of some pairs, or more.
struct ThreeFeet {
  static constexpr int kCodeCount = mechanics::ContactState::kCodeCount;
  static constexpr std::array<std::uint32_t, 3> kKeys = {0x30, 0x2010, 0x89abcde0};

  explicit ThreeFeet(std::uint64_t seed) : rng(seed) {
    for (std::size_t pair = 0; pair < 3; ++pair) {
      for (int code = 0; code < kCodeCount * kCodeCount; ++code) {
        const bool presses = code / kCodeCount > 0 && code % kCodeCount > 0;
        if (presses && rng.below(3) > 0) {
          held.insert({pair, code});
        }
      }
    }
  }

  bool stands(const States& states) const {
    bool is_any = false;
    for (std::size_t i = 0; i < 3; ++i) {
      is_any = is_any || held.contains({i, kCodeCount * states[i] + states[(i + 1) % 3]});
    }
    return is_any;
  }

  Report answer(const Order& seek) {
    Report report{.count = 3};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t given = seek.key() & ~kStateBits;
      const int code = kKeys[i] == given ? static_cast<int>(seek.key() & kStateBits) : 0;
      now[i] = kKeys[i] <= given ? code : now[i];
      report.number = kKeys[i] > given && report.number == 0 ? kKeys[i] : report.number;
    }
    return report;
  }

  base::Rng rng;
  std::set<std::pair<std::size_t, int>> held;
  States now{};
};

Report states_report(float error, std::uint16_t changed, std::uint32_t hash) {
  return {.extent = changed, .number = hash, .reals = {error, 0.5F}};
}

/// Away from a level floor, whose states go round in circles.
Drive circling_drive() {
  Drive drive(Method::kElimination);
  drive.to_mass();
  drive.next({.flags = kUneven, .extent = 5, .count = kCensus, .number = kCensus});
  if (drive.order.operation == Operation::kAngles) {
    Report stands;
    stands.feet.range = mechanics::SafeRange::kFull;
    drive.next(stands);
  }
  for (const std::uint32_t hash : {1U, 2U, 1U}) {
    drive.to_judgement();
    drive.next(states_report(1e-3F, 0, hash));  // Accurate enough to tell them.
    drive.next(states_report(1e-9F, 1, hash));
  }
  return drive;
}

/// Goes through states until the unilateral law begins; `solve` answers what is solved for.
template <class Solve>
std::vector<States> go_through(ThreeFeet& feet, Drive& drive, Solve&& solve) {
  EXPECT_EQ(drive.order.flags, kOneFoot);
  drive.next({.count = 3 * (ThreeFeet::kCodeCount - 1), .number = 7});
  std::vector<States> solved;
  while (drive.order.operation != Operation::kBegin && solved.size() <= 1000) {
    if (drive.order.operation == Operation::kSeek) {
      EXPECT_EQ(drive.order.flags, kEachState);
      drive.next(feet.answer(drive.order));
    } else if (drive.order.operation == Operation::kCorners) {
      Report report;
      report.corners.stable = feet.stands(feet.now);
      drive.next(report);
    } else {
      drive.to_judgement();
      solved.push_back(feet.now);
      drive.next(solve(solved));
    }
  }
  EXPECT_EQ(drive.order.flags & kUnilateralLaw, kUnilateralLaw);
  return solved;
}

void expect_end(Drive& drive, Verdict verdict, Reason reason) {
  drive.settle(states_report(1e-9F, 0, 3));
  Report stands;
  stands.corners.stable = true;
  ASSERT_EQ(drive.order.operation, Operation::kCorners);
  drive.next(stands);
  drive.next({});
  drive.next({.number = kCensus, .reals = {0.5F}});
  drive.expect_finished(verdict, reason);
}

TEST(Conductor, solves_for_each_state_of_three_feet_in_which_the_robot_does_not_stand) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    ThreeFeet feet(seed);
    std::set<States> falling;
    for (int code = 0; code < 1000; ++code) {
      const States states = {code % 10, code / 10 % 10, code / 100};
      if (!feet.stands(states)) {
        falling.insert(states);
      }
    }
    Drive drive = circling_drive();
    const std::vector<States> solved =
        go_through(feet, drive, [](const auto&) { return states_report(1e-9F, 1, 4); });
    EXPECT_EQ(std::set<States>(solved.begin(), solved.end()), falling);
    EXPECT_EQ(solved.size(), falling.size());
    expect_end(drive, Verdict::kSafe, Reason::kHolds);
  }
}

/// One that the law prescribes for what it leads to falls; one that does not converge may be that,
/// but is tried twice.
TEST(Conductor, is_not_safe_where_one_of_all_states_falls_or_may) {
  for (const std::size_t lost_count : {0U, 1U, 2U}) {
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      ThreeFeet feet(seed);
      Drive drive = circling_drive();
      const std::size_t first = 1 + feet.rng.below(20);
      const auto solved = go_through(feet, drive, [&](const std::vector<States>& so_far) {
        const std::size_t count = so_far.size();
        const bool is_lost = count >= first && count < first + lost_count;
        const bool falls = lost_count == 0 && count == first;
        return states_report(is_lost ? kNan : 1e-9F, falls ? 0 : 1, 4);
      });
      const bool is_safe = lost_count == 1;
      EXPECT_EQ(solved.size() == std::max(first, first + lost_count - 1), !is_safe);
      expect_end(drive, is_safe ? Verdict::kSafe : Verdict::kUndecided,
                 is_safe ? Reason::kHolds : Reason::kAmbiguousFeet);
    }
  }
}

/// Newton's method by the polynomial is the last one that can try.
TEST(Conductor, is_not_safe_where_no_method_brings_a_trial_to_an_end) {
  for (const bool converges : {false, true}) {
    Drive drive = one_sweep_drive(true);
    drive.settle(settled_report(0.9F, kFoundHash));
    ASSERT_EQ(drive.order.operation, Operation::kSeek);
    ASSERT_EQ(drive.next({.count = 1, .number = 5}).operation, Operation::kSeek);
    drive.next({.count = 1});
    drive.settle(converges ? settled_report(0.9F, kFoundHash + 1) : Drive::judgement(kNan, 0.9F));
    ASSERT_EQ(drive.order.operation, Operation::kSeek);
    EXPECT_EQ(drive.order.key(), 0U);
    drive.next({.count = 1, .number = 5});
    drive.settle(settled_report(0.9F, kFoundHash));
    ASSERT_EQ(drive.order.operation, Operation::kLoads);
    drive.next({.number = kCensus, .reals = {0.9F}});
    drive.expect_finished(converges ? Verdict::kSafe : Verdict::kUndecided,
                          converges ? Reason::kHolds : Reason::kAmbiguousFeet);
  }
}

/// Clusters cannot try: what may break by another solution is not safe.
TEST(Conductor, is_not_safe_where_another_solution_may_break_and_none_can_be_sought) {
  for (const bool may_differ : {false, true}) {
    for (const float ratio : {0.7F, 0.9F, 1.1F}) {
      Drive drive = deep_drive(200);
      drive.next({.count = 100, .number = 49});
      Report found = settled_report(ratio, kFoundHash);
      found.flags = may_differ ? found.flags : std::uint8_t{0};
      ASSERT_EQ(drive.next(found).operation, Operation::kLoads);
      drive.next({.number = kCensus, .reals = {ratio}});
      const bool is_doubted = may_differ && ratio == 0.9F;
      drive.expect_finished(is_doubted  ? Verdict::kUndecided
                            : ratio > 1 ? Verdict::kOverload
                                        : Verdict::kSafe,
                            is_doubted  ? Reason::kAmbiguousFeet
                            : ratio > 1 ? Reason::kBreaks
                                        : Reason::kHolds);
    }
  }
}

TEST(Conductor, what_is_not_found_again_is_found_from_rest) {
  Drive drive = seeking_drive(0.9F);
  drive.next({.count = 1, .number = 5});
  drive.next({.count = 1});
  drive.next();
  drive.next(settled_report(1.1F, kFoundHash + 1));
  drive.next({.count = 1, .number = 5});
  drive.next();
  ASSERT_EQ(drive.next(iteration_report(kNan)).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags & kUnilateralLaw, 0);
  drive.next();
  drive.next();
  ASSERT_EQ(drive.next(settled_report(0.9F, kFoundHash)).operation, Operation::kLoads);
  drive.next({.number = kCensus, .reals = {0.9F}});
  drive.expect_finished(Verdict::kUndecided, Reason::kAmbiguousFeet);
}

/// States that are told at solutions that are not accurate may lead to where Newton's method would
/// not come.
TEST(Conductor, leaves_a_polynomial_that_changes_states_again_and_again) {
  Drive drive = one_sweep_drive(true);
  drive.next();
  std::uint32_t hash = 0;
  while (drive.order.operation == Operation::kIterate && hash < 100) {
    EXPECT_EQ(drive.order.flags & kStandIn, 0);
    Report report = iteration_report(100, {0, 1, 0}, 1);
    report.number = ++hash;  // States that have not been seen.
    drive.next(report);
  }
  EXPECT_EQ(hash, 41U);
  ASSERT_EQ(drive.order.operation, Operation::kBegin);
  drive.next();
  EXPECT_EQ(drive.order.operation, Operation::kIterate);
  EXPECT_NE(drive.order.flags & kStandIn, 0);
}

TEST(Conductor, gives_clusters_up_that_bring_no_progress) {
  Drive drive = deep_drive(200);
  drive.next({.count = 100});
  int iterations = 0;
  while (drive.order.operation == Operation::kIterate && iterations < 100) {
    EXPECT_NE(drive.order.flags & kWithClusters, 0);
    drive.next(iteration_report(100, {0, 1, 0}));
    ++iterations;
  }
  EXPECT_LT(iterations, 20);
  ASSERT_EQ(drive.order.operation, Operation::kBegin);
  drive.next();
  EXPECT_EQ(drive.order.flags, kRestart);
}

TEST(Conductor, leaves_a_one_sweep_method_that_brings_no_number) {
  Drive drive = one_sweep_drive(false);
  drive.next();
  drive.next();
  ASSERT_EQ(drive.next(iteration_report(kNan)).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kOneSweep | kWithIterations);
  EXPECT_EQ(drive.conductor.effort().method, Method::kPolynomial);
  drive.next();
  ASSERT_EQ(drive.next(iteration_report(kNan)).operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kUnilateralLaw | kOneSweep | kWithIterations);
}

Report standing_report() {
  Report report;
  report.feet.range = mechanics::SafeRange::kFull;
  report.corners.stable = true;
  return report;
}

/// A robot with many loops that knows a verdict; a module comes. Up to the order that resumes.
Drive resumed_drive(Deflation& deflation, std::uint32_t iterations, bool is_fixed = true) {
  Drive drive(Method::kElimination);
  drive.setup.keeps_answers = true;
  drive.order = drive.conductor.begin(drive.setup, kRoot, kCensus, 4, {.deflation = &deflation});
  drive.to_mass();
  const std::uint8_t flags = is_fixed ? kAnyFixed | kManyLoops : kManyLoops;
  drive.next({.flags = flags, .extent = 5, .count = kCensus, .number = kCensus});
  if (!is_fixed) {
    drive.next(standing_report());
  }
  EXPECT_EQ(drive.next().operation, Operation::kIterate);
  drive.next(iteration_report(1e-6F));
  if (!is_fixed) {
    EXPECT_EQ(drive.order.operation, Operation::kCorners);
    drive.next(standing_report());
  }
  EXPECT_EQ(drive.order.operation, Operation::kLoads);
  EXPECT_EQ(drive.next({.number = kCensus, .reals = {0.5F}}).operation, Operation::kVerdict);
  deflation.end(iterations, true);
  deflation.end(iterations, true);
  drive.order = drive.conductor.renew(
      drive.setup, {.flags = kIsGrown, .hops = 4, .cell = {2, 2, 3}}, Planned(), nullptr);
  EXPECT_EQ(drive.order.operation, Operation::kRenew);
  drive.order = drive.conductor.after_renew(
      drive.setup, {.flags = flags, .extent = 5, .count = kCensus + 1, .number = kCensus + 1},
      Planned(), nullptr);
  return drive;
}

/// W'r and E of two changes, of which the first one is kept.
const Report kDeflatedReport = {.along = {4, 8}, .energies = {2, 0, 2}};

/// The last change's place is told in any case, and energies are asked for where they pay.
TEST(Conductor, resumes_along_what_is_kept_after_slow_solves) {
  Deflation quick;
  EXPECT_EQ(resumed_drive(quick, 6).order.operation, Operation::kResume);
  Deflation slow;
  Drive drive = resumed_drive(slow, 9);
  ASSERT_EQ(drive.order.operation, Operation::kResumeDeflated);
  EXPECT_EQ(drive.order.index, 0);
  ASSERT_EQ(drive.next(kDeflatedReport).operation, Operation::kIterateDeflated);
  EXPECT_EQ(drive.order.flags, kRestart);
  EXPECT_EQ(drive.order.along, (std::array<float, wire::kKeptMax>{2}));
}

/// h = 2 along the one change: (r, p) = -6 + 2 x 1, (q, p) = 22 + 2 x (4 - 1).
TEST(Conductor, completes_products_along_what_is_kept) {
  Deflation deflation;
  Drive drive = resumed_drive(deflation, 9);
  drive.next(kDeflatedReport);
  Report report = iteration_report(100, {-6, 22, 0});
  report.along = {1};
  ASSERT_EQ(drive.next(report).operation, Operation::kIterateDeflated);
  EXPECT_EQ(drive.order.flags, 0);
  EXPECT_FLOAT_EQ(drive.order.reals[1], -4.F / 28);
}

/// What is probably the last iteration brings corners and the worst connection, so that nothing is
/// left to ask; also where nothing is kept that it could go along.
TEST(Conductor, the_last_iteration_closes_the_equilibrium) {
  for (const std::uint32_t iterations : {6U, 9U}) {
    Deflation deflation;
    Drive drive = resumed_drive(deflation, iterations, false);
    ASSERT_EQ(drive.next(standing_report()).operation,
              iterations > 6 ? Operation::kIterateDeflated : Operation::kIterate);
    ASSERT_NE(drive.next(iteration_report(1, {-4, 28, 0})).operation, Operation::kIterateLast);
    ASSERT_EQ(drive.next(iteration_report(1e-2F, {-4, 28, 0})).operation, Operation::kIterateLast);
    Report last = standing_report();
    last.reals = {1e-6F, 0.75F};
    last.cell = {4, 5, 6};
    last.direction = base::Direction::kMinusY;
    drive.next(last);
    drive.expect_finished(Verdict::kSafe, Reason::kHolds);
    EXPECT_EQ(drive.order.answer.load_ratio_max, 0.75F);
    EXPECT_EQ(drive.order.answer.worst_cell, (base::Cell{4, 5, 6}));
    EXPECT_EQ(drive.order.answer.worst_direction, base::Direction::kMinusY);
  }
}

}  // namespace
}  // namespace holdfast::agent
