// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "balance.hpp"

namespace holdfast::certificate {
namespace {

constexpr const char* kTooLarge = "a force is too large for the numbers of the proof";

/// A rotation about x or y, and the state's tilt about it.
struct Tilt {
  std::size_t index;
  int sign;
};

std::array<Tilt, 2> tilts(const State& state) { return {{{3, state.tilt_x}, {4, state.tilt_y}}}; }

Six difference(Six a, const Six& b) {
  for (std::size_t i = 0; i < 6; ++i) {
    a[i] -= b[i];
  }
  return a;
}

void add_to(Six& sum, const Six& term) {
  for (std::size_t i = 0; i < 6; ++i) {
    sum[i] += term[i];
  }
}

Integer absolute(Integer value) { return value < 0 ? -value : value; }

/// e x t for the force t of a rest.
Six lever_of(const Six& rest, int axis) {
  Six lever{};
  add_at_a(lever, {rest[0], rest[1], rest[2], 0, 0, 0}, axis);
  return lever;
}

/// The spring forces s that balance a rest r at the end b: r_t = s_t, r_m = s_m - e x s_t.
Six balancing_at_b(const Six& rest, int axis) {
  const Six lever = lever_of(rest, axis);
  Six s = rest;
  for (std::size_t i = 3; i < 6; ++i) {
    s[i] += lever[i];
  }
  return s;
}

/// The spring forces s that balance a rest r at the end a: r_t = -s_t, r_m = -s_m - e x s_t.
Six balancing_at_a(const Six& rest, int axis) {
  Six s = lever_of(rest, axis);
  for (std::size_t i = 0; i < 3; ++i) {
    s[i] = -rest[i];
    s[i + 3] -= rest[i + 3];
  }
  return s;
}

}  // namespace

Balancer::Balancer(const Certificate& certificate, const Structure& structure,
                   const Constants& constants)
    : certificate_(certificate), structure_(structure), constants_(constants) {
  std::size_t next = 1;
  for (std::size_t facet = 0; facet < structure.facets().size(); ++facet) {
    field_of_facet_.push_back(state_of(facet).is_tilted() ? next++ : 0);
  }
}

Springs Balancer::facet_springs(const State& state) const {
  Springs springs = constants_.h[kZ];
  if (certificate_.law != Law::kRegularised) {
    return springs;
  }
  for (std::size_t i = 0; i < 6; ++i) {
    const bool is_weak =
        !state.is_pressed || (i == 3 && state.tilt_x != 0) || (i == 4 && state.tilt_y != 0);
    springs[i] = is_weak ? constants_.weakness * springs[i] : springs[i];
  }
  return springs;
}

/// Sets the follower, an integer near c t_z with c = (1 - gamma) times the facet's half width, and
/// one unit more in the field that belongs to this facet.
void Balancer::follow(std::size_t facet, std::size_t field, const Six& gap,
                      Balance& balance) const {
  const double force = constants_.follow.middle() * static_cast<double>(gap[kZ]);
  if (!(std::abs(force) < std::ldexp(1.0, kMagnitudeBitsMax))) {
    balance.fault = kTooLarge;
    return;
  }
  const Integer unit = field_of_facet_[facet] == field ? Integer{1} << certificate_.bits : 0;
  balance.follower[facet] = static_cast<Integer>(force) + unit;
}

/// An edge or a corner under pressure p: the torques that tilt are p, and the facet has lifted by
/// v in the cone with v . s = 0. p = (sum of |r| - u_z) / (1 + sum of 1 / h_r) over the tilts.
void Balancer::press_edge(std::size_t facet, const Six& gap, Balance& balance) const {
  const Springs& h = constants_.h[kZ];
  const State& state = state_of(facet);
  double lift = -static_cast<double>(gap[kZ]);
  double share = 1;
  for (const auto& [index, sign] : tilts(state)) {
    lift += sign * static_cast<double>(gap[index]);
    share += sign == 0 ? 0 : 1 / h[index].middle();
  }
  const double pressure = lift / share;
  if (!(pressure > 0 && pressure < std::ldexp(1.0, kMagnitudeBitsMax))) {
    balance.fault = "a facet that is said to be pressed is not";
    return;
  }
  const auto p = static_cast<Integer>(pressure);
  Six& s = balance.facet[facet];
  Six v{};
  s[kZ] = -p;
  for (const auto& [index, sign] : tilts(state)) {
    if (sign != 0) {
      s[index] = sign * p;
      v[index] = gap[index] - static_cast<Integer>(sign * pressure / h[index].middle());
      v[kZ] += sign * v[index];
    }
    const bool is_in_cone = sign * v[index] >= 0 && absolute(s[index]) <= p;
    if (!is_in_cone) {
      balance.fault = "a facet's state is not the one that its displacements prescribe";
    }
  }
  balance.hold[facet] = difference(gap, v);
}

/// One facet under the unilateral law.
void Balancer::press(std::size_t facet, const Six& gap, Balance& balance) const {
  const State& state = state_of(facet);
  if (!state.is_pressed) {
    balance.facet[facet] = {};
    balance.hold[facet] = {};
    if (gap[kZ] < absolute(gap[3]) + absolute(gap[4])) {
      balance.fault = "a facet that is said to be open is not";
    }
  } else if (state.is_tilted()) {
    press_edge(facet, gap, balance);
  }
}

Balance Balancer::from_springs(std::size_t field) const {
  const Field& u = certificate_.fields[field];
  const std::vector<std::size_t>& facets = structure_.facets();
  Balance balance;
  balance.rest.resize(u.size());
  if (field == 0) {
    for (Six& load : balance.rest) {
      load[kZ] = -(Integer{1} << certificate_.bits);
    }
  }
  bool is_too_large = false;
  for (const Beam& beam : structure_.beams()) {
    const Six& s = balance.beam.emplace_back(spring_force(
        constants_.h[static_cast<std::size_t>(beam.axis)], gap(u, beam), is_too_large));
    add_at_a(balance.rest[beam.a], s, beam.axis);
    add_at_b(balance.rest[beam.b], s, beam.axis);
  }
  balance.follower.assign(facets.size(), 0);
  for (std::size_t i = 0; i < facets.size(); ++i) {
    const Six w = facet_gap(u, facets[i]);
    balance.hold.push_back(w);
    balance.facet.push_back(spring_force(facet_springs(state_of(i)), w, is_too_large));
    if (certificate_.law == Law::kUnilateral) {
      press(i, w, balance);
    }
    Six force = balance.facet.back();
    if (certificate_.law == Law::kRegularised && state_of(i).is_tilted()) {
      follow(i, field, w, balance);
      for (const auto& [index, sign] : tilts(state_of(i))) {
        force[index] -= sign * balance.follower[i];
      }
    }
    add_at_b(balance.rest[facets[i]], force, kZ);
  }
  if (is_too_large) {
    balance.fault = kTooLarge;
  }
  return balance;
}

/// Goes from the ends of the trees to their roots.
void Balancer::close(Balance& balance) const {
  const std::vector<std::size_t>& facets = structure_.facets();
  std::vector<std::size_t> facet_of(balance.rest.size());
  for (std::size_t i = 0; i < facets.size(); ++i) {
    facet_of[facets[i]] = i;
  }
  for (std::size_t n = structure_.order().size(); n-- > 0;) {
    const std::size_t module = structure_.order()[n];
    const std::size_t link = structure_.link()[module];
    Six& rest = balance.rest[module];
    bool is_fine = is_small(rest);
    if (link == Structure::kFixed) {
      rest = {};
    } else if (link == Structure::kFacet) {
      Six& carried = balance.facet[facet_of[module]];
      const Six s = balancing_at_b(rest, kZ);
      add_to(carried, s);
      add_at_b(rest, s, kZ);
      is_fine = is_fine && is_small(carried);
    } else {
      const Beam& beam = structure_.beams()[link];
      const Six s =
          beam.b == module ? balancing_at_b(rest, beam.axis) : balancing_at_a(rest, beam.axis);
      add_to(balance.beam[link], s);
      add_at_a(balance.rest[beam.a], s, beam.axis);
      add_at_b(balance.rest[beam.b], s, beam.axis);
      is_fine = is_fine && is_small(balance.beam[link]);
    }
    if (!is_fine || rest != Six{}) {
      balance.fault = kTooLarge;
      return;
    }
  }
}

double Balancer::mismatch(const Balance& balance, std::size_t field) const {
  Ball energy;
  for (std::size_t i = 0; i < balance.beam.size(); ++i) {
    const Beam& beam = structure_.beams()[i];
    add_mismatch(energy, constants_.h[static_cast<std::size_t>(beam.axis)], balance.beam[i],
                 gap(certificate_.fields[field], beam));
  }
  for (std::size_t i = 0; i < balance.facet.size(); ++i) {
    add_mismatch(energy, facet_springs(state_of(i)), balance.facet[i], balance.hold[i]);
  }
  return energy.root_high();
}

double Balancer::magnitude(const Balance& balance) const {
  Ball energy;
  for (std::size_t i = 0; i < balance.beam.size(); ++i) {
    add_energy(energy, constants_.h[static_cast<std::size_t>(structure_.beams()[i].axis)],
               balance.beam[i]);
  }
  for (std::size_t i = 0; i < balance.facet.size(); ++i) {
    add_energy(energy, facet_springs(state_of(i)), balance.facet[i]);
  }
  return energy.root_high();
}

}  // namespace holdfast::certificate
