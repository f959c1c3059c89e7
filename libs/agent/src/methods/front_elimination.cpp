// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/front_elimination.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/beams.hpp"
#include "equilibrium/displacements.hpp"
#include "equilibrium/stage_load.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "methods/front_codec.hpp"
#include "world/facets.hpp"

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

std::size_t at(int index) { return static_cast<std::size_t>(index); }

std::size_t at(Direction face) { return static_cast<std::size_t>(face); }

bool holds_all_over(const Node& node) {
  const Surroundings* surroundings = surroundings_of(node);
  return surroundings != nullptr ? surrounded::hold_all_over(*surroundings)
                                 : node.is_held && node.state == mechanics::kStuck;
}

/// A facet loses so much of its pressure until it counts as one that holds all over in any case. Of
/// those that are nearer to letting go most do, when others have: kept with the first that do they
/// save batches of one and two. With 0.5, 0.9, 0.95, 0.98 and all of it, of 1,400 random robots the
/// worst takes 33, 30, 30, 30 and 458 sweeps, the fronts of the last being too large for modules.
constexpr double kWeakShare = 0.95;

/// Are the states that the law prescribes others than those in use?
bool wants_others(Node& node, const ContactSetting& contact) {
  Surroundings* surroundings = surroundings_of(node);
  return surroundings != nullptr &&
         surrounded::look_up_states(*surroundings, contact, node.u, kPressureTieEliminated);
}

bool is_weak(const Node& node, const ContactSetting& contact) {
  if (const Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
    return surrounded::is_any_weak(*surroundings, contact, node.u, kWeakShare);
  }
  base::Vec6<double> trial = mechanics::trial_force(contact.facet, node.u);
  trial[2] *= 1 - kWeakShare;
  return node.is_ground && !(mechanics::contact_state(contact.facet, trial) == mechanics::kStuck);
}

