// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "methods.hpp"

/// Sweeps: an order goes down the tree, its report comes up, and most of them exchange six reals
/// between all neighbours on the way.
///
/// A module works on an order as soon as it comes, sends its vector to its neighbours, waits for
/// theirs and for its children's reports, and reports. A neighbour nearer to the root may be one
/// exchange ahead, never two: its next vector depends on ours. So two buffers do, told apart by the
/// lowest bit of the exchange's tag. Reports are added up in the order of the faces, not of their
/// arrival, so that rounding does not depend on the timing.
namespace holdfast::agent {

namespace sweep {

constexpr bool exchanges(const Order& order) {
  switch (order.operation) {
    case wire::Operation::kHigh:
    case wire::Operation::kLow:
    case wire::Operation::kGradient:
    case wire::Operation::kJacobi:
    case wire::Operation::kStep:
    case wire::Operation::kTreeStep:
    case wire::Operation::kClusters:
      return true;
    case wire::Operation::kBegin:
      return order.count > 0;
    case wire::Operation::kStart:
      return (order.flags & (kWithScalars | kWithBlocks)) == 0;
    case wire::Operation::kSlope:
      return (order.flags & kExchangeFirst) != 0;
    default:
      return false;
  }
}

/// Exchanges that go on while the report is on its way up and the next order on its way down. With
/// clusters two polynomials; the image of the first is needed, and that of the clusters' part.
constexpr std::uint16_t exchanges_behind(const Order& order) {
  if constexpr (!kHasAllMethods) {
    return 0;
  }
  switch (order.operation) {
    case wire::Operation::kStep:
      return static_cast<std::uint16_t>((order.flags & kWithClusters) != 0 ? 2 * order.count + 2
                                                                           : order.count);
    case wire::Operation::kBegin:
    case wire::Operation::kClusters:
      return order.count;
    default:
      return 0;
  }
}

/// A preconditioner of degree m shares m more vectors than its first and its last one, which are
/// the same for m = 0. A step shares its move in two parts and then the terms of its polynomial.
constexpr std::uint16_t exchange_count(const Order& order) {
  switch (order.operation) {
    case wire::Operation::kJacobi:
    case wire::Operation::kBegin:
      return order.count;
    case wire::Operation::kStep:
      return static_cast<std::uint16_t>(2 + exchanges_behind(order));
    case wire::Operation::kTreeStep:
      return 2;
    default:
      return static_cast<std::uint16_t>(order.count + 1);
  }
}

/// Forces whose digits beyond single precision count.
constexpr bool is_precise(wire::Operation operation) {
  return operation == wire::Operation::kHigh || operation == wire::Operation::kLow ||
         operation == wire::Operation::kStep;
}

/// A linear solve's exchanges: the preconditioner's terms, then w = A z.
constexpr bool is_preconditioned(wire::Operation operation) {
  return operation == wire::Operation::kStart || operation == wire::Operation::kGradient;
}

constexpr Phase phase_of(wire::Operation operation) {
  switch (operation) {
    case wire::Operation::kPlan:
    case wire::Operation::kForget:
    case wire::Operation::kHosts:
    case wire::Operation::kMass:
      return Phase::kMass;
    case wire::Operation::kAngles:
      return Phase::kSimplified;
    case wire::Operation::kCorners:
      return Phase::kModel;
    case wire::Operation::kLoads:
    case wire::Operation::kVerdict:
      return Phase::kOverload;
    default:
      return Phase::kEquilibrium;
  }
}

/// In the label of `planned down`: the index, and for a step which part of a displacement it is.
inline constexpr std::uint8_t kIndexMask = 0x3f;
inline constexpr std::uint8_t kLeading = 0x40;
inline constexpr std::uint8_t kTrailing = 0x80;

inline wire::Writer vector_message(wire::MessageType type, std::uint8_t label,
                                   const base::Vec6<float>& vector) {
  wire::Writer message(type);
  message.u8(label);
  for (const float value : vector) {
    message.real(static_cast<double>(value));
  }
  return message;
}

inline base::Vec6<float> read_vector(wire::Reader& in) {
  base::Vec6<float> vector{};
  for (float& value : vector) {
    value = in.real();
  }
  return vector;
}

}  // namespace sweep

}  // namespace holdfast::agent
