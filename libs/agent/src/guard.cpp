// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/messages.hpp"
#include "methods.hpp"
#include "sweep.hpp"

/// What a neighbour may say at this moment.
///
/// A message that is legal by itself can still be one that no working program sends now: an order
/// from a child, a column of a loop that nobody has told of, a step before there is an equilibrium.
/// Taking it would work on memory that belongs to another method. Such a message, and one that
/// is_legal() refuses, has no effect but two: it is counted, and the neighbour, whose faults
/// are now known, counts as silent. Leaving it out alone would not do: a sum without it could make
/// a robot `safe` that is not.
namespace holdfast::agent {

using wire::MessageType;
using wire::Operation;

void Agent::refuse(int face) { links_[static_cast<std::size_t>(face)].lose(); }

/// Where an order leads; what it must not lead to has been refused before.
Agent::Course Agent::course_after(const Order& order) const {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return Course::kPlanned;
    case Operation::kHosts:
      return Course::kHosted;
    case Operation::kMass:
      return Course::kWeighed;
    case Operation::kBegin:
      return (order.flags & kOneSweep) == 0    ? Course::kGradients
             : (order.flags & kWithSteps) == 0 ? Course::kElimination
                                               : Course::kSteps;
    case Operation::kClusters:
      return Course::kClusters;
    case Operation::kVerdict:
      return Course::kAnswered;
    default:
      return course_;
  }
}

/// Of orders: may this one come next?
bool Agent::is_in_course(const Order& order) const {
  const Course course = course_;
  if (order.operation == Operation::kVerdict) {  // Said again, it is the same one.
    return course != Course::kAnswered || order.answer == order_.answer;
  }
  if (stage_ != kTreeStage) {
    return false;
  }
  switch (order.operation) {
    case Operation::kPlan:
      return order.index == kNoPlanned
                 ? course == Course::kWaves
                 : course == Course::kPlanned && order.index == planned_.count();
    case Operation::kForget:
      return course == Course::kPlanned;
    case Operation::kHosts:
      return course == Course::kPlanned && planned_.agrees_with(order.masks);
    case Operation::kMass:
      return course == Course::kHosted;
    case Operation::kAngles:
      return course == Course::kWeighed && fits_exact_check(setup_, order.mass) &&
             mass_report().extent <= kExtentMax;
    case Operation::kBegin:
      return is_good_begin(order);
    case Operation::kFactor:
    case Operation::kTreeStep:
      return course == Course::kElimination;
    case Operation::kCorners:
    case Operation::kLoads:
      return course >= Course::kElimination && course != Course::kAnswered;
    case Operation::kClusters:
      return is_good_begin(order) && planned_.count() <= kClusterPlannedMax;
    case Operation::kStep:
      return course == Course::kClusters ||
             (course == Course::kSteps && (order.flags & kWithClusters) == 0);
    default:
      return course == Course::kGradients;
  }
}

/// Of an equilibrium. What elimination knows of the tree lives until another method begins.
bool Agent::is_good_begin(const Order& order) const {
  if (course_ < Course::kWeighed || course_ == Course::kAnswered) {
    return false;
  }
  const auto next = course_after(order);
  if (next == Course::kElimination) {
    return course_ <= Course::kElimination && order.count == 0 && !work_.tree.has_too_many;
  }
  const bool has_steps = (order.flags & kWithSteps) != 0;
  return kHasAllMethods &&
         (next == Course::kGradients ? !has_steps && order.count == 0
                                     : has_steps && (order.flags & kOneSweep) != 0);
}

/// Of messages of the present round, in a stage.
bool Agent::is_expected(int face, std::span<const std::uint8_t> message) const {
  const bool is_parent = face == parent_ && awaited_ == 0;
  const bool is_child = (children_ & bit(face)) != 0;
  const bool reports = is_sweeping_ && (reports_awaited_ & bit(face)) != 0;
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kEcho:
      return (awaited_ & bit(face)) != 0;
    case MessageType::kAppoint:
      // One of an earlier stage is late: the next wave was here before it.
      return message[1] < stage_ ||
             (message[1] == stage_ && is_parent && course_ == Course::kWaves);
    case MessageType::kMark:
      return stage_ == kFarStage && (nearer_ & bit(face)) == 0 && awaited_ == 0 &&
             course_ == Course::kWaves;
    case MessageType::kOrder:
      return is_parent && !is_sweeping_ && !has_next_order_ && is_in_course(decode_order(message));
    case MessageType::kReport:
      return reports && message[1] == static_cast<std::uint8_t>(order_.operation);
    case MessageType::kPlannedDown:
      return is_parent && (message[1] & kPlannedIndexMask) < planned_.count() &&
             (kHasAllMethods || message[1] <= kPlannedIndexMask);  // Parts are those of steps.
    case MessageType::kPlannedUp:
      return is_child && message[1] < planned_.count() &&
             (order_.operation != Operation::kStep || planned_up_awaited_ != 0);
    case MessageType::kLoop:
      return reports && order_.operation == Operation::kMass &&
             work_.tree.child_cut_count[static_cast<std::size_t>(face)] < kLoopsMax;
    case MessageType::kColumn:
    case MessageType::kBranchUp:
    case MessageType::kBranchDown:
      return is_clustered_ || is_expected_of_branch(face, message, reports);
    case MessageType::kJoin:
    case MessageType::kVector:
      break;
  }
  return true;
}

/// Of elimination: only what a child's loops, or this module's own, account for.
bool Agent::is_expected_of_branch(int face, std::span<const std::uint8_t> message,
                                  bool reports) const {
  if (course_ != Course::kElimination) {
    return false;
  }
  const BranchWork& tree = work_.tree;
  const int label = message[1];
  const bool is_factor = order_.operation == Operation::kFactor;
  const bool is_step = order_.operation == Operation::kTreeStep;
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kColumn:
      return reports && is_factor &&
             Branch::loops_of_column(label) <= tree.child_cut_count[static_cast<std::size_t>(face)];
    case MessageType::kBranchUp:
      return reports && (is_factor || is_step) &&
             label <= tree.child_cut_count[static_cast<std::size_t>(face)];
    default:
      return is_sweeping_ && is_step && down_awaited_ != 0 && face == parent_ &&
             label <= tree.branch.open_count();
  }
}

}  // namespace holdfast::agent
