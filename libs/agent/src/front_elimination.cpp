// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/front_elimination.hpp"

#include "beams.hpp"
#include "displacements.hpp"
#include "facets.hpp"
#include "holdfast/agent/messages.hpp"
#include "scalar.hpp"
#include "stage_load.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;

/// The label of the first message of a child that has no front; else how many nodes follow.
constexpr int kNoFront = 0xff;

/// Room that has to be left in a queue for what follows without asking: a vector and a report; and
/// the exchanges of an iteration (agent.hpp).
constexpr int kReportRoom = wire::kVectorBytes + wire::kPlainBytesMax;

int exchange_room(const Workspace& ws) {
  const int planned = ws.planned.count() > kPlannedMax ? ws.planned.count() : kPlannedMax;
  return (2 * planned + 2) * wire::kVectorBytes;
}

/// In the fourth real of a node's message: faces that are missing, then these.
constexpr unsigned kFixedBit = 1U << 6U;
constexpr unsigned kKeptBit = 1U << 7U;
constexpr unsigned kHeldBit = 1U << 8U;
constexpr unsigned kReleasedBit = 1U << 9U;
constexpr unsigned kFacesMask = kFixedBit - 1;

/// In the fifth two contact states.
constexpr int kCodeBase = mechanics::ContactState::kCodeCount;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::size_t at(Direction face) { return static_cast<std::size_t>(face); }

bool holds_all_over(const Node& node) { return node.is_held && node.state == mechanics::kStuck; }

/// Of its pressure a facet loses so much until it counts as one that holds all over in any case. Of
/// those that are nearer to letting go most do, when others have: kept with the first that do they
/// save batches of one and two. With 0.5, 0.9, 0.95, 0.98 and all of it, of 1,400 random robots the
/// worst takes 33, 30, 30, 30 and 458 sweeps, the fronts of the last being too large for modules.
constexpr double kWeakShare = 0.95;

bool is_weak(const Node& node, const ContactSetting& contact) {
  base::Vec6<double> trial = mechanics::trial_force(contact.facet, node.u);
  trial[2] *= 1 - kWeakShare;
  return node.is_ground && !(mechanics::contact_state(contact.facet, trial) == mechanics::kStuck);
}

base::Vec6<float> packed(const FrontNode& node) {
  const unsigned code = node.missing.mask() | (node.is_fixed ? kFixedBit : 0U) |
                        (node.is_kept ? kKeptBit : 0U) | (node.is_held ? kHeldBit : 0U) |
                        (node.was_released ? kReleasedBit : 0U);
  return {static_cast<float>(node.cell.x),
          static_cast<float>(node.cell.y),
          static_cast<float>(node.cell.z),
          static_cast<float>(code),
          static_cast<float>(node.state.code() + kCodeBase * node.found.code()),
          node.is_doubtful ? 1.0F : 0.0F};
}

/// False: no program of this version sends it.
bool unpack(const base::Vec6<float>& vector, FrontNode& node) {
  constexpr auto kMost = static_cast<float>(base::kCoordinateMax);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(vector[i] >= -kMost && vector[i] <= kMost)) {
      return false;
    }
  }
  if (!(vector[3] >= 0 && vector[3] < 2 * static_cast<float>(kReleasedBit))) {
    return false;
  }
  if (!(vector[4] >= 0 && vector[4] < static_cast<float>(kCodeBase * kCodeBase))) {
    return false;
  }
  const auto code = static_cast<unsigned>(vector[3]);
  const int states = static_cast<int>(vector[4]);
  node = {.cell = {static_cast<std::int32_t>(vector[0]), static_cast<std::int32_t>(vector[1]),
                   static_cast<std::int32_t>(vector[2])},
          .missing = Faces::from_mask(static_cast<std::uint8_t>(code & kFacesMask)),
          .is_fixed = (code & kFixedBit) != 0,
          .is_kept = (code & kKeptBit) != 0,
          .is_held = (code & kHeldBit) != 0,
          .was_released = (code & kReleasedBit) != 0,
          .is_doubtful = vector[5] > 0,
          .state = mechanics::ContactState::from_code(states % kCodeBase),
          .found = mechanics::ContactState::from_code(states / kCodeBase)};
  return true;
}

/// Displacements of kept nodes go up in two parts, as in an exchange.
constexpr int kPartsOfKept = 2;

