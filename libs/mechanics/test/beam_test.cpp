// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The beam between two modules, in all six directions. Expected values: Eqs. (1)-(4) of
// [Piranda 2021] written out densely with rotations built here from the directions, the closed
// forms of the cantilever, and the invariants of a free body (rigid motion, balance, energy).
// Tolerances are the rounding of the scalar, relative to the magnitudes that are summed.
#include "holdfast/mechanics/beam.hpp"

#include <gtest/gtest.h>

#include "paper.hpp"
#include "random_signed.hpp"

namespace holdfast::mechanics {
namespace {

using namespace holdfast::test;
using base::Direction;
using base::kDirections;
using base::Mat6;
using base::Vec6;

template <class Real>
BeamStiffness<Real> lopsided_beam() {
  return beam_stiffness(lopsided_section<Real>());
}

/// Entries are single products, so each is compared on its own scale, and zero with zero.
template <class Real>
void expect_equal(const Mat6<Real>& block, const Dense& expected) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      const double value =
          expected[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
      EXPECT_NEAR(static_cast<double>(block.at(row, column)), value,
                  kRounding<Real> * std::abs(value))
          << "row " << row << ", column " << column;
    }
  }
}

/// Equal up to the rounding of sums whose terms have the given magnitudes.
template <class Real>
void expect_equal(const Vec6<Real>& force, const Vec6<double>& expected,
                  const Vec6<double>& scale) {
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(static_cast<double>(force[i]), expected[i], kRounding<Real> * scale[i])
        << "component " << i;
  }
}

/// Magnitudes of the terms of K11 u_p + K12 u_q, in a frame.
Vec6<double> force_scale(const Dense& k11, const Dense& k12, const Vec6<double>& u_p,
                         const Vec6<double>& u_q) {
  Vec6<double> scale = term_magnitudes(k11, u_p);
  base::add_to(scale, term_magnitudes(k12, u_q));
  return scale;
}

/// u = [e d, (t x e) s] : deflection d towards e, slope s of the tangent t turning towards e.
Vec6<double> bent(const Axis& e, double d, const Axis& t, double s) {
  const Axis turn = cross(t, e);
  return {d * e[0], d * e[1], d * e[2], s * turn[0], s * turn[1], s * turn[2]};
}

template <class Real>
class Beam : public testing::Test {};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Beam, Scalars);

TYPED_TEST(Beam, to_a_neighbour_below_has_the_blocks_of_equations_1_and_2) {
  const auto section = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  expect_equal(block_11(beam, Direction::kMinusZ), paper_k11(section));
  expect_equal(block_12(beam, Direction::kMinusZ), paper_k12(section));
}

TYPED_TEST(Beam, in_any_direction_has_these_blocks_rotated) {
  const auto section = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  for (const Direction direction : kDirections) {
    const auto axes = local_axes(direction);
    ASSERT_EQ(dot(cross(axes[0], axes[1]), axes[2]), 1) << "R must be a rotation";
    expect_equal(block_11(beam, direction), rotated(paper_k11(section), direction));
    expect_equal(block_12(beam, direction), rotated(paper_k12(section), direction));
  }
}

TYPED_TEST(Beam, has_the_same_frame_for_vectors_as_for_blocks) {
  const Vec6<double> v = {1, 2, 3, 4, 5, 6};
  const auto real = converted<TypeParam>(v);
  for (const Direction direction : kDirections) {
    const auto local = to_local(direction, real);
    EXPECT_EQ(converted<double>(local), in_local_axes(v, direction));
    EXPECT_EQ(to_global(direction, local), real);
  }
}

TYPED_TEST(Beam, takes_the_force_k11_u_p_plus_k12_u_q) {
  const auto section = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  base::Rng rng(1);
  for (int i = 0; i < 600; ++i) {
    const Direction direction = kDirections[rng.below(6)];
    const Dense k11 = rotated(paper_k11(section), direction);
    const Dense k12 = rotated(paper_k12(section), direction);
    const auto p = random_displacement(rng);
    const auto q = random_displacement(rng);
    Vec6<double> expected = image_of(k11, p);
    base::add_to(expected, image_of(k12, q));
    expect_equal(end_force(beam, direction, converted<TypeParam>(p), converted<TypeParam>(q)),
                 expected, force_scale(k11, k12, p, q));
  }
}

