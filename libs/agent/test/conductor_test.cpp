// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The root's decisions, order by order, from reports made by hand: no robot and no mechanics. What
// is expected is the way that conductor.hpp describes.
#include "drive.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using wire::Operation;

Report loads(float ratio, std::uint32_t module_count = kCensus) {
  return {.number = module_count,
          .reals = {ratio},
          .cell = {4, 5, 6},
          .direction = base::Direction::kMinusY};
}

// ---- Planned modules, mass, rigid body.

TEST(Conductor, learns_planned_cells_one_by_one) {
  Drive drive;
  EXPECT_EQ(drive.order.operation, Operation::kPlan);
  EXPECT_EQ(drive.order.index, 0xff);
  drive.next({.flags = kFound, .cell = {7, 0, 0}});
  EXPECT_EQ(drive.order.operation, Operation::kPlan);
  EXPECT_EQ(drive.order.index, 0);
  EXPECT_EQ(drive.order.cell, (base::Cell{7, 0, 0}));
  drive.next({.flags = kFound, .mask = 2, .cell = {8, 0, 0}});
  EXPECT_EQ(drive.order.index, 1);
  EXPECT_EQ(drive.order.cell, (base::Cell{8, 0, 0}));
  drive.next({.mask = 0x20});
  EXPECT_EQ(drive.order.operation, Operation::kHosts);
  EXPECT_EQ(drive.order.masks, (PlannedMasks{2, 0x20}));
  drive.next({.mask = 3});
  EXPECT_EQ(drive.order.operation, Operation::kMass);
  EXPECT_EQ(drive.order.cell, kRoot);
  drive.next({.extent = 5, .count = kCensus + 2, .number = kCensus + 2, .moment = {-3, 4, 9}});
  EXPECT_EQ(drive.order.operation, Operation::kAngles);
  EXPECT_EQ(drive.order.mass, static_cast<std::int32_t>(kCensus) + 2);
  EXPECT_EQ(drive.order.moment, (std::array<std::int32_t, 2>{-3, 4}));
  EXPECT_FALSE(drive.conductor.is_finished());
}

TEST(Conductor, one_planned_module_too_many_is_undecided) {
  Drive drive;
  for (int i = 0; i < kPlannedMax; ++i) {
    drive.next({.flags = kFound, .cell = {i, 0, 0}});
    ASSERT_EQ(drive.order.operation, Operation::kPlan);
    ASSERT_EQ(drive.order.index, i);
  }
  Drive enough = drive;
  EXPECT_EQ(enough.next().operation, Operation::kHosts);
  // The one too many may be one that has ended.
  drive.next({.flags = kFound, .cell = {kPlannedMax, 0, 0}});
  ASSERT_EQ(drive.order.operation, Operation::kPlan);
  ASSERT_EQ(drive.order.index, kPlannedMax);
  Drive ended = drive;
  ended.next({.flags = kEnded | kFulfilled, .cell = {kPlannedMax, 0, 0}});
  EXPECT_EQ(ended.order.operation, Operation::kForget);
  drive.next({.flags = kFound, .cell = {kPlannedMax + 1, 0, 0}});
  drive.expect_finished(Verdict::kUndecided, Reason::kPlannedTooMany);
}

/// Not before all plans are known: two of them might have ended.
TEST(Conductor, a_module_that_was_told_too_many_makes_it_undecided) {
  for (const bool is_disputed : {false, true}) {
    const std::uint8_t flag = is_disputed ? kDisputed : kTooManyAnnounced;
    Drive drive;
    drive.next({.flags = static_cast<std::uint8_t>(kFound | flag)});
    ASSERT_EQ(drive.order.operation, Operation::kPlan);
    drive.next({.flags = flag});
    drive.expect_finished(Verdict::kUndecided,
                          is_disputed ? Reason::kPlanDisputed : Reason::kPlannedTooMany);
  }
}

