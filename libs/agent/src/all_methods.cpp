// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "condensed.hpp"
#include "method.hpp"

namespace holdfast::agent {
namespace {

/// A method that condenses planned modules.
constexpr MethodTable condensing(MethodTable method) {
  method.pass_condensed = pass_condensed;
  method.take_condensed = take_condensed;
  return method;
}

constexpr MethodTable kElimination = table_of<TreeElimination, &MethodState::elimination>();
constexpr MethodTable kPolynomial =
    condensing(table_of<PolynomialIteration, &MethodState::polynomial>());
constexpr MethodTable kClusters = condensing(table_of<RigidClusters, &MethodState::clusters>());
constexpr MethodTable kGradients = table_of<KrylovAndJacobi, &MethodState::gradients>();

}  // namespace

const MethodTable* method_in(Course course) {
  switch (course) {
    case Course::kWeighed:
    case Course::kElimination:
      return &kElimination;
    case Course::kPolynomial:
      return &kPolynomial;
    case Course::kClusters:
      return &kClusters;
    case Course::kGradients:
      return &kGradients;
    default:
      return nullptr;
  }
}

}  // namespace holdfast::agent
