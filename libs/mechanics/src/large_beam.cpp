// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/large_beam.hpp"

#include "screw.hpp"
#include "vector3.hpp"

namespace holdfast::mechanics {
namespace {

using base::Mat6;
using base::Vec6;

constexpr Vector3 upper(const Vec6<double>& v) { return {v[0], v[1], v[2]}; }

constexpr Vector3 lower(const Vec6<double>& v) { return {v[3], v[4], v[5]}; }

constexpr Vec6<double> joined(const Vector3& a, const Vector3& b) {
  return {a[0], a[1], a[2], b[0], b[1], b[2]};
}

constexpr Vector3 to_local(const Rotation<double>& axes, const Vector3& v) {
  return {dot(axes[0], v), dot(axes[1], v), dot(axes[2], v)};
}

constexpr Vector3 to_global(const Rotation<double>& axes, const Vector3& v) {
  return sum_of(sum_of(scaled(v[0], axes[0]), v[1], axes[1]), v[2], axes[2]);
}

/// g = de/drho^T s; drawn is 6/(5 L) of the axial strain's square.
constexpr Vector3 gradient_by_rho(const Vector3& rho, const Vec6<double>& s, double drawn) {
  return {-s[0] + drawn * rho[0] * s[2], -s[1] + drawn * rho[1] * s[2], -s[2]};
}

constexpr Vector3 gradient_by_turn(const Vec6<double>& s) { return {-s[3], -s[4], -s[5]}; }

/// The maps of a screw at psi, and what depends on psi only.
struct Screw {
  Vector3 psi;
  ScrewNumbers numbers;

  /// V^-T b = b + psi x b / 2 + c psi x (psi x b); psi -> -psi gives V^-1.
  Vector3 transposed_inverse(const Vector3& b) const {
    const Vector3 across = cross(psi, b);
    return sum_of(sum_of(b, 0.5, across), numbers.c, cross(psi, across));
  }

  /// V^-T as a matrix.
  Matrix3 transposed_inverse() const {
    Matrix3 matrix = diagonal(1.0 - numbers.c * dot(psi, psi));
    add_outer(matrix, numbers.c, psi, psi);
    add_times(matrix, 0.5, cross_matrix(psi));
    return matrix;
  }

  /// The derivative of b + sign psi x b / 2 + c psi x (psi x b) by psi, with b fixed.
  Matrix3 derivative(const Vector3& b, double sign) const {
    Matrix3 matrix = diagonal(numbers.c * dot(psi, b));
    add_times(matrix, -sign / 2, cross_matrix(b));
    add_outer(matrix, numbers.c, psi, b);
    add_outer(matrix, -2 * numbers.c, b, psi);
    add_outer(matrix, 2 * numbers.first, cross(psi, cross(psi, b)), psi);
    return matrix;
  }

