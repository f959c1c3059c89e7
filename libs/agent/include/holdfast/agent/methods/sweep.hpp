// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/groups/announcements.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/methods/front_elimination.hpp"
#include "holdfast/agent/methods/polynomial_iteration.hpp"
#include "holdfast/agent/methods/rigid_clusters.hpp"
#include "holdfast/agent/methods/tree_elimination.hpp"

namespace holdfast::agent {

struct MethodTable;

/// A method's own data; a robot's equilibrium uses one method at a time.
union MethodState {
  MethodState() : none() {}

  std::uint8_t none;
  TreeElimination elimination;
  PolynomialIteration polynomial;
  RigidClusters clusters;
  FrontElimination fronts;
};

/// Where the root is in its work, as far as its orders tell. From kElimination on there is an
/// equilibrium, by what MethodState holds.
enum class Course : std::uint8_t {
  kWaves,
  kStaged,  ///< Behind a kStage.
  kPlanned,
  kHosted,
  kWeighed,
  kElimination,
  kPolynomial,
  kClusters,
  kFronts,
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

  /// This module has come after a verdict: a kRenew is the first order that it hears.
  void adopt(Workspace& ws);

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

  /// Is there work that no message may come in between of?
  bool is_working() const { return work_ != Work::kNone; }

  /// Does a piece of that work; false if there is none.
  bool work(Workspace& ws, const Announcements& announcements);

  /// Ends the exchange under way and starts the next one; false if it has to wait.
  bool exchange(Workspace& ws);

  /// Does a piece of the method's work; false if there is none, or if it has to wait.
  bool do_piece(Workspace& ws);

  /// Begins to add up all reports, if all is done here and below; the sum goes to the parent.
  bool begin_report(const Workspace& ws);

  /// True once after each sweep: the sum of its reports is here.
  bool take_end();

  const Report& sum() const { return sum_; }

 private:
  /// What a message or an exchange has set off.
  enum class Work : std::uint8_t {
    kNone,
    kBegin,          ///< Of an order.
    kBeginCondense,  ///< Of an order: the forces for it are here at once.
    kCondense,
    kExchange,
    kReport,
    kSum,
  };

  const MethodTable* method() const;
  PlannedPart planned_part(const Workspace& ws) const;
  Pending pending() const;
  bool is_good_hosts(const Workspace& ws, const Order& order) const;
  bool is_good_answer(const Workspace& ws, const Answer& answer) const;
  bool is_good_resume(const Workspace& ws, const Order& order) const;
  bool is_good_from_kept(const Workspace& ws, const Order& order) const;
  bool is_good_seek(const Workspace& ws, const Order& order) const;
  bool is_good_begin(const Workspace& ws, const Order& order) const;
  void begin_faces(Workspace& ws, const Order& order);
  void begin_method(Workspace& ws, const Order& order);
  void make_method(Workspace& ws);
  void begin_work(Work work);
  void end_work(Workspace& ws);
  void end_exchange(Workspace& ws);
  void take_planned_down(Workspace& ws, std::span<const std::uint8_t> message);
  void take_planned_up(Workspace& ws, std::span<const std::uint8_t> message);
  bool report(Workspace& ws, const Announcements& announcements);
  void add_up(Workspace& ws);

  Order order_;
  Report sum_;
  Course course_ = Course::kWaves;
  bool is_under_way_ = false;
  bool has_ended_ = false;  ///< The sum has not been taken.
  Work work_ = Work::kNone;
  std::uint8_t piece_ = 0;  ///< Of the work; no further than 255.
  bool is_renewed_ = true;  ///< No order but those about free faces has come behind kRenew, or any.
  bool has_tree_ = false;   ///< The state is elimination's, which has learned the tree's loops.
  MethodState state_;
};

}  // namespace holdfast::agent
