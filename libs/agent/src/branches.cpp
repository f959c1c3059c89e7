// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "branches.hpp"

namespace holdfast::agent {

void Agent::begin_branch() { new (&work_.tree) BranchWork; }

void Agent::take_loop(int face, std::span<const std::uint8_t> message) {
  std::uint8_t& count = work_.tree.child_cut_count[static_cast<std::size_t>(face)];
  work_.tree.child_cuts[static_cast<std::size_t>(face)][count++] = decoded<Cut>(message);
}

/// Finds out which loops pass or close here, and tells the parent.
std::uint8_t Agent::survey_loops() {
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
    send(parent_, encode(tree.branch.cut(tree.branch.open_slot(i))));
  }
  return 0;
}

/// Is there a connection at this face that is not part of the tree?
bool Agent::is_cut(int face) const {
  const bool is_in_tree = face == parent_ || (children_ & bit(face)) != 0;
  return (used_faces() & bit(face)) != 0 && !is_in_tree;
}

/// The connection at a face, named from its lower end.
Cut Agent::cut_at(int face) const {
  const auto direction = static_cast<base::Direction>(face);
  const bool is_upper = face % 2 != 0;
  return is_upper ? Cut{base::neighbour(nodes_[0].cell, direction), base::opposite(direction)}
                  : Cut{nodes_[0].cell, direction};
}

Joint Agent::joint_to_parent() const {
  return {setup_.beam, static_cast<base::Direction>(parent_)};
}

