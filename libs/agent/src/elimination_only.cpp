// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "method.hpp"

namespace holdfast::agent {
namespace {

constexpr MethodTable kElimination = table_of<TreeElimination, &MethodState::elimination>();

}  // namespace

const MethodTable* method_in(Course course) {
  return course == Course::kWeighed || course == Course::kElimination ? &kElimination : nullptr;
}

}  // namespace holdfast::agent
