// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/rigid_clusters.hpp"

#include "groups/leaves.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "methods/minimal_residuals.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;

/// Largest distance from a cluster's top in each direction: clusters are 8 long, but for that of
/// the root. 6 are better for frames 4 modules thick, but plates 8 wide fall apart; and so they do
/// if only the root's cluster is smaller.
constexpr int kClusterReach = 7;

/// A bit in the label of a load: it comes from within a cluster that stands still.
constexpr std::uint8_t kHeld = 1;

/// What a module shares of its choice: the cells of its top and of its parent's cluster's top, from
/// the root's cell, in the first number also the face of the parent.
struct Choice {
  base::Cell top;
  base::Cell parent_top;
  int parent_face = kNoFace;

  static constexpr int kNoFace = 7;
};

// A cell is at most twice kCoordinateMax from the root, and all numbers have to be whole ones of
// binary32.
static_assert(8 * 2 * base::kCoordinateMax + Choice::kNoFace < std::int32_t{1} << 24);
static_assert(Choice::kNoFace < 8 && base::kDirectionCount <= Choice::kNoFace);

base::Vec6<float> encoded(const Choice& choice) {
  return {static_cast<float>(8 * choice.top.x + choice.parent_face),
          static_cast<float>(choice.top.y),
          static_cast<float>(choice.top.z),
          static_cast<float>(choice.parent_top.x),
          static_cast<float>(choice.parent_top.y),
          static_cast<float>(choice.parent_top.z)};
}

/// Numbers that no choice has are 0: what a vector says is nowhere checked.
Choice choice_in(const base::Vec6<float>& vector) {
  constexpr float kMost = 16 * base::kCoordinateMax + 8;
  const auto number = [&](std::size_t i) {
    const bool is_good = vector[i] >= -kMost && vector[i] <= kMost;
    return is_good ? static_cast<std::int32_t>(vector[i]) : std::int32_t{0};
  };
  const std::int32_t first = number(0);
  return {.top = {first >> 3, number(1), number(2)},
          .parent_top = {number(3), number(4), number(5)},
          .parent_face = static_cast<int>(first & 7)};
}

/// May the module at `cell` join the cluster with this top?
bool may_join(const base::Cell& cell, const base::Cell& top) {
  const auto is_within = [](std::int32_t d) { return -kClusterReach <= d && d <= kClusterReach; };
  return is_within(cell.x - top.x) && is_within(cell.y - top.y) && is_within(cell.z - top.z);
}

/// Does the order's iteration have clusters between two polynomials?
bool has_clusters(const Order& order) {
  return order.operation == Operation::kIterate && (order.flags & kWithClusters) != 0;
}

}  // namespace

PlannedPart RigidClusters::planned_part(const Workspace& ws, const Order& order) {
  return part_in_iteration(ws, order);
}

Pending RigidClusters::pending() const {
  switch (piece_) {
    case Piece::kNone:
      return Pending::kNothing;
    case Piece::kChoose:
    case Piece::kJoin:
      return Pending::kBeforeReport;
    default:
      return Pending::kBehindReport;
  }
}

bool RigidClusters::begin(Workspace& ws, const Order& order, int piece) {
  MinimalResiduals iteration(ws, order, memory_, rho_);
  if (order.operation == Operation::kClusters) {
    piece_ = Piece::kChoose;
    return iteration.begin(piece);
  }
  if (piece == 0 && has_clusters(order)) {
    // Children add theirs as they come.
    cluster_.clear();
    awaited_ = children_;
    is_shift_here_ = ws.tree.is_root();
  }
  return iteration.move(piece);
}

void RigidClusters::take(Workspace& ws, const Order& order, Direction face,
                         std::span<const std::uint8_t> message) {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kColumn:
      return take_part(order, face, message);
    case MessageType::kBranchUp:
      return take_load(face, message);
    default:
      return take_shift(ws, message);
  }
}

/// Behind the report of an iteration with clusters come the first polynomial and its image, the
/// clusters' displacements, the second polynomial.
bool RigidClusters::take_exchange(Workspace& ws, const Order& order, int piece) {
  MinimalResiduals iteration(ws, order, memory_, rho_);
  const int left = ws.exchange.left();
  const int degree = order.count;
  if (ws.exchange.left_before_report() > 0) {
    if (order.operation == Operation::kIterate) {
      return iteration.take_displacements(piece);
    }
    meet_neighbours(ws);
    iteration.start_terms();
    return false;
  }
  if (!has_clusters(order) || left > degree + 2 || left <= degree) {
    return iteration.take_term(piece);
  }
  iteration.subtract_beams();
  iteration.subtract_facets();
  if (left == degree + 2) {
    piece_ = Piece::kStiffness;
  } else {
    iteration.first_terms();
  }
  return false;
}

