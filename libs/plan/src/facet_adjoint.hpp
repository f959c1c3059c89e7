// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// How a facet's force answers to loads anywhere on a robot, the *core*: its adjoint displacements.
///
/// Let q u be fz, mx or my of the facet for displacements u, all facets stuck, and z the core's
/// displacements under the load q, K_0 z = q. By reciprocity q u = z f for the displacements under
/// loads f. A robot that has grown since has more beams: z is continued to new modules, each in
/// balance with its neighbours, and e = h w(z) are the forces of the beams and facets that the core
/// has not. With displacements u of the grown robot that leave f - K u unbalanced, and its exact
/// ones u*,
///   q u* = q u + z (f - K u) + (z* - z) K (u* - u),      |z* - z| <= |e| + the error of z.
/// as K z* = q. The last holds as z* minimises 1/2 z K z - q z, and z misses the minimum by
/// 1/2 |z* - z|^2: of the core's part z is the minimum itself, and the rest of it is 1/2 |e|^2.
/// Far from the facet e is small, and where a module hangs on one other it is zero. So the force is
/// known but for the product of two errors [Becker 2001].
///
/// That is also q u* = z f - (K z - q) u + ..., and K z - q is next to nothing but where modules
/// have been attached: there it is what e puts on them, and on the core what its solution has left.
/// So once the whole sum is known for some u_0 of a state, it takes a sum over new modules to know
/// it for other u and later states, but for (the error of z) |u - u_0|.
struct FacetAdjoint {
  using Vec = base::Vec6<double>;

  std::size_t facet = 0;                             ///< Of the target.
  std::array<Vec, 3> load{};                         ///< q on its module, for fz, mx and my.
  std::shared_ptr<const std::vector<Element>> core;  ///< Its modules, of the target, ascending.
  std::vector<std::array<Vec, 3>> z;                 ///< By place in the core, for fz, mx and my.
  std::array<double, 3> error{};                     ///< Of z, in the energy norm.
};

using FacetAdjoints = std::vector<std::shared_ptr<const FacetAdjoint>>;

/// Finds the adjoints of facets, by index in the target, of a robot all whose facets are stuck;
/// none of those that cannot be solved, nor of any more when it is late. The number of threads
/// makes no other difference.
FacetAdjoints find_adjoints(const model::RobotSpec& spec, const model::Robot& target,
                            const ElementSet& core, const std::vector<std::size_t>& facets,
                            int thread_count, const std::function<bool()>& is_late);

}  // namespace holdfast::plan
