// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "conjugate_gradients.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/precision.hpp"
#include "reduced_network.hpp"

/// Displacements of a robot for given contact states, without a factorization: what BlockLu is for
/// small robots. Elimination by hand (ReducedNetwork), conjugate gradients, multigrid
/// preconditioner.
namespace holdfast::solver {

struct MultigridOptions {
  Precision precision = Precision::kSingle;
  bool may_yield = true;  ///< Whether facets' states will be other than stuck.
  int thread_count = 0;   ///< 0: all cores.
  std::function<void(int iteration, double error)> progress = {};
};

class Multigrid {
 public:
  using Vec = base::Vec6<double>;

  /// Keeps a reference to the robot. All facets are stuck until set_facet().
  Multigrid(const model::Robot& robot, MultigridOptions options);

  /// A guess of how much memory a robot needs, bytes.
  static std::size_t bytes_for(std::size_t module_count, Precision precision);

  Precision precision() const { return precision_; }

  /// Starts anew in another precision, with the same network and facets.
  void set_precision(Precision precision);

  /// Puts all facets back to stuck, under another law.
  void set_law(const mechanics::GroundFacet<double>& facet);
  void set_facet(std::size_t module, const mechanics::ContactState& state, bool is_held);

  /// Another load than the weight, by module; the displacements begin at zero again.
  void set_load(std::vector<Vec> load);

  /// Whether anything changed since the last solution; if not, solve() goes on with that system.
  bool is_new() const { return is_stale_; }

  /// Goes on from the present displacements until the error in the energy norm is `tolerance` times
  /// that of the first guess, zero, and at most `energy_error_max`. Returns false if it does not
  /// get there, or the robot is too slender for the precision. As long as errors are more than
  /// rounding, at least `iteration_count_min` iterations.
  bool solve(double tolerance, int iteration_count_min = 0,
             double energy_error_max = std::numeric_limits<double>::infinity());

  /// The error that the last solution was to have in the energy norm, (N mm)^(1/2), by estimate.
  double energy_error() const { return energy_error_; }

  /// Whether bending is that of chains: the network has few nodes, and these few neighbours. A
  /// single beam may then have a large part of the whole error's energy.
  bool is_thin() const;

  /// About what the displacement of a module on the ground is still off by. After solve().
  Vec facet_correction(std::size_t module) const;

  /// By module.
  std::vector<Vec> displacement();

  int iteration_count() const { return iteration_count_; }

  /// Of the last solution, for its system.
  int last_count() const { return last_count_; }

 private:
  struct Facet {
    std::int32_t node = 0;
    std::uint8_t code = 0;      ///< 0: stuck, a beam like any other.
    std::uint8_t old_code = 0;  ///< The one that the residual knows.
    mechanics::ContactState state;
    bool is_held = true;
  };

  Mat tangent(std::uint8_t code) const;
  Vec force(std::uint8_t code, std::size_t node) const;
  bool is_too_slender() const;
  std::vector<std::int32_t> nodes_alone() const;
  bool begin();
  std::unique_ptr<Iteration> make_iteration();
  void update_iteration();
  void compute_residual();
  void update_residual();
  std::vector<NodeTerm> unsymmetric_terms() const;

  const model::Robot& robot_;
  Precision precision_;
  Team team_;
  ReducedNetwork network_;
  mechanics::GroundFacet<double> ground_;
  Vec weight_{};
  std::vector<std::int32_t> facet_of_module_;
  std::vector<Facet> facets_;
  std::vector<std::int32_t> alone_;  ///< Nodes that join no cluster.
  std::unique_ptr<Iteration> iteration_;
  bool is_law_new_ = false;         ///< Everything must be made again.
  bool is_residual_known_ = false;  ///< But for facets that changed.
  bool may_yield_ = true;
  std::function<void(int, double)> progress_;
  bool is_stale_ = true;  ///< Some facet changed since the last solve.
  double reference_ = 0;  ///< Square of the first error.
  double energy_error_ = 0;
  int iteration_count_ = 0;
  int last_count_ = 0;
  int told_count_ = 0;
};

}  // namespace holdfast::solver
