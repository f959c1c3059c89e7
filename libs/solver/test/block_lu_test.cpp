// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The sparse block factorization against Eigen's dense LU with partial pivoting, on random graphs
// and lattices; fill by closed form where it is known. The matrices are well conditioned (diagonal
// blocks dominate), so both agree to rounding: 1e-11 leaves room for some hundred unknowns.
#include "holdfast/solver/block_lu.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "holdfast/base/rng.hpp"
#include "random_signed.hpp"

namespace holdfast::solver {
namespace {

using base::Mat6;
using base::Vec6;
using test::random_signed;

constexpr double kTolerance = 1e-11;
constexpr std::size_t kUnlimited = 1'000'000;

/// Unsymmetric, entries within one, `weight` added on the diagonal.
Mat6<double> random_block(base::Rng& rng, double weight) {
  Mat6<double> block;
  for (double& value : block.values) {
    value = random_signed(rng);
  }
  for (int i = 0; i < 6; ++i) {
    block.at(i, i) += weight;
  }
  return block;
}

Mat6<double> scaled_identity(double scale) {
  Mat6<double> block;
  for (int i = 0; i < 6; ++i) {
    block.at(i, i) = scale;
  }
  return block;
}

std::vector<Edge> lattice(std::int32_t a, std::int32_t b, std::int32_t c) {
  std::vector<Edge> edges;
  for (std::int32_t i = 0; i < a * b * c; ++i) {
    if (i % a + 1 < a) {
      edges.push_back({i, i + 1});
    }
    if (i / a % b + 1 < b) {
      edges.push_back({i + a, i});
    }
    if (i / (a * b) + 1 < c) {
      edges.push_back({i, i + a * b});
    }
  }
  return edges;
}

std::vector<Edge> random_graph(base::Rng& rng, std::int32_t node_count, std::uint64_t percent) {
  std::vector<Edge> edges;
  for (std::int32_t a = 0; a < node_count; ++a) {
    for (std::int32_t b = 0; b < a; ++b) {
      if (rng.below(100) < percent) {
        edges.push_back(rng.below(2) == 0 ? Edge{a, b} : Edge{b, a});
      }
    }
  }
  return edges;
}

/// Every node but the first is joined to a random earlier one.
std::vector<Edge> random_tree(base::Rng& rng, std::int32_t node_count) {
  std::vector<Edge> edges;
  for (std::int32_t node = 1; node < node_count; ++node) {
    edges.push_back({node, static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(node)))});
  }
  return edges;
}

/// One system, twice: in blocks and dense.
class System {
 public:
  System(std::int32_t node_count, std::vector<Edge> edges, base::Rng& rng)
      : edges_(std::move(edges)),
        node_count_(static_cast<std::size_t>(node_count)),
        lu_(node_count_, edges_, kUnlimited),
        dense_(Eigen::MatrixXd::Zero(6 * node_count, 6 * node_count)) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      set_edge(e, random_block(rng, 0));
    }
    for (std::int32_t node = 0; node < node_count; ++node) {
      set_diagonal(node, random_block(rng, 6.0 * node_count));
    }
  }

  void set_edge(std::size_t edge, const Mat6<double>& block) {
    lu_.set_edge(edge, block);
    put(edges_[edge].a, edges_[edge].b, block, false);
    put(edges_[edge].b, edges_[edge].a, block, true);
  }

  void set_diagonal(std::int32_t node, const Mat6<double>& block) {
    lu_.set_diagonal(static_cast<std::size_t>(node), block);
    put(node, node, block, false);
  }

  BlockLu& lu() { return lu_; }

  void expect_solved(base::Rng& rng) const {
    std::vector<Vec6<double>> x(node_count_);
    Eigen::VectorXd b(6 * static_cast<Eigen::Index>(node_count_));
    for (Eigen::Index i = 0; i < b.size(); ++i) {
      b(i) = random_signed(rng);
      at(x, i) = b(i);
    }
    lu_.solve(x);
    const Eigen::VectorXd expected = dense_.partialPivLu().solve(b);
    for (Eigen::Index i = 0; i < b.size(); ++i) {
      EXPECT_NEAR(at(x, i), expected(i), kTolerance * expected.lpNorm<Eigen::Infinity>());
    }
  }

 private:
  static double& at(std::vector<Vec6<double>>& x, Eigen::Index i) {
    return x[static_cast<std::size_t>(i / 6)][static_cast<std::size_t>(i % 6)];
  }

  void put(std::int32_t a, std::int32_t b, const Mat6<double>& block, bool transposed) {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        dense_(6 * a + row, 6 * b + column) =
            transposed ? block.at(column, row) : block.at(row, column);
      }
    }
  }

  std::vector<Edge> edges_;
  std::size_t node_count_;
  BlockLu lu_;
  Eigen::MatrixXd dense_;
};

