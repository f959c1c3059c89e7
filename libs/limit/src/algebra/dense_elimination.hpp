// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "holdfast/host/team.hpp"

namespace holdfast::limit {

/// Cholesky's method for dense symmetric matrices of which only some columns are eliminated, the
/// fronts of BlockCholesky. Keeps the memory that it works in.
class DenseElimination {
 public:
  /// Of a pivot's first value: less is rounding, and a pivot is never less.
  static constexpr double kNothing = 1e-15;

  /// Factors the first `width` columns of the lower triangle of a symmetric matrix; the rest of it
  /// becomes what is left. The upper triangle is of no account. `first_value` by column, before
  /// anything was eliminated. The bits do not depend on the team.
  void run(Eigen::MatrixXd& dense, Eigen::Index width, const Eigen::VectorXd& first_value,
           host::Team& team);

 private:
  void factor_panel(Eigen::MatrixXd& dense, Eigen::Index begin, Eigen::Index end,
                    const Eigen::VectorXd& first_value, host::Team& team);
  void subtract(Eigen::MatrixXd& dense, Eigen::Index from, Eigen::Index depth, Eigen::Index begin,
                Eigen::Index end, host::Team& team);
  void pack(const Eigen::MatrixXd& dense, Eigen::Index from, Eigen::Index depth, Eigen::Index begin,
            Eigen::Index end, host::Team& team);

  std::vector<double> rows_;     ///< Packed.
  std::vector<double> columns_;  ///< Packed.
};

}  // namespace holdfast::limit
