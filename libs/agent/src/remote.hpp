// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "methods.hpp"

/// Planned modules that touch several others, in the one-sweep methods.
///
/// The host of such a module lies above all that it touches, so an exchange with them takes a
/// sweep. A step has one: its order brings the module's new displacement down, its report the
/// beams' forces up, and no round more is spent. The polynomial, which has an exchange every round,
/// does without these beams: in its matrix the planned module stands apart, and M^-1 has the
/// inverse of its diagonal block. That is symmetric and positive as before, only not as good: such
/// a module costs some steps more.
namespace holdfast::agent {

/// Do planned modules stand apart in the present exchange?
template <class Real>
bool BasicAgent<Real>::is_apart() const {
  if (!kHasAllMethods || !planned_.is_any_remote()) {
    return false;
  }
  switch (order_.operation) {
    case wire::Operation::kStep:
      return true;
    case wire::Operation::kBegin:
      return (order_.flags & kOneSweep) != 0;
    case wire::Operation::kStart:
    case wire::Operation::kGradient:
      return exchanges_left_ > 1;
    default:
      return false;
  }
}

/// Nodes with a part in the polynomial.
template <class Real>
int BasicAgent<Real>::joined_count() const {
  return is_apart() ? 1 : node_count();
}

template <class Real>
Node<Real>& BasicAgent<Real>::planned_node(int k) {
  return nodes_[static_cast<std::size_t>(planned_.slot_of(k))];
}

/// Behind a step's order: where planned modules are now.
template <class Real>
void BasicAgent<Real>::share_remote() {
  planned_force_ = {};
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    const int k = planned_.hosted(i);
    const base::Vec6<double>& u = nodes_[static_cast<std::size_t>(1 + i)].u;
    base::Vec6<float> leading{};
    base::Vec6<float> trailing{};
    for (std::size_t j = 0; j < 6; ++j) {
      leading[j] = static_cast<float>(leading_part(u[j]));
      trailing[j] = static_cast<float>(u[j] - leading_part(u[j]));
    }
    send_remote_down(static_cast<std::uint8_t>(k | sweep::kLeading), leading);
    send_remote_down(static_cast<std::uint8_t>(k | sweep::kTrailing), trailing);
  }
}

template <class Real>
void BasicAgent<Real>::send_remote_down(std::uint8_t label, const base::Vec6<float>& part) {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) != 0 && planned_.is_needed_below(face, label & sweep::kIndexMask)) {
      send(face, sweep::vector_message(wire::MessageType::kPlannedDown, label, part));
    }
  }
}

/// It may come before the step's order, which waits for the exchanges of the step before.
template <class Real>
void BasicAgent<Real>::take_remote_down(std::uint8_t label, const base::Vec6<float>& part) {
  const int k = label & sweep::kIndexMask;
  if (k >= planned_.count() || !planned_.is_from_above(k)) {
    return;
  }
  Node<Real>& node = planned_node(k);
  const bool is_leading = (label & sweep::kLeading) != 0;
  for (std::size_t j = 0; j < 6; ++j) {
    node.u[j] = static_cast<double>(part[j]) + (is_leading ? 0 : node.u[j]);
  }
  if (!is_leading) {
    planned_here_ = static_cast<std::uint8_t>(planned_here_ | bit(k));
  }
  send_remote_down(label, part);
}

/// Does the present exchange need what hosts send? Of a step it is the second.
template <class Real>
bool BasicAgent<Real>::needs_hosts() const {
  const bool is_step = order_.operation == wire::Operation::kStep;
  return !is_apart() || (is_step && exchanges_left_ == exchanges_behind_ + 1);
}

template <class Real>
bool BasicAgent<Real>::is_waiting_for_hosts() const {
  return needs_hosts() && (planned_here_ & planned_.from_above()) != planned_.from_above();
}

/// In the polynomial the planned module at the other end stands still.
template <class Real>
void BasicAgent<Real>::add_beam_apart(int face) {
  const Exchanged what = exchanged();
  if (what == Exchanged::kDisplacement) {
    return;
  }
  const base::Vec6<double> force =
      mechanics::end_force(setup_.beam, static_cast<base::Direction>(face),
                           base::converted<double>(nodes_[0].shared), {});
  if (what == Exchanged::kGradient) {
    base::add_to(gradients_of(0).image, base::converted<Real>(force));
    return;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    steps_of(0).w[i] -= force[i];
  }
}

/// The beams between this module and planned ones, at u.
template <class Real>
void BasicAgent<Real>::add_remote_beams() {
  Node<Real>& node = nodes_[0];
  for (int k = 0; k < planned_.count(); ++k) {
    const int face = planned_.own_face(k);
    if (face < 0) {
      continue;
    }
    const auto direction = static_cast<base::Direction>(face);
    const base::Vec6<double>& theirs = planned_node(k).u;
    base::add_to(node.force, mechanics::end_force(setup_.beam, direction, node.u, theirs));
    base::add_to(planned_force_[static_cast<std::size_t>(k)],
                 mechanics::end_force(setup_.beam, base::opposite(direction), theirs, node.u));
    const base::Vec6<double> middle =
        mechanics::middle_force(setup_.beam, direction, node.u, theirs);
    middle_[static_cast<std::size_t>(face)] = {middle[2], middle[3], middle[4]};
  }
}

/// All reports have come, and with them the forces on the planned modules of this host.
template <class Real>
void BasicAgent<Real>::find_remote_residuals() {
  for (int i = 1; i < node_count(); ++i) {
    Node<Real>& node = nodes_[static_cast<std::size_t>(i)];
    const int k = planned_.hosted(i - 1);
    node.force = planned_force_[static_cast<std::size_t>(k)];
    for (const base::Direction direction : base::kDirections) {
      const int other = planned_.neighbour_of(k, direction);
      if (other >= 0) {
        base::add_to(node.force,
                     mechanics::end_force(setup_.beam, direction, node.u, planned_node(other).u));
      }
    }
    find_residual(i);
  }
}

}  // namespace holdfast::agent
