// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// How far the sum of masses times displacements along an axis in plan may be off, where
/// displacements are off by no more than e in the energy norm, while a robot grows.
///
/// Let l pull every module sideways by 1 N for each kg of it. By Cauchy and Schwarz that sum is off
/// by |K^-1 l| e at most, and that norm is the least of |t| = (sum of t_i^2 / h_i)^(1/2) over all
/// forces t that balance l [Prager 1947], h being the stiffness of six springs in the middle of
/// each beam and facet. One of these t takes the pull of each module down a shortest way to a
/// support: a spring at c, above which there are the modules i, bears
///   the force M = sum of m_i and a moment of no more than |sum of m_i (p_i - c)|.
/// What has been attached since adds no more than its own pull does by itself, on a way of n
/// springs, the k-th of which is no farther from it than k - 1/2 pitches:
///   m (n / h_force + pitch^2 n (4 n^2 - 1) / 12 / h_moment)^(1/2),
/// as whatever is attached makes a robot stiffer.
class SwayBound {
 public:
  /// `stiffness` is h. Keeps a reference to the robot, all modules of which are there in the end.
  SwayBound(const model::Robot& target, const base::Vec6<double>& stiffness);

  /// Begins with these modules and no others, each of which hangs together with a support.
  void begin(const std::vector<Element>& elements);

  /// Attaches a module, which must be beside one that is there or have a support.
  void attach(std::size_t module);

  /// In kg mm for each (N mm)^(1/2) of e: the same bound for every axis in plan.
  double error_per_norm() const { return error_per_norm_; }

 private:
  /// A mass, and the sum of masses times places, kg mm.
  struct Pulled {
    double mass = 0;
    base::Vec6<double> moment{};  ///< The last three are 0.
  };

  double energy_of(const Pulled& pulled, const base::Vec6<double>& middle) const;

  static constexpr std::int32_t kAbsent = -1;

  const model::Robot& target_;
  double pitch_mm_ = 0;
  double per_force_ = 0;                    ///< 1 / h_force, of the softest of three,
  double per_moment_ = 0;                   ///< and 1 / h_moment.
  std::vector<base::Vec6<double>> places_;  ///< By module: its node, mm; the last three are 0.
  std::vector<std::int32_t> depth_;         ///< By module: steps to a support, or kAbsent.
  std::vector<std::int32_t> below_;         ///< By module: the next one on its way, or kAbsent.
  std::vector<std::size_t> order_;          ///< Modules of the last begin(), by depth,
  std::vector<Pulled> pulled_;              ///< and, by module, what each hands on.
  double error_per_norm_ = 0;
};

}  // namespace holdfast::plan
