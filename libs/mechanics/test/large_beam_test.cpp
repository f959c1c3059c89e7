// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The beam at large displacements, in all directions of all lattices. Expected values: the linear
// beam at rest, central differences, invariance to rigid motions and to the exchange of the ends,
// and closed forms: a moment 2 pi EI / l closes a chain into a ring, a bar is stretched by N L /
// EA.
#include "holdfast/mechanics/large_beam.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "paper.hpp"
#include "random_signed.hpp"

namespace holdfast::mechanics {
namespace {

using namespace holdfast::test;
using base::Direction;
using base::Mat6;
using base::Vec6;

const std::vector<base::Lattice>& lattices() {
  static const std::vector<base::Lattice> all = {base::kCubic, base::kFaceCentred, base::kHexagonal,
                                                 base::kHexagonalPrism};
  return all;
}

LargeBeam large_beam(const base::Lattice& lattice, Direction direction) {
  const auto section = lopsided_section<double>();
  return {beam_stiffness(section), section.length, rotation_along<double>(lattice, direction)};
}

/// Every beam of every lattice and, for a lattice, the linear ones.
void for_each_beam(
    const std::function<void(const LargeBeam&, const LatticeBeam<double>&, Direction)>& test) {
  for (const base::Lattice& lattice : lattices()) {
    const LatticeBeam<double> linear(lopsided_section<double>(), lattice);
    for (const Direction direction : base::directions(lattice)) {
      test(large_beam(lattice, direction), linear, direction);
    }
  }
}

Vec6<double> random_step(base::Rng& rng, double shift, double turn) {
  Vec6<double> step{};
  for (std::size_t i = 0; i < 3; ++i) {
    step[i] = shift * random_signed(rng);
    step[i + 3] = turn * random_signed(rng);
  }
  return step;
}

/// A pose far from rest: turned by up to about 1.5 rad, in two steps.
Pose random_pose(base::Rng& rng) {
  return moved(moved(Pose{}, random_step(rng, 10, 0.5)), random_step(rng, 10, 0.4));
}

EndForces forces(const LargeBeam& beam, const Pose& p, const Pose& q) {
  const BeamDeformation deformation = beam.deformation(p, q);
  return beam.end_forces(deformation, beam.stress(deformation));
}

double energy(const LargeBeam& beam, const Pose& p, const Pose& q) {
  return beam.energy(beam.deformation(p, q));
}

/// Rows and columns 0 to 5 are p's.
double entry(const EndTangent& tangent, int row, int column) {
  const Mat6<double>& block =
      row < 6 ? (column < 6 ? tangent.pp : tangent.pq) : (column < 6 ? tangent.qp : tangent.qq);
  return block.at(row % 6, column % 6);
}

double component(const EndForces& force, int row) {
  return row < 6 ? force.p[base::at(row)] : force.q[base::at(row - 6)];
}

/// A step h of one of the twelve components.
void take_step(Pose& p, Pose& q, int component, double h) {
  Vec6<double> step{};
  step[base::at(component % 6)] = h;
  Pose& pose = component < 6 ? p : q;
  pose = moved(pose, step);
}

/// What a row or column of the matrix is measured by: N/mm, N, N mm.
double scale_of(const LargeBeam& beam, int row, int column) {
  const double length = beam.length();
  return beam.stiffness()[2] * (row % 6 < 3 ? 1 : length) * (column % 6 < 3 ? 1 : length);
}

TEST(large_beam, at_rest_has_the_stiffness_matrix_of_the_linear_beam) {
  for_each_beam([](const LargeBeam& beam, const LatticeBeam<double>& linear, Direction direction) {
    const EndTangent tangent = beam.tangent(beam.deformation(Pose{}, Pose{}));
    const auto expect_near = [](const Mat6<double>& a, const Mat6<double>& b) {
      for (int row = 0; row < 6; ++row) {
        for (int column = 0; column < 6; ++column) {
          const double own = std::sqrt(std::abs(b.at(row, row) * b.at(column, column)));
          EXPECT_NEAR(a.at(row, column), b.at(row, column), 4e-15 * own);
        }
      }
    };
    expect_near(tangent.pp, linear.block_11(direction));
    expect_near(tangent.qq, linear.block_11(base::opposite(direction)));
    expect_near(tangent.pq, linear.block_12(direction));
    expect_near(tangent.qp, linear.block_12(base::opposite(direction)));
  });
}

TEST(large_beam, has_the_linear_forces_at_small_displacements) {
  base::Rng rng(7);
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>& linear, Direction direction) {
    const Vec6<double> u_p = random_step(rng, 4e-9, 1e-10);
    const Vec6<double> u_q = random_step(rng, 4e-9, 1e-10);
    const BeamDeformation deformation = beam.deformation(moved({}, u_p), moved({}, u_q));
    const Vec6<double> stress = beam.stress(deformation);
    const EndForces force = beam.end_forces(deformation, stress);
    const Vec6<double> p = linear.end_force(direction, u_p, u_q);
    const Vec6<double> q = linear.end_force(base::opposite(direction), u_q, u_p);
    const Vec6<double> middle = linear.middle_force(direction, u_p, u_q);
    for (std::size_t i = 0; i < 6; ++i) {
      const double scale = beam.stiffness()[2] * 4e-9 * (i < 3 ? 1 : beam.length());
      EXPECT_NEAR(force.p[i], p[i], 1e-9 * scale);
      EXPECT_NEAR(force.q[i], q[i], 1e-9 * scale);
      EXPECT_NEAR(beam.middle_force(deformation, stress)[i], middle[i], 1e-9 * scale);
      EXPECT_NEAR(stress[i], middle[i], 1e-9 * scale);
    }
  });
}

