// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "program/cone_program.hpp"

namespace holdfast::limit {

/// What is proved of a program: its value lies within [low, high].
struct ProgramBounds {
  double low = 0;
  double high = kFactorMax;
  Eigen::VectorXd velocities = {};  ///< By row of the balances, of the upper bound; loads do work.
  int iteration_count = 0;
};

struct ProgramOptions {
  double tolerance = 1e-7;
  double low_enough = kFactorMax;
  int thread_count = 0;  ///< 0: as many as the machine has cores; decides nothing.
};

/// A primal-dual interior-point method on the homogeneous self-dual embedding, so that programs
/// whose forces have no bound or whose factor has none need no case of their own [Andersen 2003].
/// Derivation: docs/limit.md.
///
/// Stops once high - low <= tolerance * high, low >= low_enough, `is_over` says so, or rounding is
/// all that is left.
ProgramBounds maximise_factor(const ConeProgram& program, const ProgramOptions& options,
                              const std::function<bool()>& is_over);

}  // namespace holdfast::limit
