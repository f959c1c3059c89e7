// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "world/facets.hpp"

#include <span>

#include "algebra/scalar.hpp"
#include "holdfast/mechanics/frame.hpp"

namespace holdfast::agent {

std::uint32_t hash_of(const base::Cell& cell, int code) {
  std::uint32_t hash = 0x9e3779b9U;
  for (const std::int32_t value : {cell.x, cell.y, cell.z, std::int32_t{code}}) {
    hash = (hash ^ static_cast<std::uint32_t>(value)) * 0x85ebca6bU;
    hash ^= hash >> 15U;
  }
  return hash;
}

namespace {

using base::Vec6;
using mechanics::ContactState;
using mechanics::kStuck;

/// A facet that is so near to slipping may slip: forces are good to some 1e-7 of what acts on it.
constexpr double kSlipTie = 1e-5;

/// A facet that is so near to tilting presses with its edge alone: forces are good to as much.
constexpr double kEdgeTie = 1e-5;

std::span<const TouchingFacet> facets_of(const Surroundings& node) {
  return std::span(node.facets).first(node.facet_count);
}

std::span<TouchingFacet> facets_of(Surroundings& node) {
  return std::span(node.facets).first(node.facet_count);
}

const mechanics::Frame& frame_of(const TouchingFacet& facet) {
  return mechanics::kCubicFrames[static_cast<std::size_t>(facet.direction)];
}

Vec6<double> to_local(const Surroundings& node, const TouchingFacet& facet,
                      const Vec6<double>& global) {
  const mechanics::LatticeBeam<double>* beams = node.environment->beams;
  return beams == nullptr ? mechanics::to_local(frame_of(facet), global)
                          : beams->to_local(facet.direction, global);
}

Vec6<double> to_global(const Surroundings& node, const TouchingFacet& facet,
                       const Vec6<double>& local) {
  const mechanics::LatticeBeam<double>* beams = node.environment->beams;
  return beams == nullptr ? mechanics::to_global(frame_of(facet), local)
                          : beams->to_global(facet.direction, local);
}

/// The sum of force(facet, local displacement) over all facets, in the global frame.
template <class Force>
Vec6<double> sum_of(const Surroundings& node, const Vec6<double>& u, Force&& force) {
  Vec6<double> sum{};
  for (const TouchingFacet& facet : facets_of(node)) {
    base::add_to(sum, to_global(node, facet, force(facet, to_local(node, facet, u))));
  }
  return sum;
}

ContactState prescribed_state(const TouchingFacet& facet, const ContactSetting& contact,
                              const Vec6<double>& local, double tie) {
  if (facet.is_bonded) {
    return kStuck;
  }
  const mechanics::GroundFacet<double>& law = contact.facet;
  const Vec6<double> trial = mechanics::trial_force(law, local);
  const double sideways = absolute(trial[0]) + absolute(trial[1]);
  const double torque = absolute(trial[3]) + absolute(trial[4]) + absolute(trial[5]);
  const bool is_rounding = absolute(trial[2]) < tie * (sideways + torque / law.lever);
  if (is_rounding && law.law == mechanics::ContactLaw::kRegularised) {
    return {.pressed = false};
  }
  return mechanics::contact_state(law, trial);
}

bool tilts(const ContactState& state) { return state.tilt_x != 0 || state.tilt_y != 0; }

}  // namespace

namespace surrounded {

Vec6<double> facet_force(const Surroundings& node, const ContactSetting& contact,
                         const Vec6<double>& u) {
  return sum_of(node, u, [&](const TouchingFacet& facet, const Vec6<double>& local) {
    return mechanics::contact_force(contact.facet, facet.state, facet.is_held, local);
  });
}

Vec6<double> symmetric_product(const Surroundings& node, const ContactSetting& contact,
                               const Vec6<double>& u) {
  return sum_of(node, u, [&](const TouchingFacet& facet, const Vec6<double>& local) {
    return mechanics::symmetric_product(contact.facet, facet.state, facet.is_held, local);
  });
}

bool look_up_states(Surroundings& node, const ContactSetting& contact, const Vec6<double>& u,
                    double tie) {
  bool has_changed = false;
  for (TouchingFacet& facet : facets_of(node)) {
    facet.wanted = prescribed_state(facet, contact, to_local(node, facet, u), tie);
    has_changed = has_changed || !(facet.wanted == facet.state);
  }
  return has_changed;
}

Vec6<double> local_displacement(const Surroundings& node, const TouchingFacet& facet,
                                const Vec6<double>& u) {
  return to_local(node, facet, u);
}

/// Does every facet press all over, and is it held?
bool hold_all_over(const Surroundings& node) {
  bool hold = true;
  for (const TouchingFacet& facet : facets_of(node)) {
    hold = hold && facet.is_held && facet.state == kStuck;
  }
  return hold;
}

/// Is there one that would not press all over if it lost this share of its pressure?
bool is_any_weak(const Surroundings& node, const ContactSetting& contact, const Vec6<double>& u,
                 double share) {
  bool is_any = false;
  for (const TouchingFacet& facet : facets_of(node)) {
    Vec6<double> trial = mechanics::trial_force(contact.facet, to_local(node, facet, u));
    trial[2] *= 1 - share;
    is_any =
        is_any || (!facet.is_bonded && !(mechanics::contact_state(contact.facet, trial) == kStuck));
  }
  return is_any;
}

bool is_all_bonded(const Surroundings& node) {
  bool is_all = true;
  for (const TouchingFacet& facet : facets_of(node)) {
    is_all = is_all && facet.is_bonded;
  }
  return is_all;
}

void take_states(Surroundings& node) {
  for (TouchingFacet& facet : facets_of(node)) {
    facet.state = facet.wanted;
  }
}

void hold_facets(Surroundings& node, bool frees, Report& report) {
  for (TouchingFacet& facet : facets_of(node)) {
    hold_facet(facet, frees, report);
  }
}

/// Each has a key of its own.
void seek_facets(Surroundings& node, const ContactSetting& contact, const Vec6<double>& u,
                 const base::Cell& cell, const Order& order, Report& report) {
  int index = 0;
  for (TouchingFacet& facet : facets_of(node)) {
    ++index;
    if (order.flags == kEachState) {
      take_given_state(facet, cell, index, order, report);
    } else if ((order.flags & kOneFoot) != 0) {
      press_alone(facet, cell, index, order, report);
    } else {
      const bool doubts = is_doubtful(contact, facet.state, to_local(node, facet, u));
      seek_facet(facet, doubts, cell, index, order, report);
    }
  }
}

void report_facets(const Surroundings& node, const ContactSetting& contact, const Vec6<double>& u,
                   const base::Cell& cell, Report& report) {
  for (const TouchingFacet& facet : facets_of(node)) {
    if (is_doubtful(contact, facet.state, to_local(node, facet, u))) {
      report.flags = static_cast<std::uint8_t>(report.flags | kMayDiffer);
    }
    const int code = ContactState::kCodeCount * (1 + base::index(facet.direction));
    report.number += hash_of(cell, code + facet.wanted.code());
    report.flags = static_cast<std::uint8_t>(
        report.flags | (tilts(facet.state) ? kAnyTilting : 0U) |
        (facet.state == kStuck || node.environment->is_level ? 0U : kMayPull));
  }
}

}  // namespace surrounded

bool is_any_tilting(const Node& node) {
  const Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr) {
    return node.is_ground && tilts(node.state);
  }
  bool is_any = false;
  for (const TouchingFacet& facet : facets_of(*surroundings)) {
    is_any = is_any || tilts(facet.state);
  }
  return is_any;
}

