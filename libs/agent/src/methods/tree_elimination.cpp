// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/tree_elimination.hpp"

#include "equilibrium/beams.hpp"
#include "equilibrium/displacements.hpp"
#include "equilibrium/stage_load.hpp"
#include "groups/leaves.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;

/// Columns of S'; those of B', C' and P' follow.
constexpr int kStiffnessColumns = 6;

/// Pieces in which a leaf's columns go to its parent.
constexpr int kLeafPieces = kStiffnessColumns / Branch::kBatch;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

/// Faces with a connection that is not part of the tree.
Faces cut_faces(const Workspace& ws) {
  return ws.links.used() - ws.tree.parent() - ws.tree.children();
}

/// Does a face look to the smaller coordinate, so that its connection is named from beyond?
bool is_upper(Direction face) { return base::index(face) % 2 != 0; }

/// The connection at a face, named from its lower end.
Cut cut_at(const Workspace& ws, Direction face) {
  const base::Cell& cell = ws.tree.cell();
  return is_upper(face) ? Cut{ws.beside(cell, face), base::opposite(face)} : Cut{cell, face};
}

Joint joint_to_parent(const Workspace& ws) { return {ws.setup.beams(), ws.tree.parent().first()}; }

/// All columns have room at once in a queue that is lent.
bool has_room(const Links& links, Direction face, int bytes) {
  return kHasAllMethods ? links.has_long_room(face, bytes) : links.has_room(face, bytes);
}

// Not inlined: its message would stand on the stack beside the matrices of those that call it.
[[gnu::noinline]] void send_up(Workspace& ws, MessageType type, int label,
                               const base::Vec6<float>& vector) {
  ws.links.send(ws.tree.parent(), vector_message(type, static_cast<std::uint8_t>(label), vector));
}

}  // namespace

bool TreeElimination::begin(Workspace& ws, const Order& order, int /*piece*/) {
  if (order.operation == Operation::kBegin) {
    begin_equilibrium(ws, order);
  } else if (order.operation == Operation::kFactor) {
    factor(ws);
  } else if (is_resume(order.operation)) {
    // The loads are those of the displacements that are kept, which are shared first.
    begin_equilibrium(ws, order);
    ws.clear_middle();
    for (int i = 0; i < ws.node_count(); ++i) {
      share_high_part(ws.node(i));
    }
    if ((order.flags & kKeepsFactors) == 0) {
      factor(ws);
    } else {
      load_ = {};
      clear_stiffness_above(ws);  // Planned modules here touch no ground.
      begin_piece(Piece::kResiduals);
    }
  } else if (order.operation == Operation::kTreeIterate) {
    ws.clear_middle();
    // What comes down first; the root has it.
    down_awaited_ = static_cast<std::uint8_t>(ws.tree.is_root() ? 0 : 1 + branch_.open_count());
    if (down_awaited_ == 0) {
      begin_piece(Piece::kShift);
    }
  }
  return false;
}

/// Only what a child's loops, or this module's own, account for.
bool TreeElimination::expects(const Workspace& ws, const Order& order, Direction face,
                              std::span<const std::uint8_t> message) const {
  const int label = message[1];
  const int child_cuts = child_cut_count(ws, face);
  const bool reports = ws.reports.awaits(face);
  const bool is_iteration = order.operation == Operation::kTreeIterate;
  const bool is_factor = order.operation == Operation::kFactor || is_resume(order.operation);
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kLoop:
      return reports && child_cuts < kLoopsMax &&
             (order.operation == Operation::kMass || order.operation == Operation::kRenew);
    case MessageType::kColumn:
      return reports && is_factor && Branch::loops_of_column(label) <= child_cuts;
    case MessageType::kBranchUp:
      return reports && (is_factor || is_iteration) && label <= child_cuts;
    default:
      return is_iteration && down_awaited_ != 0 && ws.tree.parent().has(face) &&
             label <= branch_.open_count();
  }
}

void TreeElimination::take(Workspace& ws, const Order& /*order*/, Direction face,
                           std::span<const std::uint8_t> message) {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kLoop:
      return take_loop(ws, face, message);
    case MessageType::kColumn:
      return take_column(ws, face, message);
    case MessageType::kBranchUp:
      return take_up(ws, face, message);
    default:
      return take_down(ws, message);
  }
}

