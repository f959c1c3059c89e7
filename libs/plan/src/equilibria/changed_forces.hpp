// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// How far forces s that balance all loads, and those of displacements, h w, are from what both
/// were when a robot was solved: in the middle of each beam and facet six, local frame, of springs
/// h that know nothing of each other. Where nothing was solved both were nothing.
class ChangedForces {
 public:
  using Vec = base::Vec6<double>;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  explicit ChangedForces(const model::Robot& target);

  /// Where the module's node is, in mm; the last three are 0.
  const Vec& place(std::size_t module) const { return places_[module]; }

  /// Six numbers stiffness, h.
  const Vec& stiffness() const { return stiffness_; }

  /// The sum of squares of a force over the stiffness.
  double energy_of(const Vec& force) const;

  /// What a load about the origin that a module hands on in a direction is in the middle of its
  /// beam or facet there.
  Vec middle(const Vec& load, std::size_t module, int direction) const;

  /// Forgets all changes.
  void clear();

  /// |s - h w|^2 of all that was weighed.
  double energy() const { return energy_; }

  /// The largest load ratio of half of what s and h w have changed by together, in any beam at any
  /// time since the last clear() or weigh_all().
  double load_ratio() const { return load_ratio_; }

  /// The largest load ratio of half of what s and h w have changed by together, turned round, in
  /// any beam now.
  double load_ratio_turned() const;

  /// A module hands on one more load, about the origin, to its neighbour in a direction.
  void hand_on(std::size_t module, int direction, const Vec& load);

  /// A module hands on this load there instead of all that it has handed on so far.
  void hand_on_only(std::size_t module, int direction, const Vec& load);

  /// The beam to a neighbour carries what these displacements of its ends mean besides.
  void bear(std::size_t module, int direction, const Vec& u_module, const Vec& u_other);

  /// A facet carries one more force; not weighed yet.
  void bear(std::size_t facet, const Vec& force) { base::add_to(facet_of(facet).change, force); }

  /// What h w of a beam is now, if it was nothing.
  void open_gap(std::size_t module, int direction, const Vec& u_module, const Vec& u_other);

  /// Weighs a facet, where h w has changed by `moved`.
  void weigh_facet(std::size_t facet, const Vec& moved);

  /// Weighs all beams anew.
  void weigh_all();

  Vec facet_change(std::size_t facet) const { return facets_[facet].change; }

  struct Spring {
    std::size_t index = 0;  ///< Of a beam: by module, then every other direction from it.
    Vec change{};           ///< Of s.
    Vec gap{};              ///< Of h w.
    double energy = 0;
  };

  /// The beams that have changed since the last clear().
  const std::vector<Spring>& beams() const { return beams_; }

  /// The facets that may have, some several times.
  const std::vector<std::size_t>& facets() const { return changed_facets_; }

  double facet_energy(std::size_t facet) const { return facets_[facet].energy; }

  /// The load ratio of half of what s and h w of a beam have changed by together.
  double half_ratio(const Spring& beam) const { return ratio_of(beam, 1) / 2; }

  /// The beam from a module in a direction if h w is all that changes, by how its ends lie.
  Spring gap_between(std::size_t module, int direction, const Vec& u_module,
                     const Vec& u_other) const;

 private:
  static constexpr std::int32_t kNone = -1;

  std::size_t index_of(std::size_t module, int direction) const;

  /// Beams are known by the end from which they have an even direction.
  Spring& beam_from(std::size_t module, int direction);
  void weigh(Spring& beam);
  double ratio_of(const Spring& beam, double factor) const;

  Spring& facet_of(std::size_t facet) {
    changed_facets_.push_back(facet);
    return facets_[facet];
  }

  Vec along(std::size_t module, int direction, const Vec& load) const;
  Vec force_between(int direction, const Vec& u_module, const Vec& u_other) const;

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};
  std::size_t half_ = 0;                     ///< Of the number of directions.
  std::vector<Vec> places_;                  ///< By module.
  std::vector<std::int32_t> place_of_beam_;  ///< In beams_, by index; or kNone.
  std::vector<Spring> beams_;                ///< Those that have changed.
  std::vector<Spring> facets_;
  std::vector<std::size_t> changed_facets_;  ///< Some several times.
  double energy_ = 0;
  double load_ratio_ = 0;
};

}  // namespace holdfast::plan