  /// The second derivative of g . rho(psi) by psi, with g and a fixed.
  Matrix3 second_derivative(const Vector3& g, const Vector3& a) const {
    const double ga = dot(g, a);
    const double phi = dot(g, psi) * dot(psi, a) - dot(psi, psi) * ga;
    const Vector3 slope =
        sum_of(sum_of(scaled(dot(psi, a), g), dot(g, psi), a), -2 * ga, psi);  // of phi
    Matrix3 matrix = diagonal(2 * numbers.first * phi - 2 * numbers.c * ga);
    add_outer(matrix, 4 * numbers.second * phi, psi, psi);
    add_outer(matrix, 2 * numbers.first, psi, slope);
    add_outer(matrix, 2 * numbers.first, slope, psi);
    add_outer(matrix, numbers.c, g, a);
    add_outer(matrix, numbers.c, a, g);
    return matrix;
  }
};

Screw screw_of(const BeamDeformation& beam) {
  return {.psi = beam.turn,
          .numbers = screw_numbers(dot(beam.turn, beam.turn), dot(beam.half_turn, beam.half_turn))};
}

/// Force and moment on q in the frame of p: the gradient by a and by the relative spin. G is
/// h + E^T g.
struct LocalForce {
  Vector3 force{};
  Vector3 moment{};
  Vector3 G{};
};

LocalForce local_force(const BeamDeformation& beam, const Screw& screw, const Vector3& g,
                       const Vector3& h) {
  const Matrix3 E = screw.derivative(beam.offset, -1);
  const Vector3 G = sum_of(h, 1, product(transpose(E), g));
  return {.force = screw.transposed_inverse(g), .moment = screw.transposed_inverse(G), .G = G};
}

LocalForce local_force(const BeamDeformation& beam, const Vec6<double>& stress, double drawn) {
  return local_force(beam, screw_of(beam), gradient_by_rho(beam.rho, stress, drawn),
                     gradient_by_turn(stress));
}

/// A block of the tangent as four 3x3 ones: forces and moments by displacements and spins.
struct Quarters {
  Matrix3 force_u{};
  Matrix3 force_w{};
  Matrix3 moment_u{};
  Matrix3 moment_w{};
};

/// R B R^T for each quarter.
Mat6<double> turned(const Rotation<double>& axes, const Quarters& quarters) {
  const Matrix3 rotation = transpose(axes);
  Mat6<double> block;
  const auto put = [&](const Matrix3& quarter, int row, int column) {
    const Matrix3 global = product(product(rotation, quarter), axes);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        block.at(row + i, column + k) = global[base::at(i)][base::at(k)];
      }
    }
  };
  put(quarters.force_u, 0, 0);
  put(quarters.force_w, 0, 3);
  put(quarters.moment_u, 3, 0);
  put(quarters.moment_w, 3, 3);
  return block;
}

/// The forces on p follow from those on q: F_p = -F_q, M_p = -M_q - (x_q - x_p) x F_q. Given their
/// derivatives, and the sign with which x_q - x_p grows.
Quarters opposite(const Quarters& on_q, const Vector3& a, const Vector3& f, double sign) {
  Quarters on_p;
  const Matrix3 lever = cross_matrix(a);
  add_times(on_p.force_u, -1, on_q.force_u);
  add_times(on_p.force_w, -1, on_q.force_w);
  add_times(on_p.moment_u, -1, on_q.moment_u);
  add_times(on_p.moment_u, -1, product(lever, on_q.force_u));
  add_times(on_p.moment_u, sign, cross_matrix(f));
  add_times(on_p.moment_w, -1, on_q.moment_w);
  add_times(on_p.moment_w, -1, product(lever, on_q.force_w));
  return on_p;
}

/// The symmetric part.
Mat6<double> symmetric(const Mat6<double>& block) {
  Mat6<double> result;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      result.at(i, k) = (block.at(i, k) + block.at(k, i)) / 2;
    }
  }
  return result;
}

/// The second derivative of the energy by rho and psi.
struct EnergyCurvature {
  Matrix3 rho_rho{};
  Matrix3 rho_turn{};
  Matrix3 turn_turn{};
};

EnergyCurvature energy_curvature(const BeamDeformation& beam, const Vec6<double>& stress,
                                 const Mat6<double>& stiffness, double drawn) {
  Matrix3 force_force{};
  Matrix3 force_moment{};
  EnergyCurvature curvature;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const int row = static_cast<int>(i);
      const int column = static_cast<int>(k);
      force_force[i][k] = stiffness.at(row, column);
      force_moment[i][k] = stiffness.at(row, column + 3);
      curvature.turn_turn[i][k] = stiffness.at(row + 3, column + 3);
    }
  }
  const Matrix3 by_rho = {
      {{-1, 0, 0}, {0, -1, 0}, {drawn * beam.rho[0], drawn * beam.rho[1], -1}}};  // de/drho
  const Matrix3 transposed = transpose(by_rho);
  curvature.rho_rho = product(product(transposed, force_force), by_rho);
  curvature.rho_rho[0][0] += drawn * stress[2];
  curvature.rho_rho[1][1] += drawn * stress[2];
  add_times(curvature.rho_turn, -1, product(transposed, force_moment));
  return curvature;
}