TEST(BlockLu, solves_like_a_dense_lu_on_random_graphs) {
  base::Rng rng(1);
  for (std::uint64_t percent = 0; percent <= 100; percent += 4) {
    const std::int32_t node_count = 1 + static_cast<std::int32_t>(rng.below(24));
    System system(node_count, random_graph(rng, node_count, percent), rng);
    ASSERT_TRUE(system.lu().factor());
    system.expect_solved(rng);
  }
}

TEST(BlockLu, solves_like_a_dense_lu_on_lattices) {
  base::Rng rng(2);
  for (const auto& [a, b, c] : {std::array{12, 1, 1}, {6, 5, 1}, {4, 3, 3}}) {
    System system(a * b * c, lattice(a, b, c), rng);
    ASSERT_TRUE(system.lu().factor());
    system.expect_solved(rng);
  }
}

TEST(BlockLu, chooses_pivots_within_a_block) {
  base::Rng rng(3);
  Mat6<double> rotation;  // A cyclic permutation: its diagonal is zero.
  for (int i = 0; i < 6; ++i) {
    rotation.at(i, (i + 1) % 6) = 5;
  }
  System system(2, {{0, 1}}, rng);
  system.set_diagonal(0, rotation);
  system.set_diagonal(1, rotation);
  ASSERT_TRUE(system.lu().factor());
  system.expect_solved(rng);
}

/// A solve between changes must not spoil what is kept.
/// Pivots are stiffnesses of very different size; of none may a digit be lost.
TEST(BlockLu, inverts_large_and_small_pivots_to_the_last_digits) {
  BlockLu lu(1, {}, kUnlimited);
  Mat6<double> block;
  Vec6<double> exact{};
  for (int i = 0; i < 6; ++i) {
    block.at(i, i) = 3 * std::pow(10.0, 4 * i - 8);
    exact[static_cast<std::size_t>(i)] = 1 / block.at(i, i);
  }
  lu.set_diagonal(0, block);
  ASSERT_TRUE(lu.factor());
  std::vector<Vec6<double>> x = {{1, 1, 1, 1, 1, 1}};
  lu.solve(x);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(x[0][i], exact[i], 1e-15 * exact[i]);
  }
}

TEST(BlockLu, makes_again_only_what_a_changed_diagonal_touches_but_all_of_it) {
  base::Rng rng(4);
  System system(36, lattice(4, 3, 3), rng);
  for (int round = 0; round < 12; ++round) {
    ASSERT_TRUE(system.lu().factor());
    system.expect_solved(rng);
    for (std::uint64_t changes = rng.below(4); changes > 0; --changes) {
      const auto node = static_cast<std::int32_t>(rng.below(36));
      system.set_diagonal(node, random_block(rng, 100));
    }
  }
}

TEST(BlockLu, makes_again_what_a_changed_edge_touches) {
  base::Rng rng(10);
  const auto edges = lattice(4, 3, 2);
  System system(24, edges, rng);
  for (int round = 0; round < 12; ++round) {
    ASSERT_TRUE(system.lu().factor());
    system.expect_solved(rng);
    system.set_edge(rng.below(edges.size()), random_block(rng, 0));
  }
}

