// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/linear_system.hpp"

/// What linear theory leaves out, to second order (docs/second_order.md): at which factor of all
/// loads a robot would buckle, and how its bending changes what it carries.
///
/// K are the equations of a linear system with its facets in their states (open ones absent), u1
/// their solution, K_G the derivative of the forces B^T s at rest with the stresses s of u1 fixed.
/// The buckling factor is the smallest positive mu with K + mu K_G singular: for x of unit energy
/// x . K x = 1 it is one over the largest -x . K_G x. At lambda times the loads the robot moves by
/// lambda u1 + lambda^2 u2 + ..., where K u2 is less the part of second order of the forces at u1.
namespace holdfast::solver {

enum class BucklingAnswer : std::uint8_t {
  kFactor,      ///< It is known.
  kNone,        ///< There is none: the stresses soften nothing.
  kAbove,       ///< It is above a bound; proved, but for rounding.
  kAtMost,      ///< No more than an upper bound is known, by iteration: no proof of anything.
  kNoStiffness  ///< K is singular, or rounding leaves nothing of it: there is no factor.
};

struct Buckling {
  BucklingAnswer answer = BucklingAnswer::kNoStiffness;
  double factor = 0;  ///< The factor, or the bound; infinite of kAtMost where nothing was found.
  /// The motion in which it buckles, of unit energy, by module; empty unless it is known or
  /// bounded from above.
  std::vector<base::Vec6<double>> mode = {};
};

struct SecondOrder {
  Buckling buckling;
  std::vector<base::Vec6<double>> displacement = {};  ///< u2, by module; empty without stiffness.
};

struct SecondOrderOptions {
  /// Factors above this are not sought, as linear theory then suffices.
  double factor_max = 10;
  bool is_factor_wanted = false;  ///< Seeks the factor whatever it is.
  std::uint64_t seed = 1;         ///< Of the motions that a search begins with.
  int thread_count = 0;           ///< 0: as many as the machine has cores.
};

/// Makes a system that can be factorized, with the same facets in the same states, beside one that
/// is iterated; null where there is none. It is called only where it takes a factorization to tell.
using DirectMaker = std::function<std::unique_ptr<LinearSystem>()>;

/// The displacement u2 and the buckling factor of a robot whose `system` has the facets of a
/// solution in their states, and u1 as its displacements by module. The loads of the system are
/// forgotten.
SecondOrder second_order(LinearSystem& system, const DirectMaker& make_direct,
                         const std::vector<base::Vec6<double>>& displacement,
                         const SecondOrderOptions& options = {});

}  // namespace holdfast::solver
