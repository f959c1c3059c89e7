// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "statics.hpp"

#include <algorithm>
#include <numeric>

namespace holdfast::certificate {
namespace {

using Cell = std::array<std::int32_t, 3>;

/// Encloses the double in the certificate and the decimal number in the file that was rounded to
/// it.
Ball number(double value) {
  return {value, std::abs(value) * std::numeric_limits<double>::epsilon()};
}

struct Axes {
  explicit Axes(int axis) : i(static_cast<std::size_t>(axis)), j((i + 1) % 3), k((i + 2) % 3) {}

  std::size_t i, j, k;
};

}  // namespace

/// Table I and Eqs. (1)-(4) of [Piranda 2021], over E A / L. Local x of a vertical beam is the
/// global x axis, of a lateral one the global z axis; Iy resists rotation about local x and shear
/// along local y.
Constants::Constants(const Material& material) {
  const Ball scale = number(material.area) * number(material.pitch) * number(material.pitch);
  const Ball x = number(material.moment_x) / scale;
  const Ball y = number(material.moment_y) / scale;
  const Ball torsion =
      number(material.torsion) / (Ball(2) * (Ball(1) + number(material.poisson))) / scale;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t local_x = axis == 2 ? 0 : 2;
    const std::size_t local_y = 3 - axis - local_x;
    Springs& springs = h[axis];
    springs[axis] = Ball(1);
    springs[local_x] = Ball(12) * x;
    springs[local_y] = Ball(12) * y;
    springs[3 + axis] = Ball(4) * torsion;
    springs[3 + local_x] = Ball(4) * y;
    springs[3 + local_y] = Ball(4) * x;
  }
  is_facet_whole = material.facet == material.pitch;
  facet = is_facet_whole ? Ball(1) : number(material.facet) / number(material.pitch);
  weakness = number(material.gamma);
  follow = (Ball(1) - weakness) * facet;
  const Ball weight = number(material.mass) * number(material.gravity);
  const Ball lateral = number(material.strength_lateral) / weight;
  strength = {lateral, lateral, number(material.strength_vertical) / weight};
}

Structure::Structure(const Certificate& certificate) {
  const std::size_t count = certificate.modules.size();
  if (count == 0) {
    fault_ = "there is no module";
    return;
  }
  connect(certificate);
  if (!fault_.empty()) {
    return;
  }
  if (!plant(certificate, true) && certificate.law == Law::kRegularised) {
    plant(certificate, false);
  }
  grow();
  if (order_.size() < count) {
    fault_ = order_.empty() ? "no facet is pressed with all of its face, and no module is fixed"
                            : "the robot is not connected";
  }
}

