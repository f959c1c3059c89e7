// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "multigrid/cycle/cycle.hpp"
#include "multigrid/cycle/iteration.hpp"

/// Flexible preconditioned conjugate gradients [Notay 2000]. Displacements are kept in
/// double precision, residuals in 39 bits, less of them the smaller they are (split_numbers.hpp);
/// search directions in the preconditioner's precision, but what they do to x and r is computed
/// from the same rounded direction in double precision, so x and r do not part.
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

  void update_contact() override;

  void subtract_product() override;
  double begin() override;
  End run(const Goal& goal) override;
  bool step() override;
  End run_unsymmetric(const Goal& goal, std::span<const NodeTerm> terms) override;
  base::Vec6<double> correction(std::size_t node) override;
  void mark() override;
  std::vector<double> marked() override;
  void rest() override;
  void retire() override;
  base::Vec6<double> residual(std::size_t node) override;
  void set_residual(std::size_t node, const base::Vec6<double>& residual) override;

 private:
  /// One that A made unsymmetric runs remember.
  struct Direction {
    std::vector<Six<Real>> p;
    std::vector<Six<Real>> image;  ///< A^T p, rounded like p.
    double curvature = 0;          ///< p . A p
  };

  enum class State : std::uint8_t { kOnTheWay, kReached, kStuck };
  State state(const Goal& goal, int iteration);
  bool is_reached(const Goal& goal, int iteration) const;
  bool is_stuck(const Goal& goal, int iteration);

  double sum(double mine) { return host::sum(hierarchy_.ranks(0), mine); }

  void update_copies(std::vector<Six<Real>>& items) {
    hierarchy_.update_copies(0, std::span(items));
  }

  /// M^-1 r, after a cycle.
  std::span<const Six<Real>> preconditioned() { return hierarchy_.levels().front().z; }

  bool iterate(const host::KrylovTask::IsOver& is_over);
  bool go_on_with_product();
  bool go_on_without_product();
  bool is_product_kept() const;
  std::array<double, 2> compare(std::span<const Six<Real>> z);
  double advance_by_product(double step);
  End run_by_another(const Goal& goal, host::KrylovTask& task);
  void turn_from_last_direction();
  void multiply(const double* p, double* q);
  double run_cycle();
  double precondition();
  std::array<double, 2> precondition_and_compare();
  double multiply();
  void advance(double step);
  void count_step(double step);
  void turn();
  void copy_residual(double* numbers);
  void take_residual(const double* numbers);
  void write_gain();
  void tell() const;
  double own_residual_dot(std::span<const Six<Real>> z);
  double own_dot_with_z(const std::vector<double>& a);

  // orthogonalization.cpp
  bool is_still_reached(const Goal& goal, int iteration, double before);
  End run_by_last_direction(const Goal& goal, std::span<const NodeTerm> terms);
  bool go_on_with_product(std::span<const NodeTerm> terms);
  bool go_on_without_product(std::span<const NodeTerm> terms);
  double turn_to_curvature(std::span<const NodeTerm> terms);
  void turn_away_from(const std::vector<Direction>& older);
  Direction multiply_direction(std::span<const NodeTerm> terms);
  End run_by_all_directions(const Goal& goal, std::span<const NodeTerm> terms,
                            std::size_t direction_count);

  SplitView<float> gain() { return {.rounded = gain_.data(), .low = gain_low_.data()}; }

  void take_gain();
  void drop_direction();

  /// The residual; its rounded part is the finest level's.
  SplitView<Real> r() {
    return {.rounded = hierarchy_.levels().front().r.data(), .low = low_.data()};
  }

  Team& team_;
  Hierarchy<Real> hierarchy_;
  Cycle<Real> cycle_;
  std::size_t node_count_;         ///< Of a part of a robot this rank's own.
  bool is_solid_;                  ///< And of cubes.
  std::size_t place_count_;        ///< With copies of others'.
  std::vector<std::int16_t> low_;  ///< The low parts of r.
  std::vector<double> q_;          ///< Empty at rest.
  std::vector<Six<Real>> p_;
  std::optional<double> turn_;       ///< By which p_ is yet to be turned.
  std::optional<double> curvature_;  ///< p . K p where z has yet to be compared with p_.
  bool is_marked_ = false;           ///< If so, x has changed since by the gain
  std::optional<double> last_step_;  ///< and so many p_.
  std::vector<Six<float>> gain_;     ///< Empty as long as there is none.
  std::vector<std::int16_t> gain_low_;
  bool has_last_direction_ =
      false;  ///< p_ is that of a run of ranks, from which r has not changed.
  double error_ = 0;
  double least_error_ = 0;  ///< Of this run,
  int least_at_ = 0;        ///< and in which iteration.
};

}  // namespace holdfast::solver
