// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// Certifies that a robot stays safe while modules are attached to it, without solving it again.
///
/// Let u be the displacements of the solved robot, and s the forces of its springs, in the middle
/// of each beam and facet six that know nothing of each other, with stiffness h. A module that is
/// attached moves as its neighbour does, rigidly, and its load goes down a tree of beams to a
/// support: so there are displacements u with gaps w, and forces s that balance all loads. By
/// [Prager 1947] the exact forces s* lie on the sphere whose diameter joins s and h w:
///   |s* - (s + h w) / 2| = |s - h w| / 2,      |x|^2 = sum x_i^2 / h_i.
/// A load ratio c is convex and homogeneous, so with r = load_ratio_per_energy_norm()
///   c(s*) <= c((s + h w) / 2) + r |s - h w| / 2 <= c(solved) + c(change of s) / 2 + r |s - h w| /
///   2,
/// and what a facet lacks to tilting is off by sqrt(h_m + h_f b^2) |s - h w| / 2 at most, b being
/// half its width. If nothing breaks by that and every facet presses all over, then that is the
/// equilibrium of the paper's law, with all facets stuck. Each module costs the length of its way
/// down.
class EnergyBound {
 public:
  /// Keeps a reference to the whole robot.
  explicit EnergyBound(const model::Robot& target);

  /// Begins with a solved robot, whose modules are `elements` of the target, in that order. False
  /// if nothing can be built on it: it is not safe, a facet tilts or is open, or the polygon does
  /// not decide.
  bool begin(const std::vector<Element>& elements, const verdict::Assessment& solved);

  /// Attaches a module, which must be beside one that is there. Returns a bound of the largest load
  /// ratio, or none if the robot may be unsafe; it is then to be solved.
  std::optional<double> add(Element module);

 private:
  using Vec = base::Vec6<double>;

  struct Node {
    bool is_there = false;
    bool is_new = false;       ///< Attached since the robot was solved.
    std::int32_t parent = -1;  ///< Towards the support; -1 at one.
    int down = 0;              ///< Direction to the parent.
    std::int32_t depth = 0;
    Vec u{};            ///< Displacement.
    Vec carried{};      ///< New loads that it hands on, about the origin; global frame.
    double energy = 0;  ///< Of what its beam to the parent, or its facet, lacks; twice.
  };

  bool has_root(std::size_t module) const;
  void hang(std::size_t module);
  void take_place(std::size_t module);
  double close_loops(std::size_t module);
  void carry(std::size_t from);
  Vec middle(std::size_t module, int direction) const;
  double energy_of(const Vec& force) const;
  double ratio_of(std::size_t a, std::size_t b, int direction, const Vec& force) const;
  void look_at_facet(std::size_t facet);
  double room() const;

  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};  ///< Of the springs in the middle, h.
  double ratio_per_norm_ = 0;
  double facet_per_norm_x_ = 0;  ///< How much a facet's lack may be off, by norm.
  double facet_per_norm_y_ = 0;
  std::vector<base::Vec6<double>> places_;  ///< Nodes, mm; the last three are 0.
  std::vector<std::size_t> first_facet_;    ///< By module; facets of module i begin there.
  std::vector<Node> nodes_;
  std::vector<std::size_t> facets_;  ///< There, by index in the target.
  std::vector<double> room_;         ///< By facet of the target: what |s - h w| / 2 may be.
  double solved_ratio_ = 0;
  double solved_error_ = 0;
  double energy_ = 0;        ///< |s - h w|^2
  double change_ratio_ = 0;  ///< The largest c(change of s) / 2 so far.
};

}  // namespace holdfast::plan