/// The derivative of the force and moment on q, in the frame of p, by a and the relative spin.
Quarters local_tangent(const BeamDeformation& beam, const Screw& screw, const LocalForce& local,
                       const Vector3& g, const EnergyCurvature& curvature) {
  const Matrix3 P = screw.transposed_inverse();
  const Matrix3 N = transpose(P);
  const Matrix3 E = screw.derivative(beam.offset, -1);
  const Matrix3 Et = transpose(E);
  const Matrix3 rho_E = product(curvature.rho_rho, E);

  Matrix3 by_a_turn = rho_E;  // The second derivative by a and psi.
  add_times(by_a_turn, 1, curvature.rho_turn);
  by_a_turn = product(P, by_a_turn);
  add_times(by_a_turn, 1, screw.derivative(g, 1));

  Matrix3 by_turn = screw.second_derivative(g, beam.offset);
  const Matrix3 mixed = product(Et, curvature.rho_turn);
  add_times(by_turn, 1, curvature.turn_turn);
  add_times(by_turn, 1, product(Et, rho_E));
  add_times(by_turn, 1, mixed);
  add_times(by_turn, 1, transpose(mixed));

  Quarters result;
  result.force_u = product(product(P, curvature.rho_rho), N);
  result.force_w = product(by_a_turn, N);
  result.moment_u = product(P, transpose(by_a_turn));
  result.moment_w = product(P, by_turn);
  add_times(result.moment_w, 1, screw.derivative(local.G, 1));
  result.moment_w = product(result.moment_w, N);
  return result;
}

/// The terms of first and second order of a beam's motion at h u_p, h u_q, by powers of h: what is
/// defined in the header, with the spin w_p of p and d = u_q - u_p, local frame.
struct SecondOrderMotion {
  Vector3 w_p;
  Vector3 d;
  Vector3 a0;
  Vector3 a1;
  Vector3 psi1;
  Vector3 psi2;
  Vector3 rho1;
  Vector3 rho2;
};

SecondOrderMotion second_order_motion(const Rotation<double>& axes, double length,
                                      const Vec6<double>& u_p, const Vec6<double>& u_q) {
  SecondOrderMotion m;
  m.w_p = to_local(axes, lower(u_p));
  const Vector3 w_q = to_local(axes, lower(u_q));
  m.d = to_local(axes, sum_of(upper(u_q), -1, upper(u_p)));
  m.a0 = {0, 0, -length};
  const Vector3 back = cross(m.w_p, m.a0);
  m.a1 = sum_of(m.d, -1, back);
  const Vector3 a2 = sum_of(scaled(-1, cross(m.w_p, m.d)), 0.5, cross(m.w_p, back));
  m.psi1 = sum_of(w_q, -1, m.w_p);
  m.psi2 = scaled(-0.5, cross(m.w_p, w_q));
  const Vector3 b = cross(m.psi1, m.a0);
  m.rho1 = sum_of(m.a1, -0.5, b);
  m.rho2 = sum_of(sum_of(sum_of(a2, -0.5, cross(m.psi2, m.a0)), -0.5, cross(m.psi1, m.a1)),
                  1.0 / 12, cross(m.psi1, b));
  return m;
}

}  // namespace

Pose moved(const Pose& pose, const Vec6<double>& step) {
  Pose next = pose;
  for (std::size_t i = 0; i < 3; ++i) {
    next.displacement[i] += step[i];
  }
  next.rotation = product(rotation_by(lower(step)), pose.rotation);
  double square = 0;
  for (const double part : next.rotation) {
    square += part * part;
  }
  for (double& part : next.rotation) {
    part *= (3 - square) / 2;  // One over the root, as the square is 1 but for rounding.
  }
  return next;
}

Vector3 rotated(const std::array<double, 4>& rotation, const Vector3& vector) {
  const Vector3 v = vector_of(rotation);
  const Vector3 across = cross(v, vector);
  return sum_of(sum_of(vector, 2 * rotation[0], across), 2, cross(v, across));
}

Vector3 rotation_vector(const std::array<double, 4>& rotation) {
  return turn_of(half_turn_of(rotation));
}

LargeBeam::LargeBeam(const BeamStiffness<double>& beam, double length, const Rotation<double>& axes)
    : stiffness_{beam.shear_x,    beam.shear_y,    beam.axial,
                 beam.bend_y / 4, beam.bend_x / 4, beam.twist},
      length_(length),
      axes_(axes) {}