/// Nothing of a planned module that is there already may stay: the next one is number 0 again.
TEST(Conductor, has_a_plan_that_has_ended_forgotten_and_begins_anew) {
  for (const bool is_fulfilled : {false, true}) {
    Drive drive;
    drive.next({.flags = kFound, .cell = {1, 0, 0}});
    drive.next({.flags = kFound, .mask = 3, .cell = {2, 0, 0}});
    const std::uint8_t flags = is_fulfilled ? kEnded | kFulfilled : kEnded;
    drive.next({.flags = flags, .mask = 1, .cell = {2, 0, 0}});
    EXPECT_EQ(drive.order.operation, Operation::kForget);
    EXPECT_EQ(drive.order.cell, (base::Cell{2, 0, 0}));
    EXPECT_EQ(drive.order.flags, is_fulfilled ? kIsFulfilled : 0);
    drive.next({.flags = kFound, .cell = {1, 0, 0}});
    EXPECT_EQ(drive.order.operation, Operation::kPlan);
    EXPECT_EQ(drive.order.index, 0);
    drive.next({.mask = 3});
    EXPECT_EQ(drive.order.operation, Operation::kHosts);
    EXPECT_EQ(drive.order.masks, (PlannedMasks{3}));
  }
}

/// A module that goes on inventing plans that have ended cannot keep the robot busy for ever.
TEST(Conductor, has_no_more_than_so_many_plans_forgotten_in_a_round) {
  Drive drive;
  int forgotten_count = 0;
  while (drive.next({.flags = kEnded, .cell = {forgotten_count, 0, 0}}).operation ==
         Operation::kForget) {
    ASSERT_LT(++forgotten_count, 1000);
  }
  EXPECT_EQ(forgotten_count, 200);
  drive.expect_finished(Verdict::kUndecided, Reason::kNotConverged);
}

TEST(Conductor, a_planned_module_without_a_host_is_undecided) {
  Drive drive;
  drive.next({.flags = kFound});
  drive.next({.flags = kFound, .mask = 1, .cell = {1, 0, 0}});
  drive.next({.mask = 0});
  drive.next({.mask = kAnyRemote | 1});  // The second one is missing.
  drive.expect_finished(Verdict::kUndecided, Reason::kPlannedDetached);
}

TEST(Conductor, a_missing_module_is_never_safe) {
  for (const std::uint32_t count : {0U, kCensus - 1, kCensus + 1}) {
    Drive drive;
    drive.to_mass();
    drive.next({.flags = kAnyFixed, .count = count});
    drive.expect_finished(Verdict::kUndecided, Reason::kNeighbourSilent);
  }
  Drive drive;
  drive.to_equilibrium();
  drive.to_judgement();
  ASSERT_EQ(drive.next(Drive::judgement(0, 0.5F)).operation, Operation::kLoads);
  drive.next(loads(0.5F, kCensus - 1));
  drive.expect_finished(Verdict::kUndecided, Reason::kNeighbourSilent);
}

TEST(Conductor, toppling_is_unstable_and_needs_no_equilibrium) {
  for (const auto range : {mechanics::SafeRange::kEmpty, mechanics::SafeRange::kArc}) {
    Drive drive;
    drive.to_mass();
    ASSERT_EQ(drive.next({.extent = 5, .count = kCensus, .number = kCensus}).operation,
              Operation::kAngles);
    Report topples;
    topples.feet.range = range;
    drive.next(topples);
    drive.expect_finished(Verdict::kUnstable, Reason::kTopples);
    EXPECT_EQ(drive.conductor.effort().solves, 0U);
  }
}

TEST(Conductor, a_fixed_robot_skips_the_angles_and_the_corners) {
  Drive drive;
  drive.to_equilibrium(true);
  EXPECT_EQ(drive.order.flags, kOneSweep);
  EXPECT_EQ(drive.order.reals[0], 1e-4F);
  EXPECT_EQ(drive.order.reals[1], 240.0F);  // Extent 5 and one more, times the pitch.
  drive.to_judgement();
  EXPECT_EQ(drive.next(Drive::judgement(0, 0.5F)).operation, Operation::kLoads);
}