bool RigidClusters::do_piece(Workspace& ws, const Order& order) {
  switch (piece_) {
    case Piece::kNone:
      return false;
    case Piece::kChoose:
      return choose(ws);
    case Piece::kJoin:
      return send_joint(ws);
    case Piece::kStiffness:
      return send_stiffness(ws, order);
    case Piece::kLoad:
      return send_load(ws);
    case Piece::kShift:
      return shift(ws, order);
  }
  return false;
}

bool RigidClusters::report(Workspace& ws, const Order& order, int piece, Report& sum) {
  if (order.operation == Operation::kIterate) {
    return MinimalResiduals(ws, order, memory_, rho_).report(piece, sum);
  }
  sum.count = beam_count_;
  sum.number = stray_count_;
  return false;
}

// ---- Which clusters there are.

bool RigidClusters::choose(Workspace& ws) {
  if (!ws.exchange.is_next_complete(ws.tree.nearer())) {
    return false;
  }
  const base::Cell& own = ws.tree.cell();
  const base::Cell& root = ws.tree.root_cell();
  const base::Cell here = {own.x - root.x, own.y - root.y, own.z - root.z};
  Choice choice{.top = here, .parent_top = here};
  for (const Direction face : ws.tree.nearer()) {
    const Choice theirs = choice_in(ws.exchange.next_vector(ws.links.more(), face));
    if (may_join(here, theirs.top)) {
      choice = {
          .top = theirs.top, .parent_top = theirs.parent_top, .parent_face = base::index(face)};
      parent_ = Faces::only(face);
      break;
    }
    if (parent_.is_empty()) {
      choice = {.top = here, .parent_top = theirs.top, .parent_face = base::index(face)};
      parent_ = Faces::only(face);
    }
  }
  ws.node(0).vector.sent = encoded(choice);
  piece_ = Piece::kNone;
  ws.start_exchange(ws.planned.is_any_remote() ? PlannedPart::kApart : PlannedPart::kTogether);
  return true;
}

/// All choices are here: who is what.
void RigidClusters::meet_neighbours(const Workspace& ws) {
  const Choice own = choice_in(ws.node(0).vector.sent);
  for (const Direction face : ws.links.used()) {
    const Choice theirs = choice_in(ws.exchange.vector(ws.links.more(), face));
    const bool is_child = theirs.parent_face == base::index(base::opposite(face));
    const bool is_member = theirs.top == own.top;
    if (is_child) {
      children_.add(face);
    }
    if (is_child && is_member) {
      awaited_.set(face, !awaited_.has(face));  // What it sends may be here already.
    }
    is_top_ = is_top_ && !(parent_.has(face) && is_member);
    if (!is_member && !(theirs.parent_top == own.top)) {
      cluster_.add_to_joint(mechanics::block_11(ws.setup.beam, face));
      ++beam_count_;
      if (!(theirs.top == own.parent_top)) {
        ++stray_count_;
      }
    }
  }
  piece_ = Piece::kJoin;
}

/// The joint so far goes to the parent, or ends here.
bool RigidClusters::send_joint(Workspace& ws) {
  if (!awaited_.is_empty()) {
    return false;
  }
  piece_ = Piece::kNone;
  if (!is_top_) {
    Cluster::Parts parts;
    cluster_.find_joint_up(joint_to_parent(ws), parts);
    send_parts(ws, parts);
  } else if (!ws.tree.is_root()) {
    cluster_.close_joint();
  }
  return true;
}

// ---- Their exact solve.

Joint RigidClusters::joint_to_parent(const Workspace& ws) const {
  return {ws.setup.beam, parent_.first()};
}

void RigidClusters::send_parts(Workspace& ws, const Cluster::Parts& parts) const {
  for (int i = 0; i < Branch::kPartCount; ++i) {
    ws.links.send(parent_, vector_message(MessageType::kColumn,
                                          static_cast<std::uint8_t>(Branch::kColumnCount + i),
                                          parts[static_cast<std::size_t>(i)]));
  }
}

