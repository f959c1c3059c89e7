// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::solver {

/// The forces that a robot's beams take from every module when the modules move by `displacement`,
/// both by module; `beam` are the beams of its lattice.
std::vector<base::Vec6<double>> beam_forces(const model::Robot& robot,
                                            const model::LatticeBeam<double>& beam,
                                            const std::vector<base::Vec6<double>>& displacement);

/// a + factor b
inline base::Vec6<double> sum(base::Vec6<double> a, double factor, const base::Vec6<double>& b) {
  for (std::size_t k = 0; k < 6; ++k) {
    a[k] += factor * b[k];
  }
  return a;
}

/// a + factor b, vector by vector.
std::vector<base::Vec6<double>> sum(std::vector<base::Vec6<double>> a, double factor,
                                    const std::vector<base::Vec6<double>>& b);

/// a . b, all vectors together.
double dot_all(const std::vector<base::Vec6<double>>& a, const std::vector<base::Vec6<double>>& b);

}  // namespace holdfast::solver