/// Strains are differences of numbers that are small where they are, so that a stiff robot has as
/// many digits as a linear solution: the axial strain is taken from a - (0, 0, -L).
BeamDeformation LargeBeam::deformation(const Pose& p, const Pose& q) const {
  BeamDeformation beam;
  for (std::size_t i = 0; i < 3; ++i) {
    beam.axes[i] = rotated(p.rotation, axes_[i]);
  }
  const Vector3 v = to_local(axes_, vector_of(p.rotation));
  const Vector3 at_rest = {0, 0, -length_};
  const Vector3 across = cross(v, at_rest);
  const Vector3 shift =
      sum_of(sum_of(to_local(beam.axes, sum_of(q.displacement, -1, p.displacement)),
                    -2 * p.rotation[0], across),
             2, cross(v, across));
  beam.offset = sum_of(at_rest, 1, shift);

  const Quaternion relative = product(inverse(p.rotation), q.rotation);
  beam.half_turn = to_local(axes_, half_turn_of(relative));
  beam.turn = turn_of(beam.half_turn);
  const Screw screw = screw_of(beam);
  const Vector3 b = cross(beam.turn, beam.offset);
  const Vector3 bent = sum_of(scaled(-0.5, b), screw.numbers.c, cross(beam.turn, b));
  beam.rho = sum_of(beam.offset, 1, bent);
  const double bowed = 0.6 * (beam.rho[0] * beam.rho[0] + beam.rho[1] * beam.rho[1]) / length_;
  beam.strain = {-beam.rho[0],  -beam.rho[1],  -(shift[2] + bent[2]) + bowed,
                 -beam.turn[0], -beam.turn[1], -beam.turn[2]};
  return beam;
}

Vec6<double> LargeBeam::stress(const BeamDeformation& beam) const {
  Vec6<double> stress{};
  for (std::size_t i = 0; i < 6; ++i) {
    stress[i] = stiffness_[i] * beam.strain[i];
  }
  return stress;
}

double LargeBeam::energy(const BeamDeformation& beam) const {
  return base::dot(stress(beam), beam.strain) / 2;
}

EndForces LargeBeam::end_forces(const BeamDeformation& beam, const Vec6<double>& stress) const {
  const LocalForce local = local_force(beam, stress, 1.2 / length_);
  const Vector3 at_p = scaled(-1, sum_of(local.moment, 1, cross(beam.offset, local.force)));
  const Vector3 force = to_global(beam.axes, local.force);
  return {.p = joined(scaled(-1, force), to_global(beam.axes, at_p)),
          .q = joined(force, to_global(beam.axes, local.moment))};
}

/// A step of the ends makes, in the frame of p, da = du_q - du_p + a x w_p, the relative spin is
/// w_q - w_p, and forces of the frame turn with it: d(R_p f) = R_p (df - f x w_p).
EndTangent LargeBeam::tangent(const BeamDeformation& beam, const Vec6<double>& stress,
                              const Mat6<double>& stiffness) const {
  const double drawn = 1.2 / length_;
  const Screw screw = screw_of(beam);
  const Vector3 g = gradient_by_rho(beam.rho, stress, drawn);
  const LocalForce local = local_force(beam, screw, g, gradient_by_turn(stress));
  const Quarters by_q =
      local_tangent(beam, screw, local, g, energy_curvature(beam, stress, stiffness, drawn));
  Quarters by_p;
  const Matrix3 lever = cross_matrix(beam.offset);
  add_times(by_p.force_u, -1, by_q.force_u);
  add_times(by_p.moment_u, -1, by_q.moment_u);
  by_p.force_w = difference(product(by_q.force_u, lever), by_q.force_w);
  add_times(by_p.force_w, -1, cross_matrix(local.force));
  by_p.moment_w = difference(product(by_q.moment_u, lever), by_q.moment_w);
  add_times(by_p.moment_w, -1, cross_matrix(local.moment));

  EndTangent tangent;
  tangent.qq = turned(beam.axes, by_q);
  tangent.qp = turned(beam.axes, by_p);
  tangent.pq = turned(beam.axes, opposite(by_q, beam.offset, local.force, 1));
  tangent.pp = turned(beam.axes, opposite(by_p, beam.offset, local.force, -1));
  return tangent;
}