base::Vec6<float> part_of(const base::Vec6<double>& u, bool is_low) {
  base::Vec6<float> part{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double leading = leading_part(u[i]);
    part[i] = static_cast<float>(is_low ? u[i] - leading : leading);
  }
  return part;
}

/// Puts together what has both its ends in the list.
void join_beams(std::span<FrontNode> nodes) {
  for (FrontNode& node : nodes) {
    for (const Direction face : node.missing) {
      for (FrontNode& other : nodes) {
        if (other.cell == base::neighbour(node.cell, face) &&
            other.missing.has(base::opposite(face))) {
          node.missing.remove(face);
          node.joined.add(face);
          other.missing.remove(base::opposite(face));
          other.joined.add(base::opposite(face));
        }
      }
    }
  }
}

base::Vec6<float> six_from(std::span<const float> reals, std::size_t first) {
  base::Vec6<float> vector{};
  for (std::size_t i = 0; i < 6 && first + i < reals.size(); ++i) {
    vector[i] = reals[first + i];
  }
  return vector;
}

}  // namespace

bool FrontElimination::begin(Workspace& ws, const Order& order, int /*piece*/) {
  if (order.operation == Operation::kBegin) {
    begin_law(ws, order);
    memory_ = ws.front_memory();
  } else if (order.operation == Operation::kFactor) {
    keep_weak(ws);
    factor();
  } else if (order.operation == Operation::kTreeIterate) {
    ws.clear_middle();
    sends_front_ = false;
    for (Below& below : below_) {
      below.loads_here = 0;
    }
    const bool awaits = !ws.tree.is_root() && !has_no_room_;
    down_awaited_ =
        static_cast<std::uint16_t>(awaits ? (front_.rows() - front_.complete_rows()) / 6 : 0);
    begin_piece(Piece::kShifts);
  }
  return false;
}

/// What the regularised law has kept the unilateral one will need too.
void FrontElimination::begin_law(Workspace& ws, const Order& order) {
  PlannedSet kept;
  for (int i = 0; i < ws.node_count(); ++i) {
    if (ws.node(i).is_kept && (order.flags & kUnilateralLaw) != 0) {
      kept.add(i);
    }
  }
  begin_equilibrium(ws, order);
  weak_ = {};
  is_seeking_ = false;
  for (int i = 0; i < ws.node_count(); ++i) {
    ws.node(i).is_kept = kept.has(i);
  }
}

/// Others have let go, so that fronts are made anew.
void FrontElimination::keep_weak(Workspace& ws) {
  for (int i = 0; i < ws.node_count(); ++i) {
    ws.node(i).is_kept = ws.node(i).is_kept || weak_.has(i);
  }
}

bool FrontElimination::expects(const Workspace& ws, const Order& order, Direction face,
                               std::span<const std::uint8_t> message) const {
  if (static_cast<MessageType>(message[0]) == MessageType::kFrontDown) {
    return order.operation == Operation::kTreeIterate && down_awaited_ != 0 &&
           ws.tree.parent().has(face);
  }
  if (static_cast<MessageType>(message[0]) != MessageType::kFrontUp || !ws.reports.awaits(face)) {
    return false;
  }
  const Below& below = below_[at(face)];
  return order.operation == Operation::kFactor
             ? !below.is_known || below.loads_here < below.moving_count ||
                   below.nodes_here < below.node_count
             : order.operation == Operation::kTreeIterate && below.loads_here < below.moving_count;
}

void FrontElimination::take(Workspace& /*ws*/, const Order& order, Direction face,
                            std::span<const std::uint8_t> message) {
  if (static_cast<MessageType>(message[0]) == MessageType::kFrontUp) {
    return take_up(order, face, message);
  }
  const base::Vec6<float> shift = decoded<LabelledVector>(message).vector;
  const int row = front_.rows() - 6 * down_awaited_--;
  for (int i = 0; i < 6; ++i) {
    front_.shift(row + i) = shift[at(i)];
  }
}

/// Displacements in two parts; then contact states follow, and residuals are here. A facet that
/// does not hold all over is kept from now on.
bool FrontElimination::take_exchange(Workspace& ws, const Order& /*order*/, int /*piece*/) {
  add_forces(ws, PlannedPart::kTogether);
  if (ws.exchange.left() == 2) {
    share_low_part(ws);
    await_planned_forces(ws);
    return false;
  }
  weak_ = {};
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    follow_state(node, ws.contact, false);
    node.has_changed = node.is_ground && !node.is_kept && !holds_all_over(node);
    node.is_kept = node.is_kept || node.has_changed;
    if (is_weak(node, ws.contact)) {
      weak_.add(i);
    }
  }
  return false;
}