TEST(large_beam, has_forces_that_are_the_gradient_of_its_energy) {
  base::Rng rng(8);
  constexpr double kStep = 1e-4;
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    const Pose p = random_pose(rng);
    const Pose q = random_pose(rng);
    const EndForces force = forces(beam, p, q);
    for (int i = 0; i < 12; ++i) {
      const double h = kStep * (i % 6 < 3 ? beam.length() : 1);
      Pose p_back = p;
      Pose q_back = q;
      Pose p_on = p;
      Pose q_on = q;
      take_step(p_back, q_back, i, -h);
      take_step(p_on, q_on, i, h);
      const double slope = (energy(beam, p_on, q_on) - energy(beam, p_back, q_back)) / (2 * h);
      EXPECT_NEAR(component(force, i), slope, 1e-7 * scale_of(beam, 2, i) * beam.length());
    }
  });
}

TEST(large_beam, has_a_tangent_that_is_the_derivative_of_its_forces) {
  base::Rng rng(9);
  constexpr double kStep = 1e-5;
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    const Pose p = random_pose(rng);
    const Pose q = random_pose(rng);
    const EndTangent tangent = beam.tangent(beam.deformation(p, q));
    for (int column = 0; column < 12; ++column) {
      const double h = kStep * (column % 6 < 3 ? beam.length() : 1);
      Pose p_back = p;
      Pose q_back = q;
      Pose p_on = p;
      Pose q_on = q;
      take_step(p_back, q_back, column, -h);
      take_step(p_on, q_on, column, h);
      const EndForces back = forces(beam, p_back, q_back);
      const EndForces on = forces(beam, p_on, q_on);
      for (int row = 0; row < 12; ++row) {
        const double slope = (component(on, row) - component(back, row)) / (2 * h);
        EXPECT_NEAR(entry(tangent, row, column), slope, 1e-7 * scale_of(beam, row, column));
      }
    }
  });
}

// Spins do not commute: [w1, w2] is their cross product, so the unsymmetric part is m x / 2.
TEST(large_beam, has_a_symmetric_tangent_but_for_half_the_moments) {
  base::Rng rng(10);
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    const Pose p = random_pose(rng);
    const Pose q = random_pose(rng);
    const EndTangent tangent = beam.tangent(beam.deformation(p, q));
    const EndForces force = forces(beam, p, q);
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 12; ++column) {
        double difference = entry(tangent, row, column) - entry(tangent, column, row);
        if (row / 6 == column / 6 && row % 6 >= 3 && column % 6 >= 3 && row != column) {
          const int i = row % 3;
          const int k = column % 3;
          const int third = 3 - i - k;
          const double sign = (k - i + 3) % 3 == 1 ? 1 : -1;
          difference -= sign * component(force, 6 * (row / 6) + 3 + third);
        }
        EXPECT_NEAR(difference, 0, 1e-13 * scale_of(beam, row, column));
      }
    }
  });
}