EndTangent LargeBeam::tangent(const BeamDeformation& beam) const {
  Mat6<double> stiffness;
  for (int i = 0; i < 6; ++i) {
    stiffness.at(i, i) = stiffness_[base::at(i)];
  }
  return tangent(beam, stress(beam), stiffness);
}

/// The middle section is a_m = (1 + R_m)^-1 a = (a - y x a) / 2 from p, R_m by half the angle,
/// y = tan(t/4) psi / t.
Vec6<double> LargeBeam::middle_force(const BeamDeformation& beam,
                                     const Vec6<double>& stress) const {
  const LocalForce local = local_force(beam, stress, 1.2 / length_);
  const Vector3& y = beam.half_turn;
  const Vector3 to_q = scaled(0.5, sum_of(beam.offset, 1, cross(y, beam.offset)));
  const Vector3 moment = sum_of(local.moment, 1, cross(to_q, local.force));
  const double share = 2 / (1 + dot(y, y));
  const auto in_middle = [&](const Vector3& v) {
    const Vector3 across = cross(y, v);
    return scaled(-1, sum_of(sum_of(v, -share, across), share, cross(y, across)));
  };
  return joined(in_middle(local.force), in_middle(moment));
}

EndTangent LargeBeam::geometric_stiffness(const Vec6<double>& stress) const {
  EndTangent result = tangent(deformation(Pose{}, Pose{}), stress, Mat6<double>{});
  result.pp = symmetric(result.pp);
  result.qq = symmetric(result.qq);
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      result.pq.at(i, k) = (result.pq.at(i, k) + result.qp.at(k, i)) / 2;
      result.qp.at(k, i) = result.pq.at(i, k);
    }
  }
  return result;
}

/// The gradient of s . e2, the strains of second order under the stresses, with m, psi and rho the
/// mean turn, its difference and the strains of first order, f and M the two halves of s:
///   s . e2 = f . m x (m x a0) / 2 + f . psi x (psi x a0) / 24 + f . m x rho + M . m x psi / 2
///            + 3/5 s3 rho_t^2 / L
EndForces LargeBeam::geometric_forces(const Vec6<double>& stress, const Vec6<double>& u_p,
                                      const Vec6<double>& u_q) const {
  const Vector3 w_p = to_local(axes_, lower(u_p));
  const Vector3 w_q = to_local(axes_, lower(u_q));
  const Vector3 m = scaled(0.5, sum_of(w_p, 1, w_q));
  const Vector3 psi = sum_of(w_q, -1, w_p);
  const Vector3 a0 = {0, 0, -length_};
  const Vector3 rho = sum_of(to_local(axes_, sum_of(upper(u_q), -1, upper(u_p))), -1, cross(m, a0));
  const Vector3 f = upper(stress);
  const Vector3 moment = lower(stress);
  const auto twice = [&](const Vector3& w) {  // The gradient of f . w x (w x a0).
    return sum_of(sum_of(scaled(dot(w, f), a0), dot(w, a0), f), -2 * dot(a0, f), w);
  };
  const double bowed = 1.2 * stress[2] / length_;
  const Vector3 by_rho = sum_of(cross(f, m), bowed, Vector3{rho[0], rho[1], 0});
  const Vector3 by_psi = sum_of(scaled(1.0 / 24, twice(psi)), 0.5, cross(moment, m));
  Vector3 by_m = sum_of(scaled(0.5, twice(m)), 1, cross(rho, f));
  by_m = sum_of(sum_of(by_m, 0.5, cross(psi, moment)), 1, cross(by_rho, a0));
  const Vector3 force = to_global(axes_, by_rho);
  return {.p = joined(scaled(-1, force), to_global(axes_, sum_of(scaled(0.5, by_m), -1, by_psi))),
          .q = joined(force, to_global(axes_, sum_of(scaled(0.5, by_m), 1, by_psi)))};
}