void RigidClusters::take_part(const Order& order, Direction face,
                              std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int part = in.label - Branch::kColumnCount;
  if (part < 0 || part >= Branch::kPartCount) {
    return;
  }
  if (order.operation == Operation::kIterate) {
    cluster_.add_stiffness(part, in.vector);
    return;
  }
  cluster_.add_to_joint(part, in.vector);
  if (part + 1 == Branch::kPartCount) {
    awaited_.set(face, !awaited_.has(face));
  }
}

/// A child's load: all that comes from it.
void RigidClusters::take_load(Direction face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  if (in.label == kHeld) {
    cluster_.hold();
  }
  cluster_.add_load(base::converted<double>(in.vector));
  awaited_.remove(face);
}

/// What the first polynomial leaves here is part of the cluster's load. Planned modules emulated
/// here belong to this one's cluster.
void RigidClusters::add_own(const Workspace& ws, int node_count) {
  if (ws.node(0).is_fixed) {
    cluster_.hold();
  }
  const Leaves leaves = leaves_of(ws.planned);
  for (int i = 0; i < node_count; ++i) {
    const Node& node = ws.node(i);
    base::Vec6<double> load = memory_[static_cast<std::size_t>(i)].vectors.w;
    base::Mat6<double> stiffness;
    if (node.is_ground) {
      stiffness = symmetric_facet_tangent(node, ws.contact);
    }
    // From leaf to leaf to this module.
    int at = i;
    for (int k = leaves.count - 1; k >= 0 && at > 0; --k) {
      const auto leaf = static_cast<std::size_t>(k);
      if (leaves.node[leaf] == at) {
        const Joint joint(ws.setup.beam, leaves.to_parent[leaf]);
        joint.hand_on(load);
        stiffness = carried(joint, stiffness);
        at = leaves.parent[leaf];
      }
    }
    cluster_.add_load(load);
    if (node.is_ground) {
      cluster_.add_stiffness(stiffness);
    }
  }
}

bool RigidClusters::send_stiffness(Workspace& ws, const Order& order) {
  if (!awaited_.is_empty()) {
    return false;
  }
  add_own(ws, MinimalResiduals(ws, order, memory_, rho_).node_count());
  const bool is_hidden = cluster_.is_held() && !is_top_;
  if (!ws.tree.is_root() && !cluster_.is_free() && !is_hidden) {
    Cluster::Parts parts;
    cluster_.find_stiffness_up(joint_to_parent(ws), is_top_, parts);
    send_parts(ws, parts);
  }
  piece_ = Piece::kLoad;
  return true;
}

bool RigidClusters::send_load(Workspace& ws) {
  piece_ = Piece::kShift;
  if (ws.tree.is_root()) {
    base::Vec6<double> shift;
    cluster_.find_displacement_of_root(shift);
    ws.node(0).vector.shift = base::converted<float>(shift);
    return true;
  }
  const bool is_hidden = cluster_.is_held() && !is_top_;
  base::Vec6<double> load;
  cluster_.find_load_up(joint_to_parent(ws), is_top_, load);
  ws.links.send(parent_, vector_message(MessageType::kBranchUp, is_hidden ? kHeld : std::uint8_t{0},
                                        base::converted<float>(load)));
  return true;
}

void RigidClusters::take_shift(Workspace& ws, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  if (in.label == 0 && piece_ == Piece::kShift) {
    ws.node(0).vector.shift = in.vector;
    is_shift_here_ = true;
  }
}

/// The parent's displacement is here, and with it this module's; it becomes a term of M^-1 r.
bool RigidClusters::shift(Workspace& ws, const Order& order) {
  if (!is_shift_here_) {
    return false;
  }
  piece_ = Piece::kNone;
  auto own = base::converted<double>(ws.node(0).vector.shift);
  if (!ws.tree.is_root()) {
    cluster_.find_displacement(joint_to_parent(ws), is_top_, own);
  }
  MinimalResiduals iteration(ws, order, memory_, rho_);
  iteration.share_term(0, base::converted<float>(own));
  ws.links.send(children_, vector_message(MessageType::kBranchDown, 0, ws.node(0).vector.sent));
  const Leaves leaves = leaves_of(ws.planned);
  for (std::size_t i = 0; i < static_cast<std::size_t>(leaves.count); ++i) {
    if (leaves.node[i] < iteration.node_count()) {
      auto shift = base::converted<double>(ws.node(leaves.parent[i]).vector.sent);
      Joint(ws.setup.beam, leaves.to_parent[i]).carry(shift);
      iteration.share_term(leaves.node[i], base::converted<float>(shift));
    }
  }
  ws.start_exchange(part_in_iteration(ws, order));
  return true;
}

}  // namespace holdfast::agent