/// The blocks are symmetric exactly, as both ends use the same products. A signed permutation of
/// Eq. (1) keeps its ten nonzeros.
TYPED_TEST(Beam, has_symmetric_blocks_with_ten_nonzeros) {
  const auto beam = lopsided_beam<TypeParam>();
  for (const Direction direction : kDirections) {
    const auto k11 = block_11(beam, direction);
    const auto k12 = block_12(beam, direction);
    const auto k21 = block_12(beam, base::opposite(direction));
    int nonzeros_11 = 0;
    int nonzeros_12 = 0;
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        EXPECT_EQ(k11.at(row, column), k11.at(column, row));
        EXPECT_EQ(k12.at(row, column), k21.at(column, row));
        nonzeros_11 += k11.at(row, column) != 0 ? 1 : 0;
        nonzeros_12 += k12.at(row, column) != 0 ? 1 : 0;
      }
    }
    EXPECT_EQ(nonzeros_11, 10);
    EXPECT_EQ(nonzeros_12, 10);
  }
}

/// u = c + w x (r - r0) at both ends, L apart, about any point r0.
TYPED_TEST(Beam, resists_no_rigid_motion) {
  const auto section = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  base::Rng rng(2);
  for (int i = 0; i < 600; ++i) {
    const Direction direction = kDirections[rng.below(6)];
    const auto motion = random_displacement(rng);
    const Axis w = {motion[3], motion[4], motion[5]};
    const Axis r = {random_signed(rng) * 100, random_signed(rng) * 100, random_signed(rng) * 100};
    const auto at = [&](double distance) {
      const Axis q = step(direction);
      const Axis turn =
          cross(w, {r[0] + distance * q[0], r[1] + distance * q[1], r[2] + distance * q[2]});
      return Vec6<double>{
          motion[0] + turn[0], motion[1] + turn[1], motion[2] + turn[2], w[0], w[1], w[2]};
    };
    const auto p = at(0);
    const auto q = at(section.length);
    expect_equal(end_force(beam, direction, converted<TypeParam>(p), converted<TypeParam>(q)), {},
                 force_scale(rotated(paper_k11(section), direction),
                             rotated(paper_k12(section), direction), p, q));
  }
}

/// The beam itself is in balance: forces cancel, and so do torques about the end p.
TYPED_TEST(Beam, takes_opposite_forces_and_balanced_torques_from_its_ends) {
  const double length = lopsided_section<double>().length;
  const auto beam = lopsided_beam<TypeParam>();
  base::Rng rng(3);
  for (int i = 0; i < 600; ++i) {
    const Direction direction = kDirections[rng.below(6)];
    const auto p = converted<TypeParam>(random_displacement(rng));
    const auto q = converted<TypeParam>(random_displacement(rng));
    const auto f_p = converted<double>(end_force(beam, direction, p, q));
    const auto f_q = converted<double>(end_force(beam, base::opposite(direction), q, p));
    const Axis lever = cross(step(direction), {f_q[0], f_q[1], f_q[2]});
    for (std::size_t k = 0; k < 3; ++k) {
      // Magnitudes: 1 mm and 0.05 rad times the largest stiffnesses a, cx and bx of this section.
      EXPECT_NEAR(f_p[k] + f_q[k], 0, kRounding<TypeParam> * 2e4);
      EXPECT_NEAR(f_p[k + 3] + f_q[k + 3] + length * lever[k], 0, kRounding<TypeParam> * 8e5);
    }
  }
}

/// Twice the energy is a sum of squares, one for each way to strain a beam.
TYPED_TEST(Beam, stores_the_energy_of_six_independent_strains) {
  const auto s = lopsided_section<double>();
  const double l = s.length;
  const auto beam = lopsided_beam<TypeParam>();
  base::Rng rng(4);
  for (int i = 0; i < 600; ++i) {
    const Direction direction = kDirections[rng.below(6)];
    const auto global_p = random_displacement(rng);
    const auto global_q = random_displacement(rng);
    const auto p = in_local_axes(global_p, direction);
    const auto q = in_local_axes(global_q, direction);
    const double shear_x = p[0] - q[0] - l * (p[4] + q[4]) / 2;
    const double shear_y = p[1] - q[1] + l * (p[3] + q[3]) / 2;
    const double squares =
        12 / (l * l) * (s.moment_x * shear_x * shear_x + s.moment_y * shear_y * shear_y) +
        s.area * (p[2] - q[2]) * (p[2] - q[2]) + s.moment_y * (p[3] - q[3]) * (p[3] - q[3]) +
        s.moment_x * (p[4] - q[4]) * (p[4] - q[4]) + s.torsion * (p[5] - q[5]) * (p[5] - q[5]);
    const auto u_p = converted<TypeParam>(global_p);
    const auto u_q = converted<TypeParam>(global_q);
    const double work =
        static_cast<double>(base::dot(u_p, end_force(beam, direction, u_p, u_q)) +
                            base::dot(u_q, end_force(beam, base::opposite(direction), u_q, u_p)));
    EXPECT_GT(work, 0);
    EXPECT_NEAR(work, s.elastic_modulus / l * squares, kRounding<TypeParam> * 2e5);
  }
}