bool FrontElimination::report(Workspace& ws, const Order& order, int piece, Report& sum) {
  if (order.operation == Operation::kHold) {
    hold_facets(ws, order, sum);
    hold_kept(order);
    return false;
  }
  if (order.operation == Operation::kSeek) {
    Report known;
    seek_facets(ws, order, known);
    is_seeking_ = true;
    if (ws.tree.is_root()) {
      seek_kept(ws, order, sum);
    }
    return false;
  }
  if (order.operation != Operation::kTreeIterate) {
    return false;
  }
  sum.flags = static_cast<std::uint8_t>(sum.flags | (has_no_room_ ? kNoRoom : 0U) |
                                        (has_no_state_ ? kNoState : 0U));
  return iteration_report(ws, piece, sum);
}

/// The root's do what they do where they are, so that no front has to be made anew.
void FrontElimination::hold_kept(const Order& order) {
  if (kept_count_ == 0) {
    return;
  }
  Report known;
  for (KeptFacet& facet : memory_->kept.first(kept_count_)) {
    hold_facet(facet, (order.flags & kFreeOpen) != 0, known);
  }
}

/// The root knows all facets that may differ, as those that hold all over do not, and tries them
/// where they are: only those that lead elsewhere are worth an order.
void FrontElimination::seek_kept(const Workspace& ws, const Order& order, Report& sum) {
  if (kept_count_ == 0) {
    return;
  }
  const std::span<KeptFacet> kept = memory_->kept.first(kept_count_);
  if ((order.flags & kRemember) != 0) {
    for (KeptFacet& facet : kept) {
      facet.found = facet.state;
    }
    FrontContact contact(ws.contact.facet, front_, kept, memory_->contact);
    for (std::size_t k = 0; k < kept.size(); ++k) {
      kept[k].is_doubtful =
          is_doubtful(ws.contact, kept[k].found, kept[k].u) && contact.leads_elsewhere(k);
    }
  }
  for (KeptFacet& facet : kept) {
    const bool is_tried = facet.is_doubtful && facet.key == order.key();
    facet.state = is_tried ? mechanics::ContactState{.pressed = !facet.found.pressed} : facet.found;
    if (facet.is_doubtful) {
      ++sum.count;
      const bool is_next = facet.key > order.key() && (sum.number == 0 || facet.key < sum.number);
      sum.number = is_next ? facet.key : sum.number;
    }
  }
}

void FrontElimination::begin_piece(Piece piece) {
  piece_ = piece;
  index_ = 0;
}

bool FrontElimination::do_piece(Workspace& ws, const Order& /*order*/) {
  if (ws.exchange.is_under_way()) {
    return false;
  }
  switch (piece_) {
    case Piece::kNone:
      return false;
    case Piece::kAssemble:
      if (!ws.reports.are_here()) {
        return false;
      }
      assemble(ws);
      return true;
    case Piece::kRows:
      factor_row(ws);
      return true;
    case Piece::kLoads:
      if (!ws.reports.are_here()) {
        return false;
      }
      find_loads(ws);
      return true;
    case Piece::kSendUp:
      return send_up(ws);
    case Piece::kShifts:
      if (down_awaited_ != 0) {
        return false;
      }
      find_shifts(ws);
      return true;
    case Piece::kSendShifts:
      return send_shifts(ws);
    case Piece::kMove:
      return move(ws);
  }
  return false;
}

// ---- What comes from a child.

void FrontElimination::take_up(const Order& order, Direction face,
                               std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  Below& below = below_[at(face)];
  if (order.operation == Operation::kFactor && !below.is_known) {
    take_first(below, in.label);
    if (below.node_count == 0) {
      return;
    }
  }
  if (below.nodes_here < below.node_count) {
    take_node(below, in.vector);
  } else if (below.kept_here < kPartsOfKept * below.kept_count) {
    take_kept(below, in.vector);
  } else if (below.vectors_here < triangle_vectors(6 * below.moving_count)) {
    take_vector(below.matrix, at(below.vectors_here++), in.vector);
  } else {
    take_vector(below.loads, below.loads_here++, in.vector);
  }
}