/// A change in one of two pairs leaves the other as it is.
TEST(BlockLu, counts_the_columns_that_it_makes) {
  base::Rng rng(11);
  System system(4, {{0, 1}, {2, 3}}, rng);
  ASSERT_TRUE(system.lu().factor());
  EXPECT_EQ(system.lu().made_column_count(), 4U);
  ASSERT_TRUE(system.lu().factor());
  EXPECT_EQ(system.lu().made_column_count(), 4U);
  system.set_diagonal(0, random_block(rng, 50));
  ASSERT_TRUE(system.lu().factor());
  EXPECT_GE(system.lu().made_column_count(), 5U);
  EXPECT_LE(system.lu().made_column_count(), 6U);
}

/// The bits are those of a factorization from scratch: the operations and their order are the same.
TEST(BlockLu, refactors_to_the_bits_of_a_fresh_factorization) {
  const auto edges = lattice(4, 3, 2);
  const auto make = [&] {
    base::Rng rng(5);
    return System(24, edges, rng);
  };
  base::Rng rng(6);
  const Mat6<double> changed = random_block(rng, 50);
  System again = make();
  ASSERT_TRUE(again.lu().factor());
  again.set_diagonal(7, changed);
  ASSERT_TRUE(again.lu().factor());
  System fresh = make();
  fresh.set_diagonal(7, changed);
  ASSERT_TRUE(fresh.lu().factor());
  std::vector<Vec6<double>> x(24, Vec6<double>{1, 2, 3, 4, 5, 6});
  std::vector<Vec6<double>> y = x;
  again.lu().solve(x);
  fresh.lu().solve(y);
  EXPECT_EQ(x, y);
}

/// A complete graph is full from the start; a ring of four cannot do without one chord.
TEST(BlockLu, has_as_many_blocks_as_the_graph_demands) {
  base::Rng rng(7);
  EXPECT_EQ(BlockLu(9, random_graph(rng, 9, 100), kUnlimited).lower_block_count(), 36U);
  const std::vector<Edge> ring = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  EXPECT_EQ(BlockLu(4, ring, kUnlimited).lower_block_count(), 5U);
}

/// Leaves first, a tree fills nothing in; approximate degrees come within a third of that, while
/// the order of the nodes as they are fills in some thousand blocks, and the reverse order some
/// hundred.
TEST(BlockLu, eliminates_nodes_of_small_degree_first) {
  base::Rng rng(8);
  for (int i = 0; i < 20; ++i) {
    const std::size_t count = BlockLu(60, random_tree(rng, 60), kUnlimited).lower_block_count();
    EXPECT_GE(count, 59U);
    EXPECT_LE(count, 79U);
  }
}

TEST(BlockLu, says_when_it_would_become_too_large) {
  base::Rng rng(9);
  const auto tree = random_tree(rng, 40);
  const std::size_t count = BlockLu(40, tree, kUnlimited).lower_block_count();
  EXPECT_FALSE(BlockLu(40, tree, count).is_too_large());
  EXPECT_TRUE(BlockLu(40, tree, count - 1).is_too_large());
  EXPECT_TRUE(BlockLu(2, std::vector<Edge>{{0, 1}}, 0).is_too_large());
  EXPECT_FALSE(BlockLu(2, {}, 0).is_too_large());
}

/// [[1, -1], [-1, 1]], in whole numbers, loses its second pivot exactly.
TEST(BlockLu, recognises_a_singular_matrix_and_recovers_from_it) {
  BlockLu lu(2, std::vector<Edge>{{0, 1}}, kUnlimited);
  lu.set_edge(0, scaled_identity(-1));
  lu.set_diagonal(0, scaled_identity(1));
  lu.set_diagonal(1, scaled_identity(1));
  EXPECT_FALSE(lu.factor());
  EXPECT_FALSE(lu.factor());
  lu.set_diagonal(1, scaled_identity(3));
  ASSERT_TRUE(lu.factor());
  // 1 x - 1 y = 0 and -1 x + 3 y = 2 have the solution x = y = 1.
  std::vector<Vec6<double>> x = {Vec6<double>{}, Vec6<double>{2, 2, 2, 2, 2, 2}};
  lu.solve(x);
  EXPECT_EQ(x, (std::vector<Vec6<double>>(2, {1, 1, 1, 1, 1, 1})));
}

