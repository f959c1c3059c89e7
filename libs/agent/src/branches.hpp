// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "bits.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"

/// Elimination over the tree as messages; branch.hpp has the algebra.
///
///   kMass      with the reports: cuts that are open, so that each module knows its loops
///   kFactor    with the reports: columns of condensed stiffness, then condensed loads
///   kTreeStep  with the order: displacements and forces in cuts; with the reports: loads
///
/// Planned modules emulated here are leaves of the tree: they hang on this module or on each other.
///
/// All is done in pieces, none longer than 5 ms on a Cortex-M0; each makes the factor of 1 + S F
/// that it needs. Between the residuals of one step and the displacements of the next, Node::shared
/// has the condensed load of a planned module, then its shift.
namespace holdfast::agent {

namespace branches {

/// Columns of S'; those of B', C' and P' follow.
inline constexpr int kStiffnessColumns = 6;

/// Pieces in which a leaf's columns go to its parent.
inline constexpr int kLeafPieces = kStiffnessColumns / Branch::kBatch;

/// The planned modules of one host as a tree, parents before children.
struct Leaves {
  int count = 0;
  std::array<int, kPlannedMax> node{};    ///< Index into nodes_.
  std::array<int, kPlannedMax> parent{};  ///< The same; 0 is the host.
  std::array<base::Direction, kPlannedMax> to_parent{};
};

inline Leaves leaves_of(const Planned& planned) {
  Leaves leaves;
  std::uint8_t placed = 0;
  const auto place = [&](int node, int parent, base::Direction to_parent) {
    const auto i = static_cast<std::size_t>(leaves.count++);
    leaves.node[i] = node;
    leaves.parent[i] = parent;
    leaves.to_parent[i] = to_parent;
    placed = static_cast<std::uint8_t>(placed | bit(planned.hosted(node - 1)));
  };
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int face = planned.own_face(planned.hosted(i));
    if (face >= 0) {
      place(1 + i, 0, base::opposite(static_cast<base::Direction>(face)));
    }
  }
  for (int next = 0; next < leaves.count; ++next) {
    const int at = leaves.node[static_cast<std::size_t>(next)];
    for (const base::Direction direction : base::kDirections) {
      const int other = planned.neighbour_of(planned.hosted(at - 1), direction);
      const int node = other < 0 ? -1 : planned.node_of(other);
      if (node > 0 && (placed & bit(other)) == 0) {
        place(node, at, base::opposite(direction));
      }
    }
  }
  return leaves;
}

/// Connections between the planned modules of one host, and with it.
inline int leaf_connections(const Planned& planned) {
  int ends = 0;
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int k = planned.hosted(i);
    ends += planned.own_face(k) >= 0 ? 2 : 0;
    for (const base::Direction direction : base::kDirections) {
      ends += planned.neighbour_of(k, direction) >= 0 ? 1 : 0;
    }
  }
  return ends / 2;
}

}  // namespace branches

template <class Real>
void BasicAgent<Real>::begin_branch() {
  new (&work_.tree) BranchWork;
}

template <class Real>
void BasicAgent<Real>::take_loop(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  std::uint8_t& count = work_.tree.child_cut_count[static_cast<std::size_t>(face)];
  Cut& cut = work_.tree.child_cuts[static_cast<std::size_t>(face)][count++];
  cut.cell = in.cell();
  cut.direction = static_cast<base::Direction>(in.u8());
}

/// Finds out which loops pass or close here, and tells the parent.
template <class Real>
std::uint8_t BasicAgent<Real>::survey_loops() {
  BranchWork& tree = work_.tree;
  bool has_too_many = branches::leaf_connections(planned_) != planned_.hosted_count();
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (is_cut(face)) {
      has_too_many = tree.branch.meet(cut_at(face)) < 0 || has_too_many;
    }
  }
  for (std::size_t face = 0; face < tree.child_cuts.size(); ++face) {
    for (std::size_t i = 0; i < tree.child_cut_count[face]; ++i) {
      const int slot = tree.branch.meet(tree.child_cuts[face][i]);
      tree.slot_of[face][i] = static_cast<std::uint8_t>(slot);
      has_too_many = slot < 0 || has_too_many;
    }
  }
  tree.has_too_many = has_too_many;
  if (has_too_many) {
    return kManyLoops;
  }
  for (int i = 0; i < tree.branch.open_count() && parent_ >= 0; ++i) {
    const Cut& cut = tree.branch.cut(tree.branch.open_slot(i));
    wire::Writer message(wire::MessageType::kLoop);
    message.cell(cut.cell);
    message.u8(static_cast<std::uint8_t>(cut.direction));
    send(parent_, message);
  }
  return 0;
}

