// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "cycle.hpp"
#include "iteration.hpp"

/// Flexible preconditioned conjugate gradients [Notay 2000]. Displacements and residuals are kept
/// in double precision; search directions in that of the preconditioner, but what they do to x and
/// r is computed from the same rounded direction in double precision, so x and r never part.
namespace holdfast::solver {

template <class Real>
class ConjugateGradients final : public Iteration {
 public:
  /// Keeps references to the network, the material and the table of what facets are. Of a whole
  /// robot takes the network's order and keys away.
  ConjugateGradients(ReducedNetwork& network, const model::Material& material, Team& team,
                     const GroundTable& ground, std::span<const std::int32_t> alone);

  bool is_too_slender() const override { return hierarchy_.is_too_slender(); }

  bool is_singular() const override { return hierarchy_.is_singular(); }

  void update_contact() override { hierarchy_.update_contact(); }

  void subtract_product() override;
  double begin() override;
  End run(const Goal& goal) override;
  End run_unsymmetric(const Goal& goal, std::span<const NodeTerm> terms) override;
  base::Vec6<double> correction(std::size_t node) override;
  void rest() override;

 private:
  /// One that A made unsymmetric runs remember.
  struct Direction {
    std::vector<Six<Real>> p;
    std::vector<double> image;  ///< A^T p
    double curvature = 0;       ///< p . A p
  };

  enum class State : std::uint8_t { kOnTheWay, kReached, kStuck };
  State state(const Goal& goal, int iteration);
  bool is_reached(const Goal& goal, int iteration) const;
  bool is_stuck(const Goal& goal, int iteration);

  double sum(double mine) { return host::sum(hierarchy_.ranks(0), mine); }

  void update_copies(std::vector<Six<Real>>& items) { hierarchy_.update_copies(0, items); }

  template <class IsOver>
  bool iterate(const IsOver& is_over);
  End run_by_another(const Goal& goal, host::KrylovTask& task);
  void turn_from_last_direction();
  void multiply(const double* p, double* q);
  void run_cycle();
  double precondition();
  std::array<double, 2> precondition_and_compare();
  double multiply();
  void advance(double step);
  void tell() const;
  double own_dot_with_z(const std::vector<double>& a);
  double dot_with_z(const std::vector<double>& a);
  void round_residual();
  void turn_away_from_older();
  double remember_direction(std::span<const NodeTerm> terms);

  Team& team_;
  Hierarchy<Real> hierarchy_;
  Cycle<Real> cycle_;
  std::size_t node_count_;   ///< Of a part of a robot this rank's own.
  std::size_t place_count_;  ///< With copies of others'.
  std::vector<double> q_;    ///< Empty at rest.
  std::vector<Six<Real>> p_;
  bool has_last_direction_ =
      false;  ///< p_ is that of a run of ranks, from which r has not changed.
  std::vector<Direction> older_;
  double error_ = 0;
  double least_error_ = 0;  ///< Of this run,
  int least_at_ = 0;        ///< and in which iteration.
};

}  // namespace holdfast::solver
