// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Elimination over a tree with loops, beside a dense solve of the whole robot.
#include "holdfast/agent/algebra/branch.hpp"

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

/// A robot with its spanning tree: parents come before children.
struct Tree {
  std::vector<Cell> cells;
  std::vector<int> parents;

  int find(const Cell& cell) const {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (cells[i] == cell) {
        return static_cast<int>(i);
      }
    }
    return -1;
  }

  Direction to_parent(std::size_t i) const {
    for (const Direction direction : base::kDirections) {
      if (base::neighbour(cells[i], direction) == cells[static_cast<std::size_t>(parents[i])]) {
        return direction;
      }
    }
    return Direction::kPlusX;
  }
};

/// What holds each module from outside, full and not symmetric; zero for most.
using Springs = std::vector<Mat6<double>>;
using Vectors = std::vector<Vec6<double>>;

Vectors dense_solution(const Tree& tree, const Springs& springs, const Vectors& loads) {
  const auto beam = lopsided_beam();
  const auto n = static_cast<Eigen::Index>(6 * tree.cells.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd right(n);
  const auto add = [&](std::size_t p, std::size_t q, const Mat6<double>& block) {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        matrix(static_cast<Eigen::Index>(6 * p) + row, static_cast<Eigen::Index>(6 * q) + column) +=
            block.at(row, column);
      }
    }
  };
  for (std::size_t i = 0; i < tree.cells.size(); ++i) {
    add(i, i, springs[i]);
    for (const Direction direction : base::kDirections) {
      const int j = tree.find(base::neighbour(tree.cells[i], direction));
      if (j >= 0) {
        add(i, i, mechanics::block_11(beam, direction));
        add(i, static_cast<std::size_t>(j), mechanics::block_12(beam, direction));
      }
    }
    for (std::size_t k = 0; k < 6; ++k) {
      right(static_cast<Eigen::Index>(6 * i + k)) = loads[i][k];
    }
  }
  const Eigen::VectorXd found = matrix.fullPivLu().solve(right);
  Vectors result(tree.cells.size());
  for (std::size_t i = 0; i < tree.cells.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      result[i][k] = found(static_cast<Eigen::Index>(6 * i + k));
    }
  }
  return result;
}

using Slots = std::vector<std::array<std::uint8_t, kLoopsMax>>;

/// visit(cut, is this its upper end) for the connections that are not part of the tree.
template <class Visit>
void for_each_cut(const Tree& tree, std::size_t i, Visit&& visit) {
  for (const Direction direction : base::kDirections) {
    const Cell other = base::neighbour(tree.cells[i], direction);
    const int j = tree.find(other);
    if (j >= 0 && tree.parents[i] != j &&
        tree.parents[static_cast<std::size_t>(j)] != static_cast<int>(i)) {
      const bool is_upper = base::index(direction) % 2 != 0;
      visit(is_upper ? Cut{other, base::opposite(direction)} : Cut{tree.cells[i], direction},
            is_upper);
    }
  }
}

