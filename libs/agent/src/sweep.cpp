// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/sweep.hpp"

#include "holdfast/agent/feet.hpp"
#include "holdfast/agent/messages.hpp"
#include "holdfast/agent/operations.hpp"
#include "method.hpp"
#include "survey.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;

/// Whether an order with exchanges begins with them: kTreeIterate first finds displacements,
/// kClusters clusters.
bool starts_at_once(Operation operation) {
  return operation != Operation::kTreeIterate && operation != Operation::kClusters;
}

/// Where an order leads; what it must not lead to has been refused before.
Course course_after(const Order& order, Course course) {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return Course::kPlanned;
    case Operation::kHosts:
      return Course::kHosted;
    case Operation::kMass:
      return Course::kWeighed;
    case Operation::kBegin:
      return (order.flags & kOneSweep) == 0         ? Course::kGradients
             : (order.flags & kWithIterations) == 0 ? Course::kElimination
                                                    : Course::kPolynomial;
    case Operation::kClusters:
      return Course::kClusters;
    case Operation::kVerdict:
      return Course::kAnswered;
    default:
      return course;
  }
}

}  // namespace

const MethodTable* Sweep::method() const { return method_in(course_); }

PlannedPart Sweep::planned_part(const Workspace& ws) const {
  const MethodTable* own = method();
  return own == nullptr ? PlannedPart::kTogether : own->planned_part(ws, order_);
}

Pending Sweep::pending() const {
  const MethodTable* own = method();
  return own == nullptr ? Pending::kNothing : own->pending(state_);
}

bool Sweep::is_busy(const Workspace& ws) const {
  return ws.exchange.is_under_way() || pending() == Pending::kBehindReport;
}

void Sweep::leave(Workspace& ws) {
  is_under_way_ = false;
  course_ = Course::kWaves;
  ws.exchange.leave();
  ws.reports.await({});
}

// ---- What may be said now.

bool Sweep::is_in_course(const Workspace& ws, const Order& order) const {
  if (order.operation == Operation::kVerdict) {  // Said again, it is the same one.
    return course_ != Course::kAnswered || order.answer == order_.answer;
  }
  if (ws.tree.wave() != SpanningTree::Wave::kTree) {
    return false;
  }
  switch (order.operation) {
    case Operation::kPlan:
      return order.index == kNoPlanned
                 ? course_ == Course::kWaves
                 : course_ == Course::kPlanned && order.index == ws.planned.count();
    case Operation::kForget:
      return course_ == Course::kPlanned;
    case Operation::kHosts:
      return course_ == Course::kPlanned && ws.planned.agrees_with(order.masks);
    case Operation::kMass:
      return course_ == Course::kHosted;
    case Operation::kAngles:
      return course_ == Course::kWeighed && fits_exact_check(ws.setup, order.mass) &&
             mass_report(ws).extent <= kExtentMax;
    case Operation::kBegin:
      return is_good_begin(order);
    case Operation::kFactor:
    case Operation::kTreeIterate:
      return course_ == Course::kElimination;
    case Operation::kCorners:
    case Operation::kLoads:
      return course_ >= Course::kElimination && course_ != Course::kAnswered;
    case Operation::kClusters:
      return is_good_begin(order) && ws.planned.count() <= kClusterPlannedMax;
    case Operation::kIterate:
      return course_ == Course::kClusters ||
             (course_ == Course::kPolynomial && (order.flags & kWithClusters) == 0);
    default:
      return course_ == Course::kGradients;
  }
}

/// Whether an equilibrium may begin by this order. What elimination knows of the tree lives until
/// another method begins.
bool Sweep::is_good_begin(const Order& order) const {
  if (course_ < Course::kWeighed || course_ == Course::kAnswered) {
    return false;
  }
  const Course next = course_after(order, course_);
  if (next == Course::kElimination) {
    return course_ <= Course::kElimination && order.count == 0 &&
           !state_.elimination.has_too_many_loops();
  }
  const bool has_iterations = (order.flags & kWithIterations) != 0;
  return method_in(next) != nullptr &&
         (next == Course::kGradients ? !has_iterations && order.count == 0
                                     : has_iterations && (order.flags & kOneSweep) != 0);
}

bool Sweep::expects(const Workspace& ws, Direction face, Message message) const {
  const MethodTable* own = method();
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kReport:
      return ws.reports.awaits(face) && message[1] == static_cast<std::uint8_t>(order_.operation);
    case MessageType::kPlannedDown: {
      // Parts are those of condensed modules.
      const bool is_part = message[1] > kPlannedIndexMask;
      return ws.tree.is_led_by(face) && (message[1] & kPlannedIndexMask) < ws.planned.count() &&
             (!is_part || (own != nullptr && own->take_condensed != nullptr));
    }
    case MessageType::kPlannedUp:
      return ws.tree.children().has(face) && message[1] < ws.planned.count() &&
             (order_.operation != Operation::kIterate || ws.planned_exchange.awaits_forces());
    case MessageType::kVector:
      return true;
    default:
      return own != nullptr && own->expects(state_, ws, order_, face, message);
  }
}

