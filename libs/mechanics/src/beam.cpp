// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/beam.hpp"

#include "holdfast/base/double_double.hpp"
#include "holdfast/mechanics/frame.hpp"

namespace holdfast::mechanics {
namespace {

using base::Direction;
using base::Mat6;
using base::Vec6;

const Frame& frame_of(Direction direction) {
  return kCubicFrames[static_cast<std::size_t>(base::index(direction))];
}

template <class Real>
Vec6<Real> local_end_force(const BeamStiffness<Real>& k, const Vec6<Real>& p, const Vec6<Real>& q) {
  const Real dx = p[0] - q[0];
  const Real dy = p[1] - q[1];
  return {k.shear_x * dx - k.couple_x * (p[4] + q[4]),
          k.shear_y * dy + k.couple_y * (p[3] + q[3]),
          k.axial * (p[2] - q[2]),
          k.couple_y * dy + k.bend_y * (p[3] + q[3] / 2),
          -k.couple_x * dx + k.bend_x * (p[4] + q[4] / 2),
          k.twist * (p[5] - q[5])};
}

}  // namespace

template <class Real>
BeamStiffness<Real> beam_stiffness(const BeamSection<Real>& section) {
  const Real length = section.length;
  const Real flexural_x = section.elastic_modulus * section.moment_x / length;
  const Real flexural_y = section.elastic_modulus * section.moment_y / length;
  return {.shear_x = 12 * flexural_x / (length * length),
          .shear_y = 12 * flexural_y / (length * length),
          .axial = section.elastic_modulus * section.area / length,
          .couple_x = 6 * flexural_x / length,
          .couple_y = 6 * flexural_y / length,
          .bend_x = 4 * flexural_x,
          .bend_y = 4 * flexural_y,
          .twist = section.elastic_modulus * section.torsion / length};
}

template <class Real>
Vec6<Real> to_local(Direction direction, const Vec6<Real>& global) {
  return to_local(frame_of(direction), global);
}

template <class Real>
Vec6<Real> to_global(Direction direction, const Vec6<Real>& local) {
  return to_global(frame_of(direction), local);
}

template <class Real>
Vec6<Real> end_force(const BeamStiffness<Real>& beam, Direction direction, const Vec6<Real>& u_p,
                     const Vec6<Real>& u_q) {
  return to_global(direction,
                   local_end_force(beam, to_local(direction, u_p), to_local(direction, u_q)));
}

template <class Real>
Vec6<Real> middle_force(const BeamStiffness<Real>& beam, Direction direction, const Vec6<Real>& u_p,
                        const Vec6<Real>& u_q) {
  const Vec6<Real> p = to_local(direction, u_p);
  const Vec6<Real> q = to_local(direction, u_q);
  Vec6<Real> force = local_end_force(beam, p, q);
  force[3] = beam.bend_y / 4 * (p[3] - q[3]);
  force[4] = beam.bend_x / 4 * (p[4] - q[4]);
  return force;
}

template <class Real>
Mat6<Real> block_11(const BeamStiffness<Real>& beam, Direction direction) {
  return base::matrix_of<Real>(
      [&](const Vec6<Real>& unit) { return end_force(beam, direction, unit, Vec6<Real>{}); });
}

template <class Real>
Mat6<Real> block_12(const BeamStiffness<Real>& beam, Direction direction) {
  return base::matrix_of<Real>(
      [&](const Vec6<Real>& unit) { return end_force(beam, direction, Vec6<Real>{}, unit); });
}

#define HOLDFAST_INSTANTIATE(Real)                                                           \
  template BeamStiffness<Real> beam_stiffness(const BeamSection<Real>&);                     \
  template Vec6<Real> to_local(Direction, const Vec6<Real>&);                                \
  template Vec6<Real> to_global(Direction, const Vec6<Real>&);                               \
  template Vec6<Real> end_force(const BeamStiffness<Real>&, Direction, const Vec6<Real>&,    \
                                const Vec6<Real>&);                                          \
  template Vec6<Real> middle_force(const BeamStiffness<Real>&, Direction, const Vec6<Real>&, \
                                   const Vec6<Real>&);                                       \
  template Mat6<Real> block_11(const BeamStiffness<Real>&, Direction);                       \
  template Mat6<Real> block_12(const BeamStiffness<Real>&, Direction);

HOLDFAST_INSTANTIATE(float)
HOLDFAST_INSTANTIATE(double)
#if __SIZEOF_DOUBLE__ == 8  // Not on an ATxmega.
HOLDFAST_INSTANTIATE(base::DoubleDouble)
#endif
#undef HOLDFAST_INSTANTIATE

}  // namespace holdfast::mechanics