void FrontElimination::take_first(Below& below, int label) {
  below.is_known = true;
  below.has_room = label != kNoFront;
  below.node_count = static_cast<std::uint16_t>(label == kNoFront ? 0 : label + 1);
  below.nodes = memory_->take_nodes(below.node_count);
  below.has_room = below.has_room && below.nodes.size() == below.node_count;
}

void FrontElimination::take_node(Below& below, const base::Vec6<float>& vector) {
  FrontNode node;
  below.has_room = unpack(vector, node) && below.has_room;
  if (below.has_room) {
    below.nodes[below.nodes_here] = node;
  }
  ++below.nodes_here;
  below.moving_count = static_cast<std::uint16_t>(below.moving_count + (node.is_fixed ? 0 : 1));
  below.kept_count = static_cast<std::uint16_t>(below.kept_count + (node.is_kept ? 1 : 0));
  if (below.nodes_here < below.node_count) {
    return;
  }
  const std::size_t rows = 6 * std::size_t{below.moving_count};
  const std::span<float> reals = memory_->take_reals(triangle_reals(rows) + rows);
  below.has_room = below.has_room && (!reals.empty() || rows == 0);
  if (below.has_room) {
    below.loads = reals.first(rows);
    below.matrix = reals.subspan(rows);
  }
}

void FrontElimination::take_kept(Below& below, const base::Vec6<float>& vector) {
  int k = below.kept_here++ % below.kept_count;
  for (FrontNode& node : below.nodes) {
    if (node.is_kept && k-- == 0) {
      base::add_to(node.u, base::converted<double>(vector));
    }
  }
}

/// The `index`-th six of `into`, which is empty where there is no room.
void FrontElimination::take_vector(std::span<float> into, std::size_t index,
                                   const base::Vec6<float>& vector) {
  for (std::size_t i = 0; i < 6 && 6 * index + i < into.size(); ++i) {
    into[6 * index + i] = vector[i];
  }
}

// ---- The front.

void FrontElimination::factor() {
  below_ = {};
  front_ = {};
  kept_count_ = 0;
  has_no_room_ = false;
  has_no_state_ = false;
  sends_front_ = true;
  memory_->clear();
  begin_piece(Piece::kAssemble);
}

/// All children's fronts are here.
void FrontElimination::assemble(Workspace& ws) {
  if (!make_front(ws)) {
    return give_up(ws);
  }
  for (const Direction face : ws.tree.children()) {
    add_below(below_[at(face)]);
  }
  add_beams(ws);
  add_facets(ws);
  begin_piece(Piece::kRows);
}

/// The nodes of all children, of this module and of those that it emulates.
bool FrontElimination::make_front(Workspace& ws) {
  std::size_t count = at(ws.node_count());
  for (const Direction face : ws.tree.children()) {
    const Below& below = below_[at(face)];
    if (!below.is_known || !below.has_room || below.nodes_here < below.node_count ||
        below.loads_here < below.moving_count) {
      return false;
    }
    count += below.node_count;
  }
  const std::span<FrontNode> nodes = memory_->take_nodes(count);
  if (nodes.empty()) {
    return false;
  }
  std::size_t next = 0;
  for (const Direction face : ws.tree.children()) {
    for (const FrontNode& node : below_[at(face)].nodes) {
      nodes[next++] = node;
    }
  }
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    nodes[next++] = {.cell = ws.cell_of(i),
                     .missing = ws.faces_of(i),
                     .is_fixed = node.is_fixed,
                     .is_kept = node.is_kept,
                     .is_held = node.is_held,
                     .was_released = node.was_released,
                     .is_doubtful = node.is_doubtful,
                     .state = node.state,
                     .found = node.found,
                     .u = node.u};
  }
  join_beams(nodes);
  return front_.make(nodes, *memory_) &&
         front_.nodes().size() - front_.complete_count() < kNoFront &&
         (!ws.tree.is_root() || take_kept_facets(ws));
}

