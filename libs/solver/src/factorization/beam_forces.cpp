// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/beam_forces.hpp"

namespace holdfast::solver {

using base::Vec6;

std::vector<Vec6<double>> beam_forces(const model::Robot& robot,
                                      const model::LatticeBeam<double>& beam,
                                      const std::vector<Vec6<double>>& displacement) {
  std::vector<Vec6<double>> force(displacement.size(), Vec6<double>{});
  for (const model::Connection& connection : robot.connections()) {
    const auto a = static_cast<std::size_t>(connection.a);
    const auto b = static_cast<std::size_t>(connection.b);
    base::add_to(force[a], beam.end_force(connection.direction, displacement[a], displacement[b]));
    base::add_to(force[b], beam.end_force(base::opposite(connection.direction), displacement[b],
                                          displacement[a]));
  }
  return force;
}

std::vector<Vec6<double>> sum(std::vector<Vec6<double>> a, double factor,
                              const std::vector<Vec6<double>>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = sum(a[i], factor, b[i]);
  }
  return a;
}

double dot_all(const std::vector<base::Vec6<double>>& a, const std::vector<base::Vec6<double>>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += base::dot(a[i], b[i]);
  }
  return sum;
}

}  // namespace holdfast::solver
