// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The solve on a tree of rigid clusters, beside a dense solve with six unknowns a cluster.
#include "holdfast/agent/algebra/cluster.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "holdfast/base/rng.hpp"
#include "random_signed.hpp"
#include "test_setup.hpp"

namespace holdfast::agent {
namespace {

using base::Cell;
using base::Direction;
using base::Mat6;
using base::Vec6;
using holdfast::test::random_signed;
using test::lopsided_beam;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kPitch = 40;

/// Parents come before children; a module that is no top is in its parent's cluster.
struct Robot {
  std::vector<Cell> cells;
  std::vector<std::size_t> parents;
  std::vector<std::size_t> tops;
  std::vector<Mat6<double>> springs;  ///< Of the ground, symmetric, zero for most.
  std::vector<Vec6<double>> loads;
  std::vector<bool> is_fixed;

  std::size_t size() const { return cells.size(); }

  bool is_top(std::size_t i) const { return tops[i] == i; }

  std::size_t find(const Cell& cell) const {
    std::size_t i = 0;
    while (i < size() && cells[i] != cell) {
      ++i;
    }
    return i;
  }

  Direction to_parent(std::size_t i) const {
    for (const Direction direction : base::kDirections) {
      if (base::neighbour(cells[i], direction) == cells[parents[i]]) {
        return direction;
      }
    }
    return Direction::kPlusX;
  }

  /// visit(j, direction) for the beams of a module that are part of its cluster's joint: those to
  /// other clusters that are not children of its own.
  template <class Visit>
  void for_each_joint_beam(std::size_t i, Visit visit) const {
    for (const Direction direction : base::kDirections) {
      const std::size_t j = find(base::neighbour(cells[i], direction));
      const bool is_out = tops[i] != 0 && j < size() && tops[j] != tops[i];
      if (is_out && (tops[j] == 0 || tops[parents[tops[j]]] != tops[i])) {
        visit(direction);
      }
    }
  }
};

Robot random_robot(base::Rng& rng, bool has_fixed) {
  Robot robot;
  robot.cells = {{0, 0, 0}};
  robot.parents = {0};
  robot.tops = {0};
  const std::size_t count = 2 + rng.below(20);
  while (robot.size() < count) {
    const std::size_t at = rng.below(robot.size());
    const Cell next =
        base::neighbour(robot.cells[at], base::kDirections[static_cast<std::size_t>(rng.below(6))]);
    if (robot.find(next) == robot.size()) {
      robot.cells.push_back(next);
      robot.parents.push_back(at);
      robot.tops.push_back(rng.below(3) == 0 ? robot.size() - 1 : robot.tops[at]);
    }
  }
  robot.springs.resize(count);
  robot.loads.resize(count);
  robot.is_fixed.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      robot.loads[i][k] = random_signed(rng) * (k < 3 ? 1 : 40);
    }
    const bool is_held = i == count - 1 || rng.below(5) == 0;
    robot.is_fixed[i] = is_held && has_fixed;
    for (int k = 0; k < 6 && is_held && !has_fixed; ++k) {
      robot.springs[i].at(k, k) = k < 3 ? 3000 : 2e6;
    }
    if (is_held && !has_fixed) {
      robot.springs[i].at(2, 3) = robot.springs[i].at(3, 2) = 2e4 * random_signed(rng);
    }
  }
  return robot;
}

Matrix6 dense(const Mat6<double>& matrix) {
  return Eigen::Map<const Matrix6>(matrix.values.data());
}

/// The rigid motion of a body, given at `from`, at another place.
Matrix6 motion(const Cell& from, const Cell& at) {
  const double x = kPitch * (at.x - from.x);
  const double y = kPitch * (at.y - from.y);
  const double z = kPitch * (at.z - from.z);
  Matrix6 motion = Matrix6::Identity();
  motion.topRightCorner<3, 3>() << 0, z, -y, -z, 0, x, y, -x, 0;
  return motion;
}