// ---- What comes in.

void Sweep::take_order(Workspace& ws, Announcements& announcements, const Order& order) {
  order_ = order;
  course_ = course_after(order, course_);
  is_under_way_ = true;
  announcements.finish_forgetting();
  ws.reports.await(ws.tree.children());
  ws.exchange.plan(exchange_count(order), exchanges_behind(order));
  ws.links.send(ws.tree.children(), encode(order));
  if (is_survey(order.operation)) {
    begin_survey(ws, announcements, order);
  }
  begin_method(ws, order);
  if (ws.exchange.left() > 0 && starts_at_once(order.operation)) {
    ws.start_exchange(planned_part(ws));
  }
}

void Sweep::begin_method(Workspace& ws, const Order& order) {
  const Operation operation = order.operation;
  // What elimination has learned with kMass it needs in its equilibrium.
  if (operation == Operation::kMass || operation == Operation::kClusters ||
      (operation == Operation::kBegin && course_ != Course::kElimination)) {
    method()->make(state_);
  }
  if (!is_survey(operation)) {
    method()->begin(state_, ws, order);
  }
}

void Sweep::take(Workspace& ws, Direction face, Message message) {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kReport:
      return ws.reports.take(face, message);
    case MessageType::kVector:
      return ws.exchange.take(face, message);
    case MessageType::kPlannedDown:
      return take_planned_down(ws, message);
    case MessageType::kPlannedUp:
      return take_planned_up(ws, message);
    default:
      return method()->take(state_, ws, order_, face, message);
  }
}

void Sweep::take_planned_down(Workspace& ws, Message message) {
  if (message[1] > kPlannedIndexMask) {
    method()->take_condensed(ws, message);
  } else {
    ws.planned_exchange.take_down(ws.links, ws.tree.children(), ws.planned, message);
  }
}

void Sweep::take_planned_up(Workspace& ws, Message message) {
  if (ws.planned_exchange.take_up(message)) {
    method()->pass_condensed(ws, order_);
  }
}

// ---- What follows.

bool Sweep::exchange(Workspace& ws) {
  if (!ws.exchange.is_under_way()) {
    return false;
  }
  const PlannedPart part = planned_part(ws);
  const bool waits_for_hosts =
      part != PlannedPart::kApart &&
      (!ws.planned_exchange.is_complete(ws.planned) ||
       (part == PlannedPart::kCondensed && ws.planned_exchange.awaits_forces()));
  // What children add to planned modules emulated here comes before their reports. It belongs to an
  // order's last exchange.
  const bool waits_for_children = ws.exchange.is_last() && !ws.reports.are_here();
  if (!ws.exchange.is_complete(ws.links.used()) || waits_for_hosts || waits_for_children) {
    return false;
  }
  method()->take_exchange(state_, ws, order_);
  if (part != PlannedPart::kApart) {
    ws.planned_exchange.end();
  }
  if (part == PlannedPart::kTogether) {
    ws.planned_exchange.send_up(ws.links, ws.tree.parent(), ws.planned,
                                is_precise(order_.operation));
  }
  ws.exchange.end();
  if (ws.exchange.left() > 0 && pending() != Pending::kBehindReport) {
    ws.start_exchange(planned_part(ws));
  }
  return true;
}

bool Sweep::do_piece(Workspace& ws) {
  const MethodTable* own = method();
  return own != nullptr && own->do_piece(state_, ws, order_);
}

bool Sweep::can_finish(const Workspace& ws) const {
  return is_under_way_ && ws.reports.are_here() && pending() != Pending::kBeforeReport &&
         ws.exchange.left_before_report() <= 0;
}

Report Sweep::finish(Workspace& ws, const Announcements& announcements) {
  is_under_way_ = false;
  Report sum = own_report(ws, announcements);
  for (const Direction face : ws.tree.children()) {
    const Report theirs = decode_report(ws.reports.of(face));
    add_report(ws.setup, order_, sum, theirs);
    if (order_.operation == Operation::kPlan && order_.index != kNoPlanned) {
      ws.planned.add_below(face, order_.index, Faces::from_mask(theirs.mask));
    }
  }
  if (!ws.tree.is_root()) {
    ws.links.send(ws.tree.parent(), encode(order_.operation, sum));
  }
  return sum;
}

Report Sweep::own_report(Workspace& ws, const Announcements& announcements) {
  const Operation operation = order_.operation;
  if (!is_survey(operation)) {
    return method()->report(state_, ws, order_);
  }
  Report report = survey_report(ws, announcements, order_);
  if (operation == Operation::kMass) {
    report.flags = static_cast<std::uint8_t>(report.flags | state_.elimination.survey_loops(ws));
  }
  return report;
}

}  // namespace holdfast::agent