TEST(BlockLu, recognises_a_block_that_is_not_finite) {
  BlockLu lu(1, {}, kUnlimited);
  lu.set_diagonal(0, scaled_identity(std::numeric_limits<double>::infinity()));
  EXPECT_FALSE(lu.factor());
  lu.set_diagonal(0, scaled_identity(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_FALSE(lu.factor());
}

TEST(BlockLu, has_nothing_to_do_without_nodes) {
  BlockLu lu(0, {}, kUnlimited);
  EXPECT_FALSE(lu.is_too_large());
  EXPECT_TRUE(lu.factor());
  std::vector<Vec6<double>> x;
  lu.solve(x);
  EXPECT_EQ(lu.lower_block_count(), 0U);
}

/// Symmetric, diagonal blocks dominate.
BlockLu symmetric_lattice(base::Rng& rng, std::size_t node_count, std::span<const Edge> edges,
                          Symmetry symmetry = Symmetry::kSymmetric) {
  BlockLu lu(node_count, edges, kUnlimited, symmetry);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    lu.set_edge(e, random_block(rng, 0));
  }
  for (std::size_t node = 0; node < node_count; ++node) {
    Mat6<double> block = random_block(rng, 20);
    for (int i = 0; i < 6; ++i) {
      for (int k = 0; k < i; ++k) {
        block.at(i, k) = block.at(k, i);
      }
    }
    lu.set_diagonal(node, block);
  }
  return lu;
}

/// The results are those of factors that never were symmetric: where nothing changed, with changes
/// that are not yet factorized, and with unsymmetric blocks from then on.
TEST(BlockLu, gives_up_symmetry_and_takes_it_up_again) {
  const std::vector<Edge> edges = lattice(4, 3, 3);
  for (const bool is_changed_before : {false, true}) {
    base::Rng rng(12);
    base::Rng same(12);
    BlockLu lu = symmetric_lattice(rng, 36, edges);
    BlockLu other = symmetric_lattice(same, 36, edges, Symmetry::kNone);
    const auto expect_same_solution = [&] {
      ASSERT_TRUE(lu.factor() && other.factor());
      std::vector<Vec6<double>> x(36, Vec6<double>{1, -2, 3, -4, 5, -6});
      std::vector<Vec6<double>> y = x;
      lu.solve(x);
      other.solve(y);
      for (std::size_t i = 0; i < 36; ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
          EXPECT_NEAR(x[i][k], y[i][k], kTolerance);
        }
      }
    };
    const auto change = [&](std::size_t node, const Mat6<double>& block) {
      lu.set_diagonal(node, block);
      other.set_diagonal(node, block);
    };
    expect_same_solution();
    if (is_changed_before) {
      change(5, scaled_identity(25));
    }
    lu.set_symmetry(Symmetry::kNone);
    expect_same_solution();
    EXPECT_EQ(lu.made_column_count(), other.made_column_count());
    for (const std::size_t node : {0U, 17U, 35U}) {
      change(node, random_block(rng, 30));
      expect_same_solution();
    }
    for (const std::size_t node : {0U, 17U, 35U}) {
      change(node, scaled_identity(30));
    }
    lu.set_symmetry(Symmetry::kSymmetric);
    expect_same_solution();
  }
}

TEST(BlockLu, solves_lanes_to_the_bits_of_one_after_another) {
  base::Rng rng(5);
  const std::vector<Edge> edges = lattice(3, 3, 4);
  BlockLu lu = symmetric_lattice(rng, 36, edges);
  ASSERT_TRUE(lu.factor());
  std::vector<LaneBlock> lanes(36);
  std::vector<std::vector<Vec6<double>>> columns(kLaneCount, std::vector<Vec6<double>>(36));
  for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t node = (7 * lane + 3) % 36;  // One load each: most of it stays zero.
      columns[lane][node][k] = random_signed(rng);
      lanes[lu.place(node)].values[k][lane] = columns[lane][node][k];
    }
    lu.solve(columns[lane]);
  }
  lu.solve_lanes(lanes);
  for (std::size_t node = 0; node < 36; ++node) {
    for (std::size_t lane = 0; lane < kLaneCount; ++lane) {
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_EQ(lanes[lu.place(node)].values[k][lane], columns[lane][node][k]);
      }
    }
  }
}