/// Finds which loops pass or close where. False: too many.
bool survey(const Tree& tree, std::vector<Branch>& branches, Slots& slot_of) {
  bool fits = true;
  for (std::size_t i = branches.size(); i-- > 0 && fits;) {
    for_each_cut(tree, i, [&](const Cut& cut, bool) { fits = branches[i].meet(cut) >= 0 && fits; });
    for (std::size_t child = i + 1; child < branches.size() && fits; ++child) {
      const bool is_child = tree.parents[child] == static_cast<int>(i);
      for (int k = 0; is_child && k < branches[child].open_count(); ++k) {
        const int slot = branches[i].meet(branches[child].cut(branches[child].open_slot(k)));
        slot_of[child][static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(slot);
        fits = slot >= 0 && fits;
      }
    }
  }
  return fits;
}

/// What the modules do, in one loop instead of by messages. False: too many loops.
bool eliminate(const Tree& tree, const Springs& springs, const Vectors& loads, Vectors& result) {
  const auto beam = lopsided_beam();
  const std::size_t n = tree.cells.size();
  std::vector<Branch> branches(n);
  std::vector<BranchLoad> branch_loads(n);
  Slots slot_of(n);
  if (!survey(tree, branches, slot_of)) {
    return false;
  }
  for (std::size_t i = n; i-- > 0;) {
    Branch& branch = branches[i];
    branch.add_stiffness(springs[i]);
    for_each_cut(tree, i, [&](const Cut& cut, bool is_upper) {
      branch.add_end(branch.find(cut), is_upper, beam);
    });
    base::add_to(branch_loads[i].load, loads[i]);
    std::uint8_t piece = 0;
    while (branch.close_loops(beam, piece)) {
    }
    branch.close_loops(branch_loads[i]);
    if (i == 0) {
      break;
    }
    const auto parent = static_cast<std::size_t>(tree.parents[i]);
    const Joint joint(beam, tree.to_parent(i));
    Branch::Columns columns;
    for (int first = 0; first < Branch::kColumnCount; first += Branch::batch_at(first)) {
      if (!branch.has_columns(first, false)) {
        continue;
      }
      branch.find_columns_up(joint, false, first, Branch::batch_at(first), columns);
      for (int k = 0; k < Branch::batch_at(first); ++k) {
        branches[parent].add_column(first + k, slot_of[i], columns[static_cast<std::size_t>(k)]);
      }
    }
    Vec6<double> load = branch_loads[i].load;
    branch.find_load_up(joint, false, load);
    base::add_to(branch_loads[parent].load, load);
    CutForces gaps{};
    branch.find_gaps_up(joint, false, branch_loads[i], gaps);
    for (std::size_t k = 0; k < static_cast<std::size_t>(branch.open_count()); ++k) {
      base::add_to(branch_loads[parent].gap[static_cast<std::size_t>(slot_of[i][k])],
                   base::converted<double>(gaps[k]));
    }
  }
  std::vector<CutForces> forces(n);
  result.resize(n);
  branches[0].find_displacement_of_root(branch_loads[0], result[0]);
  branches[0].find_forces(branch_loads[0], result[0], forces[0]);
  for (std::size_t i = 1; i < n; ++i) {
    const auto parent = static_cast<std::size_t>(tree.parents[i]);
    for (int k = 0; k < branches[i].open_count(); ++k) {
      forces[i][static_cast<std::size_t>(branches[i].open_slot(k))] =
          forces[parent][static_cast<std::size_t>(slot_of[i][static_cast<std::size_t>(k)])];
    }
    result[i] = result[parent];
    branches[i].find_displacement(Joint(beam, tree.to_parent(i)), branch_loads[i], forces[i],
                                  result[i]);
    branches[i].find_forces(branch_loads[i], result[i], forces[i]);
  }
  return true;
}

/// Grown at random; the parent is any earlier neighbour.
Tree random_tree(base::Rng& rng, std::size_t count) {
  Tree tree{.cells = {{0, 0, 0}}, .parents = {-1}};
  while (tree.cells.size() < count) {
    const std::size_t at = rng.below(tree.cells.size());
    const Cell next =
        base::neighbour(tree.cells[at], base::kDirections[static_cast<std::size_t>(rng.below(6))]);
    if (tree.find(next) < 0) {
      tree.cells.push_back(next);
      tree.parents.push_back(static_cast<int>(at));
    }
  }
  return tree;
}

double largest_error(const Vectors& found, const Vectors& expected) {
  double error = 0;
  double size = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      error = std::max(error, std::abs(found[i][k] - expected[i][k]));
      size = std::max(size, std::abs(expected[i][k]));
    }
  }
  return error / size;
}

TEST(Branch, elimination_with_loops_is_the_dense_solution) {
  base::Rng rng(5);
  int loops_seen = 0;
  for (int round = 0; round < 300; ++round) {
    const Tree tree = random_tree(rng, 2 + rng.below(14));
    Springs springs(tree.cells.size());
    Vectors loads(tree.cells.size());
    for (std::size_t i = 0; i < tree.cells.size(); ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        loads[i][k] = random_signed(rng) * (k < 3 ? 1 : 40);
      }
      if (i == tree.cells.size() - 1 || rng.below(5) == 0) {
        // Stiff on the diagonal, and something that is not symmetric.
        for (int k = 0; k < 6; ++k) {
          springs[i].at(k, k) = k < 3 ? 3000 : 2e6;
        }
        springs[i].at(3, 2) = 20'000 * random_signed(rng);
      }
    }
    Vectors found;
    if (!eliminate(tree, springs, loads, found)) {
      continue;
    }
    std::size_t connections = 0;
    for (const Cell& cell : tree.cells) {
      for (const Direction direction : {Direction::kPlusX, Direction::kPlusY, Direction::kPlusZ}) {
        connections += tree.find(base::neighbour(cell, direction)) >= 0 ? 1 : 0;
      }
    }
    loops_seen += connections >= tree.cells.size() ? 1 : 0;
    EXPECT_LT(largest_error(found, dense_solution(tree, springs, loads)), 2e-4) << round;
  }
  EXPECT_GT(loops_seen, 60);
}

