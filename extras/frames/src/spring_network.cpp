// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/frames/spring_network.hpp"

#include <cmath>

#include "vector3.hpp"

namespace holdfast::frames {
namespace {

using base::Mat6;
using base::Vec6;
using plan::cross;
using plan::dot;

/// Force and moment at the end of a bar along d whose other end is held.
Vec6<double> end_force(const BarSection& s, double length, const Vector3& d,
                       const Vec6<double>& motion) {
  const Vector3 u = {motion[0], motion[1], motion[2]};
  const Vector3 t = {motion[3], motion[4], motion[5]};
  const double bend = s.elastic_modulus_mpa * s.moment_mm4 / length;
  const double axial = s.elastic_modulus_mpa * s.area_mm2 / length;
  const double shear = 12 * bend / (length * length);
  const double couple = 6 * bend / length;
  const double twist = s.shear_modulus_mpa * s.torsion_mm4 / length;
  const Vector3 t_d = cross(t, d);
  const Vector3 d_u = cross(d, u);
  Vec6<double> force{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double u_along = dot(d, u) * d[i];
    const double t_along = dot(d, t) * d[i];
    force[i] = axial * u_along + shear * (u[i] - u_along) - couple * t_d[i];
    force[3 + i] = twist * t_along + 4 * bend * (t[i] - t_along) - couple * d_u[i];
  }
  return force;
}

}  // namespace

Mat6<double> rigid_lever(const Vector3& arm_mm) {
  return base::matrix_of<double>([&](const Vec6<double>& f) {
    const Vector3 moment = cross(arm_mm, {f[0], f[1], f[2]});
    return Vec6<double>{
        -f[0], -f[1], -f[2], -f[3] - moment[0], -f[4] - moment[1], -f[5] - moment[2]};
  });
}

LoadedSpring uniform_bar(const BarEnd& a, const BarEnd& b, const BarSection& section) {
  if (b.node == kGround && a.node != kGround) {
    return uniform_bar(b, a, section);
  }
  Vector3 arm{};
  for (std::size_t i = 0; i < 3; ++i) {
    arm[i] = b.place_mm[i] - a.place_mm[i];
  }
  const double length = std::sqrt(dot(arm, arm));
  const Vector3 d = {arm[0] / length, arm[1] / length, arm[2] / length};
  LoadedSpring element;
  element.spring.a = a.node;
  element.spring.b = b.node;
  element.spring.stiffness = base::matrix_of<double>(
      [&](const Vec6<double>& motion) { return end_force(section, length, d, motion); });
  element.spring.lever = rigid_lever(arm);
  const Vector3 moment = cross(d, section.weight_n_per_mm);
  for (std::size_t i = 0; i < 3; ++i) {
    element.load_a[i] = element.load_b[i] = section.weight_n_per_mm[i] * length / 2;
    element.load_a[3 + i] = moment[i] * length * length / 12;
    element.load_b[3 + i] = -element.load_a[3 + i];
  }
  return element;
}

}  // namespace holdfast::frames