TEST(large_beam, is_invariant_to_rigid_motions_and_to_the_exchange_of_its_ends) {
  base::Rng rng(11);
  for (const base::Lattice& lattice : lattices()) {
    for (const Direction direction : base::directions(lattice)) {
      const LargeBeam beam = large_beam(lattice, direction);
      const LargeBeam back = large_beam(lattice, base::opposite(direction));
      const Pose p = random_pose(rng);
      const Pose q = random_pose(rng);
      const double own = energy(beam, p, q);
      EXPECT_NEAR(energy(back, q, p), own, 1e-13 * own);

      // The module p is at the origin at rest, q at L n.
      const Vec6<double> motion = random_step(rng, 30, 1);
      const auto turned = moved({}, {0, 0, 0, motion[3], motion[4], motion[5]}).rotation;
      const auto carry = [&](const Pose& pose, double lever) {
        Vector3 place = pose.displacement;
        for (std::size_t i = 0; i < 3; ++i) {
          place[i] -= lever * beam.axes()[2][i];
        }
        const Vector3 turned_place = rotated(turned, place);
        Pose next = moved(pose, {0, 0, 0, motion[3], motion[4], motion[5]});
        for (std::size_t i = 0; i < 3; ++i) {
          next.displacement[i] = motion[i] + turned_place[i] + lever * beam.axes()[2][i];
        }
        return next;
      };
      EXPECT_NEAR(energy(beam, carry(p, 0), carry(q, beam.length())), own, 1e-12 * own);
    }
  }
}

TEST(large_beam, has_balanced_forces_and_carries_them_through_its_middle) {
  base::Rng rng(12);
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    const Pose p = random_pose(rng);
    const Pose q = random_pose(rng);
    const BeamDeformation deformation = beam.deformation(p, q);
    const EndForces force = forces(beam, p, q);
    // Moments about p: M_p + M_q + (x_q - x_p) x F_q.
    Vector3 lever{};
    for (std::size_t i = 0; i < 3; ++i) {
      lever[i] = q.displacement[i] - p.displacement[i] - beam.length() * beam.axes()[2][i];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const std::size_t k = (i + 2) % 3;
      EXPECT_NEAR(force.p[i] + force.q[i], 0, 1e-12 * scale_of(beam, 0, 3));
      EXPECT_NEAR(force.p[3 + i] + force.q[3 + i] + lever[j] * force.q[k] - lever[k] * force.q[j],
                  0, 1e-12 * scale_of(beam, 3, 3));
    }
    const Vec6<double> middle = beam.middle_force(deformation, beam.stress(deformation));
    const double at_end = std::hypot(force.q[0], force.q[1], force.q[2]);
    EXPECT_NEAR(std::hypot(middle[0], middle[1], middle[2]), at_end, 1e-12 * at_end);
  });
}

TEST(large_beam, closes_a_chain_into_a_ring_under_a_moment_of_two_pi) {
  const LargeBeam beam = large_beam(base::kCubic, Direction::kPlusX);
  for (const int count : {3, 4, 10, 100}) {
    // Module i of the chain is turned by 2 pi i / count about y, on a circle: all strains but the
    // bending are 0, and the bending moment is EI 2 pi / l.
    const double angle = 2 * std::numbers::pi / count;
    const double radius = beam.length() / angle;
    const auto pose = [&](int i) {
      Pose turned;
      for (int step = 0; step < i; ++step) {
        turned = moved(turned, {0, 0, 0, 0, angle, 0});
      }
      turned.displacement = {radius * std::sin(i * angle) - i * beam.length(), 0,
                             -radius * (1 - std::cos(i * angle))};
      return turned;
    };
    for (const int i : {0, 1, count - 1}) {
      const BeamDeformation deformation = beam.deformation(pose(i), pose(i + 1));
      const Vec6<double> stress = beam.stress(deformation);
      const Vec6<double> middle = beam.middle_force(deformation, stress);
      const double moment = beam.stiffness()[4] * angle;
      EXPECT_NEAR(std::hypot(middle[3], middle[4], middle[5]), moment, 1e-13 * moment);
      for (const std::size_t k : {0U, 1U, 2U}) {
        // What rounding of places on the circle is to the stiffest spring.
        EXPECT_NEAR(middle[k], 0, 1e-15 * count * beam.length() * beam.stiffness()[2]);
      }
    }
  }
}

