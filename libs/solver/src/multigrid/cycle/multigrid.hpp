// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "holdfast/solver/linear_system.hpp"
#include "multigrid/coarsening/reduced_network.hpp"
#include "multigrid/cycle/conjugate_gradients.hpp"
#include "multigrid/hierarchy/condensation.hpp"

namespace holdfast::solver {

/// A robot's equations without a factorization: static condensation (ReducedNetwork), conjugate
/// gradients, multigrid preconditioner.
class Multigrid final : public LinearSystem {
 public:
  /// Makes the system; none if it needs more memory than the options allow.
  static std::unique_ptr<Multigrid> make(const model::Robot& robot,
                                         const EquilibriumOptions& options);

  Multigrid(const model::Robot& robot, const EquilibriumOptions& options);

  /// A guess of how much memory a robot needs, bytes.
  static std::size_t bytes_for(const model::Robot& robot, Precision precision);

  /// Starts anew in another precision, with the same network and facets. Returns false, and leaves
  /// all as it is, if that needs more memory than the options allow.
  [[nodiscard]] bool set_precision(Precision precision);

  [[nodiscard]] LinearOutcome solve(double tolerance) override;
  [[nodiscard]] LinearOutcome approach() override;
  std::vector<Vec> displacement() override;
  std::vector<Vec> facet_displacement() override;
  [[nodiscard]] bool refine(Solution& solution) override;
  void hand_over(Solution& solution, Further further) override;

  bool is_exact() const override { return false; }

  /// Taken from the preconditioner, and more where the iteration converges slowly: it then misses
  /// more of the error.
  std::vector<double> facet_errors() const override;
  double energy_error() const override;
  LinearReport report() const override;

 private:
  /// The node of a facet, by its place in facets().
  struct GroundNode {
    std::int32_t node = 0;
    std::size_t facet = 0;
    std::size_t beam = 0;  ///< Its place among the network's ground beams.
    FacetState known;      ///< The state that the residual knows.
  };

  /// Until when to iterate: errors in the energy norm.
  struct Target {
    double tolerance = 0;  ///< As a share of the error of no displacements at all.
    double error_max = std::numeric_limits<double>::infinity();
    int iteration_count_min = 0;  ///< As long as errors are more than rounding.
  };

  void take_law() override;
  void take_facet(std::size_t facet) override;
  void take_loads() override;
  void take_changed_loads(const model::Loads& before) override;

  std::uint8_t number_of(const FacetState& facet) const;
  void condense_loads();
  const Vec& load_of(std::size_t node) const;
  Vec displacement_of(std::int32_t node);
  Vec force_on(const FacetState& facet, std::int32_t node);
  const Mat& known_tangent(const FacetState& facet) const;

  host::Ranks& ranks() const { return robot().ranks(); }

  bool is_too_slender() const;
  bool is_thin() const;
  bool is_wide_on_feet() const;
  std::vector<std::int32_t> nodes_alone() const;
  LinearOutcome begin();
  LinearOutcome improve(const Target& target);
  double take_back_weak_springs();
  double take_back_weak_forces(std::vector<Vec>& taken);
  std::unique_ptr<Iteration> make_iteration();
  std::vector<double>& x();
  std::vector<Vec> by_module(std::vector<double>& x);
  void update_iteration();
  void compute_residual();
  void update_residual();
  std::vector<NodeTerm> unsymmetric_terms() const;

  EquilibriumOptions options_;
  Precision precision_;
  Team team_;
  ReducedNetwork network_;
  std::unique_ptr<host::Halo> module_copies_;  ///< Of other ranks' modules.
  std::unique_ptr<host::Halo> node_copies_;
  CondensedLoads condensed_;              ///< Where they are not the robot's own.
  std::vector<GroundNode> ground_nodes_;  ///< In the network's order; a node for each facet.
  std::vector<std::size_t> ground_node_of_facet_;  ///< By place in facets().
  std::vector<std::int32_t> alone_;                ///< Nodes that join no cluster.
  GroundTable known_tangents_;  ///< What the hierarchy takes for the facets' tangents.
  std::unique_ptr<Iteration> iteration_;
  std::vector<double> no_x_;        ///< Empty.
  bool is_law_new_ = false;         ///< Everything must be made again.
  bool is_contact_new_ = false;     ///< The iteration does not know all facets' states.
  bool is_residual_known_ = false;  ///< But for facets that changed.
  bool is_stale_ = true;            ///< Some facet, the law or the loads changed since solve().
  double reference_ = 0;            ///< Square of the first error,
  double error_ = 0;                ///< and of the last one that was estimated.
  double energy_error_ = 0;         ///< (N mm)^(1/2), what the last solution was to have.
  int solve_count_ = 0;
  int iteration_count_ = 0;
  int last_count_ = 0;  ///< Iterations of the last solution, for its system.
  int told_count_ = 0;
};

}  // namespace holdfast::solver
