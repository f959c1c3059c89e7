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

struct FactorView;
class SelectedInverse;

enum class Symmetry : std::uint8_t {
  kNone,
  kSymmetric,
  /// Symmetric and positive semidefinite: Cholesky's factors, which keep their digits however much
  /// the scales of rows differ, within a block too. A pivot that is nothing but rounding is taken
  /// as that rounding, so no matrix is singular.
  kPositive,
};

/// Sparse direct solver for matrices of 6x6 blocks: A = (I + L) D (I + U'), D block-diagonal.
///
/// The pattern is symmetric, the values need not be: contact makes some diagonal blocks
/// unsymmetric. As long as they are symmetric, U = L takes half the work and memory. Columns
/// are eliminated in approximate-minimum-degree order [Amestoy 1996]; pivots are chosen within a
/// diagonal block only, so callers check the residual. Left-looking: a column is made from finished
/// columns, so after some blocks have changed only their columns and the ancestors of these in the
/// elimination tree are made again.
///
/// Use: construct, set every block, factor(), solve(); then change blocks, factor(), solve()...
class BlockLu {
 public:
  /// Orders and counts, allocates no blocks yet. Gives up (see is_too_large()) once L would need
  /// more than `block_count_max` blocks; each takes 600 bytes in all, 300 of a
  /// symmetric matrix.
  BlockLu(std::size_t node_count, std::span<const Edge> edges, std::size_t block_count_max,
          Symmetry symmetry = Symmetry::kNone);

  /// Whether the factorization does not fit into memory; if so, nothing else may be called.
  bool is_too_large() const { return is_too_large_; }

  /// Blocks below the diagonal of L, fill included.
  std::size_t lower_block_count() const { return rows_.size(); }

  /// Sets A(a, b) to `ab` and A(b, a) to its transpose, for edge number `edge`; the next factor()
  /// makes again what depends on it.
  void set_edge(std::size_t edge, const base::Mat6<double>& ab);

  /// Sets A(node, node); the next factor() makes again what depends on it.
  void set_diagonal(std::size_t node, const base::Mat6<double>& block);

  /// Whether A is symmetric from here on. If it no longer is, none of the factors that are there is
  /// made again; if it is again, all are. Not of a positive one.
  void set_symmetry(Symmetry symmetry);

  /// Returns false if a diagonal block became singular. The bits do not depend on the number of
  /// threads.
  [[nodiscard]] bool factor(int thread_count = 1);

  /// Whether a symmetric A is positive definite, as its pivots say: by Sylvester's law of inertia A
  /// has as many negative eigenvalues as D. Needs a successful factor().
  bool is_positive_definite() const;

  /// Products of two blocks that factor() takes where every column is to be made.
  std::size_t factor_product_count() const;

  /// Columns that all calls of factor() have made so far.
  std::size_t made_column_count() const { return made_column_count_; }

  /// Solves A x = b in place; x holds one vector per node. Needs a successful factor().
  void solve(std::span<base::Vec6<double>> x) const;

  /// Solves A x = b in place for several b, each with one vector per node, to the same bits as one
  /// after another; reads the factors once.
  void solve_each(std::span<std::vector<base::Vec6<double>>> columns) const;

  std::size_t node_count() const { return position_.size(); }

  /// The place of a node in the order of elimination.
  std::size_t place(std::size_t node) const { return static_cast<std::size_t>(position_[node]); }

  /// Solves A x = b in place for kLaneCount b and a symmetric A, by place; to the same bits as one
  /// after another.
  void solve_lanes(std::span<LaneBlock> y) const;

  /// Blocks of A^-1 of a symmetric A: for each of the nodes, for two of them that are coupled, and
  /// for the pairs of them. Keeps a reference.
  SelectedInverse selected_inverse(std::span<const std::size_t> nodes,
                                   std::span<const Edge> pairs = {}, int thread_count = 1) const;

 private:
  friend class SelectedInverse;

  struct Entry {
    std::int32_t column = 0;
    std::size_t slot = 0;  ///< Position of this row in the column's list.
  };

  void make_row_lists();
  void allocate();
  void make_upper();