/// Is there a connection at this face that is not part of the tree?
template <class Real>
bool BasicAgent<Real>::is_cut(int face) const {
  const bool is_in_tree = face == parent_ || (children_ & bit(face)) != 0;
  return (used_faces() & bit(face)) != 0 && !is_in_tree;
}

/// The connection at a face, named from its lower end.
template <class Real>
Cut BasicAgent<Real>::cut_at(int face) const {
  const auto direction = static_cast<base::Direction>(face);
  const bool is_upper = face % 2 != 0;
  return is_upper ? Cut{base::neighbour(nodes_[0].cell, direction), base::opposite(direction)}
                  : Cut{nodes_[0].cell, direction};
}

template <class Real>
Joint BasicAgent<Real>::joint_to_parent() const {
  return {setup_.beam, static_cast<base::Direction>(parent_)};
}

/// What holds a planned module, from its own ground and the planned ones beyond it.
template <class Real>
base::Mat6<float> BasicAgent<Real>::leaf_stiffness(std::size_t node) const {
  base::Mat6<float> stiffness;
  std::size_t below = 0;
  std::size_t above = 0;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k <= i; ++k) {
      stiffness.at(i, k) = static_cast<float>(nodes_[node].factor[below++]);
      if (k < i) {
        stiffness.at(k, i) = work_.tree.leaves[node - 1][above++];
      }
    }
  }
  return stiffness;
}

template <class Real>
void BasicAgent<Real>::add_leaf_stiffness(std::size_t node, int row, int column, float value) {
  if (column <= row) {
    nodes_[node].factor[static_cast<std::size_t>(row * (row + 1) / 2 + column)] +=
        static_cast<Real>(value);
  } else {
    work_.tree.leaves[node - 1][static_cast<std::size_t>(column * (column - 1) / 2 + row)] += value;
  }
}

/// From nothing: tangents, then columns of leaves, come piece by piece.
template <class Real>
void BasicAgent<Real>::factor_branch() {
  BranchWork& tree = work_.tree;
  tree.branch.clear_stiffness();
  tree.load = {};  // Children add theirs as they come.
  tree.columns_here = {};
  tree.leaves = {};
  tree.is_symmetric = true;
  for (int i = 0; i < node_count(); ++i) {
    Node<Real>& node = nodes_[static_cast<std::size_t>(i)];
    node.factor = {};
    const bool tilts = node.is_ground && (node.state.tilt_x != 0 || node.state.tilt_y != 0);
    tree.is_symmetric = tree.is_symmetric && !tilts;
  }
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (is_cut(face)) {
      tree.branch.add_end(tree.branch.find(cut_at(face)), face % 2 != 0, setup_.beam);
    }
  }
  begin_piece(Piece::kTangents, node_count());
}

/// What a facet holds, in the contact state in use.
template <class Real>
void BasicAgent<Real>::add_tangent(std::size_t at) {
  const Node<Real>& node = nodes_[at];
  if (!node.is_ground) {
    return;
  }
  const base::Mat6<double> tangent =
      mechanics::contact_tangent(contact_.facet, node.state, node.is_held);
  if (at == 0) {
    work_.tree.branch.add_stiffness(tangent);
    return;
  }
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      add_leaf_stiffness(at, row, column, static_cast<float>(tangent.at(row, column)));
    }
  }
}

template <class Real>
void BasicAgent<Real>::begin_piece(Piece piece, int index) {
  piece_ = piece;
  piece_index_ = static_cast<std::uint8_t>(index);
}

/// The next piece; false if there is none, or if it has to wait.
template <class Real>
bool BasicAgent<Real>::do_piece() {
  if (piece_ == Piece::kNone || is_exchanging_) {
    return false;
  }
  if (piece_ < Piece::kResiduals) {
    return do_factor_piece();
  }
  if (piece_ < Piece::kShift) {
    return do_load_piece();
  }
  do_shift_piece();
  return true;
}

