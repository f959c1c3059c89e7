// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/ground_contact.hpp"

#include "holdfast/base/double_double.hpp"

namespace holdfast::mechanics {
namespace {

using base::absolute;
using base::Mat6;
using base::matrix_of;
using base::Vec6;

// Components of a facet force or displacement.
constexpr int kFx = 0;
constexpr int kFy = 1;
constexpr int kFz = 2;
constexpr int kMx = 3;
constexpr int kMy = 4;

template <class Real>
std::int8_t sign(Real value) {
  return value < 0 ? std::int8_t{-1} : std::int8_t{1};
}

template <class Real>
bool is_regularised(const GroundFacet<Real>& facet) {
  return facet.law == ContactLaw::kRegularised;
}

/// Moves a force from the facet centre to the node: the torques gain the lever of the force.
template <class Real>
Vec6<Real> at_node(const GroundFacet<Real>& facet, Vec6<Real> force) {
  force[kMx] += force[kFy] * facet.lever;
  force[kMy] -= force[kFx] * facet.lever;
  return force;
}

template <class Real>
ContactState regularised_state(const GroundFacet<Real>& facet, const Vec6<Real>& trial) {
  const Real limit = -trial[kFz] * facet.half_width;
  if (limit <= 0) {
    return {.pressed = false};
  }
  ContactState state;
  state.tilt_x = absolute(trial[kMx]) >= limit ? sign(trial[kMx]) : std::int8_t{0};
  state.tilt_y = absolute(trial[kMy]) >= limit ? sign(trial[kMy]) : std::int8_t{0};
  return state;
}

/// The cone problem in forces: trial = [f0 f1 f2] = k s with f1 = mx^/l, f2 = my^/l.
template <class Real>
struct ConeProblem {
  Real f0;                // f0 = k0 s0
  std::array<Real, 2> a;  // |f1|, |f2|
  Real corner_pressure;   // Pressure p while standing on one corner.

