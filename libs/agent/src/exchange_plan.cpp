// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "exchange_plan.hpp"

namespace holdfast::agent {

using wire::Operation;

ExchangePlan plan_of(const Order& order) {
  const std::uint16_t degree = order.count;
  const auto more = [&](int count) { return static_cast<std::uint16_t>(degree + count); };
  switch (order.operation) {
    case Operation::kHigh:
    case Operation::kLow:
      return {.count = 1};
    case Operation::kGradient:
      // A preconditioner of degree m shares m more vectors than its first and its last one, which
      // are the same for m = 0.
      return {.count = more(1)};
    case Operation::kStart:
      return (order.flags & (kWithScalars | kWithBlocks)) != 0 ? ExchangePlan{}
                                                               : ExchangePlan{.count = more(1)};
    case Operation::kSlope:
      return {.count = (order.flags & kExchangeFirst) != 0 ? more(1) : std::uint16_t{0}};
    case Operation::kJacobi:
      return {.count = degree};
    case Operation::kBegin:
      return {.count = degree, .behind = degree};
    case Operation::kClusters:
      // The choice, when it is made; then the terms of a polynomial.
      return {.count = more(1), .behind = degree, .starts_at_once = false};
    case Operation::kTreeStep:
      // The move in two parts, when it is found.
      return {.count = 2, .starts_at_once = false};
    case Operation::kStep: {
      // The move in two parts; then the terms of a polynomial, with clusters of two: the image of
      // the first is needed, and that of the clusters' part.
      const bool has_clusters = (order.flags & kWithClusters) != 0;
      const auto behind = static_cast<std::uint16_t>(has_clusters ? 2 * degree + 2 : degree);
      return {.count = static_cast<std::uint16_t>(2 + behind), .behind = behind};
    }
    default:
      return {};
  }
}

bool is_precise(Operation operation) {
  return operation == Operation::kHigh || operation == Operation::kLow ||
         operation == Operation::kStep;
}

}  // namespace holdfast::agent
