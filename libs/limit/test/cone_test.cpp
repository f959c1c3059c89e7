// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The algebra of the interior-point method's cones by its definitions: what Nesterov and Todd's
// scaling maps on what, products and quotients, steps that end on the boundary.
#include "../src/program/cone.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace holdfast::limit {
namespace {

/// A few roundings of numbers of about 1; what lies near the boundary costs some more.
constexpr double kRounding = 1e-12;

/// A point within a cone of one or three rows, `near` its boundary.
ConePart point_within(std::mt19937_64& random, Eigen::Index size, double near) {
  std::uniform_real_distribution<double> between(-1, 1);
  ConePart u(size);
  for (Eigen::Index i = 1; i < size; ++i) {
    u[i] = between(random);
  }
  u[0] = (size == 1 ? 0 : u.tail<2>().norm()) + near * (1.5 + between(random));
  return u;
}

class Cones : public testing::TestWithParam<Eigen::Index> {
 protected:
  /// Calls check(u, v) for pairs of points within the cone, up to near its boundary.
  template <class Check>
  void for_pairs(const Check& check) {
    std::mt19937_64 random(11);
    for (const double near : {1.0, 1e-2, 1e-4}) {
      for (int i = 0; i < 20; ++i) {
        check(point_within(random, GetParam(), near), point_within(random, GetParam(), 1));
      }
    }
  }
};

TEST_P(Cones, the_scaling_maps_the_dual_where_its_inverse_maps_the_point) {
  for_pairs([](const ConePart& s, const ConePart& z) {
    const Scaling scaling(s, z);
    const ConePart there = scaling.times(z);
    EXPECT_LT((there - scaling.inverse_times(s)).norm(), 1e-8 * there.norm());
    EXPECT_GT(inside(there), 0);
    EXPECT_LT((scaling.inverse_times(scaling.times(s)) - s).norm(), 1e-8 * s.norm());
  });
}

TEST_P(Cones, the_scaling_is_symmetric) {
  for_pairs([](const ConePart& s, const ConePart& z) {
    const Scaling scaling(s, z);
    const double there = s.dot(scaling.times(z));
    EXPECT_NEAR(there, z.dot(scaling.times(s)), 1e-10 * std::abs(there));
  });
}

TEST_P(Cones, the_root_of_the_scaled_rows_has_their_square) {
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> between(-1, 1);
  for_pairs([&](const ConePart& s, const ConePart& z) {
    const Scaling scaling(s, z);
    const ConeRows G = ConeRows::NullaryExpr(GetParam(), 6, [&] { return between(random); });
    ConeRows scaled(G.rows(), 6);
    for (Eigen::Index column = 0; column < 6; ++column) {
      scaled.col(column) = scaling.inverse_times(ConePart(G.col(column)));
    }
    const Eigen::Matrix<double, 6, 6> square = scaled.transpose() * scaled;
    const ConeRows root = scaling.root_times(G);
    EXPECT_LT((root.transpose() * root - square).norm(), 1e-8 * square.norm());
  });
}

TEST_P(Cones, what_times_u_is_v_is_the_quotient) {
  for_pairs([](const ConePart& u, const ConePart& v) {
    const ConePart product = jordan_product(u, v);
    EXPECT_LT((jordan_quotient(product, u) - v).norm(), 1e-6 * v.norm());
    EXPECT_LT((product - jordan_product(v, u)).norm(), kRounding);
    EXPECT_EQ(jordan_product(u, cone_centre(u.size())), u);
  });
}

TEST_P(Cones, the_longest_step_ends_on_the_boundary) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> between(-1, 1);
  int ended = 0;
  for_pairs([&](const ConePart& u, const ConePart&) {
    constexpr double kMost = 10;
    const ConePart d = ConePart::NullaryExpr(u.size(), [&] { return between(random); });
    const double step = longest_step(u, d, kMost);
    EXPECT_GT(step, 0);
    EXPECT_LE(step, kMost);
    EXPECT_GT(inside(ConePart(u + 0.999 * step * d)), 0);
    if (step < kMost) {
      ++ended;
      EXPECT_NEAR(inside(ConePart(u + step * d)), 0, 1e-9);
    } else {
      EXPECT_GE(inside(ConePart(u + kMost * d)), -1e-9);
    }
  });
  EXPECT_GT(ended, 10);
}

INSTANTIATE_TEST_SUITE_P(OfNumbersAndOfSecondOrder, Cones, testing::Values(1, 3));

TEST(Cone, the_step_along_the_axis_ends_at_the_apex_of_its_height) {
  const ConePart u = ConePart(Eigen::Vector3d(2, 0.6, 0.8));
  // (2 - t)^2 = 1.
  EXPECT_NEAR(longest_step(u, ConePart(Eigen::Vector3d(-1, 0, 0)), 5), 1, kRounding);
  // |0.6 + t, 0.8|^2 = 4.
  EXPECT_NEAR(longest_step(u, ConePart(Eigen::Vector3d(0, 1, 0)), 5), std::sqrt(3.36) - 0.6,
              kRounding);
  EXPECT_EQ(longest_step(u, ConePart(Eigen::Vector3d(1, 0.3, 0)), 5), 5);
}

}  // namespace
}  // namespace holdfast::limit
