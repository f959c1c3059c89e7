// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/agent/features.hpp"
#include "holdfast/agent/wire/wire.hpp"

/// The one table of operations: what each costs, when it exchanges, and its names.
///
/// A new operation is one more value of wire::Operation, one row here, and its fields in order.cpp;
/// the compiler asks for all three.
namespace holdfast::agent {

/// What a module is busy with; its messages are counted under this.
enum class Phase : std::uint8_t {
  kDiscovery,
  kCoordinates,
  kElection,
  kTree,
  kMass,
  kSimplified,
  kEquilibrium,
  kModel,
  kOverload,
  kDone,
};

/// A flag of kIterate: clusters between two polynomials.
inline constexpr std::uint8_t kWithClusters = 8;

/// How many times an order makes all neighbours exchange vectors: `fixed` times, and if
/// `is_counted` Order::count times more, behind the report.
struct Exchanges {
  std::uint8_t fixed = 0;
  bool is_counted = false;
  std::uint8_t twice_with = 0;  ///< With this flag of the order twice as many, and 2 more.
};

/// One row of the table.
struct OperationInfo {
  wire::Operation operation;
  const char* name;           ///< As docs/wire.md has it.
  std::uint8_t order_bytes;   ///< Size of the message down the tree, type and operation included.
  std::uint8_t report_bytes;  ///< Size of the message up the tree.
  Phase phase;                ///< What a module is busy with while it works on it.
  Exchanges exchanges = {};
  bool is_precise = false;    ///< Digits of forces beyond single precision count.
  bool is_iteration = false;  ///< It is an iteration of a linear method.
  const char* text = "";      ///< In words, for people.
};

// Named initializers would make three lines of each row.
// clang-format off
inline constexpr OperationInfo kOperations[] = {
    // operation, name, bytes down, bytes up, phase, exchanges, precise, iteration, in words
    {wire::Operation::kPlan, "plan", 12, 14, Phase::kMass, {}, false, false, "planned cells"},
    {wire::Operation::kHosts, "hosts", 18, 3, Phase::kMass, {}, false, false,
     "who hosts planned modules"},
    {wire::Operation::kMass, "mass", 11, 37, Phase::kMass, {}, false, false, "centre of mass"},
    {wire::Operation::kAngles, "angles", 23, 19, Phase::kSimplified, {}, false, false,
     "safe angles"},
    {wire::Operation::kBegin, "begin", 13, 2, Phase::kEquilibrium,
     {.is_counted = true}, false, false, "begin an equilibrium"},
    {wire::Operation::kHold, "hold", 3, 10, Phase::kEquilibrium, {}, false, false,
     "release and hold facets"},
    {wire::Operation::kCorners, "corners", 2, 21, Phase::kModel, {}, false, false,
     "support corners"},
    {wire::Operation::kLoads, "loads", 2, 24, Phase::kOverload, {}, false, false,
     "the worst connection"},
    {wire::Operation::kVerdict, "verdict", 18, 6, Phase::kOverload, {}, false, false,
     "know the verdict"},
    {wire::Operation::kFactor, "factor", 2, 2, Phase::kEquilibrium, {}, false, false,
     "condense the branches"},
    {wire::Operation::kIterate, "iterate", 17, 41, Phase::kEquilibrium,
     {.fixed = 2, .is_counted = true, .twice_with = kWithClusters}, true, true,
     "an iteration: move, residual, sums"},
    {wire::Operation::kTreeIterate, "tree iterate", 2, 17, Phase::kEquilibrium, {.fixed = 2}, false,
     true, "an iteration: move, residual"},
    {wire::Operation::kClusters, "clusters", 13, 10, Phase::kEquilibrium,
     {.fixed = 1, .is_counted = true}, false, false,
     "begin an equilibrium, find rigid clusters"},
    {wire::Operation::kForget, "forget", 12, 14, Phase::kMass, {}, false, false,
     "forget a plan that has ended"},
    {wire::Operation::kRenew, "renew", 12, 40, Phase::kMass, {}, false, false,
     "a change after the verdict"},
    {wire::Operation::kResume, "resume", 31, 20, Phase::kEquilibrium,
     {.fixed = 2, .is_counted = true}, true, false,
     "hosts, safe angles, an equilibrium from what is kept"},
    {wire::Operation::kClose, "close", 2, 35, Phase::kModel, {}, false, false,
     "support corners, the worst connection"},
    {wire::Operation::kWord, "word", 18, 23, Phase::kMass, {}, false, false,
     "words of a step"},
    {wire::Operation::kStage, "stage", 22, 7, Phase::kMass, {}, false, false,
     "the next stage of a step"},
    {wire::Operation::kShape, "shape", 2, 41, Phase::kOverload, {}, false, false,
     "box, supports, the largest load ratio"},
    {wire::Operation::kNext, "next", 35, 10, Phase::kOverload, {}, false, false,
     "where the next module may go"},
    {wire::Operation::kSeek, "seek", 7, 10, Phase::kEquilibrium, {}, false, false,
     "put a facet into another state"},
    {wire::Operation::kResumeDeflated, "resume deflated", 31,
     20 + 4 * (wire::kKeptMax + wire::kKeptPairs),
     Phase::kEquilibrium, {.fixed = 2 + wire::kKeptMax, .is_counted = true},
     true, false, "the same, and energies of what is kept"},
    {wire::Operation::kIterateDeflated, "iterate deflated", 17 + 4 * wire::kKeptMax,
     41 + 4 * wire::kKeptMax, Phase::kEquilibrium,
     {.fixed = 2, .is_counted = true}, true, true,
     "an iteration, and along what is kept"},
    {wire::Operation::kIterateLast, "iterate last", 17 + 4 * wire::kKeptMax,
     70 + 4 * wire::kKeptMax, Phase::kEquilibrium,
     {.fixed = 2, .is_counted = true}, true, true,
     "an iteration, corners, the worst connection"},
    {wire::Operation::kBend, "bend", 2, 31, Phase::kOverload, {}, false, false,
     "whether bending may matter"},
};

// clang-format on

/// The row of an operation, which is one.
constexpr const OperationInfo& info(wire::Operation operation) {
  const OperationInfo* row = kOperations;
  while (row->operation != operation) {
    ++row;
  }
  return *row;
}

/// One column of the table, by operation; at numbers that are none, zero. A program that looks up
/// columns only has no names in it.
template <class Value>
constexpr std::array<Value, wire::kOperationLast + 1> column(Value OperationInfo::*member) {
  std::array<Value, wire::kOperationLast + 1> values{};
  for (const OperationInfo& row : kOperations) {
    values[static_cast<std::size_t>(row.operation)] = row.*member;
  }
  return values;
}

namespace columns {
inline constexpr auto kExchanges = column(&OperationInfo::exchanges);
inline constexpr auto kPhases = column(&OperationInfo::phase);
inline constexpr auto kIsPrecise = column(&OperationInfo::is_precise);
}  // namespace columns

/// Does an iteration go along what is kept, if anything is?
constexpr bool is_deflated(wire::Operation operation) {
  return kKeepsAnswers && (operation == wire::Operation::kIterateDeflated ||
                           operation == wire::Operation::kIterateLast);
}

/// Is this an iteration of the polynomial?
constexpr bool is_iterate(wire::Operation operation) {
  return operation == wire::Operation::kIterate || is_deflated(operation);
}

/// Does an equilibrium begin from what is kept?
constexpr bool is_resume(wire::Operation operation) {
  return kKeepsAnswers &&
         (operation == wire::Operation::kResume || operation == wire::Operation::kResumeDeflated);
}

/// Do digits of forces beyond single precision count?
constexpr bool is_precise(wire::Operation operation) {
  return columns::kIsPrecise[static_cast<std::size_t>(operation)];
}

/// What a module is busy with while it works on an order.
constexpr Phase phase_of(wire::Operation operation) {
  return columns::kPhases[static_cast<std::size_t>(operation)];
}

}  // namespace holdfast::agent