/// Puts together what has both its ends in the list.
void join_beams(const Workspace& ws, std::span<FrontNode> nodes) {
  for (FrontNode& node : nodes) {
    for (const Direction face : node.missing) {
      for (FrontNode& other : nodes) {
        if (other.cell == ws.beside(node.cell, face) && other.missing.has(base::opposite(face))) {
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
    memory_->has_low_parts = ws.environment() != nullptr && !ws.environment()->is_level;
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
  gives_states_ = false;
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
    if (gives_states_) {
      node.has_changed = wants_others(node, ws.contact);
      continue;
    }
    if (surroundings_of(node) != nullptr) {
      follow_states_at(node, ws.contact, node.u);
    } else {
      follow_state(node, ws.contact, false);
    }
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
    seek(ws, order, sum);
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
  Report known;
  for (KeptNode& node : kept()) {
    visit_facets(
        node, [&](auto& facet, int) { hold_facet(facet, (order.flags & kFreeOpen) != 0, known); });
  }
}

std::span<KeptNode> FrontElimination::kept() const {
  return kept_count_ == 0 ? std::span<KeptNode>() : memory_->kept.first(kept_count_);
}

/// The root knows all facets that may differ, as those that hold all over do not. Where all states
/// of all facets are gone through, every facet that can let go is kept from now on.
void FrontElimination::seek(Workspace& ws, const Order& order, Report& sum) {
  const bool names_all = order.flags == kEachState || (order.flags & kOneFoot) != 0;
  Report known;
  seek_facets(ws, order, names_all ? sum : known);
  is_seeking_ = true;
  gives_states_ = order.flags == kEachState;
  for (int i = 0; i < ws.node_count() && names_all; ++i) {
    Node& node = ws.node(i);
    const Surroundings* surroundings = surroundings_of(node);
    const bool can_let_go = surroundings == nullptr || !surrounded::is_all_bonded(*surroundings);
    node.is_kept = node.is_kept || (node.is_ground && can_let_go);
  }
  if (!names_all) {
    return seek_kept(ws, order, sum);
  }
  for (KeptNode& node : kept()) {
    if (Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
      surrounded::seek_facets(*surroundings, ws.contact, node.u, node.cell, order, known);
    }
  }
}

/// The root, on a level floor, tries facets where they are: only those that lead elsewhere are
/// worth an order. Elsewhere a robot may hang on weak springs, and single precision of S does not
/// tell.
void FrontElimination::seek_kept(const Workspace& ws, const Order& order, Report& sum) {
  if ((order.flags & kRemember) != 0) {
    for (KeptNode& node : kept()) {
      visit_facets(node, [](auto& facet, int) { facet.found = facet.state; });
    }
    FrontContact contact(ws.contact, front_, kept(), memory_->contact);
    const bool is_level = ws.environment() == nullptr || ws.environment()->is_level;
    for (std::size_t k = 0; k < kept().size(); ++k) {
      KeptNode& node = kept()[k];
      visit_facets(node, [&](auto& facet, int index) {
        const base::Vec6<double> u = facet_displacement(node, index, node.u);
        facet.is_doubtful = is_doubtful(ws.contact, facet.found, u) &&
                            (!is_level || contact.leads_elsewhere(k, index));
      });
    }
  }
  for (KeptNode& node : kept()) {
    visit_facets(node, [&](auto& facet, int index) {
      const std::uint32_t key = seek_key(node.cell, index);
      const bool is_tried = facet.is_doubtful && key == order.key();
      facet.state = is_tried ? other_state(facet.found) : facet.found;
      if (facet.is_doubtful) {
        offer_key(key, order, sum);
      }
    });
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
  } else if (below.states_here < below.states_count) {
    take_facets(below, in.vector);
  } else if (below.vectors_here < matrix_parts() * triangle_vectors(6 * below.moving_count)) {
    const int high_count = triangle_vectors(6 * below.moving_count);
    const int index = below.vectors_here++;
    const bool is_low = index >= high_count;
    take_vector(is_low ? below.low : below.matrix, at(is_low ? index - high_count : index),
                in.vector);
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
  below.states_count = static_cast<std::uint16_t>(below.states_count + state_vectors(node));
  if (below.nodes_here < below.node_count) {
    return;
  }
  const std::size_t rows = 6 * std::size_t{below.moving_count};
  const std::size_t triangle = triangle_reals(rows);
  const std::span<float> reals = memory_->take_reals(rows + at(matrix_parts()) * triangle);
  below.has_room = below.has_room && (!reals.empty() || rows == 0);
  if (below.has_room) {
    below.loads = reals.first(rows);
    below.matrix = reals.subspan(rows, triangle);
    below.low = reals.subspan(rows + triangle);
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

void FrontElimination::take_facets(Below& below, const base::Vec6<float>& vector) {
  int part = below.states_here++;
  for (FrontNode& node : below.nodes) {
    if (part >= 0 && part < state_vectors(node)) {
      take_states(vector, part, node);
    }
    part -= state_vectors(node);
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
    FrontNode& own = nodes[next++];
    own = {.cell = ws.cell_of(i),
           .missing = ws.faces_of(i),
           .is_fixed = node.is_fixed,
           .is_kept = node.is_kept,
           .is_held = node.is_held,
           .was_released = node.was_released,
           .is_doubtful = node.is_doubtful,
           .state = node.state,
           .found = node.found,
           .u = node.u};
    if (const Surroundings* surroundings = surroundings_of(node); surroundings != nullptr) {
      own.facet_count = surroundings->facet_count;
      for (std::size_t k = 0; k < own.facet_count; ++k) {
        own.facets[k] = packed_state(surroundings->facets[k]);
      }
    }
  }
  join_beams(ws, nodes);
  return front_.make(nodes, *memory_) &&
         front_.nodes().size() - front_.complete_count() < kNoFront &&
         (!ws.tree.is_root() || take_kept_nodes(ws));
}

/// What the root keeps; nothing else is left of its front.
bool FrontElimination::take_kept_nodes(const Workspace& ws) {
  const std::span<const FrontNode> rest = front_.nodes().subspan(front_.complete_count());
  if (rest.size() > memory_->kept.size() || contact_reals(rest.size()) > memory_->contact.size()) {
    return false;
  }
  for (const FrontNode& node : rest) {
    if (!node.is_kept || node.is_fixed) {
      return false;
    }
    KeptNode& kept = memory_->kept[kept_count_];
    kept = {.u = node.u,
            .state = node.state,
            .is_held = node.is_held,
            .was_released = node.was_released,
            .found = node.found,
            .is_doubtful = node.is_doubtful,
            .cell = from_root(ws, node.cell)};
    if (!take_surroundings(ws, node, kept)) {
      return false;
    }
    kept.force = facet_force(kept, ws.contact, kept.u);
    visit_facets(kept, [this](auto& facet, int) {
      facet.state = is_seeking_ ? facet.state : mechanics::kStuck;
    });
    ++kept_count_;
  }
  return true;
}

/// What a kept node touches is known before the robot is built, in which states is what was sent.
/// False: no program of this version sends that, or there is no memory.
bool FrontElimination::take_surroundings(const Workspace& ws, const FrontNode& node,
                                         KeptNode& kept) {
  const Environment* environment = ws.environment();
  if (environment == nullptr) {
    return node.facet_count == 0;
  }
  if (kept_count_ >= memory_->touching.size()) {
    return false;
  }
  Surroundings& surroundings = memory_->touching[kept_count_];
  surroundings = {.environment = environment};
  environment->describe(environment->map, node.cell, surroundings);
  for (std::size_t k = 0; k < surroundings.facet_count; ++k) {
    unpack_state(node.facets[k], surroundings.facets[k]);
  }
  kept.surroundings = &surroundings;
  return surroundings.facet_count == node.facet_count;
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
          const double low = below.low.empty() ? 0 : static_cast<double>(below.low[next]);
          front_.add(row + i, column + j, static_cast<double>(below.matrix[next++]) + low);
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
      front_.add_block(row, row, block_11(ws.setup.beams(), face));
      const int column = row_at(ws.beside(node.cell, face));
      if (base::index(face) % 2 == 0 && column >= 0) {
        front_.add_block(row, column, block_12(ws.setup.beams(), face));
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
      front_.add_block(row, row, facet_tangent(node, ws.contact));
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

/// Sends as many messages as the link has room for.
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
    for (const FrontNode& node : nodes) {
      if (index < state_vectors(node)) {
        vector = states_of(node, index);
        return true;
      }
      index -= state_vectors(node);
    }
    for (int part = 0; part < matrix_parts(); ++part) {
      if (index < triangle_vectors(rows)) {
        for (int i = 0; i < 6; ++i) {
          vector[at(i)] = front_.element_left(6 * index + i, part > 0);
        }
        return true;
      }
      index -= triangle_vectors(rows);
    }
  }
  for (int i = 0; i < 6 && 6 * index < rows; ++i) {
    vector[at(i)] = front_.load(front_.complete_rows() + 6 * index + i);
  }
  return 6 * index < rows;
}

// ---- What comes down.

void FrontElimination::find_shifts(const Workspace& ws) {
  if (!has_no_room_ && ws.tree.is_root() && kept_count_ > 0) {
    FrontContact contact(ws.contact, front_, kept(), memory_->contact);
    has_no_state_ = !(gives_states_ ? contact.solve_given() : contact.solve());
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

/// Sends to every child the shifts of the nodes that it has sent; zeros where there is no answer.
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
