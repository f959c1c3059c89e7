// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "methods.hpp"
#include "scalar.hpp"
#include "sweep.hpp"
#include "system.hpp"

/// Planned modules that touch several others.
///
/// The host of such a module lies above all that it touches, so an exchange with them takes longer
/// than a round. A step does without the planned module: it is condensed. With the displacements u
/// of those that it touches its own is known,
///   u_p = K_pp^-1 (f_p - K_pr u),
/// so no force is left on it, and for the others remains S = K_rr - K_rp K_pp^-1 K_pr: as symmetric
/// as K. The polynomial cannot wait for the host, so M^-1 is that of another robot.
/// At first of the robot without the planned module: S is a little stiffer, and the steps are as
/// many as without it, or a few more. But where the planned module joins parts that bend freely
/// M^-1 S has eigenvalues of hundreds, and a full step, which every step is before its length is
/// known, goes so far that contact states change for nothing, again and again. So from the first
/// change of contact states on (kHoldPlanned; not with clusters, whose steps are damped) the
/// planned module stands still in M, its beams kHeldShare of what they are. With whole ones S would
/// be the softer matrix, as K_rp K_pp^-1 K_pr is never negative, and no eigenvalue greater than the
/// polynomial's own; so none is greater than 1 / kHeldShare times that. What is too stiff in M
/// then, six displacements for each planned module, are small eigenvalues, which conjugate
/// gradients find in some more steps. In each step the forces K_pr u go up to the host behind the
/// order, and u_p comes down: at most one sweep more.
///
/// Conjugate gradients have u_p among their unknowns. Their polynomial has its diagonal block
/// apart, and only the last exchange of a sweep, for w = A z, has its beams in it.
namespace holdfast::agent {

/// Of 58 random robots whose steps were given up, 12 still are with 0.7, 8 with 0.5, 14 with 0.4,
/// if planned modules are held from the first step on.
inline constexpr double kHeldShare = 0.5;

/// Do planned modules stand apart in the present exchange?
bool Agent::is_apart() const {
  if (!kHasAllMethods || !planned_.is_any_remote()) {
    return false;
  }
  switch (order_.operation) {
    case wire::Operation::kStep:
      return true;
    case wire::Operation::kBegin:
    case wire::Operation::kClusters:
      return (order_.flags & kOneSweep) != 0;
    case wire::Operation::kStart:
    case wire::Operation::kGradient:
      return exchanges_left_ > 1;
    default:
      return false;
  }
}

/// Nodes with a part in the polynomial.
int Agent::joined_count() const { return is_apart() ? 1 : node_count(); }

Node& Agent::planned_node(int k) { return nodes_[static_cast<std::size_t>(planned_.slot_of(k))]; }

/// Behind a step's order: the forces on planned modules at rest go up to their hosts.
void Agent::begin_condensing() {
  planned_force_ = {};
  planned_up_awaited_ = 0;
  for (int k = 0; k < planned_.count(); ++k) {
    const int own = planned_.own_face(k);
    if (own >= 0) {
      const auto direction = base::opposite(static_cast<base::Direction>(own));
      base::add_to(planned_force_[static_cast<std::size_t>(k)],
                   mechanics::end_force(setup_.beam, direction, {}, nodes_[0].u));
    }
    for (int face = 0; face < base::kDirectionCount; ++face) {
      const bool is_coming = (children_ & bit(face)) != 0 && planned_.is_needed_below(face, k);
      planned_up_awaited_ = static_cast<std::uint8_t>(planned_up_awaited_ + (is_coming ? 2 : 0));
    }
  }
  if (planned_up_awaited_ == 0) {
    pass_condensed();
  }
}

/// All forces from below are here: on to the host, or from it down again.
void Agent::pass_condensed() {
  send_planned_up();
  condense();
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    const int k = planned_.hosted(i);
    const base::Vec6<double>& u = nodes_[static_cast<std::size_t>(1 + i)].u;
    base::Vec6<float> leading{};
    base::Vec6<float> trailing{};
    for (std::size_t j = 0; j < 6; ++j) {
      leading[j] = static_cast<float>(leading_part(u[j]));
      trailing[j] = static_cast<float>(u[j] - leading_part(u[j]));
    }
    send_remote_down(static_cast<std::uint8_t>(k | kLeadingPart), leading);
    send_remote_down(static_cast<std::uint8_t>(k | kTrailingPart), trailing);
  }
}

/// u_p of all planned modules emulated here, in the contact states that belong to it.
void Agent::condense() {
  constexpr int kStateRounds = 20;
  for (int i = 1; i < node_count(); ++i) {
    nodes_[static_cast<std::size_t>(i)].has_changed = false;
  }
  bool is_settled = node_count() == 1;
  for (int round = 0; round < kStateRounds && !is_settled; ++round) {
    is_settled = true;
    solve_hosted();
    for (int i = 1; i < node_count(); ++i) {
      Node& node = nodes_[static_cast<std::size_t>(i)];
      const mechanics::ContactState before = node.state;
      follow_state(node);
      is_settled = is_settled && node.state == before;
    }
  }
}

