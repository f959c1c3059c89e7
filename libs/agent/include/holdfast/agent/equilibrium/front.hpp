// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/world/node.hpp"
#include "holdfast/base/cell.hpp"

/// Elimination with fronts: a module with everything below it in the spanning tree, condensed to
/// those nodes that are not finished with [Duff, Reid 1983].
///
/// A *front* is a list of nodes and the symmetric stiffness and the loads that belong to them. A
/// module's front holds its own node, those of planned modules that it emulates, and the fronts of
/// its children. A beam is put in as soon as both its ends are in one front. A node whose beams are
/// all in is *complete*: it is eliminated, and the rest goes up to the parent. So any number of
/// loops may pass, and a planned module between others is a node like every other, in the front of
/// its host. Facets that hold all over are put in with their node. A node with any other facet is
/// *kept*: without its facets and not eliminated, up to the root, where contact is decided
/// (front_contact.hpp). So the matrix is symmetric and positive, and contact never spoils it.
///
/// With A the front's matrix, its first n rows those of complete nodes, A = L L^t there, row by
/// row:
///   L_ij = (A_ij - sum_{k<j} L_ik L_jk) / L_jj       j < n, j <= i
///   S_ij =  A_ij - sum_{k<n} L_ik L_jk               j >= n
/// Sums are in double precision; what is stored and sent is single precision, and the iteration
/// takes its rounding away. Away from a level floor a robot may hang on weak springs, and contact
/// states follow from what single precision leaves of S: there a matrix is stored and sent in two
/// parts, 48 bits in all.
namespace holdfast::agent {

/// A node in a front.
struct FrontNode {
  base::Cell cell = {};
  Faces missing = {};     ///< Faces whose beams are not in yet.
  Faces joined = {};      ///< Faces whose beams are put in here.
  bool is_fixed = false;  ///< Does not move: no rows.
  bool is_kept = false;   ///< Its facets are the root's.
  bool is_held = true;    ///< Of a kept facet, against slip and twist.
  bool was_released = false;
  bool is_doubtful = false;            ///< Of a kept facet, as Node has it; ...
  mechanics::ContactState state = {};  ///< ... in use ...
  mechanics::ContactState found = {};  ///< ... and when others were sought.
  base::Vec6<double> u = {};           ///< Of a kept one: its displacement.
  /// A kept node with surroundings has so many facets, whose states are these (packed_state());
  /// those above are void then.
  std::uint8_t facet_count = 0;
  std::array<std::uint16_t, kTouchingFacetsMax> facets = {};

  bool is_complete() const { return missing.is_empty() && !is_kept; }
};

/// What the root keeps of a kept node from one iteration to the next. As in a Node, the facet on
/// the floor is its own, and with surroundings there are any facets, each with a state of its own.
struct KeptNode {
  base::Vec6<double> u{};
  base::Vec6<double> force{};  ///< Of its facets at u, when the loads that are here were found.
  mechanics::ContactState state;
  bool is_held = true;
  bool was_released = false;
  mechanics::ContactState found = {};  ///< When others were sought (kSeek), ...
  bool is_doubtful = false;            ///< ... and whether another state leads elsewhere.
  base::Cell cell = {};                ///< As seen from the root.
  [[no_unique_address]] PresentIf<kIsGeneral, Surroundings*> surroundings = nullptr;
};

/// What one module needs for its fronts. The caller owns it: whoever has no such memory has other
/// methods. A front that does not fit is none, and the robot takes another method.
struct FrontMemory {
  std::span<FrontNode> nodes;
  std::span<float> reals;
  std::span<KeptNode> kept;          ///< For the root: so many at most, ...
  std::span<double> contact;         ///< ... contact_reals() for them, ...
  std::span<Surroundings> touching;  ///< ... and, if there is more than a floor, as many.
  std::span<std::uint8_t> queues;    ///< For the links of all faces, kLentBytes each.
  std::size_t nodes_used = 0;
  std::size_t reals_used = 0;
  std::size_t reals_most = 0;  ///< So far, for reports.
  bool has_low_parts = false;  ///< Matrices are in two parts.

  void clear() { nodes_used = reals_used = 0; }

  /// Empty if there is no room.
  std::span<FrontNode> take_nodes(std::size_t count);
  std::span<float> take_reals(std::size_t count);
};

/// Reals of a lower triangle with so many rows.
constexpr std::size_t triangle_reals(std::size_t rows) { return rows * (rows + 1) / 2; }

/// Messages of six reals that it takes.
constexpr int triangle_vectors(int rows) {
  return static_cast<int>((triangle_reals(static_cast<std::size_t>(rows)) + 5) / 6);
}

class Front {
 public:
  /// Sorts `nodes`, complete ones first, and takes memory for matrix and loads, all zero; false if
  /// there is no room.
  bool make(std::span<FrontNode> nodes, FrontMemory& memory);

  std::span<const FrontNode> nodes() const { return nodes_; }

  /// The first row of the i-th node; -1 for a fixed one.
  int row_of(std::size_t node) const;

  /// Rows of complete nodes, and of all.
  int complete_rows() const { return complete_rows_; }

  int rows() const { return rows_; }

  /// How many nodes are eliminated; the others go up.
  std::size_t complete_count() const { return complete_count_; }

  /// Adds a symmetric 6x6 block on the diagonal, or a block for a pair of nodes; row, column: of
  /// the nodes' first unknowns.
  void add_block(int row, int column, const base::Mat6<double>& block);

  /// Adds one element; either triangle.
  void add(int row, int column, double value);

  double element(int row, int column) const { return value(at(row, column)); }

  /// The `index`-th element of S, by rows of its lower triangle, or what its first part leaves;
  /// zero behind the last one.
  float element_left(int index, bool is_low = false) const;

  /// Row `row` of L, then of S. False: not positive, nothing holds the robot.
  bool factor_row(int row);

  // Loads and shifts of a front are those of its memory.
  float& load(int row) const { return loads_[static_cast<std::size_t>(row)]; }

  float& shift(int row) const { return shifts_[static_cast<std::size_t>(row)]; }

  void clear_loads();

  /// Loads of complete nodes go over to the others.
  void condense_loads();

  /// Shifts of complete nodes, those of the others being here.
  void find_shifts();

 private:
  static std::size_t at(int row, int column) {
    return triangle_reals(static_cast<std::size_t>(row)) + static_cast<std::size_t>(column);
  }

  double product(int row, int column, int count) const;

  double value(std::size_t place) const {
    const auto high = static_cast<double>(matrix_[place]);
    return low_.empty() ? high : high + static_cast<double>(low_[place]);
  }

  void set(std::size_t place, double value);

  std::span<FrontNode> nodes_;
  std::span<float> matrix_;
  std::span<float> low_;  ///< What matrix_ leaves; empty where it has no second part.
  std::span<float> loads_;
  std::span<float> shifts_;
  std::size_t complete_count_ = 0;
  int complete_rows_ = 0;
  int rows_ = 0;
};

}  // namespace holdfast::agent
