// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Orders and reports survive the wire, and sums of reports depend neither on the order in which
// they come nor on the tree: merging is commutative and associative wherever the numbers are exact.
// The bytes themselves are tested in wire_test.cpp. Comparisons are of all that goes on the wire,
// as bytes; a report that has been decoded holds nothing else.
#include "holdfast/agent/messages/order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "holdfast/agent/cells/step_word.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "holdfast/base/rng.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using namespace holdfast::agent::test;
using wire::Operation;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A small multiple of 1/8: sums of some hundred are exact.
float exact_real(base::Rng& rng) {
  return static_cast<float>(static_cast<int>(rng.below(2001)) - 1000) / 8;
}

base::Cell random_cell(base::Rng& rng) {
  const auto coordinate = [&] {
    return static_cast<std::int32_t>(rng.below(2'000'001)) - 1'000'000;
  };
  return {coordinate(), coordinate(), coordinate()};
}

/// A module that moves, any way.
std::int32_t random_word(base::Rng& rng) {
  const auto direction = [&] {
    return static_cast<std::uint8_t>(rng.below(std::uint64_t{kFaceCountMax}));
  };
  return static_cast<std::int32_t>(bits_of({.kind = StepWord::Kind::kMove,
                                            .group = static_cast<std::uint8_t>(rng.below(4)),
                                            .face = direction(),
                                            .first = direction(),
                                            .second = direction()}));
}

Order random_order(Operation operation, base::Rng& rng) {
  Order order{.operation = operation};
  order.index = static_cast<std::uint8_t>(rng.next());
  order.flags = static_cast<std::uint8_t>(rng.next());
  order.count = static_cast<std::uint16_t>(rng.next());
  order.cell = random_cell(rng);
  for (FaceMask& mask : order.masks) {
    mask = static_cast<std::uint8_t>(rng.next());
  }
  order.mass = static_cast<std::int32_t>(rng.next());
  order.moment = {static_cast<std::int32_t>(rng.next()), static_cast<std::int32_t>(rng.next())};
  if (operation == Operation::kNext) {
    order.set_far_cell(random_cell(rng));
  }
  order.reals = {exact_real(rng), exact_real(rng), exact_real(rng)};
  for (float& real : order.along) {
    real = exact_real(rng);
  }
  order.answer = {.verdict = static_cast<Verdict>(rng.below(5)),
                  .reason = static_cast<Reason>(rng.below(12)),
                  .load_ratio_max = exact_real(rng),
                  .worst_cell = random_cell(rng),
                  .worst_direction = static_cast<base::Direction>(rng.below(6)),
                  .remarks = static_cast<std::uint8_t>(rng.below(8))};
  if (operation == Operation::kWord) {
    order.count = static_cast<std::uint16_t>(1 + rng.below(kWordCountMax));
    order.index = static_cast<std::uint8_t>(rng.below(order.count));
    order.mass = random_word(rng);
  } else if (operation == Operation::kStage) {
    order.index = static_cast<std::uint8_t>(rng.below(4));
    order.flags = static_cast<std::uint8_t>(rng.below(4));
    order.count = static_cast<std::uint16_t>(rng.below(kSceneMax));
  }
  return order;
}

const Setup& feet_setup() {
  static const auto setup = table_setup();
  return setup;
}

/// Three modules, their centre of mass at (1, -2) / 3.
FeetCheck feet_check() { return {feet_setup(), 3, {1, -2}}; }

