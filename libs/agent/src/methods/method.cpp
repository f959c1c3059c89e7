// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "methods/method.hpp"

#include "holdfast/agent/features.hpp"

namespace holdfast::agent {
namespace {

/// A method that condenses planned modules.
template <class Own, Own MethodState::*kOwn>
constexpr MethodTable condensing_table_of() {
  MethodTable table = table_of<Own, kOwn>();
  table.condense = [](MethodState& state, Workspace& ws, const Order& order, int piece) {
    return (state.*kOwn).condense(ws, order, piece);
  };
  return table;
}

constexpr MethodTable kElimination = table_of<TreeElimination, &MethodState::elimination>();
constexpr MethodTable kPolynomial =
    condensing_table_of<PolynomialIteration, &MethodState::polynomial>();
constexpr MethodTable kClusters = condensing_table_of<RigidClusters, &MethodState::clusters>();
constexpr MethodTable kFronts = table_of<FrontElimination, &MethodState::fronts>();

}  // namespace

const MethodTable* method_in(Course course) {
  switch (course) {
    case Course::kWeighed:
    case Course::kElimination:
      return &kElimination;
    case Course::kPolynomial:
      return &kPolynomial;
    case Course::kClusters:
      return kHasAllMethods ? &kClusters : nullptr;
    case Course::kFronts:
      return kHasAllMethods ? &kFronts : nullptr;
    default:
      return nullptr;
  }
}

}  // namespace holdfast::agent
