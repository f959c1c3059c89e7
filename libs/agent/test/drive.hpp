// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "holdfast/agent/conductor/conductor.hpp"
#include "test_setup.hpp"

/// A conductor driven order by order, from reports made by hand: no robot and no mechanics.
namespace holdfast::agent::test {

using wire::Operation;

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
inline constexpr std::uint32_t kCensus = 10;
inline constexpr base::Cell kRoot = {1, 2, 3};

/// A conductor, its setup and its last order.
class Drive {
 public:
  explicit Drive(Method method = Method::kFronts, std::uint16_t depth = 4,
                 std::uint32_t census = kCensus) {
    setup.method = method;
    order = conductor.begin(setup, kRoot, census, depth, {.has_fronts = method == Method::kFronts});
  }

  const Order& next(const Report& report = {}) {
    order = conductor.next(setup, report, Planned());
    return order;
  }

  /// Drives without planned modules up to the report of the mass.
  void to_mass() {
    ASSERT_EQ(next().operation, Operation::kHosts);
    ASSERT_EQ(next().operation, Operation::kMass);
  }

  void to_equilibrium(bool is_fixed = true) {
    to_mass();
    next({.flags = is_fixed ? kAnyFixed : std::uint8_t{0},
          .extent = 5,
          .count = kCensus,
          .number = kCensus});
    if (!is_fixed) {
      ASSERT_EQ(order.operation, Operation::kAngles);
      Report stands;
      stands.feet.range = mechanics::SafeRange::kFull;
      next(stands);
    }
    ASSERT_EQ(order.operation, Operation::kBegin);
  }

  void to_equilibrium_with_a_remote_planned_module() {
    next({.flags = kFound});
    next({.mask = 1});
    next({.mask = kAnyRemote | 1});
    next({.flags = kAnyFixed, .extent = 5, .count = kCensus + 1, .number = kCensus + 1});
    ASSERT_EQ(order.operation, Operation::kBegin);
  }

  /// Drives from kBegin or kFactor to the next iteration, whose report is a judgement.
  void to_judgement() {
    while (order.operation == Operation::kBegin || order.operation == Operation::kFactor) {
      next();
    }
    ASSERT_TRUE(is_iterating());
  }

  bool is_iterating() const {
    return order.operation == Operation::kTreeIterate || order.operation == Operation::kIterate;
  }

  /// Every judgement is the same, up to the order behind the last one.
  void settle(const Report& judgement) {
    constexpr int kIterationsMax = 10;
    to_judgement();
    for (int i = 0; i < kIterationsMax && is_iterating(); ++i) {
      next(judgement);
    }
  }

  static Report judgement(float error, float ratio) { return {.reals = {error, ratio}}; }

  void expect_finished(Verdict verdict, Reason reason) {
    EXPECT_EQ(order.operation, Operation::kVerdict);
    EXPECT_EQ(order.answer.verdict, verdict);
    EXPECT_EQ(order.answer.reason, reason);
    EXPECT_TRUE(conductor.is_finished());
  }

  agent::Setup setup = table_setup();
  Conductor conductor;
  Order order;
};

/// The report of an iteration: bound on the error; (r, v), (q, v), (q_older, v).
inline Report iteration_report(float bound, const std::array<double, 3>& products = {},
                               std::uint16_t changed = 0) {
  return {.extent = changed, .reals = {bound, 0.5F}, .products = products};
}

/// Up to kBegin, with more loops than modules can keep, or not.
inline Drive one_sweep_drive(bool has_many_loops) {
  Drive drive(Method::kElimination);
  drive.to_mass();
  const unsigned flags = kAnyFixed | (has_many_loops ? kManyLoops : 0U);
  drive.next({.flags = static_cast<std::uint8_t>(flags),
              .extent = 5,
              .count = kCensus,
              .number = kCensus});
  EXPECT_EQ(drive.order.operation, Operation::kBegin);
  EXPECT_EQ(drive.order.flags, has_many_loops ? kOneSweep | kWithIterations : kOneSweep);
  return drive;
}

}  // namespace holdfast::agent::test
