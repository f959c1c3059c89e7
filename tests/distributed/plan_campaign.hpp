// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "holdfast/model/robot.hpp"

/// Compares what every module answers in the end with the exact answer for the robot as it is then,
/// when plans are announced, carried out, withdrawn at any time and to any module of random robots.
namespace holdfast::test {

enum class PlanCase : std::uint8_t {
  kToldAfter,           ///< Each cell to a random module, after the verdict without it.
  kToldDuring,          ///< At random times of the first round.
  kToldSixTimes,        ///< All cells, one round after the other, to one module.
  kToldToThree,         ///< All cells to three modules.
  kAttachedAfter,       ///< Told at the start; attached after the verdict.
  kAttachedDuring,      ///< Attached at a random time of the round.
  kWithdrawnAfter,      ///< By other modules than were told, after the verdict.
  kWithdrawnDuring,     ///< At random times, to the module that was told.
  kWithdrawnElsewhere,  ///< The same to another one: may be disputed.
  kStepByStep,          ///< Told, attached, told, attached ...; judged after each.
};
inline constexpr std::size_t kPlanCaseCount = 10;

const char* name(PlanCase what);

/// Modules by what they answered.
struct PlanTally {
  int runs = 0;
  int right = 0;
  int wrong_safe = 0;
  int wrong_otherwise = 0;
  int undecided = 0;  ///< Where the exact answer is not.
  int disputed = 0;   ///< Of these, for a plan and its withdrawal at once.
  int none = 0;
  int left_over = 0;  ///< Plans and withdrawals that some module still holds and should not.

  int faults() const {
    return wrong_safe + wrong_otherwise + undecided - disputed + none + left_over;
  }
};

/// Does nothing if the robot of this seed has no planned modules.
void run_plan_case(PlanCase what, std::uint64_t seed, PlanTally& tally);

}  // namespace holdfast::test
