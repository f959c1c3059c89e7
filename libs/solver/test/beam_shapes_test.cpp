// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// How ends of a long beam move what lies between, beside a chain of beams one pitch long each that
// is solved with a dense matrix.
#include "../src/multigrid/kernels/beam_shapes.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "holdfast/mechanics/beam.hpp"
#include "holdfast/model/material.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

using base::Vec6;
using Dense = Eigen::Matrix<double, 6, 6>;

Dense dense(const base::Mat6<double>& m) { return Eigen::Map<const Dense>(m.values.data()); }

Eigen::Matrix<double, 6, 1> dense(const Vec6<double>& v) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 1>>(v.data());
}

double dot(const Vec6<double>& a, const Vec6<double>& b) { return dense(a).dot(dense(b)); }

TEST(BeamShapes, loads_move_to_the_ends_by_the_transpose_of_how_these_move_them) {
  base::Rng rng(3);
  for (std::size_t direction = 0; direction < 6; ++direction) {
    for (int place = 0; place <= 5; ++place) {
      const BeamShape shape = beam_shape(40, place, 5);
      const Vec6<double> end = random_six(rng);
      const Vec6<double> force = random_six(rng);
      Vec6<double> motion{};
      Vec6<double> load{};
      add_motion(shape, direction, end, motion);
      add_share(shape, direction, force, load);
      // The work of the force is that of its share at the end. Lengths are 40 mm.
      EXPECT_NEAR(dot(force, motion), dot(load, end), 1e-13 * 200);
    }
  }
}

TEST(BeamShapes, a_rigid_motion_of_both_ends_moves_all_between_alike) {
  const Vec6<double> turn = {0, 0, 0, 0.1, -0.2, 0.3};
  const int length = 6;
  for (std::size_t direction = 0; direction < 6; ++direction) {
    const auto at = [&](int place) {
      // u = t x r, r from the first end.
      std::array<double, 3> r{};
      r[direction / 2] = (direction % 2 == 0 ? 40.0 : -40.0) * place;
      Vec6<double> u = turn;
      u[0] = turn[4] * r[2] - turn[5] * r[1];
      u[1] = turn[5] * r[0] - turn[3] * r[2];
      u[2] = turn[3] * r[1] - turn[4] * r[0];
      return u;
    };
    for (int place = 0; place <= length; ++place) {
      Vec6<double> u{};
      add_motion(beam_shape(40, place, length), direction, at(0), u);
      add_motion(beam_shape(40, length - place, length), direction ^ 1U, at(length), u);
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_NEAR(u[i], at(place)[i], 1e-13 * 100) << direction << " " << place << " " << i;
      }
    }
  }
}

/// The modules of a run of five, its ends moved anyhow: the middle block of K, dense, times their
/// displacement is what the ends' beams push them by.
TEST(BeamShapes, between_moved_ends_modules_lie_where_a_chain_of_beams_has_them) {
  const model::Material material;
  const auto beam = mechanics::beam_stiffness(model::beam_section(material));
  base::Rng rng(4);
  constexpr int kLength = 6;
  for (std::size_t direction = 0; direction < 6; ++direction) {
    const auto onwards = static_cast<base::Direction>(direction);
    const auto back = static_cast<base::Direction>(direction ^ 1U);
    const Dense k11 =
        dense(mechanics::block_11(beam, onwards)) + dense(mechanics::block_11(beam, back));
    const Dense to_next = dense(mechanics::block_12(beam, onwards));
    const Dense to_last = dense(mechanics::block_12(beam, back));
    const int n = kLength - 1;
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(6 * n, 6 * n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(6 * n);
    const Vec6<double> first = random_six(rng);
    const Vec6<double> last = random_six(rng);
    for (int i = 0; i < n; ++i) {
      matrix.block<6, 6>(6 * i, 6 * i) = k11;
      if (i > 0) {
        matrix.block<6, 6>(6 * i, 6 * i - 6) = to_last;
      }
      if (i < n - 1) {
        matrix.block<6, 6>(6 * i, 6 * i + 6) = to_next;
      }
    }
    right.segment<6>(0) = -to_last * dense(first);
    right.segment<6>(6 * (n - 1)) = -to_next * dense(last);
    const Eigen::VectorXd solved = matrix.partialPivLu().solve(right);
    for (int place = 1; place < kLength; ++place) {
      Vec6<double> u{};
      add_motion(beam_shape(material.pitch_mm, place, kLength), direction, first, u);
      add_motion(beam_shape(material.pitch_mm, kLength - place, kLength), direction ^ 1U, last, u);
      // The chain's condition is 1e6 or so.
      const Eigen::VectorXd expected = solved.segment<6>(6 * (place - 1));
      EXPECT_LT((dense(u) - expected).norm() / expected.norm(), 1e-8) << direction << " " << place;
    }
  }
}

/// Vectors give in any direction what components give along the axes; and the share is the
/// transpose in oblique directions, too.
TEST(BeamShapes, are_the_same_along_any_unit_vector) {
  base::Rng rng(5);
  const BeamShape shape = beam_shape(40, 2, 5);
  for (std::size_t direction = 0; direction < 6; ++direction) {
    const std::array<double, 3> n =
        base::unit_vector(base::kCubic, static_cast<base::Direction>(direction));
    const Vec6<double> end = random_six(rng);
    Vec6<double> by_components{};
    Vec6<double> by_vectors{};
    add_motion(shape, direction, end, by_components);
    add_motion(shape, n, end, by_vectors);
    EXPECT_LT((dense(by_vectors) - dense(by_components)).norm(), 1e-13 * 200);
  }
  for (const base::Direction direction : base::directions(base::kFaceCentred)) {
    const std::array<double, 3> n = base::unit_vector(base::kFaceCentred, direction);
    const Vec6<double> end = random_six(rng);
    const Vec6<double> force = random_six(rng);
    Vec6<double> motion{};
    Vec6<double> load{};
    add_motion(shape, n, end, motion);
    add_share(shape, n, force, load);
    EXPECT_NEAR(dot(force, motion), dot(load, end), 1e-13 * 200);
  }
}

}  // namespace
}  // namespace holdfast::solver
