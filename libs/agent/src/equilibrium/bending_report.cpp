// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium/bending_report.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/features.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using base::Vec6;

/// Sums of a kBend before they are rounded.
struct BendingSums {
  double energy = 0;
  double moments = 0;
  double rotations = 0;
  double load_n = 0;
  double margin_nmm = static_cast<double>(kNoMomentMargin);
};

double product(const Vec6<double>& a, const Vec6<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

double size_of(double x, double y, double z) { return square_root(x * x + y * y + z * z); }

/// What a force in the middle stores by its two bending moments, twice.
double bending_energy(const Vec6<double>& stiffness, double x_nmm, double y_nmm) {
  return x_nmm * x_nmm / stiffness[3] + y_nmm * y_nmm / stiffness[4];
}

/// A facet that is a beam to the ground: its energy in place of what moves its node, its margin.
template <class Facet>
void add_facet(const Workspace& ws, const Facet& facet, bool is_bonded, const Vec6<double>& u,
               BendingSums& sums, Report& report) {
  const mechanics::GroundFacet<double>& law = ws.contact.facet;
  const Vec6<double> trial = mechanics::trial_force(law, u);
  const bool sticks = is_bonded || facet.state == mechanics::kStuck;
  const Vec6<double> force =
      sticks ? trial : base::multiply(mechanics::corrector(law, facet.state, facet.is_held), trial);
  for (std::size_t i = 0; i < force.size(); ++i) {
    sums.energy += force[i] * (force[i] - trial[i]) / law.stiffness[i];
  }
  const bool is_unilateral = law.law == mechanics::ContactLaw::kUnilateral;
  if (!is_bonded && !facet.state.pressed) {
    const bool holds = is_unilateral && facet.is_held;  // Sideways, though it is open.
    report.flags = static_cast<std::uint8_t>(report.flags | (holds ? kHasTilting : 0U));
    return;
  }
  report.number += 2;
  sums.moments += bending_energy(law.stiffness, force[3], force[4]);
  const bool slides = !is_bonded && is_unilateral && !facet.is_held;
  report.flags = static_cast<std::uint8_t>(report.flags | (slides   ? kHasSliding
                                                           : sticks ? kHasSupport
                                                                    : kHasTilting));
  if (sticks && !is_bonded) {
    const double moment = absolute(force[3]) < absolute(force[4]) ? force[4] : force[3];
    const double margin = -force[2] * law.half_width - absolute(moment);
    sums.margin_nmm = margin < sums.margin_nmm ? margin : sums.margin_nmm;
  }
}

void add_facets(const Workspace& ws, const Node& node, BendingSums& sums, Report& report) {
  const Surroundings* surroundings = surroundings_of(node);
  if (surroundings == nullptr) {
    return add_facet(ws, node, false, node.u, sums, report);
  }
  for (int i = 0; i < surroundings->facet_count; ++i) {
    const TouchingFacet& facet = surroundings->facets[static_cast<std::size_t>(i)];
    add_facet(ws, facet, facet.is_bonded,
              surrounded::local_displacement(*surroundings, facet, node.u), sums, report);
  }
}

void add_node(const Workspace& ws, int index, BendingSums& sums, Report& report) {
  const Node& node = ws.node(index);
  const std::uint32_t before = report.number;
  for (const Direction face : ws.faces_of(index)) {
    static_cast<void>(face);
    ++report.number;
  }
  if (node.is_fixed) {
    report.flags = static_cast<std::uint8_t>(report.flags | kHasSupport);
    return;
  }
  ++report.count;
  const Vec6<double> load = load_of(node, ws.setup);
  sums.energy += product(load, node.u);
  sums.load_n += size_of(load[0], load[1], load[2]);
  if (node.is_ground) {
    add_facets(ws, node, sums, report);
  }
  const double turned = node.u[3] * node.u[3] + node.u[4] * node.u[4] + node.u[5] * node.u[5];
  sums.rotations += (report.number - before) * turned * turned;
}

/// Half of what the beams of this module store by bending, all of those to planned modules.
void add_beams(const Workspace& ws, BendingSums& sums) {
  const Vec6<double>& stiffness = ws.contact.facet.stiffness;
  for (const Direction face : ws.faces_of(0)) {
    const MiddleLoad& middle = ws.middle(face);
    const double share = ws.links.used().has(face) ? 0.5 : 1.0;
    sums.moments += share * bending_energy(stiffness, middle.bending_x_nmm, middle.bending_y_nmm);
  }
  for (int i = 1; i < ws.node_count(); ++i) {
    for (const Direction direction : ws.planned.directions()) {
      const int other = ws.planned.neighbour_of(ws.planned.hosted(i - 1), direction);
      if (other >= 0 && base::index(direction) % 2 == 0) {
        const Vec6<double> middle = middle_force(ws.setup.beams(), direction, ws.node(i).u,
                                                 ws.node(ws.planned.node_of(other)).u);
        sums.moments += bending_energy(stiffness, middle[3], middle[4]);
      }
    }
  }
}

}  // namespace

Report bending_report(const Workspace& ws) {
  BendingSums sums;
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    add_node(ws, i, sums, report);
  }
  add_beams(ws, sums);
  report.reals = {static_cast<float>(sums.energy), static_cast<float>(sums.moments),
                  static_cast<float>(sums.rotations), static_cast<float>(sums.margin_nmm),
                  static_cast<float>(sums.load_n)};
  return report;
}

}  // namespace holdfast::agent
