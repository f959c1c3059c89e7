// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/solver/block_pattern.hpp"

namespace holdfast::frames {

/// A symmetric term of rank six or less: what a spring between two nodes, or between a node and
/// the ground, adds to a stiffness matrix.
///
/// It adds [lever; I] stiffness [lever' I] to the blocks of nodes a and b; without a, `stiffness`
/// to block (b, b). For a beam that is free in space, `stiffness` is its block (b, b) and `lever`
/// is minus the transpose of the motion of b's place with a as a rigid body.
struct LowRankTerm {
  std::int32_t a = -1;  ///< -1 for the ground.
  std::int32_t b = 0;
  base::Mat6<double> lever;
  base::Mat6<double> stiffness;
};

/// A sparse factorization that changes with every term instead of being made anew:
/// A = (I + L) D (I + L'), D block-diagonal, for matrices that are sums of terms.
///
/// Order and pattern of L are those of the matrix with all terms that may ever come, chosen once.
/// A node is in the matrix as long as a term touches it; one that is not has no rows. A term
/// changes only the columns on the way from its first node to the root of the elimination tree
/// [Davis 1999], block by block as in method C1 of [Gill 1974]: with p = W_k of the term
/// W S W', along that way
///     D_k' = D_k + p S p',  B = S p' D_k'^-1,  W_i -= L_ik p,  L_ik += W_i B,  S -= B p S,
/// two products of 6x6 blocks per block of L. Where a term brings its node in, S becomes zero: what
/// hangs free changes nothing behind it. Rounding errors add up over many changes, so callers check
/// the residual, and factor() anew when it has grown.
class GrowingFactor {
 public:
  /// `edges`: the pairs of nodes that terms will couple; repeated ones do no harm.
  GrowingFactor(std::size_t node_count, std::span<const solver::Edge> edges);

  /// Blocks below the diagonal of L with all terms, fill included.
  std::size_t lower_block_count() const { return pattern_.rows.size(); }

  /// Whether any term touches the node.
  bool is_present(std::size_t node) const {
    return is_present_[base::at(pattern_.position[node])] != 0;
  }

  /// Adds a term that brings in one node at most, by a regular stiffness. Returns false, and
  /// changes nothing, if the matrix became singular or the term touches only new nodes.
  [[nodiscard]] bool add(const LowRankTerm& term);

  /// Removes a term that was added. Returns false, and changes nothing, if the matrix became
  /// singular; a node that no other term touches goes with it.
  [[nodiscard]] bool remove(const LowRankTerm& term);

  /// Takes back the last add() or remove(), to the same bits. Once, and not after factor().
  void undo();

  /// Factors the sum of these terms anew. Returns false if a diagonal block became singular.
  [[nodiscard]] bool factor(std::span<const LowRankTerm* const> terms);

  /// Solves A x = b in place; x holds one vector per node, zero at nodes that are not present.
  void solve(std::span<base::Vec6<double>> x) const;

 private:
  struct Entry {
    std::size_t column = 0;
    std::size_t slot = 0;  ///< Position of this row in the column's list.
  };

  /// The journal from which undo() restores the columns that the last change has touched.
  struct Journal {
    std::vector<std::size_t> columns;
    std::vector<base::Mat6<double>> blocks;  ///< Per column D, D^-1, then its blocks of L.
    std::vector<std::size_t> cleared_slots;
    std::vector<base::Mat6<double>> cleared_blocks;
    std::int32_t a = -1;
    std::int32_t b = -1;
    std::int32_t toggled = -1;  ///< The place that came or went.
    int sign = 0;               ///< 1 after add(), -1 after remove(), 0 if nothing is to undo.
  };

  std::int32_t place(std::int32_t node) const {
    return node < 0 ? -1 : pattern_.position[base::at(node)];
  }

  void begin(const LowRankTerm& term, int sign);
  void save(std::size_t column);
  void spread(const LowRankTerm& term, std::int32_t from, std::int32_t entering, std::int32_t stop,
              base::Mat6<double> s);
  bool update_column(std::size_t column, std::int32_t entering, base::Mat6<double>& s);
  void leave(std::size_t column);
  void make_column(std::size_t column);

  solver::BlockPattern pattern_;
  std::vector<std::size_t> row_start_;         ///< into row_entries_
  std::vector<Entry> row_entries_;             ///< columns left of the diagonal that meet a row
  std::vector<std::int32_t> term_count_;       ///< terms that touch a place
  std::vector<std::uint8_t> is_present_;       ///< by place
  std::vector<base::Mat6<double>> diagonal_;   ///< D(k)
  std::vector<base::Mat6<double>> inverse_;    ///< D(k)^-1
  std::vector<base::Mat6<double>> lower_;      ///< L(i, k); zero where a node is not present
  std::vector<base::Mat6<double>> w_;          ///< scratch: W_i of the term, else zero
  std::vector<std::size_t> slot_of_row_;       ///< scratch: row -> slot in the current column
  mutable std::vector<base::Vec6<double>> y_;  ///< scratch: a solution by place
  Journal journal_;
  bool is_singular_ = false;
};

}  // namespace holdfast::frames