namespace {

/// Can corners of a facet bear this by pressing and friction? `force` in its frame, the torque
/// about the node, which is its lever before the facet.
///
/// It presses with P at c = (my^, -mx^) / P, for instance with P/4 (1 +- cx/h) (1 +- cy/h) at the
/// corners, h half its width. Across, corners share the force as they press, and turn about c by w
/// times pressure times distance: together w P (2 h^2 - c^2), which is the torque about c. That is
/// one way; if no corner slips in it, the facet holds. On a level floor under weight alone turning
/// is not asked of (verdict/stability.hpp), and w is none.
bool may_slip_at_corners(const Vec6<double>& force, double friction,
                         const mechanics::GroundFacet<double>& facet, bool turns) {
  const double half_width = facet.half_width;
  const double pressure = -force[2];
  const std::array<double, 2> across = {force[0] / pressure, force[1] / pressure};
  const std::array<double, 2> centre = {(force[4] + force[0] * facet.lever) / pressure,
                                        (force[1] * facet.lever - force[3]) / pressure};
  const double most = (1 - kSlipTie) * friction * friction;
  if (!turns) {
    return !(across[0] * across[0] + across[1] * across[1] < most);
  }
  const double torque = force[5] / pressure - centre[0] * across[1] + centre[1] * across[0];
  const double spread = 2 * half_width * half_width - centre[0] * centre[0] - centre[1] * centre[1];
  const double turn = torque / spread;
  bool holds = spread > 0;
  for (int corner = 0; corner < 4; ++corner) {
    const double x = (corner % 2 == 0 ? -half_width : half_width) - centre[0];
    const double y = (corner < 2 ? -half_width : half_width) - centre[1];
    const double along_x = across[0] - turn * y;
    const double along_y = across[1] + turn * x;
    holds = holds && along_x * along_x + along_y * along_y < most;
  }
  return !holds;
}

}  // namespace

