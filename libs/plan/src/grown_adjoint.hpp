// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
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
  /// others. From then on answers for this state and those beyond. False if the state lacks a
  /// module of the core.
  bool grow_to(const std::vector<Element>& elements);

  /// Continues z to a module beside one that z is known for.
  void grow(std::size_t module);

  /// How many modules a state on the way has beyond the core; none if it is not on the way.
  std::optional<std::size_t> count_in(const std::vector<Element>& elements) const;

  /// Whether the module comes next, after so many.
  bool is_next(std::size_t count, std::size_t module) const {
    return count < grown_modules_.size() && base::at(grown_modules_[count]) == module;
  }

  /// q u + z (f - K u) for fz, mx and my, of displacements u that leave `rest`, f - K u,
  /// unbalanced, both by module of the target, in the state that has so many modules beyond the
  /// core.
  Triple force(const std::vector<Vec>& u, const std::vector<Vec>& rest, std::size_t count) const;

  /// What of that is due to modules beyond the core, from one to before another: z f of these, less
  /// what e puts on modules times how far these are displaced.
  Triple share(const std::vector<Vec>& u, std::size_t first, std::size_t end) const;

  /// How that of the first so many changes if modules move from where they were still: but for
  /// error_of_moved() times how far the core moves, in the energy norm.
  Triple share_of_moved(const std::vector<Vec>& u, const std::vector<Vec>& still,
                        std::size_t count) const;

  double error_of_moved(const Triple& factors) const;

  /// What |z* - z| is at most for a combination of fz, mx and my, in the state that has so many
  /// modules beyond the core.
  double error(const Triple& factors, std::size_t count) const;

 private:
  static constexpr std::int32_t kAbsent = -1;

  /// What the beam of a module that has grown puts on one that was there, as much as z moves them.
  struct Pull {
    std::size_t module = 0;
    std::array<Vec, 3> force{};
  };

  const Vec& z(std::size_t component, std::size_t module) const {
    const std::size_t place = base::at(place_[module]);
    const std::size_t core_count = core_->z.size();
    return place < core_count ? core_->z[place][component] : grown_[place - core_count][component];
  }

  bool is_known(std::size_t module) const { return place_[module] != kAbsent; }

  void shrink_to_core();
  bool is_beside(std::size_t module) const;
  std::array<double, 9> products_of_gaps(std::size_t module) const;
  void find_pulls(std::size_t module);
  void settle();
  bool leave_out(std::size_t count);
  void add_up(const Pull& pull);
  std::span<const Pull> pulls(std::size_t first, std::size_t end) const;
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
  std::vector<Triple> lift_;  ///< z f of grown modules, summed up in the same way.
  /// Of those that had grown at the last grow_to(), so many, the pulls, one of each module that is
  /// pulled, and |e|^2 of those whose pulls are left out.
  std::size_t settled_count_ = 0;
  std::vector<Pull> settled_;
  std::vector<std::int32_t> settled_place_;  ///< By module; kAbsent.
  Triple left_out_{};
  std::vector<Pull> pulls_;              ///< Of those that have grown since,
  std::vector<std::size_t> pull_count_;  ///< with none of them, with one, and so on so many.
};

using GrownAdjoints = std::vector<std::shared_ptr<GrownAdjoint>>;

}  // namespace holdfast::plan