  ConeProblem(const GroundFacet<Real>& facet, const Vec6<Real>& trial) : f0(trial[kFz]) {
    const Real k0 = facet.stiffness[kFz];
    Real sum = 0;
    Real share = 1;
    for (std::size_t i = 0; i < 2; ++i) {
      const Real k = facet.stiffness[kMx + i] / (facet.half_width * facet.half_width);
      a[i] = absolute(trial[kMx + i]) / facet.half_width;
      sum += a[i] / k;
      share += k0 / k;
    }
    corner_pressure = (k0 * sum - f0) / share;
  }
};

template <class Real>
ContactState unilateral_state(const GroundFacet<Real>& facet, const Vec6<Real>& trial) {
  const ConeProblem<Real> cone(facet, trial);
  const auto [a1, a2] = cone.a;
  if (a1 <= -cone.f0 && a2 <= -cone.f0) {
    return {.pressed = cone.f0 < 0};
  }
  const Real p = cone.corner_pressure;
  if (p <= 0) {
    return {.pressed = false};
  }
  // p of the corner is a weighted mean of an edge's pressure and the other torque's force, so a
  // torque that does not exceed it does not tilt; if neither exceeded it the facet were closed.
  ContactState state;
  if (a1 > p || a1 >= a2) {
    state.tilt_x = sign(trial[kMx]);
  }
  if (a2 > p || a2 > a1) {
    state.tilt_y = sign(trial[kMy]);
  }
  return state;
}

/// The force of the paper's law, Eqs. (10)-(12).
template <class Real>
Vec6<Real> regularised_force(const GroundFacet<Real>& facet, ContactState state,
                             const Vec6<Real>& trial) {
  const Real gamma = facet.gamma;
  Vec6<Real> force = trial;
  if (!state.pressed) {
    for (Real& value : force) {
      value *= gamma;
    }
  }
  const Real arm = (1 - gamma) * facet.half_width;
  if (state.tilt_x != 0) {
    const Real follows = arm * trial[kFz];
    force[kMx] = gamma * trial[kMx] - (state.tilt_x < 0 ? -follows : follows);
  }
  if (state.tilt_y != 0) {
    const Real follows = arm * trial[kFz];
    force[kMy] = gamma * trial[kMy] - (state.tilt_y < 0 ? -follows : follows);
  }
  return force;
}

/// The cone law. Pressed, p is linear in the trial force, fz = -p, m^ = sign p l where the facet
/// tilts; of all other components the facet holds the trial value, or nothing.
template <class Real>
Vec6<Real> unilateral_force(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                            const Vec6<Real>& trial) {
  const Real keep = 1 - facet.gamma;
  const Real l = facet.half_width;
  const Real k0 = facet.stiffness[kFz];
  const std::array<std::int8_t, 6> tilts = {0, 0, 0, state.tilt_x, state.tilt_y, 0};
  // p = (sum over tilts of k0/k |m^|/l - fz) / share, with k = stiffness / l^2.
  Real share = 1;
  for (std::size_t i = kMx; i <= kMy; ++i) {
    share += tilts[i] != 0 ? k0 * l * l / facet.stiffness[i] : 0;
  }
  Vec6<Real> force{};
  for (std::size_t row = 0; row < 6; ++row) {
    const bool is_sideways = row < kFz || row > kMy;
    const bool is_held_here = is_sideways ? is_held : state.pressed;
    const bool follows = state.pressed && (row == kFz || tilts[row] != 0);
    if (!follows) {
      force[row] += ((is_held_here ? keep : Real{0}) + facet.gamma) * trial[row];
      continue;
    }
    const Real lever = row == kFz ? Real{-1} : static_cast<Real>(tilts[row]) * l;
    for (std::size_t i = kFz; i <= kMy; ++i) {
      Real pressure = -1 / share;
      if (i != kFz) {
        pressure = static_cast<Real>(tilts[i]) * k0 * l / facet.stiffness[i] / share;
      }
      const Real entry = lever * pressure * keep;
      force[row] += (i == row ? entry + facet.gamma : entry) * trial[i];
    }
  }
  return force;
}

}  // namespace

template <class Real>
GroundFacet<Real> ground_facet(const BeamStiffness<Real>& beam, Real length, Real facet_width,
                               Real gamma, ContactLaw law) {
  return {.stiffness = {beam.shear_x, beam.shear_y, beam.axial, beam.bend_y / 4, beam.bend_x / 4,
                        beam.twist},
          .lever = length / 2,
          .half_width = facet_width / 2,
          .gamma = gamma,
          .law = law};
}

template <class Real>
GroundFacet<Real> ground_facet(const BeamSection<Real>& section, Real facet_width, Real gamma,
                               ContactLaw law) {
  return ground_facet(beam_stiffness(section), section.length, facet_width, gamma, law);
}

template <class Real>
Vec6<Real> trial_force(const GroundFacet<Real>& facet, const Vec6<Real>& u) {
  const Vec6<Real>& h = facet.stiffness;
  return {h[0] * (u[0] - u[4] * facet.lever),
          h[1] * (u[1] + u[3] * facet.lever),
          h[2] * u[2],
          h[3] * u[3],
          h[4] * u[4],
          h[5] * u[5]};
}

template <class Real>
ContactState contact_state(const GroundFacet<Real>& facet, const Vec6<Real>& trial) {
  return is_regularised(facet) ? regularised_state(facet, trial) : unilateral_state(facet, trial);
}

/// The force on the facet, about its centre.
template <class Real>
Vec6<Real> corrected(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                     const Vec6<Real>& trial) {
  return is_regularised(facet) ? regularised_force(facet, state, trial)
                               : unilateral_force(facet, state, is_held, trial);
}

template <class Real>
Mat6<Real> corrector(const GroundFacet<Real>& facet, ContactState state, bool is_held) {
  return matrix_of<Real>(
      [&](const Vec6<Real>& unit) { return corrected(facet, state, is_held, unit); });
}

template <class Real>
Vec6<Real> contact_force(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                         const Vec6<Real>& u) {
  return at_node(facet, corrected(facet, state, is_held, trial_force(facet, u)));
}

template <class Real>
Mat6<Real> contact_tangent(const GroundFacet<Real>& facet, ContactState state, bool is_held) {
  return matrix_of<Real>(
      [&](const Vec6<Real>& unit) { return contact_force(facet, state, is_held, unit); });
}

/// Facet coordinates: a diagonal, and kappa e e^T where the facet tilts, e = [uz, tx, ty] -> lift
/// of the pressed edge or corner.
template <class Real>
Vec6<Real> symmetric_product(const GroundFacet<Real>& facet, ContactState state, bool is_held,
                             const Vec6<Real>& u) {
  const bool is_unilateral = !is_regularised(facet);
  const Real gamma = facet.gamma;
  const Vec6<Real> trial = trial_force(facet, u);
  const bool holds_sideways = is_unilateral ? is_held : state.pressed;
  Vec6<Real> force = trial;
  for (std::size_t i = 0; i < 6; ++i) {
    const bool is_sideways = i < kFz || i > kMy;
    force[i] *= (is_sideways ? holds_sideways : state.pressed) ? Real{1} : gamma;
  }
  if (state.pressed && (state.tilt_x != 0 || state.tilt_y != 0)) {
    const std::array<Real, 2> tilts = {static_cast<Real>(state.tilt_x),
                                       static_cast<Real>(state.tilt_y)};
    const Real k0 = facet.stiffness[kFz];
    Real give = 1;
    Real lift = u[kFz];
    for (std::size_t i = 0; i < 2; ++i) {
      const Real e = -tilts[i] * facet.half_width;
      give += k0 * e * e / facet.stiffness[kMx + i];
      lift += e * u[kMx + i];
    }
    const Real pressed = (is_unilateral ? (1 - gamma) * k0 / give : k0) * lift;
    force[kFz] = pressed + (is_unilateral ? gamma * trial[kFz] : Real{0});
    for (std::size_t i = 0; i < 2; ++i) {
      const Real e = -tilts[i] * facet.half_width;
      force[kMx + i] = (tilts[i] != 0 ? gamma : Real{1}) * trial[kMx + i] + e * pressed;
    }
  }
  return at_node(facet, force);
}

template <class Real>
Mat6<Real> symmetric_tangent(const GroundFacet<Real>& facet, ContactState state, bool is_held) {
  return matrix_of<Real>(
      [&](const Vec6<Real>& unit) { return symmetric_product(facet, state, is_held, unit); });
}

#define HOLDFAST_INSTANTIATE(Real)                                                           \
  template GroundFacet<Real> ground_facet(const BeamSection<Real>&, Real, Real, ContactLaw); \
  template GroundFacet<Real> ground_facet(const BeamStiffness<Real>&, Real, Real, Real,      \
                                          ContactLaw);                                       \
  template Vec6<Real> trial_force(const GroundFacet<Real>&, const Vec6<Real>&);              \
  template ContactState contact_state(const GroundFacet<Real>&, const Vec6<Real>&);          \
  template Mat6<Real> corrector(const GroundFacet<Real>&, ContactState, bool);               \
  template Vec6<Real> contact_force(const GroundFacet<Real>&, ContactState, bool,            \
                                    const Vec6<Real>&);                                      \
  template Mat6<Real> contact_tangent(const GroundFacet<Real>&, ContactState, bool);         \
  template Vec6<Real> symmetric_product(const GroundFacet<Real>&, ContactState, bool,        \
                                        const Vec6<Real>&);                                  \
  template Mat6<Real> symmetric_tangent(const GroundFacet<Real>&, ContactState, bool);

HOLDFAST_INSTANTIATE(float)
HOLDFAST_INSTANTIATE(double)
#if __SIZEOF_DOUBLE__ == 8  // Not on an ATxmega.
HOLDFAST_INSTANTIATE(base::DoubleDouble)
#endif
#undef HOLDFAST_INSTANTIATE

}  // namespace holdfast::mechanics