/// The blocks are parts of the solutions for unit vectors.
TEST(BlockLu, gives_blocks_of_the_inverse_of_a_symmetric_matrix) {
  base::Rng rng(6);
  const std::vector<Edge> edges = lattice(3, 3, 3);
  BlockLu lu = symmetric_lattice(rng, 27, edges);
  ASSERT_TRUE(lu.factor());
  const auto expect_block = [&](const Mat6<double>& block, const Edge& nodes) {
    for (int column = 0; column < 6; ++column) {
      std::vector<Vec6<double>> x(27);
      x[base::at(nodes.b)] = base::unit<double>(column);
      lu.solve(x);
      for (int row = 0; row < 6; ++row) {
        EXPECT_NEAR(block.at(row, column), x[base::at(nodes.a)][static_cast<std::size_t>(row)],
                    kTolerance);
      }
    }
  };
  const std::vector<std::size_t> asked = {4, 13, 14, 5, 26};
  const SelectedInverse inverse = lu.selected_inverse(asked);
  for (const Edge& edge : {Edge{4, 4}, {26, 26}, {4, 5}, {5, 4}, {14, 13}, {13, 4}, {5, 14}}) {
    expect_block(inverse.block(base::at(edge.a), base::at(edge.b)), edge);
  }
  // Pairs that are not coupled, and one that is.
  std::vector<std::size_t> corners = {0, 2, 6, 8, 18, 20, 24, 26, 1};
  const std::vector<Edge> pairs = {{0, 26}, {2, 24}, {18, 8}, {6, 20}, {26, 24}, {0, 1}};
  const SelectedInverse more = lu.selected_inverse(corners, pairs);
  for (const Edge& edge : pairs) {
    expect_block(more.block(base::at(edge.a), base::at(edge.b)), edge);
    expect_block(more.block(base::at(edge.b), base::at(edge.a)), {edge.b, edge.a});
  }
  for (const std::size_t node : corners) {
    const auto place = static_cast<std::int32_t>(node);
    expect_block(more.block(node, node), {place, place});
  }
}

/// Large enough for columns to be shared.
TEST(BlockLu, makes_columns_to_the_same_bits_on_any_number_of_threads) {
  constexpr std::size_t kCount = 7 * 7 * 10;
  const std::vector<Edge> edges = lattice(7, 7, 10);
  base::Rng rng(8);
  base::Rng same(8);
  BlockLu one = symmetric_lattice(rng, kCount, edges);
  BlockLu several = symmetric_lattice(same, kCount, edges);
  ASSERT_GT(one.factor_product_count(), 100000U);
  ASSERT_TRUE(one.factor(1));
  ASSERT_TRUE(several.factor(3));
  std::vector<Vec6<double>> x(kCount);
  x[7] = {1, 2, 3, 4, 5, 6};
  std::vector<Vec6<double>> y = x;
  one.solve(x);
  several.solve(y);
  EXPECT_EQ(x, y);
  std::vector<std::size_t> nodes(kCount);
  std::iota(nodes.begin(), nodes.end(), 0U);
  const std::vector<Edge> pairs = {{0, 489}, {3, 300}};
  const SelectedInverse by_one = one.selected_inverse(nodes, pairs, 1);
  const SelectedInverse by_several = several.selected_inverse(nodes, pairs, 3);
  for (const Edge& edge : edges) {
    EXPECT_EQ(by_one.block(base::at(edge.a), base::at(edge.b)).values,
              by_several.block(base::at(edge.a), base::at(edge.b)).values);
  }
  for (const Edge& edge : pairs) {
    EXPECT_EQ(by_one.block(base::at(edge.a), base::at(edge.b)).values,
              by_several.block(base::at(edge.a), base::at(edge.b)).values);
  }
}