/// What holds a planned module, from its own ground and the planned ones beyond it.
base::Mat6<float> Agent::leaf_stiffness(std::size_t node) const {
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

void Agent::add_leaf_stiffness(std::size_t node, int row, int column, float value) {
  if (column <= row) {
    nodes_[node].factor[static_cast<std::size_t>(row * (row + 1) / 2 + column)] +=
        static_cast<float>(value);
  } else {
    work_.tree.leaves[node - 1][static_cast<std::size_t>(column * (column - 1) / 2 + row)] += value;
  }
}

/// From nothing: tangents, then columns of leaves, come piece by piece.
void Agent::factor_branch() {
  BranchWork& tree = work_.tree;
  tree.branch.clear_stiffness();
  tree.load = {};  // Children add theirs as they come.
  tree.columns_here = {};
  tree.leaves = {};
  tree.is_symmetric = true;
  for (int i = 0; i < node_count(); ++i) {
    Node& node = nodes_[static_cast<std::size_t>(i)];
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
void Agent::add_tangent(std::size_t at) {
  const Node& node = nodes_[at];
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

void Agent::begin_piece(Piece piece, int index) {
  piece_ = piece;
  piece_index_ = static_cast<std::uint8_t>(index);
}

/// The next piece; false if there is none, or if it has to wait.
bool Agent::do_piece() {
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

bool Agent::do_factor_piece() {
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
void Agent::send_leaf_columns(const branches::Leaves& leaves, int leaf, int first) {
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

void Agent::take_column(int face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  const int part = index - Branch::kColumnCount;
  BranchWork& tree = work_.tree;
  std::uint8_t& here = tree.columns_here[static_cast<std::size_t>(face)];
  if (part < 0) {
    tree.is_symmetric = tree.is_symmetric && index >= branches::kStiffnessColumns;
    tree.branch.add_column(index, tree.slot_of[static_cast<std::size_t>(face)], in.vector);
    here = static_cast<std::uint8_t>(index + 1);
  } else {
    tree.branch.add_part(part, in.vector);
    here = part + 1 == Branch::kPartCount ? std::uint8_t{6} : here;
  }
}

/// Is all here that this column needs?
bool Agent::is_column_ready(int column) const {
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
bool Agent::send_columns() {
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

void Agent::send_batch(int column, int count) {
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

[[gnu::noinline]] void Agent::send_column(int label, const base::Vec6<float>& column) {
  send(parent_,
       vector_message(wire::MessageType::kColumn, static_cast<std::uint8_t>(label), column));
}

void Agent::take_branch_up(int face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  BranchLoad& load = work_.tree.load;
  base::Vec6<double>* into = &load.load;
  if (index > 0) {
    const int slot =
        work_.tree.slot_of[static_cast<std::size_t>(face)][static_cast<std::size_t>(index - 1)];
    into = &load.gap[static_cast<std::size_t>(slot)];
  }
  base::add_to(*into, base::converted<double>(in.vector));
}

/// The residuals here join the loads from below, and all go up.
bool Agent::do_load_piece() {
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

[[gnu::noinline]] void Agent::send_load_up() {
  base::Vec6<double> load = work_.tree.load.load;
  work_.tree.branch.find_load_up(joint_to_parent(), nodes_[0].is_fixed, load);
  send_branch_up(0, base::converted<float>(load));
}

[[gnu::noinline]] void Agent::send_gaps_up() {
  const BranchWork& tree = work_.tree;
  CutForces gaps{};
  tree.branch.find_gaps_up(joint_to_parent(), nodes_[0].is_fixed, tree.load, gaps);
  for (int i = 0; i < tree.branch.open_count(); ++i) {
    send_branch_up(1 + i, gaps[static_cast<std::size_t>(i)]);
  }
}

void Agent::find_residual_loads() {
  base::add_to(work_.tree.load.load, residual(nodes_[0], setup_, contact_));
  for (std::size_t i = 1; i < static_cast<std::size_t>(node_count()); ++i) {
    nodes_[i].shared = base::converted<float>(residual(nodes_[i], setup_, contact_));
  }
}

/// A leaf hands its load on.
void Agent::send_leaf_load(const branches::Leaves& leaves, std::size_t leaf) {
  const auto at = static_cast<std::size_t>(leaves.node[leaf]);
  const auto parent = static_cast<std::size_t>(leaves.parent[leaf]);
  auto load = base::converted<double>(nodes_[at].shared);
  find_load_up(Joint(setup_.beam, leaves.to_parent[leaf]), leaf_stiffness(at), load);
  if (parent == 0) {
    base::add_to(work_.tree.load.load, load);
  } else {
    base::add_to(nodes_[parent].shared, base::converted<float>(load));
  }
}

void Agent::send_branch_up(int index, const base::Vec6<float>& vector) {
  send(parent_,
       vector_message(wire::MessageType::kBranchUp, static_cast<std::uint8_t>(index), vector));
}

/// What comes down first; the root has it.
void Agent::begin_tree_step() {
  middle_ = {};
  down_awaited_ =
      parent_ < 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(1 + work_.tree.branch.open_count());
  if (down_awaited_ == 0) {
    begin_piece(Piece::kShift);
  }
}

void Agent::take_branch_down(std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  BranchWork& tree = work_.tree;
  const base::Vec6<float> vector = in.vector;
  if (index == 0) {
    nodes_[0].shared = vector;  // The parent's shift.
  } else {
    tree.forces[static_cast<std::size_t>(tree.branch.open_slot(index - 1))] = vector;
  }
  if (--down_awaited_ == 0) {
    begin_piece(Piece::kShift);
  }
}

/// M^-1 r of this module and of the planned ones here; then they move by it. All see it in single
/// precision, as the children do.
void Agent::do_shift_piece() {
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
        Node& node = nodes_[static_cast<std::size_t>(i)];
        base::add_to(node.u, base::converted<double>(node.shared));
        share_high_part(node);
      }
      start_exchange();
      begin_piece(Piece::kResiduals);
  }
}

[[gnu::noinline]] void Agent::find_own_shift() {
  const BranchWork& tree = work_.tree;
  auto shift = base::converted<double>(nodes_[0].shared);
  if (nodes_[0].is_fixed) {
    shift = {};
  } else if (parent_ < 0) {
    tree.branch.find_displacement_of_root(tree.load, shift);
  } else {
    tree.branch.find_displacement(joint_to_parent(), tree.load, tree.forces, shift);
  }
  nodes_[0].shared = base::converted<float>(shift);
}

void Agent::find_leaf_shift(const branches::Leaves& leaves, std::size_t leaf) {
  const auto at = static_cast<std::size_t>(leaves.node[leaf]);
  const auto parent = static_cast<std::size_t>(leaves.parent[leaf]);
  auto load = base::converted<double>(nodes_[at].shared);
  auto shift = base::converted<double>(nodes_[parent].shared);
  find_displacement(Joint(setup_.beam, leaves.to_parent[leaf]), leaf_stiffness(at), load, shift);
  nodes_[at].shared = base::converted<float>(shift);
}

void Agent::send_branch_down() {
  BranchWork& tree = work_.tree;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) == 0) {
      continue;
    }
    const auto at = static_cast<std::size_t>(face);
    send(face, vector_message(wire::MessageType::kBranchDown, 0, nodes_[0].shared));
    for (std::size_t i = 0; i < tree.child_cut_count[at]; ++i) {
      const auto slot = static_cast<std::size_t>(tree.slot_of[at][i]);
      send(face, vector_message(wire::MessageType::kBranchDown, static_cast<std::uint8_t>(1 + i),
                                tree.forces[slot]));
    }
  }
  tree.load = {};
}

}  // namespace holdfast::agent
