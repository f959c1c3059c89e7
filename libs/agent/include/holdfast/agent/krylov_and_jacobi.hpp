// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/exchange_method.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

/// Conjugate gradients, and the paper's Jacobi iterations: linear solves for a correction g, from
/// one residual to the next. The loop that their orders belong to is described in conductor.hpp,
/// the vectors in node.hpp.
class KrylovAndJacobi : public ExchangeMethod {
  static constexpr int kSlopePlaces = 5;

 public:
  bool begin(Workspace& ws, const Order& order, int piece);

  bool take_exchange(Workspace& ws, const Order& order, int piece);

  /// The preconditioner's polynomial has the diagonal blocks of planned modules apart, and only the
  /// last exchange of a sweep, for w = A z, has their beams in it.
  static PlannedPart planned_part(const Workspace& ws, const Order& order);

  bool report(Workspace& ws, const Order& order, int piece, Report& sum);

 private:
  Gradients& vectors(int node) {
    return Workspace::is_own_node(node) ? vectors_[static_cast<std::size_t>(node)]
                                        : more_vectors(node);
  }

  const Gradients& vectors(int node) const {
    return Workspace::is_own_node(node) ? vectors_[static_cast<std::size_t>(node)]
                                        : more_vectors(node);
  }

  /// Of a planned module for which there is no room here.
  Gradients& more_vectors([[maybe_unused]] int node) const {
    return more_->gradients[static_cast<std::size_t>(node - kPlannedMax - 1)];
  }

  void move(Workspace& ws, const Order& order);
  void start_solve(Workspace& ws, const Order& order, int part, int node);
  void iterate_gradient(Workspace& ws, const Order& order, int node);
  void precondition(Workspace& ws, int node, int degree, bool is_joined);
  void share_correction(Workspace& ws) const;
  void find_images(Workspace& ws, const Order& order);
  void next_term(Workspace& ws, const Order& order, int node);
  void iterate_jacobi(Workspace& ws);
  void iterate_jacobi(Workspace& ws, int node, double& error);

  bool report_residual(Workspace& ws, const Order& order, int piece, Report& report);
  void report_products(const Workspace& ws, Report& report) const;
  bool report_slopes(const Workspace& ws, const Order& order, int piece, Report& report);
  void report_mix(const Workspace& ws, Report& report) const;

  std::array<Gradients, 1 + kPlannedMax> vectors_{};
  MorePlanned* more_ = nullptr;                ///< Not owned; may be null.
  std::array<double, kSlopePlaces> slopes_{};  ///< While they are added up.
  float rho_ = 0;                              ///< Coefficient of the polynomial preconditioner.
  float jacobi_error_ = 0;  ///< The bound on the error that the last Jacobi iteration has found.
  bool is_first_iteration_ = false;  ///< The first iteration of a Jacobi method is next.
  bool is_scalar_ = false;           ///< Scalar diagonal instead of blocks.
};

}  // namespace holdfast::agent