  /// What a thread needs to make columns: row -> slot in the current one.
  struct Scratch {
    std::vector<std::size_t> slot_of_row;
  };

  template <class WaitFor>
  bool make_column(std::size_t column, Scratch& scratch, const WaitFor& wait_for);
  template <class WaitFor>
  bool subtract_left(std::size_t column, base::Mat6<double>& pivot, const WaitFor& wait_for,
                     const Scratch& scratch);
  template <class WaitFor>
  bool subtract_left_symmetric(std::size_t column, base::Mat6<double>& pivot,
                               const WaitFor& wait_for, const Scratch& scratch);
  void substitute(std::span<base::Vec6<double>> y, std::size_t count) const;
  FactorView view() const;
  std::size_t find_slot(std::int32_t column, std::int32_t row) const;

  std::vector<Edge> edges_;
  Symmetry symmetry_ = Symmetry::kNone;
  std::vector<std::int32_t> position_;     ///< node -> place in the elimination order
  std::vector<std::int32_t> parent_;       ///< elimination tree, by place
  std::vector<std::size_t> column_start_;  ///< into rows_, lower_, upper_
  std::vector<std::int32_t> rows_;         ///< rows below the diagonal, ascending
  std::vector<std::size_t> row_start_;     ///< into row_entries_
  std::vector<Entry> row_entries_;         ///< columns left of the diagonal that meet a row
  std::vector<std::size_t> edge_slot_;     ///< edge -> slot of its lower block
  std::vector<std::vector<std::size_t>> column_edges_;  ///< column -> edges stored in it

  std::vector<base::Mat6<double>> diagonal_;  ///< A(k, k)
  std::vector<std::uint8_t> is_positive_;     ///< Whether D(k) of a symmetric matrix is.
  std::vector<base::Mat6<double>> inverse_;   ///< D(k)^-1; of a positive matrix that of D's root.
  /// L(i, k); of a symmetric matrix L(i, k) D(k), of a positive one Cholesky's.
  std::vector<base::Mat6<double>> lower_;
  std::vector<base::Mat6<double>> upper_;  ///< U(k, i), not yet divided by D, where it is needed.
  std::vector<base::Mat6<double>> edge_lower_;  ///< A(i, k) of each edge, i below k
  std::vector<bool> is_stale_;                  ///< columns whose factor is out of date
  std::size_t made_column_count_ = 0;
  bool is_singular_ = false;
  bool is_too_large_ = false;
};

/// Blocks of the inverse of a symmetric matrix where its factors have some, and where these need
/// others, from the last column to the first [Takahashi 1973; Erisman 1975]. Good as long as the
/// factors are.
class SelectedInverse {
 public:
  /// The block of rows `node_a` and columns `node_b`, two of the nodes asked for that are the same,
  /// coupled, or a pair that was asked for.
  base::Mat6<double> block(std::size_t node_a, std::size_t node_b) const;

  /// Products of two blocks that it took.
  std::size_t product_count() const;

 private:
  friend class BlockLu;

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Finds the columns that the nodes need, and which rows.
  SelectedInverse(const BlockLu& lu, std::span<const std::size_t> nodes,
                  std::span<const Edge> pairs);

  class PanelMaker;

  /// Columns that are made together: each is the parent of the one before it and has the same rows
  /// below, in the factors as well.
  struct Panel {
    std::size_t first = 0;
    std::size_t column_count = 0;
  };

  void find_rows(std::vector<std::vector<std::int32_t>> more);
  void find_panels();
  void make(int thread_count);

  const BlockLu* lu_;
  std::vector<std::int32_t> columns_;         ///< Those that are needed, the last first.
  std::vector<Panel> panels_;                 ///< Of these, the last first.
  std::vector<std::size_t> turn_;             ///< By place: its panel, or kNone.
  std::vector<std::size_t> column_start_;     ///< By place, into rows_ and below_.
  std::vector<std::int32_t> rows_;            ///< Ascending.
  std::vector<base::Mat6<double>> diagonal_;  ///< By place.
  std::vector<base::Mat6<double>> below_;
};

}  // namespace holdfast::solver
