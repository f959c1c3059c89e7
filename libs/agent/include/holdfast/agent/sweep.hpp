// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/announcements.hpp"
#include "holdfast/agent/krylov_and_jacobi.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/polynomial_iteration.hpp"
#include "holdfast/agent/rigid_clusters.hpp"
#include "holdfast/agent/tree_elimination.hpp"
#include "holdfast/agent/workspace.hpp"

namespace holdfast::agent {

struct MethodTable;

/// A method's own data; a robot's equilibrium uses one method at a time.
union MethodState {
  MethodState() : none() {}

  std::uint8_t none;
  TreeElimination elimination;
  PolynomialIteration polynomial;
  RigidClusters clusters;
  KrylovAndJacobi gradients;
};

/// Where the root is in its work, as far as its orders tell. From kElimination on there is an
/// equilibrium, by what MethodState holds.
enum class Course : std::uint8_t {
  kWaves,
  kPlanned,
  kHosted,
  kWeighed,
  kElimination,
  kPolynomial,
  kClusters,
  kGradients,
  kAnswered,
};

/// Sweeps: an order goes down the tree, its report comes up, and most of them exchange six reals
/// between all neighbours on the way.
///
/// A module works on an order as soon as it comes, sends its vector to its neighbours, waits for
/// theirs and for its children's reports, and reports.
class Sweep {
 public:
  /// The order under way, or the last one.
  const Order& order() const { return order_; }

  /// Is the report of the order still to come?
  bool is_under_way() const { return is_under_way_; }

  /// Has the root given an order in this round?
  bool has_begun() const { return course_ != Course::kWaves; }

  /// Does work go on behind the last report that must end before another order is begun?
  bool is_busy(const Workspace& ws) const;

  /// The round is over.
  void leave(Workspace& ws);

  // ---- What may be said now.

  /// May this order come next?
  bool is_in_course(const Workspace& ws, const Order& order) const;

  /// May this message of a sweep, which is no order, come from the neighbour at `face`?
  bool expects(const Workspace& ws, Direction face, std::span<const std::uint8_t> message) const;

  // ---- What comes in.

  void take_order(Workspace& ws, Announcements& announcements, const Order& order);

  /// A message of a sweep, orders apart.
  void take(Workspace& ws, Direction face, std::span<const std::uint8_t> message);

  // ---- What follows, a piece at a time.

  /// Ends the exchange under way and starts the next one; false if it has to wait.
  bool exchange(Workspace& ws);

  /// Does a piece of the method's work; false if there is none, or if it has to wait.
  bool do_piece(Workspace& ws);

  /// Is all done here and below?
  bool can_finish(const Workspace& ws) const;

  /// Adds up all reports, and sends the sum to the parent.
  Report finish(Workspace& ws, const Announcements& announcements);

 private:
  const MethodTable* method() const;
  PlannedPart planned_part(const Workspace& ws) const;
  Pending pending() const;
  bool is_good_begin(const Order& order) const;
  void begin_method(Workspace& ws, const Order& order);
  void take_planned_down(Workspace& ws, std::span<const std::uint8_t> message);
  void take_planned_up(Workspace& ws, std::span<const std::uint8_t> message);
  Report own_report(Workspace& ws, const Announcements& announcements);

  Order order_;
  Course course_ = Course::kWaves;
  bool is_under_way_ = false;
  MethodState state_;
};

}  // namespace holdfast::agent
