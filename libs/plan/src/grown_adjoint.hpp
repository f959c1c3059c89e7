// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "facet_adjoint.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "local_balance.hpp"

namespace holdfast::plan {

/// A facet's adjoint, continued to modules with which a robot grows after its core, one after
/// another. It serves all states on that way at once: those that have the core and the first so
/// many of these modules.
class GrownAdjoint {
 public:
  using Vec = base::Vec6<double>;

  /// Factors of fz, mx and my, or these.
  using Triple = std::array<double, 3>;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  GrownAdjoint(const model::Robot& target, std::shared_ptr<const FacetAdjoint> core);

  /// Of the target.
  std::size_t facet() const { return core_->facet; }

  /// Continues z to all modules of a connected state; from the core if it has been continued to
  /// others. False if the state lacks a module of the core.
  bool grow_to(const std::vector<Element>& elements);

  /// Continues z to a module beside one that z is known for.
  void grow(std::size_t module);

  /// How many modules a state on the way has beyond the core; none if it is not on the way.
  std::optional<std::size_t> count_in(const std::vector<Element>& elements) const;

  /// Whether the module comes next, after so many.
  bool is_next(std::size_t count, std::size_t module) const {
    return count < grown_modules_.size() && base::at(grown_modules_[count]) == module;
  }

  /// z (f - K u) for fz, mx and my, where displacements leave f - K u unbalanced, by module of the
  /// target, in the state that has so many modules beyond the core.
  Triple work(const std::vector<Vec>& rest, std::size_t count) const;

  /// What the module that comes after so many adds to work(): by its load, its facets and its beams
  /// to modules that are there.
  Triple work_of_next(std::size_t count, const std::vector<Vec>& u) const;

  /// What |z* - z| is at most for a combination of fz, mx and my, in the state that has so many
  /// modules beyond the core.
  double error(const Triple& factors, std::size_t count) const;

 private:
  static constexpr std::int32_t kAbsent = -1;

  const Vec& z(std::size_t component, std::size_t module) const {
    const std::size_t place = base::at(place_[module]);
    const std::size_t core_count = core_->z.size();
    return place < core_count ? core_->z[place][component] : grown_[place - core_count][component];
  }

  bool is_known(std::size_t module) const { return place_[module] != kAbsent; }

  void shrink_to_core();
  bool is_beside(std::size_t module) const;
  std::array<double, 9> products_of_gaps(std::size_t module) const;
  template <class Each>
  void for_each_beam(std::size_t module, const Each& each) const;
  template <class Each>
  void for_each_facet(std::size_t module, const Each& each) const;

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};  ///< Of the springs in the middle, h.
  std::shared_ptr<const FacetAdjoint> core_;
  LocalBalance local_;                     ///< What z is known for.
  std::vector<std::int32_t> place_;        ///< By module: in the core's z, then in grown_; kAbsent.
  std::vector<std::array<Vec, 3>> grown_;  ///< z beyond the core,
  std::vector<Element> grown_modules_;     ///< and whose it is.
  /// <e_i, e_k>, by rows, with no module beyond the core, with one, and so on.
  std::vector<std::array<double, 9>> gram_;
};

using GrownAdjoints = std::vector<std::shared_ptr<GrownAdjoint>>;

}  // namespace holdfast::plan
