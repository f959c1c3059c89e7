// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "algebra/dense_elimination.hpp"
#include "holdfast/host/team.hpp"

namespace holdfast::limit {

using Block = Eigen::Matrix<double, 6, 6>;

/// Sparse direct solver for symmetric positive semidefinite matrices of 6x6 blocks, as products of
/// triangles, K = L L'. Multifrontal [Duff 1983]: columns with the same rows below are eliminated
/// together from one dense matrix, their front, which makes the most of the machine. The nodes'
/// places give the order: halves of the structure first, what lies between them last [George 1973].
///
/// A pivot that is nothing but rounding is taken as that rounding, so callers check the residual.
class BlockCholesky {
 public:
  using Edge = std::pair<int, int>;

  /// Orders and counts. `edges` are the pairs of coupled nodes, each pair once.
  /// `thread_count` threads make L, 0: as many as the machine has cores; the bits do not depend on
  /// it.
  BlockCholesky(std::span<const Eigen::Vector3d> places, std::span<const Edge> edges,
                int thread_count = 0);

  /// Multiplications that factor() takes, about.
  double work() const { return work_; }

  /// Makes L of the blocks K(node, node), and K(a, b) by edge.
  void factor(std::span<const Block> diagonal, std::span<const Block> coupling);

  /// Solves K x = b in place; six rows per node.
  void solve(Eigen::VectorXd& x);

 private:
  /// Columns [first, last) in the order of elimination, with the same rows below them.
  struct Front {
    int first = 0;
    int last = 0;
    std::vector<int> rows = {};   ///< Below, ascending.
    std::size_t zeros = 0;        ///< Blocks in its columns that L does not have.
    std::vector<int> edges = {};  ///< Whose blocks are in its columns.
    std::vector<int> children = {};
    int parent = -1;
    std::vector<int> seats = {};   ///< Of its rows below among all rows of its parent.
    Eigen::VectorXd handed = {};   ///< While solving: what its parent's rows are given.
    Eigen::MatrixXd columns = {};  ///< Of L.

    bool may_join(int column, std::size_t row_count) const;
    std::size_t zeros_by(std::size_t row_count) const;

    int width() const { return 6 * (last - first); }

    int height() const { return width() + 6 * static_cast<int>(rows.size()); }

    /// The place of a row of L among its rows, in blocks.
    int seat(int row) const;

    /// Multiplications, about.
    double work() const { return static_cast<double>(width()) * height() * height(); }
  };

  /// What eliminating one front after the other needs.
  struct Workspace {
    Eigen::MatrixXd dense = {};
    Eigen::VectorXd first_value = {};
    DenseElimination elimination = {};
  };

  void make_fronts(std::span<const Edge> edges);
  void link_fronts(const std::vector<int>& front_of);
  void make_branches();
  void factor(std::size_t index, std::span<const Block> diagonal, std::span<const Block> coupling,
              Workspace& work, host::Team& team);
  void gather(const Front& front, std::span<const Block> diagonal, std::span<const Block> coupling,
              Eigen::MatrixXd& dense);
  void substitute_forward(Front& front, Eigen::VectorXd& x);
  void substitute_back(const Front& front, Eigen::VectorXd& x) const;

  std::vector<int> place_;  ///< By node, in the order of elimination.
  std::vector<int> node_;   ///< The other way.
  std::vector<Edge> edges_;
  std::vector<Front> fronts_;
  std::vector<Eigen::MatrixXd> left_;               ///< By front: what is left for its parent.
  std::vector<std::vector<std::size_t>> branches_;  ///< Fronts of subtrees, ascending.
  std::vector<std::size_t> stem_;                   ///< All other fronts.
  host::Team team_;
  double work_ = 0;
};

}  // namespace holdfast::limit
