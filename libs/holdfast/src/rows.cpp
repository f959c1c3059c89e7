// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <type_traits>

#include "holdfast/holdfast.hpp"
#include "holdfast/verdict/connection_law.hpp"

namespace holdfast {
namespace {

/// Objects that are `Width` doubles and nothing else, as rows.
template <std::size_t Width, class Object>
Rows rows_of(const std::vector<Object>& objects) {
  static_assert(sizeof(Object) == Width * sizeof(double) && std::is_standard_layout_v<Object> &&
                std::is_trivially_copyable_v<Object>);
  return {.numbers = {reinterpret_cast<const double*>(objects.data()), objects.size() * Width},
          .width = Width};
}

}  // namespace

Rows connection_rows(const CheckResult& result) {
  return rows_of<5>(result.assessment.connections);
}

std::vector<model::Limit> connection_limits(const model::Robot& robot,
                                            const verdict::Assessment& assessment) {
  const verdict::ConnectionLaws laws(robot);
  std::vector<model::Limit> limits;
  for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
    limits.push_back(laws.limit(robot.connections()[i], assessment.connections[i]));
  }
  return limits;
}

Rows displacement_rows(const CheckResult& result) {
  return rows_of<6>(result.assessment.equilibrium.displacement);
}

std::vector<base::Vec6<double>> ground_forces(const model::Robot& robot,
                                              const CheckResult& result) {
  return solver::ground_forces(robot, result.assessment.equilibrium);
}

}  // namespace holdfast