/// Sums of a few stay exact and in range.
Report random_report(Operation operation, base::Rng& rng) {
  Report report;
  const bool is_learning = operation == Operation::kPlan || operation == Operation::kForget;
  report.flags = static_cast<std::uint8_t>(rng.below(is_learning ? 32 : 4));
  report.mask = static_cast<std::uint8_t>(rng.next());
  report.extent = static_cast<std::uint16_t>(rng.next());
  report.count = static_cast<std::uint32_t>(rng.next());
  report.number = static_cast<std::uint32_t>(rng.next());
  const auto sum = [&] { return static_cast<std::int32_t>(rng.below(1'000'001)) - 500'000; };
  report.moment = {sum(), sum(), sum()};
  for (float& real : report.reals) {
    real = exact_real(rng);
  }
  for (double& product : report.products) {
    product = static_cast<double>(exact_real(rng));
  }
  for (float& real : report.along) {
    real = exact_real(rng);
  }
  for (float& real : report.energies) {
    real = exact_real(rng);
  }
  if (operation == Operation::kWord) {
    report.mask = static_cast<std::uint8_t>(rng.below(4));
    report.number = static_cast<std::uint32_t>(random_word(rng));
  } else if (operation == Operation::kStage) {
    report.flags = static_cast<std::uint8_t>(rng.below(2));
  }
  const bool has_cell = !is_learning || (report.flags & (kFound | kEnded)) != 0;
  report.cell = has_cell ? random_cell(rng) : base::Cell{};
  if (operation == Operation::kShape) {
    report.set_far_cell(random_cell(rng));
  }
  report.direction = static_cast<base::Direction>(rng.below(6));
  report.remarks = static_cast<std::uint8_t>(rng.below(16));
  if (rng.below(4) != 0) {
    report.feet = feet_check().of_foot(sum(), sum());
  }
  const auto half_cells = [&] { return 2 * static_cast<std::int32_t>(rng.below(5)) - 5; };
  for (std::uint64_t i = 0; i < rng.below(3); ++i) {
    report.corners = mechanics::merge(report.corners,
                                      {.count = 1, .corners = {{half_cells(), half_cells(), 0}}});
  }
  return report;
}

std::string text_of(Operation operation, const Report& report) {
  return to_hex(encode(operation, report).bytes());
}

Report through_wire(Operation operation, const Report& report) {
  return decode_report(encode(operation, report).bytes());
}

Report merged(Operation operation, Report into, const Report& from) {
  if (operation == Operation::kAngles) {
    into.feet = feet_check().merge(into.feet, from.feet);
    return into;
  }
  if (operation == Operation::kResume || operation == Operation::kResumeDeflated) {
    into.feet = feet_check().merge(into.feet, from.feet);
  }
  merge(operation, into, from);
  return into;
}

TEST(Order, every_order_comes_back) {
  base::Rng rng(1);
  for (const OperationInfo& row : kOperations) {
    for (int round = 0; round < 100; ++round) {
      const auto message = encode(random_order(row.operation, rng));
      EXPECT_EQ(message.bytes().size(), std::size_t{row.order_bytes});
      const Order back = decode_order(message.bytes());
      EXPECT_EQ(back.operation, row.operation);
      EXPECT_EQ(to_hex(encode(back).bytes()), to_hex(message.bytes()));
    }
  }
}

TEST(Order, every_report_comes_back) {
  base::Rng rng(2);
  for (const OperationInfo& row : kOperations) {
    for (int round = 0; round < 100; ++round) {
      const auto message = encode(row.operation, random_report(row.operation, rng));
      EXPECT_EQ(message.bytes().size(), std::size_t{row.report_bytes});
      EXPECT_EQ(text_of(row.operation, decode_report(message.bytes())), to_hex(message.bytes()));
    }
  }
}

Order there_and_back(Operation operation, Order& sent, base::Rng& rng) {
  sent = random_order(operation, rng);
  return decode_order(encode(sent).bytes());
}

/// Field by field, for what bytes alone would not tell: that decoding puts them where they were.
TEST(Order, fields_come_back_where_they_were) {
  base::Rng rng(3);
  Order sent;
  Order back = there_and_back(Operation::kPlan, sent, rng);
  EXPECT_EQ(back.index, sent.index);
  EXPECT_EQ(back.cell, sent.cell);
  back = there_and_back(Operation::kForget, sent, rng);
  EXPECT_EQ(back.flags, sent.flags);
  EXPECT_EQ(back.cell, sent.cell);
  back = there_and_back(Operation::kHosts, sent, rng);
  EXPECT_EQ(back.masks, sent.masks);
  back = there_and_back(Operation::kAngles, sent, rng);
  EXPECT_EQ(back.mass, sent.mass);
  EXPECT_EQ(back.moment, sent.moment);
  back = there_and_back(Operation::kIterate, sent, rng);
  EXPECT_EQ(back.flags, sent.flags);
  EXPECT_EQ(back.count, sent.count);
  EXPECT_EQ(back.reals, sent.reals);
  back = there_and_back(Operation::kVerdict, sent, rng);
  EXPECT_EQ(back.answer.verdict, sent.answer.verdict);
  EXPECT_EQ(back.answer.reason, sent.answer.reason);
  EXPECT_EQ(back.answer.load_ratio_max, sent.answer.load_ratio_max);
  EXPECT_EQ(back.answer.worst_cell, sent.answer.worst_cell);
  EXPECT_EQ(back.answer.worst_direction, sent.answer.worst_direction);
  EXPECT_EQ(back.answer.remarks, sent.answer.remarks);
  const Report mass = random_report(Operation::kMass, rng);
  const Report mass_back = through_wire(Operation::kMass, mass);
  EXPECT_EQ(mass_back.count, mass.count);
  EXPECT_EQ(mass_back.moment, mass.moment);
  EXPECT_EQ(mass_back.extent, mass.extent);
  const Report iteration = random_report(Operation::kTreeIterate, rng);
  const Report iteration_back = through_wire(Operation::kTreeIterate, iteration);
  EXPECT_EQ(iteration_back.reals[1], iteration.reals[1]);
  EXPECT_EQ(iteration_back.number, iteration.number);
  EXPECT_EQ(iteration_back.extent, iteration.extent);
}

TEST(Order, fields_of_what_is_kept_come_back_where_they_were) {
  base::Rng rng(5);
  Order sent;
  Order back;
  for (const Operation operation : {Operation::kResume, Operation::kResumeDeflated}) {
    back = there_and_back(operation, sent, rng);
    EXPECT_EQ(back.flags, sent.flags);
    EXPECT_EQ(back.index, sent.index);
    EXPECT_EQ(back.count, sent.count);
    EXPECT_EQ(back.reals, (std::array<float, 3>{sent.reals[0], sent.reals[1], 0}));
    EXPECT_EQ(back.mass, sent.mass);
    EXPECT_EQ(back.moment, sent.moment);
    EXPECT_EQ(back.along, decltype(back.along){});
  }
  for (const Operation operation : {Operation::kIterateDeflated, Operation::kIterateLast}) {
    back = there_and_back(operation, sent, rng);
    EXPECT_EQ(back.flags, sent.flags);
    EXPECT_EQ(back.count, sent.count);
    EXPECT_EQ(back.reals, sent.reals);
    EXPECT_EQ(back.along, sent.along);
  }
  const Report resumed = random_report(Operation::kResumeDeflated, rng);
  const Report resumed_back = through_wire(Operation::kResumeDeflated, resumed);
  EXPECT_EQ(resumed_back.along, resumed.along);
  EXPECT_EQ(resumed_back.energies, resumed.energies);
  const Report last = random_report(Operation::kIterateLast, rng);
  const Report last_back = through_wire(Operation::kIterateLast, last);
  EXPECT_EQ(last_back.reals[1], last.reals[1]);
  EXPECT_EQ(last_back.number, last.number);
  EXPECT_EQ(last_back.products, last.products);
  EXPECT_EQ(last_back.along, last.along);
  EXPECT_EQ(last_back.energies, decltype(last.energies){});
  EXPECT_EQ(last_back.corners.count, last.corners.count);
  EXPECT_EQ(last_back.cell, last.cell);
  EXPECT_EQ(last_back.direction, last.direction);
  EXPECT_EQ(last_back.remarks, last.remarks);
}

/// Corner sets are left out of associativity: of many corners on a line any two may be kept.
TEST(Order, merging_is_commutative_and_associative) {
  base::Rng rng(4);
  for (const OperationInfo& row : kOperations) {
    const Operation operation = row.operation;
    for (int round = 0; round < 300; ++round) {
      const Report a = through_wire(operation, random_report(operation, rng));
      const Report b = through_wire(operation, random_report(operation, rng));
      const Report c = through_wire(operation, random_report(operation, rng));
      Report left = merged(operation, merged(operation, a, b), c);
      Report right = merged(operation, a, merged(operation, b, c));
      EXPECT_EQ(left.corners.stable, right.corners.stable);
      EXPECT_EQ(left.corners.count, right.corners.count);
      left.corners = right.corners = {};
      EXPECT_EQ(text_of(operation, left), text_of(operation, right)) << row.name;
      left = merged(operation, a, b);
      right = merged(operation, b, a);
      left.corners = right.corners = {};
      EXPECT_EQ(text_of(operation, left), text_of(operation, right)) << row.name;
    }
  }
}

TEST(Order, mass_counts_and_keeps_the_largest_extent) {
  const Report a = {.extent = 7, .count = 2, .moment = {3, -4, 8}};
  const Report b = {.flags = kAnyFixed, .extent = 9, .count = 5, .moment = {-10, 1, -9}};
  const Report sum = merged(Operation::kMass, a, b);
  EXPECT_EQ(sum.count, 7U);
  EXPECT_EQ(sum.extent, 9);
  EXPECT_EQ(sum.moment, (std::array<std::int64_t, 3>{-7, -3, -1}));
  EXPECT_EQ(sum.flags, kAnyFixed);
}

TEST(Order, moments_that_overflow_say_so_and_stay) {
  const Report most = {.moment = {kMomentMost, -kMomentMost}};
  const Report still = merged(Operation::kMass, most, {.moment = {0, 0}});
  EXPECT_EQ(still.flags, 0);
  EXPECT_EQ(still.moment, most.moment);
  const Report over = merged(Operation::kMass, most, {.moment = {1, -1}});
  EXPECT_EQ(over.flags, kSumOverflow);
  EXPECT_EQ(over.moment, most.moment);
  // What comes later cannot take it back.
  const Report later = merged(Operation::kMass, over, {.moment = {-5, 5}});
  EXPECT_EQ(later.flags, kSumOverflow);
  EXPECT_EQ(merged(Operation::kMass, {.moment = {-5, 5}}, over).flags, kSumOverflow);
}

TEST(Order, the_next_planned_cell_is_the_first_of_all) {
  const Report none;
  const Report early = {.flags = kFound, .mask = 1, .cell = {-3, 9, 9}};
  const Report late = {.flags = kFound, .mask = 4, .cell = {2, 0, 0}};
  for (const auto& [a, b] : {std::pair{early, late}, {late, early}}) {
    const Report both = merged(Operation::kPlan, a, b);
    EXPECT_EQ(both.cell, early.cell);
    EXPECT_EQ(both.mask, 5);
  }
  EXPECT_EQ(merged(Operation::kPlan, none, late).cell, late.cell);
  EXPECT_EQ(merged(Operation::kPlan, late, none).cell, late.cell);
  EXPECT_EQ(merged(Operation::kPlan, none, none).flags, 0);
}

/// Whatever is planned: the root must have it forgotten before it learns anything else.
TEST(Order, a_plan_that_has_ended_goes_before_all_others) {
  const Report planned = {.flags = kFound | kDisputed, .cell = {-9, 0, 0}};
  const Report ended = {.flags = kEnded | kFulfilled, .cell = {5, 0, 0}};
  const Report later = {.flags = kEnded, .cell = {6, 0, 0}};
  for (const Operation operation : {Operation::kPlan, Operation::kForget}) {
    for (const auto& [a, b] : {std::pair{planned, ended}, {ended, planned}}) {
      const Report both = merged(operation, a, b);
      EXPECT_EQ(both.cell, ended.cell);
      EXPECT_EQ(both.flags, kFound | kDisputed | kEnded | kFulfilled);
      EXPECT_EQ(merged(operation, later, both).cell, ended.cell);
    }
  }
}

TEST(Order, of_equal_loads_the_first_cell_is_the_worst) {
  const Report low = {.count = 0, .number = 3, .reals = {0.5F}, .cell = {-9, 0, 0}};
  const Report first = {.count = 1,
                        .number = 4,
                        .reals = {1.25F},
                        .cell = {0, 0, 0},
                        .direction = base::Direction::kMinusX};
  const Report second = {.count = 2,
                         .number = 5,
                         .reals = {1.25F},
                         .cell = {0, 0, 1},
                         .direction = base::Direction::kPlusY};
  for (const auto& [a, b] : {std::pair{first, second}, {second, first}}) {
    const Report all = merged(Operation::kLoads, merged(Operation::kLoads, low, a), b);
    EXPECT_EQ(all.reals[0], 1.25F);
    EXPECT_EQ(all.cell, first.cell);
    EXPECT_EQ(all.direction, first.direction);
    EXPECT_EQ(all.count, 3U);
    EXPECT_EQ(all.number, 12U);
  }
}

/// What an iteration adds up, and of the largest load ratio, which it reports anyway, the place.
TEST(Order, the_last_iteration_keeps_the_place_of_the_larger_ratio) {
  const auto report_of = [](float ratio, const base::Cell& cell, base::Direction direction) {
    Report report;
    report.reals = {0.125F, ratio};
    report.cell = cell;
    report.direction = direction;
    return report;
  };
  // The bound on the error, which comes before it, is of no account.
  Report low = report_of(0.5F, {-9, 0, 0}, base::Direction::kPlusZ);
  low.reals[0] = 8;
  const Report first = report_of(1.25F, {0, 0, 0}, base::Direction::kMinusX);
  const Report second = report_of(1.25F, {0, 0, 1}, base::Direction::kPlusY);
  const auto merged_last = [](const Report& a, const Report& b) {
    return merged(Operation::kIterateLast, a, b);
  };
  for (const auto& [a, b] : {std::pair{first, second}, {second, first}}) {
    for (const Report& all :
         {merged_last(merged_last(low, a), b), merged_last(a, merged_last(b, low))}) {
      EXPECT_EQ(all.error(), 8.25F);
      EXPECT_EQ(all.load_ratio_max(), 1.25F);
      EXPECT_EQ(all.cell, first.cell);
      EXPECT_EQ(all.direction, first.direction);
    }
  }
  EXPECT_EQ(merged_last(low, second).cell, second.cell);
  EXPECT_EQ(merged_last(second, low).cell, second.cell);
  // Without a connection there is no place.
  const Report none = report_of(kNoLoadRatio, {-99, 0, 0}, base::Direction::kPlusX);
  EXPECT_EQ(merged_last(none, low).cell, low.cell);
  EXPECT_EQ(merged_last(low, none).cell, low.cell);
}

TEST(Order, the_last_iteration_is_an_iteration_with_all_that_closes) {
  const auto corner_at = [](std::int32_t x) {
    return mechanics::SupportCorners{.count = 1, .corners = {{x, 1, 0}}};
  };
  const Report a = {.flags = kAnyTilting,
                    .extent = 2,
                    .number = 5,
                    .reals = {0.25F, 2},
                    .products = {1, 2, -3},
                    .corners = corner_at(-1),
                    .along = {1, 2, 3, 4}};
  const Report b = {.flags = kMayPull,
                    .extent = 3,
                    .number = 7,
                    .reals = {0.5F, 1},
                    .products = {4, -5, 6},
                    .corners = corner_at(3),
                    .along = {-1, 0.5F, 8, 0.25F}};
  const Report sum = merged(Operation::kIterateLast, a, b);
  EXPECT_EQ(sum.flags, kAnyTilting | kMayPull);
  EXPECT_EQ(sum.changed_count(), 5);
  EXPECT_EQ(sum.states_hash(), 12U);
  EXPECT_EQ(sum.error(), 0.75F);
  EXPECT_EQ(sum.load_ratio_max(), 2.0F);
  EXPECT_EQ(sum.products, (std::array<double, 3>{5, -3, 3}));
  EXPECT_EQ(sum.along, (std::array<float, 4>{0, 2.5F, 11, 4.25F}));
  EXPECT_EQ(sum.corners.count, 2);
  // To a kClose the ratio is the first of its reals.
  EXPECT_EQ(worst_of(sum).worst_load_ratio(), 2.0F);
  EXPECT_EQ(worst_of(sum).corners.count, 2);
}

TEST(Order, sums_along_what_is_kept_add_up) {
  Report a;
  Report b;
  for (std::size_t i = 0; i < a.energies.size(); ++i) {
    a.energies[i] = static_cast<float>(i);
    b.energies[i] = 0.5F;
  }
  a.along = {1, 2, 3, 4};
  b.along = {8, 8, -8, 8};
  for (const Operation operation :
       {Operation::kResumeDeflated, Operation::kIterateDeflated, Operation::kIterateLast}) {
    EXPECT_EQ(merged(operation, a, b).along, (std::array<float, 4>{9, 10, -5, 12}));
  }
  const Report sum = merged(Operation::kResumeDeflated, a, b);
  for (std::size_t i = 0; i < sum.energies.size(); ++i) {
    EXPECT_EQ(sum.energies[i], static_cast<float>(i) + 0.5F);
  }
}

TEST(Order, counts_of_hold_and_verdict_add_up) {
  const Report hold =
      merged(Operation::kHold, {.count = 2, .number = 1}, {.count = 3, .number = 4});
  EXPECT_EQ(hold.count, 5U);
  EXPECT_EQ(hold.number, 5U);
  EXPECT_EQ(merged(Operation::kVerdict, {.count = 28}, {.count = 1}).count, 29U);
}

/// 0 stands for none.
TEST(Order, the_next_facet_is_the_one_with_the_least_key) {
  for (const auto& [a, b, least] : {std::tuple{5U, 0U, 5U},
                                    {0U, 5U, 5U},
                                    {7U, 5U, 5U},
                                    {5U, 7U, 5U},
                                    {0x80000000U, 7U, 7U},
                                    {0U, 0U, 0U}}) {
    const Report both =
        merged(Operation::kSeek, {.count = 2, .number = a}, {.count = 1, .number = b});
    EXPECT_EQ(both.next_key(), least);
    EXPECT_EQ(both.count, 3U);
  }
}

TEST(Order, changed_facets_do_not_wrap) {
  const Report many = merged(Operation::kTreeIterate, {.extent = 0xfffe}, {.extent = 3});
  EXPECT_EQ(many.extent, 0xffff);
}

/// NaN survives from whichever side it comes, and whatever comes after it.
TEST(Order, what_is_not_a_number_survives) {
  const Report one = {.reals = {1, 1}};
  for (const float other : {-1e30F, 0.5F, 2.0F, kNan}) {
    const Report fine = {.reals = {other, other}};
    const Report bad_ratio = {.reals = {0, kNan}};
    EXPECT_TRUE(std::isnan(merged(Operation::kTreeIterate, bad_ratio, fine).reals[1])) << other;
    EXPECT_TRUE(std::isnan(merged(Operation::kTreeIterate, fine, bad_ratio).reals[1])) << other;
    const Report bad_error = {.reals = {kNan, 0}};
    EXPECT_TRUE(std::isnan(merged(Operation::kTreeIterate, bad_error, fine).reals[0])) << other;
    EXPECT_TRUE(std::isnan(merged(Operation::kTreeIterate, fine, bad_error).reals[0])) << other;
    const Report bad_load = {.reals = {kNan}};
    EXPECT_TRUE(std::isnan(merged(Operation::kLoads, bad_load, fine).reals[0])) << other;
    EXPECT_TRUE(std::isnan(merged(Operation::kLoads, fine, bad_load).reals[0])) << other;
    EXPECT_TRUE(std::isnan(merged(Operation::kIterateLast, bad_ratio, fine).reals[1])) << other;
    EXPECT_TRUE(std::isnan(merged(Operation::kIterateLast, fine, bad_ratio).reals[1])) << other;
  }
  EXPECT_EQ(merged(Operation::kTreeIterate, one, one).reals[1], 1.0F);
}

/// The worst connection's limit goes with it; that a gap opens or a facet slips is true of all.
TEST(Order, remarks_go_with_the_worst_connection_or_are_of_any) {
  const auto report_of = [](float ratio, std::uint8_t remarks) {
    Report report;
    report.reals = {ratio, ratio};
    report.remarks = remarks;
    return report;
  };
  for (const Operation operation :
       {Operation::kLoads, Operation::kClose, Operation::kIterateLast}) {
    Report sum = report_of(0.5F, 1);
    merge(operation, sum, report_of(0.75F, 2 | kFacetSlips));
    merge(operation, sum, report_of(0.25F, 3 | kGapOpens));
    EXPECT_EQ(sum.remarks, 2 | kGapOpens | kFacetSlips);
    EXPECT_EQ(through_wire(operation, sum).remarks, sum.remarks);
  }
}

/// A direction that the lattice does not have, and in a verdict the bit that only reports have.
TEST(Order, directions_and_remarks_that_nobody_writes_are_refused) {
  Order sent{.operation = Operation::kVerdict,
             .answer = {.verdict = Verdict::kSafe, .reason = Reason::kHolds}};
  const auto is_legal_with = [&](int direction, std::uint8_t remarks, int face_count) {
    sent.answer.worst_direction = static_cast<base::Direction>(direction);
    sent.answer.remarks = remarks;
    Order back;
    return decode(encode(sent).bytes(), back, face_count);
  };
  EXPECT_TRUE(is_legal_with(5, 7, 6));
  EXPECT_FALSE(is_legal_with(6, 7, 6));
  EXPECT_TRUE(is_legal_with(11, 7, 12));
  EXPECT_FALSE(is_legal_with(12, 0, 12));
  EXPECT_FALSE(is_legal_with(5, kFacetSlips, 6));
}

TEST(Order, every_verdict_and_reason_has_a_name_of_its_own) {
  std::set<std::string> names;
  for (int i = 0; i <= static_cast<int>(Verdict::kUndecided); ++i) {
    names.insert(name(static_cast<Verdict>(i)));
  }
  EXPECT_EQ(names.size(), 5U);
  names.clear();
  for (int i = 0; i < kReasonCount; ++i) {
    names.insert(name(static_cast<Reason>(i)));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kReasonCount));
}

}  // namespace
}  // namespace holdfast::agent