/// Displacements of all modules, from the energy: sum over springs of (difference) S (difference).
std::vector<Vec6<double>> dense_solution(const Robot& robot) {
  const auto n = static_cast<Eigen::Index>(6 * robot.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
  const auto place = [](std::size_t i) { return static_cast<Eigen::Index>(6 * i); };
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const std::size_t top = robot.tops[i];
    const std::size_t above = robot.tops[robot.parents[top]];
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(6, n);
    own.middleCols<6>(place(top)) = motion(robot.cells[top], robot.cells[i]);
    matrix += own.transpose() * dense(robot.springs[i]) * own;
    right += own.transpose() * Eigen::Map<const Eigen::Vector<double, 6>>(robot.loads[i].data());
    Eigen::MatrixXd apart = own;
    apart.middleCols<6>(place(above)) -= motion(robot.cells[above], robot.cells[i]);
    robot.for_each_joint_beam(i, [&](Direction direction) {
      const Matrix6 beam = dense(mechanics::block_11(lopsided_beam(), direction));
      matrix += apart.transpose() * (beam / Cluster::kReach) * apart;
    });
  }
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const std::size_t still = robot.is_fixed[i] ? robot.tops[i] : i;
    if (robot.is_fixed[i] || !robot.is_top(i)) {
      matrix.middleRows<6>(place(still)).setZero();
      matrix.middleCols<6>(place(still)).setZero();
      matrix.block<6, 6>(place(still), place(still)).setIdentity();
      right.segment<6>(place(still)).setZero();
    }
  }
  const Eigen::VectorXd solution = matrix.fullPivLu().solve(right);
  std::vector<Vec6<double>> result(robot.size());
  for (std::size_t i = 0; i < robot.size(); ++i) {
    const std::size_t top = robot.tops[i];
    Eigen::Map<Eigen::Vector<double, 6>>(result[i].data()) =
        motion(robot.cells[top], robot.cells[i]) * solution.segment<6>(place(top));
  }
  return result;
}

/// What the modules do, in one loop instead of by messages.
std::vector<Vec6<double>> solution(const Robot& robot) {
  const auto beam = lopsided_beam();
  std::vector<Cluster> clusters(robot.size());
  Cluster::Parts parts;
  for (std::size_t i = robot.size(); i-- > 1;) {
    robot.for_each_joint_beam(i, [&](Direction direction) {
      clusters[i].add_to_joint(mechanics::block_11(beam, direction));
    });
    if (robot.is_top(i)) {
      clusters[i].close_joint();
    } else if (robot.tops[i] != 0) {
      clusters[i].find_joint_up(Joint(beam, robot.to_parent(i)), parts);
      for (int part = 0; part < Branch::kPartCount; ++part) {
        clusters[robot.parents[i]].add_to_joint(part, parts[static_cast<std::size_t>(part)]);
      }
    }
  }
  for (std::size_t i = robot.size(); i-- > 0;) {
    clusters[i].add_stiffness(robot.springs[i]);
    clusters[i].add_load(robot.loads[i]);
    if (robot.is_fixed[i]) {
      clusters[i].hold();
    }
    if (i == 0) {
      break;
    }
    Cluster& parent = clusters[robot.parents[i]];
    const Joint joint(beam, robot.to_parent(i));
    if (clusters[i].is_held() && !robot.is_top(i)) {
      parent.hold();
    } else if (!clusters[i].is_free()) {
      clusters[i].find_stiffness_up(joint, robot.is_top(i), parts);
      for (int part = 0; part < Branch::kPartCount; ++part) {
        parent.add_stiffness(part, parts[static_cast<std::size_t>(part)]);
      }
    }
    Vec6<double> load;
    clusters[i].find_load_up(joint, robot.is_top(i), load);
    parent.add_load(load);
  }
  std::vector<Vec6<double>> result(robot.size());
  clusters[0].find_displacement_of_root(result[0]);
  for (std::size_t i = 1; i < robot.size(); ++i) {
    result[i] = result[robot.parents[i]];
    clusters[i].find_displacement(Joint(beam, robot.to_parent(i)), robot.is_top(i), result[i]);
  }
  return result;
}

void expect_the_dense_solution(const Robot& robot) {
  const auto expected = dense_solution(robot);
  const auto found = solution(robot);
  double size = 0;
  double error = 0;
  for (std::size_t i = 0; i < robot.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      size = std::max(size, std::abs(expected[i][k]));
      error = std::max(error, std::abs(found[i][k] - expected[i][k]));
    }
  }
  // Single precision, and what some twenty modules in a row make of it.
  EXPECT_LE(error, 2e-4 * size);
}

TEST(Cluster, the_tree_of_clusters_on_springs_is_solved_exactly) {
  base::Rng rng(5);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    expect_the_dense_solution(random_robot(rng, false));
  }
}

TEST(Cluster, a_cluster_with_a_fixed_module_stands_still) {
  base::Rng rng(6);
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    expect_the_dense_solution(random_robot(rng, true));
  }
}

TEST(Cluster, nothing_moves_where_nothing_holds) {
  Cluster cluster;
  cluster.add_load({1, 2, 3, 4, 5, 6});
  EXPECT_TRUE(cluster.is_free());
  Vec6<double> u{};
  cluster.find_displacement_of_root(u);
  EXPECT_EQ(u, Vec6<double>{});
}

}  // namespace
}  // namespace holdfast::agent