TEST(large_beam, is_stretched_like_a_bar_and_twisted_like_a_shaft) {
  for_each_beam([](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    Vec6<double> step{};
    for (std::size_t i = 0; i < 3; ++i) {
      step[i] = -3 * beam.axes()[2][i];        // q goes 3 mm along n
      step[i + 3] = -0.7 * beam.axes()[2][i];  // and turns by 0.7 about it.
    }
    const BeamDeformation deformation = beam.deformation({}, moved({}, step));
    const Vec6<double> middle = beam.middle_force(deformation, beam.stress(deformation));
    EXPECT_NEAR(middle[2], 3 * beam.stiffness()[2], 1e-12 * middle[2]);
    EXPECT_NEAR(middle[5], 0.7 * beam.stiffness()[5], 1e-12 * middle[5]);
    for (const std::size_t k : {0U, 1U, 3U, 4U}) {
      EXPECT_NEAR(middle[k], 0, 1e-9);
    }
  });
}

// Central differences of B^T s at rest, with s fixed.
TEST(large_beam, has_the_geometric_stiffness_of_fixed_stresses) {
  base::Rng rng(13);
  constexpr double kStep = 1e-4;
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    Vec6<double> stress{};
    for (double& s : stress) {
      s = random_signed(rng);
    }
    const EndTangent geometric = beam.geometric_stiffness(stress);
    Mat6<double> derivative[2][2];
    for (int column = 0; column < 12; ++column) {
      const double h = kStep * (column % 6 < 3 ? beam.length() : 1);
      const auto at = [&](double step) {
        Pose p;
        Pose q;
        take_step(p, q, column, step);
        return beam.end_forces(beam.deformation(p, q), stress);
      };
      const EndForces on = at(h);
      const EndForces back = at(-h);
      for (int row = 0; row < 12; ++row) {
        derivative[row / 6][column / 6].at(row % 6, column % 6) =
            (component(on, row) - component(back, row)) / (2 * h);
      }
    }
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 12; ++column) {
        const double half = (derivative[row / 6][column / 6].at(row % 6, column % 6) +
                             derivative[column / 6][row / 6].at(column % 6, row % 6)) /
                            2;
        const double scale = (row % 6 < 3 ? 1 : beam.length()) * (column % 6 < 3 ? 1 : 40);
        EXPECT_NEAR(entry(geometric, row, column), half, 1e-7 * scale);
        EXPECT_EQ(entry(geometric, row, column), entry(geometric, column, row));
      }
    }
  });
}

TEST(large_beam, has_the_forces_of_its_geometric_stiffness_without_making_it) {
  base::Rng rng(12);
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    Vec6<double> stress{};
    for (double& s : stress) {
      s = random_signed(rng);
    }
    const Vec6<double> u_p = random_step(rng, 1, 0.1);
    const Vec6<double> u_q = random_step(rng, 1, 0.1);
    const EndTangent matrix = beam.geometric_stiffness(stress);
    const EndForces found = beam.geometric_forces(stress, u_p, u_q);
    auto at_p = base::multiply(matrix.pp, u_p);
    base::add_to(at_p, base::multiply(matrix.pq, u_q));
    auto at_q = base::multiply(matrix.qp, u_p);
    base::add_to(at_q, base::multiply(matrix.qq, u_q));
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(found.p[i], at_p[i], 1e-13 * beam.length());
      EXPECT_NEAR(found.q[i], at_q[i], 1e-13 * beam.length());
    }
  });
}

