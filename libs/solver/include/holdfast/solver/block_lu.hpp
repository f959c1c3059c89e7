// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/block_pattern.hpp"
#include "holdfast/solver/lanes.hpp"

namespace holdfast::solver {

/// Sparse direct solver for matrices of 6x6 blocks: A = (I + L) D (I + U'), D block-diagonal.
///
/// The pattern is symmetric, the values need not be: contact makes some diagonal blocks
/// unsymmetric. Columns are eliminated in approximate-minimum-degree order [Amestoy 1996]; pivots
/// are chosen within a diagonal block only, so callers check the residual. Left-looking: a column
/// is made from finished columns, so after some blocks have changed only their columns and the
/// ancestors of these in the elimination tree are made again.
///
/// Use: construct, set every block, factor(), solve(); then change blocks, factor(), solve()...
class BlockLu {
 public:
  /// Orders and counts, allocates no blocks yet. Gives up (see is_too_large()) once L would need
  /// more than `block_count_max` blocks; each takes 600 bytes in all.
  BlockLu(std::size_t node_count, std::span<const Edge> edges, std::size_t block_count_max);

  /// Whether the factorization does not fit into memory; if so, nothing else may be called.
  bool is_too_large() const { return is_too_large_; }

  /// Blocks below the diagonal of L, fill included.
  std::size_t lower_block_count() const { return rows_.size(); }

  /// Sets A(a, b) to `ab` and A(b, a) to its transpose, for edge number `edge`; the next factor()
  /// makes again what depends on it.
  void set_edge(std::size_t edge, const base::Mat6<double>& ab);

  /// Sets A(node, node); the next factor() makes again what depends on it.
  void set_diagonal(std::size_t node, const base::Mat6<double>& block);

  /// Returns false if a diagonal block became singular.
  [[nodiscard]] bool factor();

  /// Columns that all calls of factor() have made so far.
  std::size_t made_column_count() const { return made_column_count_; }

  /// Solves A x = b in place; x holds one vector per node. Needs a successful factor().
  void solve(std::span<base::Vec6<double>> x) const;

  /// Solves A x = b in place for several b, each with one vector per node, to the same bits as one
  /// after another; reads the factors once.
  void solve_each(std::span<std::vector<base::Vec6<double>>> columns) const;

  std::size_t node_count() const { return position_.size(); }

  /// Where a node stands in the order of elimination.
  std::size_t place(std::size_t node) const { return static_cast<std::size_t>(position_[node]); }

  /// Solves A x = b in place for kLaneCount b, by place; to the same bits as one after another.
  void solve_lanes(std::span<LaneBlock> y) const;

  /// The forward substitution of six right-hand sides, the unit vectors of one node: (I + L)^-1,
  /// where it is not zero, on the node's way up the elimination tree.
  void forward(std::size_t node, std::vector<std::int32_t>& places,
               std::vector<base::Mat6<double>>& blocks) const;

  /// Of a symmetric A = (I + L) D (I + L'): the block of A^-1 for two nodes, a' D^-1 b of what
  /// forward() makes of each.
  base::Mat6<double> symmetric_product(std::span<const std::int32_t> places_a,
                                       std::span<const base::Mat6<double>> a,
                                       std::span<const std::int32_t> places_b,
                                       std::span<const base::Mat6<double>> b) const;

 private:
  struct Entry {
    std::int32_t column = 0;
    std::size_t slot = 0;  ///< Position of this row in the column's list.
  };

  void make_row_lists();
  void allocate();
  void make_column(std::size_t column);
  void substitute(std::span<base::Vec6<double>> y, std::size_t count) const;
  std::size_t find_slot(std::int32_t column, std::int32_t row) const;

  std::vector<Edge> edges_;
  std::vector<std::int32_t> position_;     ///< node -> place in the elimination order
  std::vector<std::int32_t> parent_;       ///< elimination tree, by place
  std::vector<std::size_t> column_start_;  ///< into rows_, lower_, upper_
  std::vector<std::int32_t> rows_;         ///< rows below the diagonal, ascending
  std::vector<std::size_t> row_start_;     ///< into row_entries_
  std::vector<Entry> row_entries_;         ///< columns left of the diagonal that meet a row
  std::vector<std::size_t> edge_slot_;     ///< edge -> slot of its lower block
  std::vector<std::vector<std::size_t>> column_edges_;  ///< column -> edges stored in it

  std::vector<base::Mat6<double>> diagonal_;    ///< A(k, k)
  std::vector<base::Mat6<double>> inverse_;     ///< D(k)^-1
  std::vector<base::Mat6<double>> lower_;       ///< L(i, k)
  std::vector<base::Mat6<double>> upper_;       ///< U(k, i), not yet divided by D
  std::vector<base::Mat6<double>> edge_lower_;  ///< A(i, k) of each edge, i below k
  std::vector<bool> is_stale_;                  ///< columns whose factor is out of date
  std::vector<std::size_t> slot_of_row_;        ///< scratch: row -> slot in the current column
  std::size_t made_column_count_ = 0;
  bool is_singular_ = false;
  bool is_too_large_ = false;
};

}  // namespace holdfast::solver