/// Displacements in two parts; then contact states follow, and residuals are here.
bool TreeElimination::take_exchange(Workspace& ws, const Order& /*order*/, int /*piece*/) {
  add_forces(ws, PlannedPart::kTogether);
  if (ws.exchange.left() == 2) {
    share_low_part(ws);
    return false;
  }
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    node.has_changed = false;
    if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
      // The next kFactor takes them.
      node.has_changed =
          surrounded::look_up_states(*surroundings, ws.contact, node.u, kPressureTieEliminated);
    } else {
      follow_state(node, ws.contact, false);
    }
  }
  return false;
}

bool TreeElimination::report(Workspace& ws, const Order& order, int piece, Report& sum) {
  if (kHasAllMethods && order.operation == Operation::kSeek) {
    seek_facets(ws, order, sum);
    return false;
  }
  return order.operation == Operation::kTreeIterate && iteration_report(ws, piece, sum);
}

void TreeElimination::begin_piece(Piece piece, int index) {
  piece_ = piece;
  piece_index_ = static_cast<std::uint8_t>(index);
}

bool TreeElimination::do_piece(Workspace& ws, const Order& /*order*/) {
  if (ws.exchange.is_under_way()) {
    return false;
  }
  switch (piece_) {
    case Piece::kNone:
      return false;
    case Piece::kTangents:
      return do_tangent(ws);
    case Piece::kLeafColumns:
      return do_leaf_columns(ws);
    case Piece::kLoops:
      return do_loops(ws);
    case Piece::kSymmetry:
      return do_symmetry(ws);
    case Piece::kColumns:
      return send_columns(ws);
    case Piece::kShift:
    case Piece::kForces:
    case Piece::kLeafShifts:
    case Piece::kMove:
      return do_shift_piece(ws);
    default:
      return do_load_piece(ws);
  }
}

// ---- Loops.

std::uint8_t TreeElimination::survey_loops(Workspace& ws) {
  bool has_too_many = leaf_connections(ws.planned) != ws.planned.hosted_count();
  for (const Direction face : cut_faces(ws)) {
    has_too_many = branch_.meet(cut_at(ws, face)) < 0 || has_too_many;
  }
  for (const Direction face : directions(ws.links.more())) {
    for (std::size_t i = 0; i < child_cut_count(ws, face); ++i) {
      const int slot = branch_.meet(child_cuts(ws, face)[i]);
      slots_of(ws, face)[i] = static_cast<std::uint8_t>(slot);
      has_too_many = slot < 0 || has_too_many;
    }
  }
  has_too_many_ = has_too_many;
  if (has_too_many) {
    return kManyLoops;
  }
  for (int i = 0; i < branch_.open_count(); ++i) {
    const Cut& cut = branch_.cut(branch_.open_slot(i));
    ws.links.send(ws.tree.parent(), encode(cut));
  }
  return 0;
}

bool TreeElimination::has_new_loop(const Workspace& ws) const {
  for (const Direction face : cut_faces(ws)) {
    if (branch_.find(cut_at(ws, face)) < 0) {
      return true;
    }
  }
  return false;
}

void TreeElimination::take_loop(Workspace& ws, Direction face,
                                std::span<const std::uint8_t> message) {
  decode(message, child_cuts(ws, face)[child_cut_count(ws, face)++]);
}

// ---- Stiffness.

void TreeElimination::clear_stiffness_above(const Workspace& ws) {
  stiffness_above_ = {};
  if (MorePlanned* more = ws.planned.more_planned(); more != nullptr) {
    more->stiffness_above = {};
  }
}

/// Begins from nothing: tangents, then columns of leaves, come piece by piece.
void TreeElimination::factor(Workspace& ws) {
  branch_.clear_stiffness();
  load_ = {};  // Children add theirs as they come.
  for (const Direction face : directions(ws.links.more())) {
    columns_here(ws, face) = 0;
  }
  clear_stiffness_above(ws);
  is_symmetric_ = true;
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    node.matrix.stiffness_below = {};
    if (surroundings_of(node) != nullptr) {
      take_states(node);
    }
    is_symmetric_ = is_symmetric_ && !is_any_tilting(node);
  }
  for (const Direction face : cut_faces(ws)) {
    branch_.add_end(branch_.find(cut_at(ws, face)), is_upper(face), ws.setup.beams());
  }
  begin_piece(Piece::kTangents, ws.node_count());
}