TEST(BlockLu, says_on_several_threads_that_a_matrix_is_singular) {
  constexpr std::size_t kCount = 7 * 7 * 10;
  base::Rng rng(8);
  BlockLu lu = symmetric_lattice(rng, kCount, lattice(7, 7, 10));
  lu.set_diagonal(200, Mat6<double>{{std::numeric_limits<double>::quiet_NaN()}});
  EXPECT_FALSE(lu.factor(3));
}

/// The numbers are the same by another order of the same sums.
TEST(BlockLu, factors_what_is_known_to_be_symmetric_alike) {
  base::Rng rng(6);
  base::Rng same(6);
  const std::vector<Edge> edges = lattice(4, 3, 5);
  BlockLu symmetric = symmetric_lattice(rng, 60, edges);
  BlockLu general = symmetric_lattice(same, 60, edges, Symmetry::kNone);
  ASSERT_TRUE(symmetric.factor());
  ASSERT_TRUE(general.factor());
  std::vector<Vec6<double>> x(60);
  x[7] = {1, 2, 3, 4, 5, 6};
  std::vector<Vec6<double>> y = x;
  symmetric.solve(x);
  general.solve(y);
  for (std::size_t node = 0; node < 60; ++node) {
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(x[node][k], y[node][k], kTolerance);
    }
  }
}

/// A positive matrix on a graph, dense and in blocks: `scale` by row times one that is well
/// conditioned.
struct PositiveMatrix {
  PositiveMatrix(std::vector<Edge> graph, std::int32_t node_count, const Eigen::VectorXd& scale)
      : edges(std::move(graph)), dense(6 * node_count, 6 * node_count) {
    base::Rng rng(17);
    dense.setZero();
    dense.diagonal().setConstant(40);
    for (const Edge& edge : edges) {
      const Mat6<double> block = random_block(rng, 0);
      const Eigen::Map<const Eigen::Matrix<double, 6, 6>> ab(block.values.data());
      dense.block<6, 6>(6 * edge.a, 6 * edge.b) = ab;
      dense.block<6, 6>(6 * edge.b, 6 * edge.a) = ab.transpose();
    }
    dense = scale.asDiagonal() * dense * scale.asDiagonal();
  }

  Mat6<double> block(std::int32_t row, std::int32_t column) const {
    Mat6<double> result;
    Eigen::Map<Eigen::Matrix<double, 6, 6>>(result.values.data()) =
        dense.block<6, 6>(6 * row, 6 * column);
    return result;
  }

  Eigen::VectorXd solved(const Eigen::VectorXd& b, Symmetry symmetry, int thread_count = 1) const {
    const auto count = static_cast<std::size_t>(b.size() / 6);
    BlockLu lu(count, edges, kUnlimited, symmetry);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      lu.set_edge(e, block(edges[e].a, edges[e].b));
    }
    std::vector<Vec6<double>> x(count);
    for (std::size_t node = 0; node < count; ++node) {
      const auto i = static_cast<std::int32_t>(node);
      lu.set_diagonal(node, block(i, i));
      std::copy_n(b.data() + 6 * node, 6, x[node].begin());
    }
    EXPECT_TRUE(lu.factor(thread_count));
    lu.solve(x);
    return Eigen::Map<const Eigen::VectorXd>(x[0].data(), b.size());
  }

  std::vector<Edge> edges;
  Eigen::MatrixXd dense;
};

TEST(PositiveBlockLu, solves_what_the_symmetric_one_solves) {
  const PositiveMatrix matrix(lattice(5, 4, 3), 60, Eigen::VectorXd::Ones(360));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(360, -1, 2);
  const Eigen::VectorXd x = matrix.solved(b, Symmetry::kPositive);
  EXPECT_LT((x - matrix.dense.lu().solve(b)).lpNorm<Eigen::Infinity>(), kTolerance);
  EXPECT_LT((x - matrix.solved(b, Symmetry::kSymmetric)).lpNorm<Eigen::Infinity>(), kTolerance);
}

