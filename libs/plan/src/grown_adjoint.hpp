// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "facet_adjoint.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "local_balance.hpp"

namespace holdfast::plan {

/// A facet's adjoint that is continued while a robot grows, and what z says of the facet's force
/// for displacements that are not in balance (FacetAdjoint).
class GrownAdjoint {
 public:
  using Vec = base::Vec6<double>;

  /// Factors of fz, mx and my, or these.
  using Triple = std::array<double, 3>;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  GrownAdjoint(const model::Robot& target, std::shared_ptr<const FacetAdjoint> core);

  const std::shared_ptr<const FacetAdjoint>& core() const { return core_; }

  /// Continues z to all modules of a connected state. False if it lacks one that z is known for.
  bool grow_to(const std::vector<Element>& elements);

  /// Continues z to a module beside one that z is known for.
  void grow(std::size_t module);

  /// Takes what displacements leave unbalanced, f - K u, by module of the target.
  void set_rest(const std::vector<Vec>& rest);

  /// Directly after grow(): adds what the displacements of the module, and those of its neighbours
  /// that it has been attached to, leave unbalanced by its beams and its load.
  void add_rest(std::size_t module, const std::vector<Vec>& u);

  /// z (f - K u) for fz, mx and my.
  const Triple& work() const { return work_; }

  /// What |z* - z| is at most for a combination of fz, mx and my.
  double error(const Triple& factors) const;

 private:
  const Vec& z(std::size_t component, std::size_t module) const {
    const std::size_t place = base::at(place_[module]);
    const std::size_t core_count = core_->z.size();
    return place < core_count ? core_->z[place][component] : grown_[place - core_count][component];
  }

  bool is_beside(std::size_t module) const;
  void weigh(std::size_t module);
  template <class Each>
  void for_each_beam(std::size_t module, const Each& each) const;
  template <class Each>
  void for_each_facet(std::size_t module, const Each& each) const;

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};  ///< Of the springs in the middle, h.
  std::shared_ptr<const FacetAdjoint> core_;
  LocalBalance local_;                     ///< What z is known for.
  std::vector<std::int32_t> place_;        ///< By module: in the core's z, then in grown_.
  std::vector<std::array<Vec, 3>> grown_;  ///< z beyond the core,
  std::vector<Element> grown_modules_;     ///< and whose it is.
  Triple work_{};
  std::array<double, 9> gram_{};  ///< <e_i, e_k>, by rows.
};

}  // namespace holdfast::plan