/// Gauss and Seidel, module by module: exact at once for one alone, and there are five at most.
void Agent::solve_hosted() {
  constexpr int kPassesMax = 1000;
  constexpr double kLeastMove = 1e-14;
  double move = 1;
  double size = 0;
  for (int pass = 0; pass < kPassesMax && move > kLeastMove * size; ++pass) {
    move = 0;
    for (int i = 1; i < node_count(); ++i) {
      Node& node = nodes_[static_cast<std::size_t>(i)];
      node.force = force_on_hosted(i);
      System system(diagonal_block(node, setup_, contact_, node_faces(i)));
      system.factor();
      base::Vec6<double> change = residual(node, setup_, contact_);
      system.solve(change);
      for (std::size_t j = 0; j < 6; ++j) {
        node.u[j] += change[j];
        move = absolute(change[j]) > move ? absolute(change[j]) : move;
        size = absolute(node.u[j]) > size ? absolute(node.u[j]) : size;
      }
    }
  }
  for (int i = 1; i < node_count(); ++i) {
    nodes_[static_cast<std::size_t>(i)].force = force_on_hosted(i);
  }
}

/// All beams of a planned module emulated here; those to other modules have left their force at
/// u_p = 0 in planned_force_.
base::Vec6<double> Agent::force_on_hosted(int node_index) const {
  const int k = planned_.hosted(node_index - 1);
  const base::Vec6<double>& own = nodes_[static_cast<std::size_t>(node_index)].u;
  base::Vec6<double> force = planned_force_[static_cast<std::size_t>(k)];
  for (const base::Direction direction : base::kDirections) {
    const int other = planned_.neighbour_of(k, direction);
    if (other >= 0) {
      const auto slot = static_cast<std::size_t>(planned_.node_of(other));
      base::add_to(force, mechanics::end_force(setup_.beam, direction, own, nodes_[slot].u));
    } else if ((planned_.total(k) & bit(base::index(direction))) != 0) {
      base::add_to(force, mechanics::end_force(setup_.beam, direction, own, {}));
    }
  }
  return force;
}

void Agent::send_remote_down(std::uint8_t label, const base::Vec6<float>& part) {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) != 0 && planned_.is_needed_below(face, label & kPlannedIndexMask)) {
      send(face, vector_message(wire::MessageType::kPlannedDown, label, part));
    }
  }
}

void Agent::take_remote_down(std::uint8_t label, const base::Vec6<float>& part) {
  const int k = label & kPlannedIndexMask;
  if (!planned_.is_from_above(k)) {
    return;
  }
  Node& node = planned_node(k);
  const bool is_leading = (label & kLeadingPart) != 0;
  for (std::size_t j = 0; j < 6; ++j) {
    node.u[j] = static_cast<double>(part[j]) + (is_leading ? 0 : node.u[j]);
  }
  if (!is_leading) {
    planned_here_ = static_cast<std::uint8_t>(planned_here_ | bit(k));
  }
  send_remote_down(label, part);
}

/// Does the present exchange need what hosts send? Of a step it is the second.
bool Agent::needs_hosts() const {
  const bool is_step = order_.operation == wire::Operation::kStep;
  return !is_apart() || (is_step && exchanges_left_ == exchanges_behind_ + 1);
}

bool Agent::is_waiting_for_hosts() const {
  const bool is_missing = (planned_here_ & planned_.from_above()) != planned_.from_above();
  return needs_hosts() && (is_missing || (is_apart() && planned_up_awaited_ != 0));
}

/// Do planned modules stand still in the polynomial of the step under way?
bool Agent::holds_planned() const {
  return is_apart() && order_.operation == wire::Operation::kStep &&
         (order_.flags & kHoldPlanned) != 0;
}

/// In the polynomials a planned module stands still, in those of steps its beams are weaker.
void Agent::add_beam_apart(int face) {
  const auto direction = static_cast<base::Direction>(face);
  const Exchanged what = exchanged();
  if (what == Exchanged::kGradient) {
    base::add_to(gradients_of(0).image,
                 mechanics::end_force(setup_.beam_float, direction, nodes_[0].shared, {}));
  } else if (what == Exchanged::kTerm && holds_planned()) {
    const base::Vec6<double> force =
        mechanics::end_force(setup_.beam, direction, base::converted<double>(nodes_[0].shared), {});
    for (std::size_t i = 0; i < 6; ++i) {
      steps_of(0).w[i] -= kHeldShare * force[i];
    }
  }
}

/// The beams between this module and planned ones, at u.
void Agent::add_remote_beams() {
  Node& node = nodes_[0];
  for (int k = 0; k < planned_.count(); ++k) {
    const int face = planned_.own_face(k);
    if (face < 0) {
      continue;
    }
    const auto direction = static_cast<base::Direction>(face);
    const base::Vec6<double>& theirs = planned_node(k).u;
    base::add_to(node.force, mechanics::end_force(setup_.beam, direction, node.u, theirs));
    const base::Vec6<double> middle =
        mechanics::middle_force(setup_.beam, direction, node.u, theirs);
    middle_[static_cast<std::size_t>(face)] = {middle[2], middle[3], middle[4]};
  }
}

}  // namespace holdfast::agent