/// May a facet slip in the states in use? As the exact solver asks, the force across is compared
/// with what presses (verdict/stability.cpp), and, where the rigid body has to hold by friction,
/// corners are.
bool may_slip(const Node& node, const ContactSetting& contact) {
  const Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr || !node.is_ground) {
    return false;
  }
  const Environment& environment = *surroundings->environment;
  bool may = false;
  for (const TouchingFacet& facet : facets_of(*surroundings)) {
    if (facet.friction == kNoSlip || facet.is_bonded || !facet.state.pressed) {
      continue;
    }
    const Vec6<double> force = mechanics::contact_force(contact.facet, facet.state, facet.is_held,
                                                        to_local(*surroundings, facet, node.u));
    const bool is_idle = environment.is_level && force[0] == 0 && force[1] == 0;
    may = may || (!is_idle &&
                  may_slip_at_corners(force, facet.friction, contact.facet, !environment.is_level));
  }
  return may;
}

bool is_any_bonded(const Surroundings& node) {
  bool is_any = false;
  for (const TouchingFacet& facet : facets_of(node)) {
    is_any = is_any || facet.is_bonded;
  }
  return is_any;
}

void reset(Surroundings& node) {
  for (TouchingFacet& facet : facets_of(node)) {
    facet = {
        .direction = facet.direction, .is_bonded = facet.is_bonded, .friction = facet.friction};
  }
}

namespace {

std::int32_t rounded(double value) {
  return static_cast<std::int32_t>(value < 0 ? value - 0.5 : value + 0.5);
}

/// A place of a facet's own frame, seen from the node, in the unit of corners.
mechanics::Corner corner_at(const Surroundings& node, const TouchingFacet& facet,
                            const base::Cell& cell, const std::array<std::int32_t, 3>& local) {
  const Environment& environment = *node.environment;
  const std::int32_t pitch = 2 * environment.foot_denominator;
  if (environment.beams != nullptr) {
    const auto node_place = base::node_place(*environment.lattice, cell);
    const Vec6<double> inner = {double(local[0]), double(local[1]), double(local[2]), 0, 0, 0};
    const Vec6<double> away = environment.beams->to_global(facet.direction, inner);
    const auto place = [&](std::size_t i) {
      return rounded(kCornerParts * (node_place[i] + away[i] / pitch));
    };
    return {place(0), place(1), place(2)};
  }
  std::array<std::int32_t, 3> place = {pitch * cell.x, pitch * cell.y, pitch * cell.z};
  const mechanics::Frame& frame = frame_of(facet);
  for (std::size_t i = 0; i < 3; ++i) {
    place[frame.axis[i]] += frame.sign[i] * local[i];
  }
  return {place[0], place[1], place[2]};
}

/// The edges that a facet presses with, as the state of one that tilts over them: it does where it
/// is so near to that that rounding could decide.
ContactState edges_of(const Surroundings& node, const TouchingFacet& facet,
                      const ContactSetting& contact, const Vec6<double>& u) {
  ContactState edges = facet.state;
  if (facet.is_given) {
    return edges;
  }
  const mechanics::GroundFacet<double>& law = contact.facet;
  const Vec6<double> force =
      mechanics::contact_force(law, facet.state, facet.is_held, to_local(node, facet, u));
  const double limit = -(1 - kEdgeTie) * force[2] * law.half_width;
  const auto tilt = [&](double torque) {
    return absolute(torque) < limit ? std::int8_t{0}
                                    : static_cast<std::int8_t>(torque < 0 ? -1 : 1);
  };
  if (edges.tilt_x == 0) {
    edges.tilt_x = tilt(force[3] - force[1] * law.lever);
  }
  if (edges.tilt_y == 0) {
    edges.tilt_y = tilt(force[4] + force[0] * law.lever);
  }
  return edges;
}

}  // namespace

/// mx^ < 0 presses the +y' edge, my^ > 0 the +x' edge.
mechanics::SupportCorners support_corners(const Surroundings& node, const ContactSetting& contact,
                                          const Vec6<double>& u, const base::Cell& cell) {
  mechanics::SupportCorners corners;
  const Environment& environment = *node.environment;
  const std::int32_t half_pitch = environment.foot_denominator;
  const std::int32_t half_width = environment.foot_numerator;
  for (const TouchingFacet& facet : facets_of(node)) {
    if (facet.is_bonded) {
      return {.stable = true};
    }
    if (!facet.state.pressed) {
      continue;
    }
    const ContactState edges = edges_of(node, facet, contact, u);
    if (edges == kStuck && half_width > 0) {
      return {.stable = true};
    }
    for (std::int32_t corner = 0; corner < 4; ++corner) {
      const std::int32_t side_x = corner % 2 == 0 ? -1 : 1;
      const std::int32_t side_y = corner < 2 ? -1 : 1;
      if (edges.tilt_x == side_y || edges.tilt_y == -side_x) {
        continue;
      }
      // From the node: half a pitch to the facet, along -z', then to its corner.
      const std::array<std::int32_t, 3> local = {side_x * half_width, side_y * half_width,
                                                 -half_pitch};
      const mechanics::SupportCorners one = {.count = 1,
                                             .corners = {corner_at(node, facet, cell, local)}};
      corners = environment.beams == nullptr ? mechanics::merge(corners, one)
                                             : mechanics::merge_rounded(corners, one);
    }
  }
  return corners;
}

}  // namespace holdfast::agent
