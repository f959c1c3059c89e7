// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/messages/order.hpp"

/// Planned modules that touch several others.
///
/// The host of such a module lies above all that it touches, so an exchange with them takes longer
/// than a round. An iteration does without the planned module: it is condensed. With the
/// displacements u of those that it touches its own is known,
///   u_p = K_pp^-1 (f_p - K_pr u),
/// so no force is left on it, and for the others remains S = K_rr - K_rp K_pp^-1 K_pr: as symmetric
/// as K. The polynomial cannot wait for the host, so M^-1 is that of another robot.
/// At first of the robot without the planned module: S is a little stiffer, and the iterations are
/// as many as without it, or a few more. But where the planned module joins parts that bend freely
/// M^-1 S has eigenvalues of hundreds, and a full correction, which every iteration is before its
/// length is known, goes so far that contact states change for nothing, again and again. So from
/// the first change of contact states on (kHoldPlanned; not with clusters, whose iterations are
/// damped) the planned module stands still in M, its beams kHeldShare of what they are. With whole
/// ones S would be the softer matrix, as K_rp K_pp^-1 K_pr is never negative, and no eigenvalue
/// greater than the polynomial's own; so none is greater than 1 / kHeldShare times that. What is
/// too stiff in M then, six displacements for each planned module, are small eigenvalues, which
/// conjugate gradients find in some more iterations. In each iteration the forces K_pr u go up to
/// the host behind the order, and u_p comes down: at most one sweep more.
namespace holdfast::agent {

/// How stiff the beams of a planned module are that stands still in the polynomial. Of 58 random
/// robots whose iterations were given up, 12 still are with 0.7, 8 with 0.5, 14 with 0.4, if
/// planned modules are held from the first iteration on.
inline constexpr double kHeldShare = 0.5;

/// Does an order of the polynomial's move modules between which planned ones may be?
constexpr bool moves_between_others(wire::Operation operation) {
  return is_iterate(operation) || is_resume(operation);
}

/// Nodes with a part in the polynomial.
inline int joined_count(const Workspace& ws, PlannedPart part) {
  return part == PlannedPart::kTogether ? ws.node_count() : 1;
}

/// Behind an iteration's order: the forces on planned modules at rest begin to go up to their
/// hosts.
void begin_condensing(Workspace& ws);

/// A part of a planned module's displacement has come from its host.
void take_condensed(Workspace& ws, std::span<const std::uint8_t> message);

/// Adds the forces of the beams between this module and planned ones, at u.
void add_condensed_beams(Workspace& ws);

}  // namespace holdfast::agent