template <class Real>
bool BasicAgent<Real>::do_factor_piece() {
  if (piece_ == Piece::kTangents) {
    add_tangent(--piece_index_);
    if (piece_index_ == 0) {
      begin_piece(Piece::kLeafColumns, branches::kLeafPieces * planned_.hosted_count());
    }
    return true;
  }
  if (piece_ == Piece::kLeafColumns) {
    if (piece_index_ == 0) {
      begin_piece(Piece::kLoops);
      return true;
    }
    --piece_index_;
    send_leaf_columns(branches::leaves_of(planned_), piece_index_ / branches::kLeafPieces,
                      piece_index_ % branches::kLeafPieces * Branch::kBatch);
    return true;
  }
  if (piece_ == Piece::kLoops) {
    Branch& branch = work_.tree.branch;
    if (branch.closes_loops() && reports_awaited_ != 0) {
      return false;
    }
    if (!branch.close_loops(setup_.beam, piece_index_)) {
      begin_piece(Piece::kSymmetry);
    }
    return true;
  }
  if (piece_ == Piece::kSymmetry) {
    if (!is_column_ready(0)) {
      return false;
    }
    BranchWork& tree = work_.tree;
    tree.is_symmetric = tree.is_symmetric || tree.branch.is_symmetric();
    begin_piece(Piece::kColumns);
    return true;
  }
  return send_columns();
}

/// A leaf hands its stiffness on: columns `first` and on.
template <class Real>
void BasicAgent<Real>::send_leaf_columns(const branches::Leaves& leaves, int leaf, int first) {
  const auto i = static_cast<std::size_t>(leaf);
  const auto parent = static_cast<std::size_t>(leaves.parent[i]);
  const Joint joint(setup_.beam, leaves.to_parent[i]);
  Branch::Columns columns;
  find_stiffness_up(joint, leaf_stiffness(static_cast<std::size_t>(leaves.node[i])), first,
                    columns);
  for (int k = 0; k < Branch::kBatch; ++k) {
    const base::Vec6<float>& column = columns[static_cast<std::size_t>(k)];
    if (parent == 0) {
      work_.tree.branch.add_column(first + k, {}, column);
      continue;
    }
    for (int row = 0; row < 6; ++row) {
      add_leaf_stiffness(parent, row, first + k, column[static_cast<std::size_t>(row)]);
    }
  }
}

template <class Real>
void BasicAgent<Real>::take_column(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const int index = in.u8();
  const int part = index - Branch::kColumnCount;
  BranchWork& tree = work_.tree;
  std::uint8_t& here = tree.columns_here[static_cast<std::size_t>(face)];
  if (part < 0) {
    tree.is_symmetric = tree.is_symmetric && index >= branches::kStiffnessColumns;
    tree.branch.add_column(index, tree.slot_of[static_cast<std::size_t>(face)],
                           sweep::read_vector(in));
    here = static_cast<std::uint8_t>(index + 1);
  } else {
    tree.branch.add_part(part, sweep::read_vector(in));
    here = part + 1 == Branch::kPartCount ? std::uint8_t{6} : here;
  }
}

/// Is all here that this column needs?
template <class Real>
bool BasicAgent<Real>::is_column_ready(int column) const {
  const BranchWork& tree = work_.tree;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const auto at = static_cast<std::size_t>(face);
    if ((reports_awaited_ & bit(face)) != 0 &&
        tree.columns_here[at] <
            tree.branch.columns_needed(column, tree.slot_of[at], tree.child_cut_count[at])) {
      return false;
    }
  }
  return true;
}

/// The next columns for the parent, as many as are ready; those of zeros need not be sent. False:
/// more when there is room on the link, or when children have sent more.
template <class Real>
bool BasicAgent<Real>::send_columns() {
  const Branch& branch = work_.tree.branch;
  const auto skip = [&](int count) {
    piece_index_ = static_cast<std::uint8_t>(piece_index_ + count);
  };
  while (piece_index_ < Branch::kColumnCount && parent_ >= 0) {
    if (!is_column_ready(piece_index_)) {
      return false;
    }
    if (!branch.has_columns(piece_index_, nodes_[0].is_fixed)) {
      skip(6);  // A whole block.
      continue;
    }
    int count = 1;
    while (count < Branch::batch_at(piece_index_) && is_column_ready(piece_index_ + count)) {
      ++count;
    }
    // What follows must find room too.
    const int room = (count + 1 + kLoopsMax) * wire::kVectorBytes + wire::kMessageBytesMax;
    if (!links_[static_cast<std::size_t>(parent_)].has_room(room)) {
      return false;
    }
    send_batch(piece_index_, count);
    skip(count);
    return true;
  }
  begin_piece(Piece::kResiduals);
  return true;
}