/// 65,534 hops, 2^24 units of mass and first moments in x and y below 2^31 are exact (feet.hpp);
/// what is more says so. A row of 131,069 has its ends 65,534 from its middle.
TEST(Conductor, a_robot_too_large_to_be_counted_is_undecided) {
  constexpr std::uint32_t kRow = 131'069;
  Drive longest(Method::kElimination, 65'534, kRow);
  longest.to_mass();
  Drive further = longest;
  Drive overflow = longest;
  Drive fine = longest;
  EXPECT_EQ(longest.next({.extent = 65'534, .count = kRow, .number = kRow}).operation,
            Operation::kAngles);
  further.next({.extent = 65'535, .count = kRow, .number = kRow});
  further.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
  overflow.next({.flags = kSumOverflow, .extent = 5, .count = kRow, .number = kRow});
  overflow.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
  Drive lopsided = fine;
  lopsided.next(
      {.extent = 5, .count = kRow, .number = kRow, .moment = {0, -(std::int64_t{1} << 31)}});
  lopsided.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
  Drive high = fine;
  const Report tower = {.extent = 5, .count = kRow, .number = kRow, .moment = {0, 0, 1LL << 40}};
  EXPECT_EQ(high.next(tower).operation, Operation::kAngles);
  fine.setup.facet_denominator = kFacetPartMax + 1;
  fine.next({.extent = 5, .count = kRow, .number = kRow});
  fine.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
  Drive many(Method::kElimination, 4, (1U << 24U) + 1);
  many.to_mass();
  many.next({.extent = 5, .count = (1U << 24U) + 1, .number = (1U << 24U) + 1});
  many.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
  Drive deep(Method::kElimination, 0xffff);
  deep.to_mass();
  deep.next({.flags = kAnyFixed, .extent = 5, .count = kCensus, .number = kCensus});
  deep.expect_finished(Verdict::kUndecided, Reason::kTooLarge);
}

// ---- Verdicts.

/// Begins from a settled equilibrium of a fixed robot.
void expect_verdict(float ratio, float error, Verdict verdict, Reason reason) {
  Drive drive;
  drive.to_equilibrium();
  drive.to_judgement();
  ASSERT_EQ(drive.next(Drive::judgement(error, ratio)).operation, Operation::kLoads);
  drive.next(loads(ratio));
  drive.expect_finished(verdict, reason);
  EXPECT_EQ(drive.order.answer.load_ratio_max, ratio);
  EXPECT_EQ(drive.order.answer.worst_cell, (base::Cell{4, 5, 6}));
  EXPECT_EQ(drive.order.answer.worst_direction, base::Direction::kMinusY);
}

TEST(Conductor, the_largest_ratio_decides) {
  expect_verdict(0.5F, 1e-4F, Verdict::kSafe, Reason::kHolds);
  expect_verdict(-3, 1e-4F, Verdict::kSafe, Reason::kHolds);
  expect_verdict(0.999F, 4e-5F, Verdict::kSafe, Reason::kHolds);
  expect_verdict(1.5F, 1e-4F, Verdict::kOverload, Reason::kBreaks);
  expect_verdict(1000, 1e-4F, Verdict::kOverload, Reason::kBreaks);
}

TEST(Conductor, a_ratio_of_one_is_too_close_to_tell) {
  expect_verdict(1, 1e-9F, Verdict::kUndecided, Reason::kTooClose);
}

TEST(Conductor, a_ratio_near_one_asks_for_a_better_solution) {
  Drive drive;
  drive.to_equilibrium();
  drive.to_judgement();
  const float ratio = 1.0003F;
  EXPECT_EQ(drive.next(Drive::judgement(2e-5F, ratio)).operation, Operation::kTreeIterate);
  EXPECT_EQ(drive.next(Drive::judgement(1e-5F, ratio)).operation, Operation::kLoads);
  drive.next(loads(ratio));
  drive.expect_finished(Verdict::kOverload, Reason::kBreaks);
}

/// Runs until a verdict: every judgement brings the same report, whatever else is asked nothing.
void run_with(Drive& drive, const Report& judgement) {
  for (int i = 0; i < 1000 && !drive.conductor.is_finished(); ++i) {
    drive.next(drive.is_iterating() ? judgement : Report{});
  }
}

TEST(Conductor, a_ratio_near_one_that_gets_no_better_is_too_close) {
  Drive drive;
  drive.to_equilibrium();
  run_with(drive, Drive::judgement(2e-4F, 1.0003F));
  drive.expect_finished(Verdict::kUndecided, Reason::kTooClose);
}

TEST(Conductor, loads_that_are_not_numbers_decide_nothing) {
  Drive drive;
  drive.to_equilibrium();
  drive.to_judgement();
  ASSERT_EQ(drive.next(Drive::judgement(1e-4F, 0.5F)).operation, Operation::kLoads);
  drive.next(loads(kNan));
  drive.expect_finished(Verdict::kUndecided, Reason::kNotConverged);
}

/// A single module has no connection; it reports the least ratio there is.
TEST(Conductor, a_robot_without_connections_is_safe) {
  Drive drive;
  drive.to_equilibrium();
  drive.to_judgement();
  ASSERT_EQ(drive.next(Drive::judgement(0, kNoLoadRatio)).operation, Operation::kLoads);
  drive.next(loads(kNoLoadRatio));
  drive.expect_finished(Verdict::kSafe, Reason::kHolds);
}

// ---- Methods.

/// The laws and methods that are tried until the verdict: 'b' begins the regularised law, 'B' the
/// unilateral one, by elimination 'e', the polynomial 'p' or fronts 'f'.
std::string ways_of(Drive& drive, const Report& judgement) {
  std::string ways;
  for (int i = 0; i < 1000 && !drive.conductor.is_finished(); ++i) {
    if (const Order& order = drive.order; order.operation == Operation::kBegin) {
      ways += (order.flags & kUnilateralLaw) != 0 ? 'B' : 'b';
      ways += (order.flags & kWithFronts) != 0       ? 'f'
              : (order.flags & kWithIterations) != 0 ? 'p'
                                                     : 'e';
    }
    drive.next(drive.is_iterating() ? judgement : Report{});
  }
  return ways;
}

/// The polynomial twice: as it is, and as Newton's method.
TEST(Conductor, what_is_not_a_number_makes_it_try_every_method_and_law_once) {
  for (const auto& [method, ways] : {std::pair{Method::kFronts, "bebfbpBp"},
                                     {Method::kElimination, "bebpBp"},
                                     {Method::kPolynomial, "bpbpBp"}}) {
    Drive drive(method);
    drive.to_equilibrium();
    EXPECT_EQ(ways_of(drive, Drive::judgement(kNan, 0)), ways);
    drive.expect_finished(Verdict::kUndecided, Reason::kNotConverged);
    EXPECT_EQ(drive.conductor.effort().method, Method::kPolynomial);
    EXPECT_TRUE(drive.conductor.effort().is_unilateral);
  }
}

/// Nobody has the weight of a condensed module before the first exchange, so nothing is begun.
TEST(Conductor, with_a_remote_planned_module_the_first_iteration_only_looks) {
  Drive drive(Method::kElimination);
  drive.to_equilibrium_with_a_remote_planned_module();
  EXPECT_EQ(drive.order.flags, kOneSweep | kWithIterations);
  EXPECT_EQ(drive.order.count, 0);
  ASSERT_EQ(drive.next().operation, Operation::kIterate);
  EXPECT_EQ(drive.order.flags, kRestart | kKeepStates);
  ASSERT_EQ(drive.next({.reals = {5, 0.5F}}).operation, Operation::kIterate);
  EXPECT_EQ(drive.order.flags, kRestart) << "it has moved nothing, so there is nothing to minimise";
}

TEST(Conductor, iterations_stop_at_their_limit) {
  for (const Method method : {Method::kElimination, Method::kPolynomial}) {
    Drive drive(method);
    drive.setup.iteration_count_max = 50;
    drive.to_equilibrium();
    float error = 1e6F;
    for (int i = 0; i < 1000 && !drive.conductor.is_finished(); ++i) {
      error *= 0.6F;  // There is always some progress.
      drive.next(Drive::judgement(1 + error, 1));
    }
    drive.expect_finished(Verdict::kUndecided, Reason::kNotConverged);
    EXPECT_LE(drive.conductor.effort().iterations, 53U);
  }
}

// ---- Contact.

/// Facets want another state: it is adopted and solved for, unless it was there before at a
/// solution as good.
TEST(Conductor, follows_contact_states_until_they_cycle) {
  Drive drive(Method::kElimination);
  drive.to_equilibrium(false);
  drive.to_judgement();
  Report change = Drive::judgement(1e-5F, 0.5F);
  change.extent = 2;
  for (const std::uint32_t states : {11U, 12U, 13U, 12U}) {
    ASSERT_EQ(drive.next(Drive::judgement(0.01F, 0.5F)).operation, Operation::kTreeIterate);
    change.number = states;
    drive.next(change);
    if (states != 12 || drive.order.operation == Operation::kFactor) {
      ASSERT_EQ(drive.order.operation, Operation::kFactor);
      drive.to_judgement();
    }
  }
  EXPECT_EQ(drive.conductor.effort().contact_iterations, 4U);
  EXPECT_EQ(drive.order.operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kUnilateralLaw | kOneSweep | kWithIterations);
}

TEST(Conductor, corners_that_contradict_the_rigid_body_call_for_the_unilateral_law) {
  Drive drive;
  drive.to_equilibrium(false);
  drive.to_judgement();
  ASSERT_EQ(drive.next(Drive::judgement(1e-5F, 0.5F)).operation, Operation::kCorners);
  Drive agrees = drive;
  Report stable;
  stable.corners = mechanics::fixed_support();
  EXPECT_EQ(agrees.next(stable).operation, Operation::kLoads);
  drive.next();
  EXPECT_EQ(drive.order.operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, kUnilateralLaw | kOneSweep | kWithFronts);
}

/// Up to the loads under the unilateral law, with `open_held` feet that are off the ground and
/// held.
Drive unilateral_loads(float ratio, std::uint32_t open_held) {
  Drive drive;
  drive.to_equilibrium(false);
  drive.to_judgement();
  drive.next(Drive::judgement(1e-5F, 0.5F));
  drive.next();  // The corners disagree.
  drive.to_judgement();
  drive.next(Drive::judgement(1e-5F, ratio));
  drive.next();  // Corners no longer matter.
  EXPECT_EQ(drive.order.operation, Operation::kHold);
  EXPECT_EQ(drive.order.flags, kReleaseOpen);
  drive.next({.number = open_held});
  EXPECT_EQ(drive.order.operation, Operation::kLoads);
  drive.next(loads(ratio));
  return drive;
}

TEST(Conductor, without_ambiguous_feet_the_unilateral_law_decides) {
  unilateral_loads(0.5F, 0).expect_finished(Verdict::kSafe, Reason::kHolds);
  unilateral_loads(1.5F, 0).expect_finished(Verdict::kOverload, Reason::kBreaks);
}

TEST(Conductor, ambiguous_feet_are_tried_held_and_free) {
  for (const auto& [held, freed] : {std::pair{0.5F, 0.6F}, {0.5F, 1.6F}, {1.5F, 1.6F}, {1.5F, 0}}) {
    Drive drive = unilateral_loads(held, 1);
    ASSERT_EQ(drive.order.operation, Operation::kHold);
    EXPECT_EQ(drive.order.flags, kFreeOpen);
    drive.next({.count = 1});
    drive.to_judgement();
    drive.next(Drive::judgement(1e-5F, freed));
    const bool agrees = (held >= 1) == (freed >= 1);
    const bool breaks = held >= 1;
    drive.expect_finished(!agrees  ? Verdict::kUndecided
                          : breaks ? Verdict::kOverload
                                   : Verdict::kSafe,
                          !agrees  ? Reason::kAmbiguousFeet
                          : breaks ? Reason::kBreaks
                                   : Reason::kHolds);
  }
}

TEST(Conductor, released_feet_are_solved_for_again) {
  Drive drive;
  drive.to_equilibrium(false);
  drive.to_judgement();
  drive.next(Drive::judgement(1e-5F, 0.5F));
  drive.next();
  drive.to_judgement();
  drive.next(Drive::judgement(1e-5F, 0.5F));
  ASSERT_EQ(drive.next().operation, Operation::kHold);
  EXPECT_EQ(drive.next({.count = 2}).operation, Operation::kTreeIterate);
}

}  // namespace
}  // namespace holdfast::agent