/// p is the tip, q is clamped. A transverse tip force P bends it by P L^3 / (3 E I) with the slope
/// P L^2 / (2 E I); Ix resists towards local x. K11 is regular, so K11 u = F has no other solution.
TYPED_TEST(Beam, bends_as_a_cantilever_with_its_other_end_clamped) {
  const auto s = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  const double load = 7;
  for (const Direction direction : kDirections) {
    const auto axes = local_axes(direction);
    for (const std::size_t transverse : {0U, 1U}) {
      const double flexural = s.elastic_modulus * (transverse == 0 ? s.moment_x : s.moment_y);
      const auto u = bent(axes[transverse], load * std::pow(s.length, 3) / (3 * flexural), axes[2],
                          load * s.length * s.length / (2 * flexural));
      const auto force = end_force(beam, direction, converted<TypeParam>(u), {});
      const Axis& e = axes[transverse];
      // 4 P and 2 P L: the terms of the force and of the torque before they cancel.
      expect_equal(force, {load * e[0], load * e[1], load * e[2], 0, 0, 0},
                   {28, 28, 28, 560, 560, 560});
    }
  }
}

/// Lengthened by P L / (E A), twisted by M L / (E Jv).
TYPED_TEST(Beam, stretches_and_twists_as_a_rod_with_its_other_end_clamped) {
  const auto s = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  const double stretch = 7 * s.length / (s.elastic_modulus * s.area);
  const double twist = 90 * s.length / (s.elastic_modulus * s.torsion);
  for (const Direction direction : kDirections) {
    const Axis z = local_axes(direction)[2];
    const Vec6<double> u = {stretch * z[0], stretch * z[1], stretch * z[2],
                            twist * z[0],   twist * z[1],   twist * z[2]};
    expect_equal(end_force(beam, direction, converted<TypeParam>(u), {}),
                 {7 * z[0], 7 * z[1], 7 * z[2], 90 * z[0], 90 * z[1], 90 * z[2]},
                 {7, 7, 7, 90, 90, 90});
  }
}

/// Eq. (16): 1/2 R^T (F_pq - F_qp).
TYPED_TEST(Beam, carries_in_its_middle_the_mean_of_its_end_forces) {
  const auto section = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  base::Rng rng(5);
  for (int i = 0; i < 600; ++i) {
    const Direction direction = kDirections[rng.below(6)];
    const auto p = random_displacement(rng);
    const auto q = random_displacement(rng);
    const auto u_p = converted<TypeParam>(p);
    const auto u_q = converted<TypeParam>(q);
    Vec6<double> mean = converted<double>(end_force(beam, direction, u_p, u_q));
    const auto f_q = end_force(beam, base::opposite(direction), u_q, u_p);
    for (std::size_t k = 0; k < 6; ++k) {
      mean[k] = (mean[k] - static_cast<double>(f_q[k])) / 2;
    }
    const Vec6<double> scale =
        force_scale(paper_k11(section), paper_k12(section), in_local_axes(p, direction),
                    in_local_axes(q, direction));
    expect_equal(middle_force(beam, direction, u_p, u_q), in_local_axes(mean, direction), scale);
  }
}

/// Pulled apart by d, with opposite turns t: tension E A d / L and bending E I 2t / L.
TYPED_TEST(Beam, reports_tension_as_positive_in_its_middle) {
  const auto s = lopsided_section<double>();
  const auto beam = lopsided_beam<TypeParam>();
  const double d = 0.25;
  const double t = 0.125;
  for (const Direction direction : kDirections) {
    const auto axes = local_axes(direction);
    const Axis& z = axes[2];
    const Axis& x = axes[0];
    const Vec6<double> p = {d * z[0], d * z[1], d * z[2], t * x[0], t * x[1], t * x[2]};
    const Vec6<double> q = {0, 0, 0, -t * x[0], -t * x[1], -t * x[2]};
    const auto middle =
        middle_force(beam, direction, converted<TypeParam>(p), converted<TypeParam>(q));
    const double tension = s.elastic_modulus * s.area * d / s.length;
    const double bending = s.elastic_modulus * s.moment_y * 2 * t / s.length;
    expect_equal(middle, {0, 0, tension, bending, 0, 0}, {0, 0, tension, bending, 0, 0});
  }
}

}  // namespace
}  // namespace holdfast::mechanics