/// What a facet holds, in the contact state in use.
bool TreeElimination::do_tangent(Workspace& ws) {
  const int index = --piece_index_;
  if (index == 0) {
    begin_piece(Piece::kLeafColumns, kLeafPieces * ws.planned.hosted_count());
  }
  Node& node = ws.node(index);
  if (!node.is_ground) {
    return true;
  }
  const base::Mat6<double> tangent = facet_tangent(node, ws.contact);
  if (index == 0) {
    branch_.add_stiffness(tangent);
    return true;
  }
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      add_leaf_stiffness(node, stiffness_above(ws, index - 1), row, column,
                         static_cast<float>(tangent.at(row, column)));
    }
  }
  return true;
}

/// What holds a planned module, from its own ground and the planned ones beyond it.
base::Mat6<float> TreeElimination::leaf_stiffness(const Node& node, const Above& above) {
  base::Mat6<float> stiffness;
  std::size_t below = 0;
  std::size_t next_above = 0;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k <= i; ++k) {
      stiffness.at(i, k) = node.matrix.stiffness_below[below++];
      if (k < i) {
        stiffness.at(k, i) = above[next_above++];
      }
    }
  }
  return stiffness;
}

void TreeElimination::add_leaf_stiffness(Node& node, Above& above, int row, int column,
                                         float value) {
  if (column <= row) {
    node.matrix.stiffness_below[at(row * (row + 1) / 2 + column)] += value;
  } else {
    above[at(column * (column - 1) / 2 + row)] += value;
  }
}

bool TreeElimination::do_leaf_columns(Workspace& ws) {
  if (piece_index_ == 0) {
    begin_piece(Piece::kLoops);
    return true;
  }
  --piece_index_;
  send_leaf_columns(ws, leaves_of(ws.planned), piece_index_ / kLeafPieces,
                    piece_index_ % kLeafPieces * Branch::kBatch);
  return true;
}

/// A leaf hands its stiffness on: columns `first` and on.
void TreeElimination::send_leaf_columns(Workspace& ws, const Leaves& leaves, int leaf, int first) {
  const int node = leaves.node[at(leaf)];
  const int parent = leaves.parent[at(leaf)];
  Branch::Columns columns;
  {
    const Joint joint(ws.setup.beams(), leaves.to_parent[at(leaf)]);
    find_stiffness_up(joint, leaf_stiffness(ws.node(node), stiffness_above(ws, node - 1)), first,
                      columns);
  }
  for (int k = 0; k < Branch::kBatch; ++k) {
    const base::Vec6<float>& column = columns[at(k)];
    if (parent == 0) {
      branch_.add_column(first + k, {}, column);
      continue;
    }
    for (int row = 0; row < 6; ++row) {
      add_leaf_stiffness(ws.node(parent), stiffness_above(ws, parent - 1), row, first + k,
                         column[at(row)]);
    }
  }
}

bool TreeElimination::do_loops(const Workspace& ws) {
  if (branch_.closes_loops() && !ws.reports.are_here()) {
    return false;
  }
  if (!branch_.close_loops(ws.setup.beams(), piece_index_)) {
    begin_piece(Piece::kSymmetry);
  }
  return true;
}

bool TreeElimination::do_symmetry(const Workspace& ws) {
  if (!is_column_ready(ws, 0)) {
    return false;
  }
  is_symmetric_ = is_symmetric_ || branch_.is_symmetric();
  begin_piece(Piece::kColumns);
  return true;
}

void TreeElimination::take_column(Workspace& ws, Direction face,
                                  std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  const int part = index - Branch::kColumnCount;
  std::uint8_t& here = columns_here(ws, face);
  if (part < 0) {
    is_symmetric_ = is_symmetric_ && index >= kStiffnessColumns;
    branch_.add_column(index, slots_of(ws, face), in.vector);
    here = static_cast<std::uint8_t>(index + 1);
  } else {
    branch_.add_part(part, in.vector);
    here = part + 1 == Branch::kPartCount ? std::uint8_t{kStiffnessColumns} : here;
  }
}