void Structure::connect(const Certificate& certificate) {
  const std::vector<Module>& modules = certificate.modules;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (!modules[i].is_fixed && modules[i].cell[2] == certificate.support_z) {
      facets_.push_back(i);
    }
  }
  beams_of_.resize(modules.size());
  for (auto& beams : beams_of_) {
    beams.fill(kNone);
  }
  // Along each axis neighbours are next to each other in the order of the other two, then of it.
  std::vector<std::size_t> sorted(modules.size());
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  for (int axis = 0; axis < 3; ++axis) {
    const auto [i, j, k] = Axes(axis);
    const auto key = [&, i = i, j = j, k = k](std::size_t module) {
      const Cell& cell = modules[module].cell;
      return Cell{cell[j], cell[k], cell[i]};
    };
    std::sort(sorted.begin(), sorted.end(),
              [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
    for (std::size_t n = 1; n < sorted.size(); ++n) {
      const std::size_t a = sorted[n - 1];
      const std::size_t b = sorted[n];
      Cell next = key(a);
      if (next == key(b)) {
        fault_ = "two modules are in one cell";
      }
      ++next[2];
      if (next == key(b)) {
        beams_of_[a][2 * i] = beams_.size();
        beams_of_[b][2 * i + 1] = beams_.size();
        beams_.push_back({.a = a, .b = b, .axis = axis});
      }
    }
  }
}

/// Takes fixed modules and facets as supports, those that are pressed with all of their face only
/// or all. Returns whether there are any.
bool Structure::plant(const Certificate& certificate, bool is_full_only) {
  link_.assign(certificate.modules.size(), kNone);
  depth_.assign(certificate.modules.size(), 0);
  order_.clear();
  const auto support = [&](std::size_t module, std::size_t kind) {
    link_[module] = kind;
    order_.push_back(module);
  };
  for (std::size_t i = 0; i < certificate.modules.size(); ++i) {
    if (certificate.modules[i].is_fixed) {
      support(i, kFixed);
    }
  }
  for (const std::size_t i : facets_) {
    const State& state = certificate.modules[i].state;
    if (!is_full_only || (state.is_pressed && !state.is_tilted())) {
      support(i, kFacet);
    }
  }
  return !order_.empty();
}

/// Goes breadth first, so that paths are short.
void Structure::grow() {
  for (std::size_t next = 0; next < order_.size(); ++next) {
    const std::size_t module = order_[next];
    for (const std::size_t beam : beams_of_[module]) {
      if (beam == kNone) {
        continue;
      }
      const std::size_t other = beams_[beam].a == module ? beams_[beam].b : beams_[beam].a;
      if (link_[other] == kNone) {
        link_[other] = beam;
        depth_[other] = depth_[module] + 1;
        order_.push_back(other);
      }
    }
  }
}

Six gap(const Field& field, const Beam& beam) {
  const Six& p = field[beam.a];
  const Six& q = field[beam.b];
  const auto [i, j, k] = Axes(beam.axis);
  Six w{};
  w[i] = q[i] - p[i];
  w[j] = q[j] - p[j] - (p[k + 3] + q[k + 3]);
  w[k] = q[k] - p[k] + (p[j + 3] + q[j + 3]);
  for (std::size_t r = 3; r < 6; ++r) {
    w[r] = q[r] - p[r];
  }
  return w;
}

Six facet_gap(const Field& field, std::size_t module) {
  Six w = field[module];
  w[0] -= w[4];
  w[1] += w[3];
  return w;
}

namespace {

/// The torque e x s_t of a force half a pitch along an axis.
void add_lever(Six& force, const Six& s, int axis) {
  const auto [i, j, k] = Axes(axis);
  force[j + 3] -= s[k];
  force[k + 3] += s[j];
}

}  // namespace

void add_at_a(Six& force, const Six& s, int axis) {
  for (std::size_t i = 0; i < 6; ++i) {
    force[i] += s[i];
  }
  add_lever(force, s, axis);
}

void add_at_b(Six& force, const Six& s, int axis) {
  for (std::size_t i = 0; i < 6; ++i) {
    force[i] -= s[i];
  }
  add_lever(force, s, axis);
}

Six spring_force(const Springs& h, const Six& w, bool& is_too_large) {
  Six s{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double force = h[i].middle() * static_cast<double>(w[i]);
    if (std::abs(force) < std::ldexp(1.0, kMagnitudeBitsMax)) {
      s[i] = static_cast<Integer>(force);
    } else {
      is_too_large = true;
    }
  }
  return s;
}

void add_mismatch(Ball& energy, const Springs& h, const Six& s, const Six& w) {
  for (std::size_t i = 0; i < 6; ++i) {
    const Ball off = (ball_of(s[i]) - h[i] * ball_of(w[i])).largest();
    energy = energy + off * off / h[i];
  }
}

void add_energy(Ball& energy, const Springs& h, const Six& s) {
  for (std::size_t i = 0; i < 6; ++i) {
    energy = energy + ball_of(s[i]) * ball_of(s[i]) / h[i];
  }
}

bool is_small(const Six& six) {
  constexpr Integer kLimit = Integer{1} << kMagnitudeBitsMax;
  return std::all_of(six.begin(), six.end(),
                     [](Integer value) { return value < kLimit && value > -kLimit; });
}

}  // namespace holdfast::certificate