/// What the root keeps of facets; nothing else is left of its front.
bool FrontElimination::take_kept_facets(const Workspace& ws) {
  const std::span<const FrontNode> rest = front_.nodes().subspan(front_.complete_count());
  if (rest.size() > memory_->kept.size() || contact_reals(rest.size()) > memory_->contact.size()) {
    return false;
  }
  for (const FrontNode& node : rest) {
    if (!node.is_kept || node.is_fixed) {
      return false;
    }
    memory_->kept[kept_count_++] = {.u = node.u,
                                    .state = is_seeking_ ? node.state : mechanics::kStuck,
                                    .is_held = node.is_held,
                                    .was_held = node.is_held,
                                    .was_released = node.was_released,
                                    .found = node.found,
                                    .is_doubtful = node.is_doubtful,
                                    .key = seek_key(from_root(ws, node.cell), 0)};
  }
  return true;
}

/// The first row of the node in a cell; -1 if it has none.
int FrontElimination::row_at(const base::Cell& cell) const {
  for (std::size_t i = 0; i < front_.nodes().size(); ++i) {
    if (front_.nodes()[i].cell == cell) {
      return front_.row_of(i);
    }
  }
  return -1;
}

/// A child's matrix.
void FrontElimination::add_below(const Below& below) {
  std::size_t next = 0;
  int row_count = 0;
  for (const FrontNode& node : below.nodes) {
    if (node.is_fixed) {
      continue;
    }
    const int row = row_at(node.cell);
    for (int i = 0; i < 6; ++i) {
      int column_count = 0;
      for (const FrontNode& other : below.nodes) {
        if (other.is_fixed || column_count > row_count) {
          continue;
        }
        const int column = row_at(other.cell);
        const int last = column_count == row_count ? i : 5;
        for (int j = 0; j <= last; ++j) {
          front_.add(row + i, column + j, below.matrix[next++]);
        }
        ++column_count;
      }
    }
    ++row_count;
  }
}

void FrontElimination::add_beams(const Workspace& ws) {
  for (const FrontNode& node : front_.nodes()) {
    const int row = row_at(node.cell);
    for (const Direction face : node.joined) {
      if (row < 0) {
        continue;
      }
      front_.add_block(row, row, mechanics::block_11(ws.setup.beam, face));
      const int column = row_at(base::neighbour(node.cell, face));
      if (base::index(face) % 2 == 0 && column >= 0) {
        front_.add_block(row, column, mechanics::block_12(ws.setup.beam, face));
      }
    }
  }
}

/// Facets of nodes here that hold all over.
void FrontElimination::add_facets(const Workspace& ws) {
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    if (node.is_ground && !node.is_kept) {
      const int row = row_at(ws.cell_of(i));
      front_.add_block(row, row,
                       mechanics::contact_tangent(ws.contact.facet, node.state, node.is_held));
    }
  }
}

void FrontElimination::factor_row(const Workspace& ws) {
  if (index_ >= front_.rows()) {
    begin_piece(Piece::kLoads);
  } else if (!front_.factor_row(index_++)) {
    give_up(ws);
  }
}

/// There is no front here.
void FrontElimination::give_up(const Workspace& ws) {
  has_no_room_ = true;
  front_ = {};
  begin_piece(ws.tree.is_root() ? Piece::kNone : Piece::kSendUp);
}

/// The residuals here join the loads from below.
void FrontElimination::find_loads(const Workspace& ws) {
  begin_piece(ws.tree.is_root() ? Piece::kNone : Piece::kSendUp);
  if (has_no_room_) {
    return;
  }
  front_.clear_loads();
  const auto add = [this](const base::Cell& cell, const base::Vec6<float>& load) {
    const int row = row_at(cell);
    for (int i = 0; i < 6 && row >= 0; ++i) {
      front_.load(row + i) += load[at(i)];
    }
  };
  for (const Direction face : ws.tree.children()) {
    std::size_t next = 0;
    for (const FrontNode& node : below_[at(face)].nodes) {
      if (!node.is_fixed) {
        add(node.cell, six_from(below_[at(face)].loads, 6 * next++));
      }
    }
  }
  for (int i = 0; i < ws.node_count(); ++i) {
    add(ws.cell_of(i), base::converted<float>(residual(ws, i)));
  }
  front_.condense_loads();
}

// ---- What goes up.

/// As many messages as the link has room for.
bool FrontElimination::send_up(Workspace& ws) {
  const Direction parent = ws.tree.parent().first();
  bool has_sent = false;
  while (ws.links.has_long_room(parent, wire::kVectorBytes + kReportRoom)) {
    base::Vec6<float> vector{};
    int label = 0;
    if (!find_vector_up(index_, vector, label)) {
      begin_piece(Piece::kNone);
      return true;
    }
    ++index_;
    has_sent = true;
    ws.links.send(ws.tree.parent(),
                  vector_message(MessageType::kFrontUp, static_cast<std::uint8_t>(label), vector));
  }
  return has_sent;
}

