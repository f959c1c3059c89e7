// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/precise_refinement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::DoubleDouble;

/// A correction this small beside the displacements is rounding in 106 bits.
constexpr double kSmallChange = 1e-26;

/// What stops falling below this has 18 digits at least and counts as found.
constexpr double kFound = 1e-18;

/// More steps than a factorization in double has needed on the softest and longest robots seen, 12.
constexpr int kStepMax = 60;

using PreciseVec = base::Vec6<DoubleDouble>;

/// The section in 106 bits from the start: rounded to double the numbers of one beam would no
/// longer fit together, and a beam that turns as a rigid body would resist.
mechanics::BeamSection<DoubleDouble> precise_section(const model::Material& material) {
  const mechanics::BeamSection<double> section = model::beam_section(material);
  return {.elastic_modulus = section.elastic_modulus,
          .length = section.length,
          .area = section.area,
          .moment_x = section.moment_x,
          .moment_y = section.moment_y,
          .torsion = section.torsion};
}

DoubleDouble inner_product(const std::vector<PreciseVec>& a, const std::vector<PreciseVec>& b) {
  DoubleDouble sum;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += base::dot(a[i], b[i]);
  }
  return sum;
}

/// a += factor b
void add(std::vector<PreciseVec>& a, DoubleDouble factor, const std::vector<PreciseVec>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      a[i][k] += factor * b[i][k];
    }
  }
}

template <class To, class From>
std::vector<base::Vec6<To>> all_converted(const std::vector<base::Vec6<From>>& vectors) {
  std::vector<base::Vec6<To>> result(vectors.size());
  std::ranges::transform(vectors, result.begin(), base::converted<To, From>);
  return result;
}

}  // namespace

PreciseRefinement::PreciseRefinement(const LinearSystem& system)
    : system_(system),
      robot_(system.robot()),
      beam_(precise_section(robot_.material()), robot_.lattice()),
      law_(beam_, 2 * robot_.foot_half_width_mm(), system.ground().gamma, system.ground().law) {}

bool PreciseRefinement::run(const std::vector<Vec>& displacement, const Solve& solve) {
  displacement_ = all_converted<DoubleDouble>(displacement);
  older_.clear();
  PreciseVecs left = residual();
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kStepMax; ++step) {
    std::vector<Vec> correction = all_converted<double>(left);
    solve(correction);
    Direction next = conjugate(all_converted<DoubleDouble>(correction));
    const DoubleDouble length = inner_product(next.p, left) / next.curvature;
    if (!std::isfinite(length.high)) {
      return false;
    }
    add(displacement_, length, next.p);
    add(left, -length, next.image);
    const double change = std::abs(length.high) * size_of(next.p);
    const double largest = size_of(displacement_);
    if (change <= kSmallChange * largest) {
      return true;
    }
    least = std::min(least, change);
    older_.push_back(std::move(next));
  }
  return least <= kFound * size_of(displacement_);
}

/// The step less what older ones have done: p_old . A p = 0.
PreciseRefinement::Direction PreciseRefinement::conjugate(PreciseVecs step) const {
  Direction next = {.p = std::move(step), .image = {}, .curvature = {}};
  next.image = product(next.p);
  for (const Direction& old : older_) {
    const DoubleDouble turn = inner_product(old.p, next.image) / old.curvature;
    add(next.p, -turn, old.p);
    add(next.image, -turn, old.image);
  }
  next.curvature = inner_product(next.p, next.image);
  return next;
}

bool PreciseRefinement::is_fixed(std::size_t module) const {
  return robot_.modules()[module].support == model::Support::kFixed;
}

/// The largest motion of a module, mm; rotations act at a lever of one pitch.
double PreciseRefinement::size_of(const PreciseVecs& motion) const {
  double size = 0;
  for (const PreciseVec& u : motion) {
    for (std::size_t k = 0; k < 6; ++k) {
      size = std::max(size, std::abs(u[k].high) * (k < 3 ? 1 : robot_.material().pitch_mm));
    }
  }
  return size;
}

/// A u: the force on every module that is not fixed, by its beams and its facet.
PreciseRefinement::PreciseVecs PreciseRefinement::product(const PreciseVecs& u) const {
  PreciseVecs force(u.size());
  const auto take = [&](std::size_t module, const PreciseVec& part) {
    if (!is_fixed(module)) {
      base::add_to(force[module], part);
    }
  };
  for (const model::Connection& connection : robot_.connections()) {
    const std::size_t a = at(connection.a);
    const std::size_t b = at(connection.b);
    take(a, beam_.end_force(connection.direction, u[a], u[b]));
    take(b, beam_.end_force(base::opposite(connection.direction), u[b], u[a]));
  }
  for (const FacetState& facet : system_.facets()) {
    take(facet.module, law_.force(facet, u[facet.module]));
  }
  return force;
}

/// What the displacements leave of the loads.
PreciseRefinement::PreciseVecs PreciseRefinement::residual() const {
  PreciseVecs left = product(displacement_);
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (DoubleDouble& component : left[i]) {
      component = -component;
    }
    if (!is_fixed(i)) {
      base::add_to(left[i], base::converted<DoubleDouble>(system_.loads()[i]));
    }
  }
  return left;
}

std::vector<base::Vec6<double>> PreciseRefinement::high() const {
  return all_converted<double>(displacement_);
}

std::vector<base::Vec6<double>> PreciseRefinement::low() const {
  std::vector<Vec> part = high();
  for (std::size_t i = 0; i < part.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      part[i][k] = static_cast<double>(displacement_[i][k] - DoubleDouble(part[i][k]));
    }
  }
  return part;
}

std::vector<mechanics::ContactState> PreciseRefinement::states() const {
  std::vector<mechanics::ContactState> states;
  states.reserve(system_.facets().size());
  for (const FacetState& facet : system_.facets()) {
    states.push_back(law_.state_at(facet, displacement_[facet.module]));
  }
  return states;
}

}  // namespace holdfast::solver