/// A cantilever of 300: the tip sinks by q L^4 / (8 E I) and the sum of shear; the condition is
/// about 1e11, and still single precision will do.
TEST(Branch, a_long_arm_loses_no_digits) {
  const auto beam = lopsided_beam();
  constexpr int kCount = 300;
  Tree tree;
  Springs springs(kCount + 1);
  Vectors loads(kCount + 1);
  for (int i = 0; i <= kCount; ++i) {
    tree.cells.push_back({i, 0, 0});
    tree.parents.push_back(i - 1);
    loads[static_cast<std::size_t>(i)][2] = i > 0 ? -0.6 : 0;
  }
  for (int k = 0; k < 6; ++k) {
    springs[0].at(k, k) = 1e12;
  }
  Vectors found;
  ASSERT_TRUE(eliminate(tree, springs, loads, found));
  // Beam by beam: forces by statics, each beam's own flexibility, rigid motion beyond.
  double sag = 0;
  for (int i = 1; i <= kCount; ++i) {
    const double force = 0.6 * (kCount - i + 1);
    double torque = 0;  // About the outer end of beam i.
    for (int j = i; j <= kCount; ++j) {
      torque += 0.6 * 40.0 * (j - i);
    }
    const double lateral_bend = beam.bend_x / 4 * 40;  // E I
    const double slope = force * 40 * 40 / (2 * lateral_bend) + torque * 40 / lateral_bend;
    sag += force * 40 * 40 * 40 / (3 * lateral_bend) + torque * 40 * 40 / (2 * lateral_bend) +
           slope * 40 * (kCount - i);
  }
  EXPECT_NEAR(found.back()[2] / -sag, 1, 1e-5);
}

/// Seen from the parent, in parts and in columns; both added up there are the same matrix, which
/// one more beam makes visible.
TEST(Branch, a_symmetric_stiffness_is_the_same_in_parts) {
  const auto beam = lopsided_beam();
  base::Rng rng(5);
  for (int round = 0; round < 20; ++round) {
    Mat6<double> springs;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j <= i; ++j) {
        springs.at(i, j) = springs.at(j, i) = random_signed(rng) + (i == j ? 9 : 0);
      }
    }
    const bool is_fixed = round % 5 == 4;
    const Joint up(beam, base::kDirections[static_cast<std::size_t>(rng.below(6))]);
    Branch branch;
    branch.add_stiffness(springs);
    Branch by_parts;
    Branch by_columns;
    Branch::Columns columns;
    for (int first = 0; first < Branch::kPartCount; first += 2) {
      branch.find_parts_up(up, is_fixed, first, columns);
      by_parts.add_part(first, columns[0]);
      by_parts.add_part(first + 1, columns[1]);
    }
    for (int first = 0; first < 6; first += Branch::kBatch) {
      branch.find_columns_up(up, is_fixed, first, Branch::kBatch, columns);
      for (int k = 0; k < Branch::kBatch; ++k) {
        by_columns.add_column(first + k, {}, columns[static_cast<std::size_t>(k)]);
      }
    }
    for (int first = 0; first < 6; first += Branch::kBatch) {
      Branch::Columns other;
      by_parts.find_columns_up(up, false, first, Branch::kBatch, columns);
      by_columns.find_columns_up(up, false, first, Branch::kBatch, other);
      for (std::size_t k = 0; k < Branch::kBatch; ++k) {
        for (std::size_t row = 0; row < 6; ++row) {
          EXPECT_NEAR(columns[k][row], other[k][row], 1e-4F * (1 + std::abs(other[k][row])));
        }
      }
    }
  }
}

TEST(Branch, a_third_loop_does_not_fit) {
  Branch branch;
  EXPECT_EQ(branch.meet({{0, 0, 0}, Direction::kPlusX}), 0);
  EXPECT_EQ(branch.meet({{1, 0, 0}, Direction::kPlusX}), 1);
  EXPECT_EQ(branch.meet({{2, 0, 0}, Direction::kPlusX}), -1);
  EXPECT_EQ(branch.open_count(), 2);
  EXPECT_EQ(branch.meet({{0, 0, 0}, Direction::kPlusX}), 0);  // Its other end.
  EXPECT_EQ(branch.open_count(), 1);
  EXPECT_EQ(branch.open_slot(0), 1);
}

}  // namespace
}  // namespace holdfast::agent