/// Rows that differ by sixteen digits, within a block too, cost none.
TEST(PositiveBlockLu, keeps_digits_however_much_rows_differ) {
  const Eigen::VectorXd scale = Eigen::VectorXd::NullaryExpr(
      360, [](Eigen::Index i) { return std::pow(10.0, static_cast<double>(i * i % 17) - 8); });
  const PositiveMatrix even(lattice(5, 4, 3), 60, Eigen::VectorXd::Ones(360));
  const PositiveMatrix uneven(lattice(5, 4, 3), 60, scale);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(360, -1, 2);
  const Eigen::VectorXd expected = even.dense.lu().solve(b);
  const Eigen::VectorXd x =
      scale.cwiseProduct(uneven.solved(scale.cwiseProduct(b), Symmetry::kPositive));
  EXPECT_LT((x - expected).lpNorm<Eigen::Infinity>(), kTolerance);
}

TEST(PositiveBlockLu, has_the_same_bits_on_all_threads) {
  const PositiveMatrix matrix(lattice(8, 8, 8), 512, Eigen::VectorXd::Ones(3072));
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(3072, -1, 2);
  EXPECT_EQ(matrix.solved(b, Symmetry::kPositive, 1), matrix.solved(b, Symmetry::kPositive, 3));
}

/// Connected nodes without a support: forces that are in balance are solved all the same.
TEST(PositiveBlockLu, takes_pivots_that_are_rounding_for_rounding) {
  constexpr std::int32_t kCount = 30;
  PositiveMatrix matrix(lattice(kCount, 1, 1), kCount, Eigen::VectorXd::Ones(6 * kCount));
  matrix.dense.setZero();
  for (const Edge& edge : matrix.edges) {
    for (int i = 0; i < 6; ++i) {
      const Eigen::Index a = 6 * edge.a + i;
      const Eigen::Index b = 6 * edge.b + i;
      matrix.dense(a, a) += 1 + i;
      matrix.dense(b, b) += 1 + i;
      matrix.dense(a, b) -= 1 + i;
      matrix.dense(b, a) -= 1 + i;
    }
  }
  Eigen::VectorXd b = Eigen::VectorXd::Zero(6 * kCount);
  b.head<6>().setConstant(1);
  b.tail<6>().setConstant(-1);
  const Eigen::VectorXd x = matrix.solved(b, Symmetry::kPositive);
  EXPECT_LT((matrix.dense * x - b).lpNorm<Eigen::Infinity>(), 1e-6);
}

/// Symmetric matrices whose least eigenvalue is moved through zero.
TEST(BlockLu, tells_whether_a_symmetric_matrix_is_positive_definite) {
  base::Rng rng(11);
  for (int round = 0; round < 20; ++round) {
    constexpr std::int32_t kCount = 12;
    const std::vector<Edge> edges = random_graph(rng, kCount, 30);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(6 * kCount, 6 * kCount);
    std::vector<Mat6<double>> blocks;
    for (const Edge& edge : edges) {
      blocks.push_back(random_block(rng, 0));
      for (int i = 0; i < 36; ++i) {
        dense(6 * edge.a + i % 6, 6 * edge.b + i / 6) = blocks.back().at(i % 6, i / 6);
        dense(6 * edge.b + i / 6, 6 * edge.a + i % 6) = blocks.back().at(i % 6, i / 6);
      }
    }
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(dense).eigenvalues().minCoeff();
    for (const double beside : {-1e-6, 1e-6}) {
      BlockLu lu(kCount, edges, kUnlimited, Symmetry::kSymmetric);
      for (std::size_t e = 0; e < edges.size(); ++e) {
        lu.set_edge(e, blocks[e]);
      }
      for (std::size_t node = 0; node < kCount; ++node) {
        lu.set_diagonal(node, scaled_identity(beside - least));
      }
      ASSERT_TRUE(lu.factor());
      EXPECT_EQ(lu.is_positive_definite(), beside > 0) << round;
    }
  }
}

}  // namespace
}  // namespace holdfast::solver