// Hermite's cubics: N/(30 L) [36, 3 L, -36, 3 L; 3 L, 4 L^2, -3 L, -L^2; ...] [Przemieniecki 1968].
TEST(large_beam, has_the_consistent_geometric_stiffness_of_an_axial_force) {
  const LargeBeam beam = large_beam(base::kCubic, Direction::kMinusZ);  // z' is z, x' is x.
  const double length = beam.length();
  const EndTangent geometric = beam.geometric_stiffness({0, 0, 5, 0, 0, 0});
  EXPECT_NEAR(geometric.pp.at(0, 0), 5 * 6 / (5 * length), 1e-14);
  EXPECT_NEAR(geometric.pq.at(0, 0), -5 * 6 / (5 * length), 1e-14);
  EXPECT_NEAR(std::abs(geometric.pp.at(0, 4)), 5.0 / 10, 1e-14);
  EXPECT_NEAR(geometric.pp.at(4, 4), 5 * 2 * length / 15, 1e-13);
  EXPECT_NEAR(geometric.pq.at(4, 4), -5 * length / 30, 1e-13);
  EXPECT_NEAR(geometric.pp.at(2, 2), 0, 1e-14);
}

TEST(large_beam, has_forces_of_second_order_that_are_the_even_part_of_all) {
  base::Rng rng(14);
  for_each_beam([&](const LargeBeam& beam, const LatticeBeam<double>&, Direction) {
    const Vec6<double> u_p = random_step(rng, 20, 0.5);
    const Vec6<double> u_q = random_step(rng, 20, 0.5);
    const EndForces second = beam.second_order_forces(u_p, u_q);
    const auto at = [&](double h) {
      const Vec6<double> zero{};
      return forces(beam, moved({}, base::sum_of(zero, h, u_p)),
                    moved({}, base::sum_of(zero, h, u_q)));
    };
    constexpr double kStep = 1e-3;
    const EndForces on = at(kStep);
    const EndForces back = at(-kStep);
    for (int i = 0; i < 12; ++i) {
      const double even = (component(on, i) + component(back, i)) / (2 * kStep * kStep);
      // The next even term is of fourth order, kStep^2 of this; rounding is 1e-16 / kStep^2.
      EXPECT_NEAR(component(second, i), even, 2e-6 * scale_of(beam, 0, i) * 20);
    }
  });
}

TEST(large_beam, turns_by_the_rotation_vectors_of_its_steps) {
  base::Rng rng(15);
  for (int trial = 0; trial < 100; ++trial) {
    const Vec6<double> step = random_step(rng, 1, 1.7);  // Below pi.
    const Vector3 turn = rotation_vector(moved({}, step).rotation);
    const double angle = std::hypot(step[3], step[4], step[5]);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(turn[i], step[3 + i], 2e-15 * (1 + angle));
    }
  }
}

// Both ways to c meet at t = 1, and it is the function of tangents of the standard library.
TEST(large_beam, has_the_strains_of_a_screw_at_any_angle) {
  const LargeBeam beam = large_beam(base::kCubic, Direction::kMinusZ);
  for (const double t : {1e-6, 0.1, 0.5, 0.999999, 1.000001, 1.5, 2.5, 3.0}) {
    // q is turned about x by t and not displaced: a = (0, 0, -L), rho_y = L t / 2, and
    // rho_z = -L (1 - c t^2) = -L (t/2) cot(t/2).
    const BeamDeformation deformation = beam.deformation({}, moved({}, {0, 0, 0, t, 0, 0}));
    const double length = beam.length();
    EXPECT_NEAR(deformation.strain[3], -t, 1e-15 * (1 + t));
    EXPECT_NEAR(std::abs(deformation.rho[1]), length * t / 2, 1e-14 * length);
    EXPECT_NEAR(deformation.rho[2], -length * (t / 2) / std::tan(t / 2), 1e-14 * length);
  }
}

}  // namespace
}  // namespace holdfast::mechanics
