// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// No eigenvalue of D^-1 K is above 2, whatever is connected with what: docs/theory.md proves it
// beam by beam, Eigen's dense eigenvalues show it. D is the 6 x 6 block diagonal of K.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "holdfast/mechanics/beam.hpp"

namespace holdfast {
namespace {

using Matrix = Eigen::MatrixXd;
using Vector3 = Eigen::Vector3d;

constexpr double kRounding = 1e-10;

Eigen::Matrix<double, 6, 6> matrix_of(const base::Mat6<double>& block) {
  return Eigen::Map<const Eigen::Matrix<double, 6, 6>>(block.values.data());
}

/// A graph of beams that lie in any direction; every beam is Eqs. (1)-(2), turned by Eqs. (3)-(4).
class Frames {
 public:
  explicit Frames(int count) : k_(Matrix::Zero(6 * count, 6 * count)), d_(k_) {}

  /// Connects p with q, which lies at `towards` from it.
  void connect(int p, int q, const Vector3& towards,
               const mechanics::BeamSection<double>& section) {
    const auto beam = mechanics::beam_stiffness(section);
    const Vector3 z = -towards.normalized();
    const Vector3 seed = std::abs(z.z()) < 0.9 ? Vector3::UnitZ() : Vector3::UnitX();
    const Vector3 x = (seed - seed.dot(z) * z).normalized();
    Eigen::Matrix3d axes;
    axes << x, z.cross(x), z;
    Eigen::Matrix<double, 6, 6> r = Eigen::Matrix<double, 6, 6>::Zero();
    r.topLeftCorner<3, 3>() = axes;
    r.bottomRightCorner<3, 3>() = axes;
    add(p, p, r * matrix_of(block_11(beam, base::Direction::kMinusZ)) * r.transpose());
    add(p, q, r * matrix_of(block_12(beam, base::Direction::kMinusZ)) * r.transpose());
    add(q, q, r * matrix_of(block_11(beam, base::Direction::kPlusZ)) * r.transpose());
    add(q, p, r * matrix_of(block_12(beam, base::Direction::kPlusZ)) * r.transpose());
  }

  /// The eigenvalues of D^-1 K, ascending.
  Eigen::VectorXd spectrum() const {
    EXPECT_LT((k_ - k_.transpose()).norm(), kRounding * k_.norm());
    return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(k_, d_, Eigen::EigenvaluesOnly)
        .eigenvalues();
  }

 private:
  void add(int p, int q, const Eigen::Matrix<double, 6, 6>& block) {
    k_.block<6, 6>(6 * p, 6 * q) += block;
    if (p == q) {
      d_.block<6, 6>(6 * p, 6 * p) += block;
    }
  }

  Matrix k_;
  Matrix d_;
};

mechanics::BeamSection<double> table_1() {
  return {.elastic_modulus = 100,
          .length = 40,
          .area = 1600,
          .moment_x = 40.0 * 40 * 40 * 40 / 12,
          .moment_y = 40.0 * 40 * 40 * 40 / 12,
          .torsion = 2.25 * 40 * 40 * 40 * 40 / 41.6};
}

/// All pairs of places that are one apart.
Frames lattice(const std::vector<Vector3>& places) {
  Frames frames(static_cast<int>(places.size()));
  for (std::size_t p = 0; p < places.size(); ++p) {
    for (std::size_t q = p + 1; q < places.size(); ++q) {
      if (std::abs((places[q] - places[p]).norm() - 1) < 1e-9) {
        frames.connect(static_cast<int>(p), static_cast<int>(q), places[q] - places[p], table_1());
      }
    }
  }
  return frames;
}

TEST(Spectrum, of_a_free_cube_of_27_reaches_2_and_is_symmetric_about_1) {
  std::vector<Vector3> places;
  for (int i = 0; i < 27; ++i) {
    places.emplace_back(i % 3, i / 3 % 3, i / 9);
  }
  const Eigen::VectorXd values = lattice(places).spectrum();
  EXPECT_NEAR(values.maxCoeff(), 2, kRounding);
  EXPECT_LT((values + values.reverse() - Eigen::VectorXd::Constant(values.size(), 2)).norm(), 1e-9);
}

TEST(Spectrum, of_32_modules_on_the_face_centred_lattice_is_below_2) {
  // Cubes of side sqrt(2) with nodes at corners and faces' centres: twelve neighbours, triangles.
  std::vector<Vector3> places;
  const Vector3 members[] = {{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}};
  for (int i = 0; i < 8; ++i) {
    for (const Vector3& member : members) {
      places.push_back(std::sqrt(2.0) * (Vector3(i % 2, i / 2 % 2, i / 4) + member));
    }
  }
  ASSERT_EQ(places.size(), 32U);
  const Eigen::VectorXd values = lattice(places).spectrum();
  EXPECT_LT(values.maxCoeff(), 1.9);
  EXPECT_NEAR(values.minCoeff(), 0, kRounding);
}

TEST(Spectrum, of_any_graph_of_any_beams_is_at_most_2) {
  base::Rng rng(7);
  const auto between = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(rng.next() >> 11) * 0x1p-53;
  };
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    constexpr int kCount = 12;
    Frames frames(kCount);
    for (int beam = 0; beam < 30; ++beam) {
      const int p = beam % kCount;
      const int q = (p + 1 + static_cast<int>(rng.next() % (kCount - 1))) % kCount;
      frames.connect(p, q, {between(-1, 1), between(-1, 1), between(-1, 1)},
                     {.elastic_modulus = between(1, 1000),
                      .length = between(1, 100),
                      .area = between(1, 5000),
                      .moment_x = between(1, 500'000),
                      .moment_y = between(1, 500'000),
                      .torsion = between(1, 500'000)});
    }
    const Eigen::VectorXd values = frames.spectrum();
    EXPECT_LE(values.maxCoeff(), 2 + kRounding);
    EXPECT_GE(values.minCoeff(), -kRounding);
  }
}

}  // namespace
}  // namespace holdfast