/// Is all here that this column needs?
bool TreeElimination::is_column_ready(const Workspace& ws, int column) const {
  for (const Direction face : ws.reports.awaited()) {
    if (columns_here(ws, face) <
        branch_.columns_needed(column, slots_of(ws, face), child_cut_count(ws, face))) {
      return false;
    }
  }
  return true;
}

/// The next columns for the parent, as many as are ready; those of zeros need not be sent. False:
/// more when there is room on the link, or when children have sent more.
bool TreeElimination::send_columns(Workspace& ws) {
  const auto skip = [&](int count) {
    piece_index_ = static_cast<std::uint8_t>(piece_index_ + count);
  };
  while (piece_index_ < Branch::kColumnCount && !ws.tree.is_root()) {
    if (!is_column_ready(ws, piece_index_)) {
      return false;
    }
    if (!branch_.has_columns(piece_index_, ws.node(0).is_fixed)) {
      skip(6);  // A whole block.
      continue;
    }
    int count = 1;
    while (count < Branch::batch_at(piece_index_) && is_column_ready(ws, piece_index_ + count)) {
      ++count;
    }
    // What follows must find room too.
    const int room = (count + 1 + kLoopsMax) * wire::kVectorBytes + wire::kPlainBytesMax;
    if (!has_room(ws.links, ws.tree.parent().first(), room)) {
      return false;
    }
    send_batch(ws, piece_index_, count);
    skip(count);
    return true;
  }
  begin_piece(Piece::kResiduals);
  return true;
}

void TreeElimination::send_batch(Workspace& ws, int column, int count) const {
  const bool is_fixed = ws.node(0).is_fixed;
  const bool has_parts = is_symmetric_ && column < kStiffnessColumns;
  // Two parts are made of three columns.
  const int first = has_parts ? column * 2 / Branch::kBatch : column;
  Branch::Columns columns;
  {
    const Joint joint = joint_to_parent(ws);
    has_parts ? branch_.find_parts_up(joint, is_fixed, first, columns)
              : branch_.find_columns_up(joint, is_fixed, first, count, columns);
  }
  for (int k = 0; k < (has_parts ? 2 : count); ++k) {
    const int label = first + k + (has_parts ? Branch::kColumnCount : 0);
    send_up(ws, MessageType::kColumn, label, columns[at(k)]);
  }
}

// ---- Loads.

/// The residuals here join the loads from below, and all go up.
bool TreeElimination::do_load_piece(Workspace& ws) {
  if (!ws.reports.are_here()) {
    return false;
  }
  switch (piece_) {
    case Piece::kResiduals:
      find_residual_loads(ws);
      begin_piece(Piece::kLeafLoads, ws.planned.hosted_count());
      break;
    case Piece::kLeafLoads:
      if (piece_index_ == 0) {
        begin_piece(Piece::kCloseLoad);
      } else {
        send_leaf_load(ws, leaves_of(ws.planned), --piece_index_);
      }
      break;
    case Piece::kCloseLoad:
      branch_.close_loops(load_);
      begin_piece(ws.tree.is_root() ? Piece::kNone : Piece::kLoadUp);
      break;
    case Piece::kLoadUp:
      send_load_up(ws);
      begin_piece(Piece::kGapsUp);
      break;
    default:
      send_gaps_up(ws);
      begin_piece(Piece::kNone);
  }
  return true;
}

void TreeElimination::find_residual_loads(Workspace& ws) {
  base::add_to(load_.load, residual(ws, 0));
  for (int i = 1; i < ws.node_count(); ++i) {
    ws.node(i).vector.load = base::converted<float>(residual(ws, i));
  }
}

/// A leaf hands its load on.
void TreeElimination::send_leaf_load(Workspace& ws, const Leaves& leaves, int leaf) {
  const int node = leaves.node[at(leaf)];
  const int parent = leaves.parent[at(leaf)];
  auto load = base::converted<double>(ws.node(node).vector.load);
  find_load_up(Joint(ws.setup.beams(), leaves.to_parent[at(leaf)]),
               leaf_stiffness(ws.node(node), stiffness_above(ws, node - 1)), load);
  if (parent == 0) {
    base::add_to(load_.load, load);
  } else {
    base::add_to(ws.node(parent).vector.load, base::converted<float>(load));
  }
}

