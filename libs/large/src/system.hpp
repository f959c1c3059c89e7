// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/large/follow.hpp"
#include "holdfast/model/large_beams.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/solver/block_lu.hpp"

/// The equations of a robot at large displacements: forces, tangent, and its factors.
namespace holdfast::large {

using Vec = base::Vec6<double>;

/// A robot in any shape, in equilibrium or not.
struct Configuration {
  double factor = 0;  ///< lambda, of all loads.
  std::vector<mechanics::Pose> poses;
  std::vector<solver::FacetState> facets;
  /// Sideways stresses of released facets that are still there, by facet: loads on the way to none.
  /// Empty if there are none at all.
  std::vector<Vec> kept;
};

/// The largest numbers of a step or a residual, as lengths or forces.
struct Size {
  double translation = 0;  ///< mm or N
  double rotation = 0;     ///< rad or N mm
};

Size size_of(std::span<const Vec> vectors);

/// Keeps a reference to the robot. Vectors are by node: the modules that are not fixed, in order.
class System {
 public:
  /// Makes the equations of a robot; none if the factors need more memory than is allowed.
  static std::unique_ptr<System> make(const model::Robot& robot, const Options& options);

  const model::Robot& robot() const { return robot_; }

  double pitch() const { return pitch_; }

  /// The robot at rest, all facets pressed and held.
  Configuration at_rest() const;

  /// Puts every facet into the state that its strains ask for. Returns whether any changed.
  bool look_up_facets(Configuration& here) const;

  /// What the loads, times lambda, exceed the forces of beams and facets by. Finds the deformations
  /// that tangent and forces are made from.
  std::vector<Vec> residual(const Configuration& here);

  /// Factors the tangent of the last residual(), which `here` must not have left. The symmetric
  /// part if that is asked for, or no torque makes a difference. Returns false if it is singular.
  bool factor(const Configuration& here, bool is_symmetric);

  /// Stiffens each module in tangents that are factored from now on: by this share of the largest
  /// load times the pitch, for a pitch or 1 rad.
  void set_shift(double share) { shift_ = share * load_size_ * pitch_; }

  /// Whether the tangent that was factored, symmetric, is positive definite.
  bool is_definite() const { return lu_->is_positive_definite(); }

  /// Solves with the factors.
  std::vector<Vec> solve(std::vector<Vec> right) const;

  /// The loads for lambda = 1, by node.
  const std::vector<Vec>& loads() const { return loads_; }

  /// The largest force of a load, or torque over the pitch, N.
  double load_size() const { return load_size_; }

  /// Goes a step from `here`.
  void move(Configuration& here, std::span<const Vec> step, double share) const;

  /// A vector by node of one by module.
  std::vector<Vec> by_node(const std::vector<Vec>& by_module) const;

  /// The module of a node.
  std::size_t module_of(std::size_t node) const { return module_of_node_[node]; }

  /// The stresses with which a facet is held against slip and twist; 0 for all others.
  Vec sideways_stress(const Configuration& here, std::size_t facet) const;

  /// All that is to be known of an equilibrium, of which residual() was the last call.
  State state(const Configuration& here) const;

  /// The strain at the edge of a connection's facet, of the last residual().
  double edge_strain(std::size_t connection) const;

  int factor_count() const { return factor_count_; }

 private:
  System(const model::Robot& robot, const Options& options);

  bool make_factors(const Options& options);

  const mechanics::LargeBeam& beam(base::Direction direction) const { return beams_[direction]; }

  mechanics::BeamDeformation facet_deformation(const Configuration& here, std::size_t facet) const;
  Vec facet_stress(const Configuration& here, std::size_t facet,
                   const mechanics::BeamDeformation& deformation) const;
  mechanics::EndForces facet_forces(const Configuration& here, std::size_t facet) const;
  void add_facet_tangents(const Configuration& here, std::vector<base::Mat6<double>>& diagonal);

  const model::Robot& robot_;
  model::LatticeBeam<double> lattice_beam_;
  solver::FacetLaw<double> law_;
  model::LargeBeams beams_;
  double pitch_;
  bool is_bonded_;
  int thread_count_;
  host::Team team_;
  std::vector<std::int32_t> node_of_module_;  ///< -1 for fixed modules.
  std::vector<std::size_t> module_of_node_;
  std::vector<Vec> loads_;
  double load_size_ = 0;
  double shift_ = 0;
  bool has_torques_ = false;
  std::vector<model::Connection> connections_;
  std::vector<mechanics::BeamDeformation> deformations_;
  std::vector<mechanics::BeamDeformation> facet_deformations_;
  std::optional<solver::BlockLu> lu_;
  int factor_count_ = 0;
};

}  // namespace holdfast::large
