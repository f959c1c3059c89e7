// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/limit/structure.hpp"

/// The limit load: the largest factor of all loads that any distribution of forces balances within
/// the limits of all joints; the static theorem of limit analysis. A second-order cone program,
/// solved by an interior-point method. Derivation: docs/limit.md.
namespace holdfast::limit {

/// Factors beyond this are not distinguished from an infinite one: known forces have about six
/// digits.
inline constexpr double kFactorMax = 1e5;

struct LimitOptions {
  double tolerance = 1e-6;  ///< Of the bracket, as a share of the factor.
  /// The bracket is what it is so far when this time is over; an iteration that has begun is ended.
  double seconds_max = 600;
  int thread_count = 0;  ///< 0: as many as the machine has cores; decides nothing.
  /// Forces of all joints that balance the loads, such as the elastic ones, local frame; they spare
  /// most of the work for large structures. Empty: none are known.
  std::span<const base::Vec6<double>> known_forces = {};
  /// Called between programs with the bracket so far.
  std::function<void(double low, double high)> progress = {};
};

/// A joint that takes part in the collapse, and what it does.
struct Yield {
  std::size_t joint = 0;  ///< Index.
  std::int32_t a = 0;     ///< Its bodies.
  std::int32_t b = Joint::kGround;
  model::Limit limit = model::Limit::kOpens;
  double speed = 0;  ///< mm, of `b` relative to `a`, where the fastest body moves 1 mm.
};

/// How the structure collapses: rigid bodies, joints that give way.
struct Mechanism {
  /// Each body's velocity, of its centre, and angular velocity, mm and rad; the largest is 1 mm.
  std::vector<base::Vec6<double>> velocities;
  std::vector<Yield> yields;  ///< Fastest first.
};

struct LimitLoad {
  enum class Outcome : std::uint8_t {
    kFound,      ///< The factor lies within [low, high], which is narrow enough.
    kUnbounded,  ///< No factor up to kFactorMax is too large, or there is no load.
    kStopped,    ///< Out of time, or of digits: [low, high] is wider.
  };

  Outcome outcome = Outcome::kStopped;
  double low = 0;
  double high = kFactorMax;
  Mechanism mechanism;            ///< Of the upper bound; empty if unbounded or none was found.
  int program_count = 0;          ///< Programs solved.
  std::size_t row_count_max = 0;  ///< Rows of the largest.
};

LimitLoad limit_load(const Structure& structure, const LimitOptions& options = {});

/// The load ratio of a joint under a force, of its law; a contact that is pulled has none.
double joint_ratio(const Joint& joint, const base::Vec6<double>& force);

/// "found", "unbounded", "stopped".
const char* name(LimitLoad::Outcome outcome);

}  // namespace holdfast::limit