// The pieces that follow are not inlined, so that none has the others' vectors on its stack.

[[gnu::noinline]] void TreeElimination::send_load_up(Workspace& ws) const {
  base::Vec6<double> load = load_.load;
  branch_.find_load_up(joint_to_parent(ws), ws.node(0).is_fixed, load);
  send_up(ws, MessageType::kBranchUp, 0, base::converted<float>(load));
}

[[gnu::noinline]] void TreeElimination::send_gaps_up(Workspace& ws) const {
  CutForces gaps{};
  branch_.find_gaps_up(joint_to_parent(ws), ws.node(0).is_fixed, load_, gaps);
  for (int i = 0; i < branch_.open_count(); ++i) {
    send_up(ws, MessageType::kBranchUp, 1 + i, gaps[at(i)]);
  }
}

void TreeElimination::take_up(Workspace& ws, Direction face,
                              std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  base::Vec6<double>& into = index == 0 ? load_.load : load_.gap[slots_of(ws, face)[at(index - 1)]];
  base::add_to(into, base::converted<double>(in.vector));
}

// ---- Displacements.

void TreeElimination::take_down(Workspace& ws, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int index = in.label;
  if (index == 0) {
    ws.node(0).vector.shift = in.vector;  // The parent's shift.
  } else {
    forces_[at(branch_.open_slot(index - 1))] = in.vector;
  }
  if (--down_awaited_ == 0) {
    begin_piece(Piece::kShift);
  }
}

/// M^-1 r of this module and of the planned ones here; then they move by it. All see it in single
/// precision, as the children do.
bool TreeElimination::do_shift_piece(Workspace& ws) {
  switch (piece_) {
    case Piece::kShift:
      find_own_shift(ws);
      begin_piece(Piece::kForces);
      break;
    case Piece::kForces:
      branch_.find_forces(load_, base::converted<double>(ws.node(0).vector.shift), forces_);
      send_down(ws);
      begin_piece(Piece::kLeafShifts);
      break;
    case Piece::kLeafShifts:
      if (piece_index_ == ws.planned.hosted_count()) {
        begin_piece(Piece::kMove);
      } else {
        find_leaf_shift(ws, leaves_of(ws.planned), piece_index_++);
      }
      break;
    default:
      for (int i = 0; i < ws.node_count(); ++i) {
        Node& node = ws.node(i);
        base::add_to(node.u, base::converted<double>(node.vector.shift));
        share_high_part(node);
      }
      ws.start_exchange(PlannedPart::kTogether);
      begin_piece(Piece::kResiduals);
  }
  return true;
}

[[gnu::noinline]] void TreeElimination::find_own_shift(Workspace& ws) {
  Node& node = ws.node(0);
  auto shift = base::converted<double>(node.vector.shift);
  if (node.is_fixed) {
    shift = {};
  } else if (ws.tree.is_root()) {
    branch_.find_displacement_of_root(load_, shift);
  } else {
    branch_.find_displacement(joint_to_parent(ws), load_, forces_, shift);
  }
  node.vector.shift = base::converted<float>(shift);
}

void TreeElimination::find_leaf_shift(Workspace& ws, const Leaves& leaves, int leaf) {
  Node& node = ws.node(leaves.node[at(leaf)]);
  auto load = base::converted<double>(node.vector.load);
  auto shift = base::converted<double>(ws.node(leaves.parent[at(leaf)]).vector.shift);
  find_displacement(Joint(ws.setup.beams(), leaves.to_parent[at(leaf)]),
                    leaf_stiffness(node, stiffness_above(ws, leaves.node[at(leaf)] - 1)), load,
                    shift);
  node.vector.shift = base::converted<float>(shift);
}

void TreeElimination::send_down(Workspace& ws) {
  for (const Direction face : ws.tree.children()) {
    ws.links.send(Faces::only(face),
                  vector_message(MessageType::kBranchDown, 0, ws.node(0).vector.shift));
    for (std::size_t i = 0; i < child_cut_count(ws, face); ++i) {
      ws.links.send(Faces::only(face),
                    vector_message(MessageType::kBranchDown, static_cast<std::uint8_t>(1 + i),
                                   forces_[slots_of(ws, face)[i]]));
    }
  }
  load_ = {};
}

}  // namespace holdfast::agent
