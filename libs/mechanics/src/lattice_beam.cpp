// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/lattice_beam.hpp"

#include "holdfast/base/double_double.hpp"

namespace holdfast::mechanics {
namespace {

using base::Direction;
using base::Mat6;
using base::Vec6;

/// All beams have the same law in their own frames; this is the direction whose frame is the global
/// one, with R = 1.
constexpr Direction kUpright = Direction::kMinusZ;

}  // namespace

template <class Real>
Rotation<Real> rotation_along(const base::Lattice& lattice, Direction direction) {
  const std::array<Real, 3> n = base::unit_vector<Real>(lattice, direction);
  const Real across = Real(1) - n[2] * n[2];  // Square of the length of e_z - (e_z . n) n.
  const bool is_vertical = n[0] == Real(0) && n[1] == Real(0);
  std::array<Real, 3> x = {Real(1), Real(0), Real(0)};
  if (!is_vertical) {
    const Real length = base::root(across);
    x = {-n[2] * n[0] / length, -n[2] * n[1] / length, across / length};
  }
  const std::array<Real, 3> z = {-n[0], -n[1], -n[2]};
  return {x, {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]}, z};
}

namespace {

template <class Real>
Vec6<Real> rotated(const Rotation<Real>& axes, const Vec6<Real>& global) {
  Vec6<Real> local;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::array<Real, 3>& axis = axes[i];
    local[i] = axis[0] * global[0] + axis[1] * global[1] + axis[2] * global[2];
    local[i + 3] = axis[0] * global[3] + axis[1] * global[4] + axis[2] * global[5];
  }
  return local;
}

}  // namespace

template <class Real>
LatticeBeam<Real>::LatticeBeam(const BeamSection<Real>& section, const base::Lattice& lattice)
    : beam_(beam_stiffness(section)), is_cubic_(lattice == base::kCubic) {
  for (const Direction direction : base::facet_directions(lattice)) {
    rotations_[static_cast<std::size_t>(base::index(direction))] =
        rotation_along<Real>(lattice, direction);
  }
}

template <class Real>
Vec6<Real> LatticeBeam<Real>::to_local(Direction direction, const Vec& global) const {
  return is_cubic_ ? mechanics::to_local(direction, global) : rotated(rotation(direction), global);
}

template <class Real>
Vec6<Real> LatticeBeam<Real>::to_global(Direction direction, const Vec& local) const {
  if (is_cubic_) {
    return mechanics::to_global(direction, local);
  }
  const Rotation<Real>& axes = rotation(direction);
  Vec global{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      global[k] += axes[i][k] * local[i];
      global[k + 3] += axes[i][k] * local[i + 3];
    }
  }
  return global;
}

template <class Real>
Mat6<Real> LatticeBeam<Real>::to_global(Direction direction, const Mat6<Real>& local) const {
  return base::matrix_of<Real>([&](const Vec& unit) {
    return to_global(direction, base::multiply(local, to_local(direction, unit)));
  });
}

template <class Real>
Vec6<Real> LatticeBeam<Real>::end_force(Direction direction, const Vec& u_p, const Vec& u_q) const {
  if (is_cubic_) {
    return mechanics::end_force(beam_, direction, u_p, u_q);
  }
  const Rotation<Real>& axes = rotation(direction);
  return to_global(direction,
                   mechanics::end_force(beam_, kUpright, rotated(axes, u_p), rotated(axes, u_q)));
}

template <class Real>
Vec6<Real> LatticeBeam<Real>::middle_force(Direction direction, const Vec& u_p,
                                           const Vec& u_q) const {
  if (is_cubic_) {
    return mechanics::middle_force(beam_, direction, u_p, u_q);
  }
  const Rotation<Real>& axes = rotation(direction);
  return mechanics::middle_force(beam_, kUpright, rotated(axes, u_p), rotated(axes, u_q));
}

template <class Real>
Mat6<Real> LatticeBeam<Real>::block_11(Direction direction) const {
  return base::matrix_of<Real>([&](const Vec& unit) { return end_force(direction, unit, Vec{}); });
}

template <class Real>
Mat6<Real> LatticeBeam<Real>::block_12(Direction direction) const {
  return base::matrix_of<Real>([&](const Vec& unit) { return end_force(direction, Vec{}, unit); });
}

#define HOLDFAST_INSTANTIATE(Real)                                         \
  template Rotation<Real> rotation_along(const base::Lattice&, Direction); \
  template class LatticeBeam<Real>;

HOLDFAST_INSTANTIATE(float)
HOLDFAST_INSTANTIATE(double)
#if __SIZEOF_DOUBLE__ == 8  // Not on an ATxmega.
HOLDFAST_INSTANTIATE(base::DoubleDouble)
#endif
#undef HOLDFAST_INSTANTIATE

}  // namespace holdfast::mechanics