Vec6<double> LargeBeam::second_order_stress(const Vec6<double>& u_p,
                                            const Vec6<double>& u_q) const {
  const SecondOrderMotion motion = second_order_motion(axes_, length_, u_p, u_q);
  const Vector3& rho1 = motion.rho1;
  const double bowed = 0.6 * (rho1[0] * rho1[0] + rho1[1] * rho1[1]) / length_;
  Vec6<double> stress = {-motion.rho2[0], -motion.rho2[1], bowed - motion.rho2[2],
                         -motion.psi2[0], -motion.psi2[1], -motion.psi2[2]};
  for (std::size_t i = 0; i < 6; ++i) {
    stress[i] *= stiffness_[i];
  }
  return stress;
}

/// The frame in the middle turns by w_p + psi / 2; in it the lever to q is
/// (a0 + h (a1 - psi1 x a0 / 4)) / 2.
Vec6<double> LargeBeam::second_order_middle_force(const Vec6<double>& u_p, const Vec6<double>& u_q,
                                                  const Vec6<double>& first_on_q,
                                                  const Vec6<double>& second_on_q) const {
  const SecondOrderMotion motion = second_order_motion(axes_, length_, u_p, u_q);
  const Vector3 turn = sum_of(motion.w_p, 0.5, motion.psi1);
  const Vector3 f1 = to_local(axes_, upper(first_on_q));
  const Vector3 m1 = to_local(axes_, lower(first_on_q));
  const Vector3 f2 = sum_of(to_local(axes_, upper(second_on_q)), -1, cross(turn, f1));
  const Vector3 m2 = sum_of(to_local(axes_, lower(second_on_q)), -1, cross(turn, m1));
  const Vector3 lever1 = scaled(0.5, sum_of(motion.a1, -0.25, cross(motion.psi1, motion.a0)));
  const Vector3 moment = sum_of(sum_of(m2, 0.5, cross(motion.a0, f2)), 1, cross(lever1, f1));
  return joined(scaled(-1, f2), scaled(-1, moment));
}

/// All of end_forces() by powers of h; 1 and 2 mark the terms of first and second order.
EndForces LargeBeam::second_order_forces(const Vec6<double>& u_p, const Vec6<double>& u_q) const {
  const SecondOrderMotion motion = second_order_motion(axes_, length_, u_p, u_q);
  const auto& [w_p, d, a0, a1, psi1, psi2, rho1, rho2] = motion;
  const double drawn = 1.2 / length_;
  const double bowed = drawn * (rho1[0] * rho1[0] + rho1[1] * rho1[1]) / 2;
  const Vec6<double>& k = stiffness_;
  const double axial1 = -k[2] * rho1[2];
  const Vector3 g1 = {k[0] * rho1[0], k[1] * rho1[1], -axial1};
  const Vector3 g2 = {k[0] * rho2[0] + drawn * rho1[0] * axial1,
                      k[1] * rho2[1] + drawn * rho1[1] * axial1, -k[2] * (bowed - rho2[2])};
  const Vector3 h1 = {k[3] * psi1[0], k[4] * psi1[1], k[5] * psi1[2]};
  const Vector3 h2 = {k[3] * psi2[0], k[4] * psi2[1], k[5] * psi2[2]};

  // E = [a]x / 2 + ((psi . a) + psi a^T - 2 a psi^T) / 12, to first order; E^T times a vector.
  const Vector3 G1 = sum_of(h1, -0.5, cross(a0, g1));
  const Vector3 by_a1 = sum_of(scaled(dot(psi1, a0) / 12, g1), -0.5, cross(a1, g1));
  const Vector3 E1_g1 = sum_of(sum_of(by_a1, dot(psi1, g1) / 12, a0), -dot(a0, g1) / 6, psi1);
  const Vector3 G2 = sum_of(sum_of(h2, -0.5, cross(a0, g2)), 1, E1_g1);
  const Vector3 turn = sum_of(scaled(0.5, psi1), 1, w_p);  // V^-T, then R_p
  const Vector3 force = sum_of(g2, 1, cross(turn, g1));
  const Vector3 moment = sum_of(G2, 1, cross(turn, G1));
  const Vector3 at_p = scaled(-1, sum_of(sum_of(moment, 1, cross(a0, force)), 1, cross(d, g1)));
  const Vector3 global = to_global(axes_, force);
  return {.p = joined(scaled(-1, global), to_global(axes_, at_p)),
          .q = joined(global, to_global(axes_, moment))};
}

}  // namespace holdfast::mechanics