template <class Real>
void BasicAgent<Real>::send_batch(int column, int count) {
  const Branch& branch = work_.tree.branch;
  const bool is_fixed = nodes_[0].is_fixed;
  const bool has_parts = work_.tree.is_symmetric && column < branches::kStiffnessColumns;
  // Two parts are made of three columns.
  const int first = has_parts ? column * 2 / Branch::kBatch : column;
  Branch::Columns columns;
  {
    const Joint joint = joint_to_parent();
    has_parts ? branch.find_parts_up(joint, is_fixed, first, columns)
              : branch.find_columns_up(joint, is_fixed, first, count, columns);
  }
  for (int k = 0; k < (has_parts ? 2 : count); ++k) {
    const int label = first + k + (has_parts ? Branch::kColumnCount : 0);
    send_column(label, columns[static_cast<std::size_t>(k)]);
  }
}

template <class Real>
[[gnu::noinline]] void BasicAgent<Real>::send_column(int label, const base::Vec6<float>& column) {
  send(parent_,
       sweep::vector_message(wire::MessageType::kColumn, static_cast<std::uint8_t>(label), column));
}

template <class Real>
void BasicAgent<Real>::take_branch_up(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const int index = in.u8();
  BranchLoad& load = work_.tree.load;
  base::Vec6<double>* into = &load.load;
  if (index > 0) {
    const int slot =
        work_.tree.slot_of[static_cast<std::size_t>(face)][static_cast<std::size_t>(index - 1)];
    into = &load.gap[static_cast<std::size_t>(slot)];
  }
  base::add_to(*into, base::converted<double>(sweep::read_vector(in)));
}

/// The residuals here join the loads from below, and all go up.
template <class Real>
bool BasicAgent<Real>::do_load_piece() {
  BranchWork& tree = work_.tree;
  if (reports_awaited_ != 0) {
    return false;
  }
  switch (piece_) {
    case Piece::kResiduals:
      find_residual_loads();
      begin_piece(Piece::kLeafLoads, planned_.hosted_count());
      break;
    case Piece::kLeafLoads:
      if (piece_index_ == 0) {
        begin_piece(Piece::kCloseLoad);
      } else {
        send_leaf_load(branches::leaves_of(planned_), --piece_index_);
      }
      break;
    case Piece::kCloseLoad:
      tree.branch.close_loops(tree.load);
      begin_piece(parent_ < 0 ? Piece::kNone : Piece::kLoadUp);
      break;
    case Piece::kLoadUp:
      send_load_up();
      begin_piece(Piece::kGapsUp);
      break;
    default:
      send_gaps_up();
      begin_piece(Piece::kNone);
  }
  return true;
}

template <class Real>
[[gnu::noinline]] void BasicAgent<Real>::send_load_up() {
  base::Vec6<double> load = work_.tree.load.load;
  work_.tree.branch.find_load_up(joint_to_parent(), nodes_[0].is_fixed, load);
  send_branch_up(0, base::converted<float>(load));
}

template <class Real>
[[gnu::noinline]] void BasicAgent<Real>::send_gaps_up() {
  const BranchWork& tree = work_.tree;
  CutForces gaps{};
  tree.branch.find_gaps_up(joint_to_parent(), nodes_[0].is_fixed, tree.load, gaps);
  for (int i = 0; i < tree.branch.open_count(); ++i) {
    send_branch_up(1 + i, gaps[static_cast<std::size_t>(i)]);
  }
}

template <class Real>
void BasicAgent<Real>::find_residual_loads() {
  base::add_to(work_.tree.load.load, residual(nodes_[0], setup_, contact_));
  for (std::size_t i = 1; i < static_cast<std::size_t>(node_count()); ++i) {
    nodes_[i].shared = base::converted<Real>(residual(nodes_[i], setup_, contact_));
  }
}

/// A leaf hands its load on.
template <class Real>
void BasicAgent<Real>::send_leaf_load(const branches::Leaves& leaves, std::size_t leaf) {
  const auto at = static_cast<std::size_t>(leaves.node[leaf]);
  const auto parent = static_cast<std::size_t>(leaves.parent[leaf]);
  auto load = base::converted<double>(nodes_[at].shared);
  find_load_up(Joint(setup_.beam, leaves.to_parent[leaf]), leaf_stiffness(at), load);
  if (parent == 0) {
    base::add_to(work_.tree.load.load, load);
  } else {
    base::add_to(nodes_[parent].shared, base::converted<Real>(load));
  }
}