/// The `index`-th message to the parent; false behind the last one.
bool FrontElimination::find_vector_up(int index, base::Vec6<float>& vector, int& label) const {
  if (has_no_room_) {
    label = kNoFront;
    return index == 0 && sends_front_;
  }
  const int rows = front_.rows() - front_.complete_rows();
  if (sends_front_) {
    const std::span<const FrontNode> nodes = front_.nodes().subspan(front_.complete_count());
    const int node_count = static_cast<int>(nodes.size());
    if (index < node_count) {
      label = node_count - 1 - index;
      vector = packed(nodes[at(index)]);
      return true;
    }
    index -= node_count;
    for (const bool is_low : {false, true}) {
      for (const FrontNode& node : nodes) {
        if (node.is_kept && index-- == 0) {
          vector = part_of(node.u, is_low);
          return true;
        }
      }
    }
    if (index < triangle_vectors(rows)) {
      for (int i = 0; i < 6; ++i) {
        vector[at(i)] = front_.element_left(6 * index + i);
      }
      return true;
    }
    index -= triangle_vectors(rows);
  }
  for (int i = 0; i < 6 && 6 * index < rows; ++i) {
    vector[at(i)] = front_.load(front_.complete_rows() + 6 * index + i);
  }
  return 6 * index < rows;
}

// ---- What comes down.

void FrontElimination::find_shifts(const Workspace& ws) {
  if (!has_no_room_ && ws.tree.is_root() && kept_count_ > 0) {
    FrontContact contact(ws.contact.facet, front_, memory_->kept.first(kept_count_),
                         memory_->contact);
    has_no_state_ = !contact.solve();
  }
  if (!has_no_room_) {
    front_.find_shifts();
  }
  begin_piece(Piece::kSendShifts);
}

base::Vec6<float> FrontElimination::shift_of(const base::Cell& cell) const {
  const int row = has_no_room_ ? -1 : row_at(cell);
  base::Vec6<float> shift{};
  for (int i = 0; i < 6 && row >= 0; ++i) {
    shift[at(i)] = front_.shift(row + i);
  }
  return shift;
}

/// To every child the shifts of the nodes that it has sent; zeros where there is no answer.
bool FrontElimination::send_shifts(Workspace& ws) {
  int index = index_;
  for (const Direction face : ws.tree.children()) {
    const Below& below = below_[at(face)];
    if (index >= below.moving_count) {
      index -= below.moving_count;
      continue;
    }
    if (!ws.links.has_long_room(face, wire::kVectorBytes + kReportRoom)) {
      return false;
    }
    base::Vec6<float> shift{};
    for (const FrontNode& node : below.nodes) {
      if (!node.is_fixed && index-- == 0) {
        shift = shift_of(node.cell);
      }
    }
    ws.links.send(Faces::only(face), vector_message(MessageType::kFrontDown, 0, shift));
    ++index_;
    return true;
  }
  begin_piece(Piece::kMove);
  return true;
}

/// Where planned modules are emulated further up, the two exchanges of an iteration must not mix: a
/// host begins the second one when it has all forces of the first.
void FrontElimination::await_planned_forces(Workspace& ws) {
  constexpr int kParts = 2;
  int awaited = 0;
  for (int k = 0; k < ws.planned.count(); ++k) {
    for (const Direction child : ws.tree.children()) {
      awaited += ws.planned.is_needed_below(child, k) ? kParts : 0;
    }
  }
  ws.planned_exchange.await_forces(awaited);
}

/// All nodes here move, and the exchanges begin; they ask for no room on the way.
bool FrontElimination::move(Workspace& ws) {
  for (const Direction face : ws.tree.children()) {
    if (!ws.links.has_room(face, exchange_room(ws))) {
      return false;
    }
  }
  for (int i = 0; i < ws.node_count(); ++i) {
    Node& node = ws.node(i);
    base::add_to(node.u, base::converted<double>(shift_of(ws.cell_of(i))));
    share_high_part(node);
  }
  await_planned_forces(ws);
  ws.start_exchange(PlannedPart::kTogether);
  begin_piece(Piece::kLoads);
  return true;
}

}  // namespace holdfast::agent