template <class Real>
void BasicAgent<Real>::send_branch_up(int index, const base::Vec6<float>& vector) {
  send(parent_, sweep::vector_message(wire::MessageType::kBranchUp,
                                      static_cast<std::uint8_t>(index), vector));
}

/// What comes down first; the root has it.
template <class Real>
void BasicAgent<Real>::begin_tree_step() {
  middle_ = {};
  down_awaited_ =
      parent_ < 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(1 + work_.tree.branch.open_count());
  if (down_awaited_ == 0) {
    begin_piece(Piece::kShift);
  }
}

template <class Real>
void BasicAgent<Real>::take_branch_down(std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const int index = in.u8();
  BranchWork& tree = work_.tree;
  const base::Vec6<float> vector = sweep::read_vector(in);
  if (index == 0) {
    nodes_[0].shared = base::converted<Real>(vector);  // The parent's shift.
  } else {
    tree.forces[static_cast<std::size_t>(tree.branch.open_slot(index - 1))] = vector;
  }
  if (--down_awaited_ == 0) {
    begin_piece(Piece::kShift);
  }
}

/// M^-1 r of this module and of the planned ones here; then they move by it. All see it in single
/// precision, as the children do.
template <class Real>
void BasicAgent<Real>::do_shift_piece() {
  BranchWork& tree = work_.tree;
  switch (piece_) {
    case Piece::kShift:
      find_own_shift();
      begin_piece(Piece::kForces);
      break;
    case Piece::kForces:
      tree.branch.find_forces(tree.load, base::converted<double>(nodes_[0].shared), tree.forces);
      send_branch_down();
      begin_piece(Piece::kLeafShifts);
      break;
    case Piece::kLeafShifts:
      if (piece_index_ == planned_.hosted_count()) {
        begin_piece(Piece::kMove);
      } else {
        find_leaf_shift(branches::leaves_of(planned_), piece_index_++);
      }
      break;
    default:
      for (int i = 0; i < node_count(); ++i) {
        Node<Real>& node = nodes_[static_cast<std::size_t>(i)];
        base::add_to(node.u, base::converted<double>(node.shared));
        share_high_part(node);
      }
      start_exchange();
      begin_piece(Piece::kResiduals);
  }
}

template <class Real>
[[gnu::noinline]] void BasicAgent<Real>::find_own_shift() {
  const BranchWork& tree = work_.tree;
  auto shift = base::converted<double>(nodes_[0].shared);
  if (nodes_[0].is_fixed) {
    shift = {};
  } else if (parent_ < 0) {
    tree.branch.find_displacement_of_root(tree.load, shift);
  } else {
    tree.branch.find_displacement(joint_to_parent(), tree.load, tree.forces, shift);
  }
  nodes_[0].shared = equilibrium::as_sent(base::converted<Real>(shift));
}

template <class Real>
void BasicAgent<Real>::find_leaf_shift(const branches::Leaves& leaves, std::size_t leaf) {
  const auto at = static_cast<std::size_t>(leaves.node[leaf]);
  const auto parent = static_cast<std::size_t>(leaves.parent[leaf]);
  auto load = base::converted<double>(nodes_[at].shared);
  auto shift = base::converted<double>(nodes_[parent].shared);
  find_displacement(Joint(setup_.beam, leaves.to_parent[leaf]), leaf_stiffness(at), load, shift);
  nodes_[at].shared = base::converted<Real>(shift);
}

template <class Real>
void BasicAgent<Real>::send_branch_down() {
  BranchWork& tree = work_.tree;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) == 0) {
      continue;
    }
    const auto at = static_cast<std::size_t>(face);
    send(face, sweep::vector_message(wire::MessageType::kBranchDown, 0,
                                     base::converted<float>(nodes_[0].shared)));
    for (std::size_t i = 0; i < tree.child_cut_count[at]; ++i) {
      const auto slot = static_cast<std::size_t>(tree.slot_of[at][i]);
      send(face, sweep::vector_message(wire::MessageType::kBranchDown,
                                       static_cast<std::uint8_t>(1 + i), tree.forces[slot]));
    }
  }
  tree.load = {};
}

}  // namespace holdfast::agent
