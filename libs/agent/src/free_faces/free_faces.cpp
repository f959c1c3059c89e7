// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/free_faces/free_faces.hpp"

#include "algebra/scalar.hpp"
#include "algebra/support_margin.hpp"
#include "equilibrium/beams.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/messages.hpp"

namespace holdfast::agent {
namespace {

using base::Cell;
using wire::MessageType;
using wire::Operation;

/// The label of the message that goes down before a way is known; those before are the way's parts.
constexpr std::uint8_t kOutsideLabel = kReachLabelLast;
static_assert(LoadWay::kParts == kOutsideLabel);

/// The least pressure at an edge of a facet that does not press all over.
constexpr float kNotStuck = -1;

Cell from(const Cell& cell, const Cell& origin) {
  return {cell.x - origin.x, cell.y - origin.y, cell.z - origin.z};
}

/// 62 random bits of a connection, the same at both its ends [Steele 2014].
std::int64_t label_of(const Cell& cell, Direction direction) {
  const bool is_upper = base::index(direction) % 2 != 0;
  const Cell lower = is_upper ? base::neighbour(cell, direction) : cell;
  std::uint64_t bits = static_cast<std::uint64_t>(base::index(direction) / 2) + 1;
  for (const std::int32_t value : {lower.x, lower.y, lower.z}) {
    bits = (bits ^ static_cast<std::uint32_t>(value)) + 0x9e3779b97f4a7c15U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    bits ^= bits >> 31U;
  }
  return static_cast<std::int64_t>(bits >> 2U);
}

/// Connections that are not part of the tree.
Faces cuts_of(const Workspace& ws) {
  return ws.links.used() - ws.tree.parent() - ws.tree.children();
}

/// Does the module rest, or is it fixed?
bool is_support(const Node& node) { return node.is_fixed || node.is_ground; }

/// What the only facet of a module holds, in the middle between its centre and the ground's node.
MiddleLoad facet_load(const Workspace& ws) {
  const base::Vec6<double> force = mechanics::trial_force(ws.contact.facet, ws.node(0).u);
  return {.axial_n = force[2], .bending_x_nmm = force[3], .bending_y_nmm = force[4]};
}

bool is_stuck(const Node& node) {
  return node.state.pressed && node.state.tilt_x == 0 && node.state.tilt_y == 0;
}

/// How much an edge of the facet is pressed at least, in N.
float facet_margin(const Workspace& ws) {
  if (!ws.node(0).is_ground) {
    return kNoFacetMargin;
  }
  const MiddleLoad load = facet_load(ws);
  const double bending = absolute(load.bending_x_nmm) > absolute(load.bending_y_nmm)
                             ? absolute(load.bending_x_nmm)
                             : absolute(load.bending_y_nmm);
  return is_stuck(ws.node(0)) ? static_cast<float>(-2 * bending / ws.setup.facet_mm - load.axial_n)
                              : kNotStuck;
}

float ratio_at(const Workspace& ws, Direction direction) {
  float ratio = kNoLoadRatio;
  visit_loads(ws, [&](const Cell& cell, Direction there, double value) {
    ratio = cell == ws.tree.cell() && there == direction ? static_cast<float>(value) : ratio;
  });
  return ratio;
}

}  // namespace

void FreeFaces::note(Faces touched, const Answer& answer) {
  for (const Direction direction : touched) {
    FreeFace& face = faces_[at(direction)];
    face.verdict = answer.verdict;
    face.has_load_ratio = answer.verdict == Verdict::kSafe || answer.verdict == Verdict::kOverload;
    face.load_ratio_max = answer.load_ratio_max;
  }
}

// ---- The shape.

Report FreeFaces::shape_report(const Workspace& ws) const {
  Report report;
  report.cell = ws.tree.cell();
  report.set_far_cell(ws.tree.cell());
  report.count = is_support(ws.node(0)) ? 1 : 0;
  for (const Direction face : cuts_of(ws)) {
    report.moment[0] ^= label_of(ws.tree.cell(), face);
  }
  report.reals = {largest_load_ratio(ws), facet_margin(ws)};
  report.mask = is_support(ws.node(0)) ? 0 : kFar;
  return report;
}

void FreeFaces::take_shape(Direction child, const Report& report) {
  supports_below_[at(child)] = report.count;
  label_below_[at(child)] = report.moment[0];
  ratio_below_[at(child)] = report.reals[0];
  hops_below_[at(child)] = report.support_hops();
}

/// One hop more for the parent.
void FreeFaces::take_shape_here(Report& sum) {
  supports_here_ = sum.count;
  label_here_ = sum.moment[0];
  first_ = sum.cell;
  last_ = sum.far_cell();
  has_shape_ = true;
  sum.mask = static_cast<std::uint8_t>(sum.mask + (sum.mask < kFar ? 1 : 0));
}

// ---- Begin and end.

/// What is known from here down must fit.
bool FreeFaces::is_good_next(const Workspace& ws, const Order& order) const {
  const Cell far = order.far_cell();
  const auto has = [&](const Cell& cell) {
    return order.cell.x <= cell.x && cell.x <= far.x && order.cell.y <= cell.y && cell.y <= far.y &&
           order.cell.z <= cell.z && cell.z <= far.z;
  };
  return has_shape_ && ws.planned.count() == 0 && OccupiedCells::fits(order.cell, far) &&
         has(first_) && has(last_) && has(ws.tree.root_cell()) && supports_here_ <= order.count;
}

void FreeFaces::begin_next(const Workspace& ws, const Order& order) {
  has_shape_ = false;
  is_under_way_ = true;
  order_ = order;
  cells_.begin(order.cell, order.far_cell());
  cells_.add(ws.tree.cell());
  const bool has_forces = (order.flags & kHasForces) != 0;
  needs_outside_ = has_forces && !ws.tree.is_root() && supports_here_ > 0;
  has_outside_ = !needs_outside_;
  has_sent_outside_ = !has_forces;
  has_way_ = !has_forces;
  has_sent_way_ = !has_forces;
  if (has_forces && has_outside_) {
    find_inward(ws);
  }
}

Report FreeFaces::next_report() const {
  Report report;
  for (const FreeFace& face : faces_) {
    report.count += face.verdict != Verdict::kNone && face.verdict != Verdict::kUndecided ? 1 : 0;
    report.number += face.verdict == Verdict::kUndecided ? 1 : 0;
  }
  return report;
}

// ---- Messages.

bool FreeFaces::expects(const Workspace& ws, Direction face,
                        std::span<const std::uint8_t> message) const {
  const int label = message[1];
  if (!is_under_way_) {
    return false;
  }
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kCellsUp:
      return ws.tree.children().has(face) && label == parts_from_[at(face)] &&
             label < cells_.part_count();
    case MessageType::kCellsDown:
      return ws.tree.is_led_by(face) && parts_up_ == cells_.part_count() && label == parts_here_ &&
             label < cells_.part_count();
    default:
      return label == kOutsideLabel ? needs_outside_ && !has_outside_ && ws.tree.is_led_by(face)
                                    : inward_.has(face) && !has_way_ && label == reach_parts_ &&
                                          label < way_.part_count();
  }
}

void FreeFaces::take(const Workspace& ws, Direction face, std::span<const std::uint8_t> message) {
  const auto type = static_cast<MessageType>(message[0]);
  if (type == MessageType::kReach) {
    return take_reach(ws, message);
  }
  take_part(face, type == MessageType::kCellsUp, message);
}

void FreeFaces::take_part(Direction face, bool is_up, std::span<const std::uint8_t> message) {
  const auto bytes = cells_.part(message[1]);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    bytes[i] = is_up ? static_cast<std::uint8_t>(bytes[i] | message[2 + i]) : message[2 + i];
  }
  is_up ? ++parts_from_[at(face)] : ++parts_here_;
}

void FreeFaces::take_reach(const Workspace& ws, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  if (in.label != kOutsideLabel) {
    elsewhere_ = larger(elsewhere_, way_.take_part(in.label, in.vector));
    ++reach_parts_;
    return;
  }
  outside_ = in.vector[0];
  hops_outside_ =
      in.vector[1] >= 0 && in.vector[1] < kFar ? static_cast<std::uint16_t>(in.vector[1]) : kFar;
  leads_parent_ = in.vector[2] == 1;
  has_outside_ = true;
  find_inward(ws);
}

// ---- Pieces.

bool FreeFaces::do_piece(Workspace& ws) {
  return is_under_way_ && (send_outside(ws) || continue_way(ws) || send_reach(ws) ||
                           send_part_up(ws) || send_part_down(ws) || judge_next(ws));
}

/// A part is complete when all children's are here.
bool FreeFaces::send_part_up(Workspace& ws) {
  if (parts_up_ == cells_.part_count()) {
    return false;
  }
  for (const Direction face : ws.tree.children()) {
    if (parts_from_[at(face)] <= parts_up_) {
      return false;
    }
  }
  if (!ws.tree.is_root()) {
    if (!ws.links.has_room(ws.tree.parent().first(), kRoomBytes)) {
      return false;
    }
    ws.links.send(ws.tree.parent(),
                  part_message(MessageType::kCellsUp, parts_up_, cells_.part(parts_up_)));
  }
  ++parts_up_;
  return true;
}

bool FreeFaces::send_part_down(Workspace& ws) {
  const int here = ws.tree.is_root() && parts_up_ == cells_.part_count() ? parts_up_ : parts_here_;
  if (parts_down_ >= here) {
    return false;
  }
  for (const Direction face : ws.tree.children()) {
    if (!ws.links.has_room(face, kRoomBytes)) {
      return false;
    }
  }
  ws.links.send(ws.tree.children(),
                part_message(MessageType::kCellsDown, parts_down_, cells_.part(parts_down_)));
  ++parts_down_;
  return true;
}

/// The largest load ratio of all connections here, and behind children and parent, but those at
/// the faces that are left out.
float FreeFaces::largest_but(const Workspace& ws, Faces left_out) const {
  float largest = kNoLoadRatio;
  for (const Direction face : ws.links.used() - left_out) {
    largest = larger(largest, ratio_at(ws, face));
    if (ws.tree.children().has(face)) {
      largest = larger(largest, ratio_below_[at(face)]);
    } else if (ws.tree.parent().has(face)) {
      largest = larger(largest, outside_);
    }
  }
  return largest;
}

/// Hops to the nearest support here or behind faces that are not left out.
std::uint16_t FreeFaces::hops_from_here(const Workspace& ws, Faces left_out) const {
  std::uint16_t hops = is_support(ws.node(0)) ? 0 : hops_outside_;
  for (const Direction face : ws.tree.children() - left_out) {
    hops = hops_below_[at(face)] < hops ? hops_below_[at(face)] : hops;
  }
  return hops;
}

/// A child with supports below it hears what is outside of its subtree.
bool FreeFaces::send_outside(Workspace& ws) {
  if (has_sent_outside_ || !has_outside_) {
    return false;
  }
  for (const Direction face : ws.tree.children()) {
    const Faces child = Faces::only(face);
    const int hops = hops_from_here(ws, child) + 1;
    // In its own hops; a support needs no way.
    const bool is_led = hops_below_[at(face)] > 1 && hops < hops_below_[at(face)] - 1;
    outward_.set(face, supports_below_[at(face)] == 0 || is_led);
    if (supports_below_[at(face)] > 0) {
      const float outside = larger(largest_but(ws, child), ratio_at(ws, face));
      const float leads = inward_.has(face) ? 1.0F : 0.0F;
      ws.links.send(child, vector_message(MessageType::kReach, kOutsideLabel,
                                          {outside, static_cast<float>(hops), leads, 0, 0, 0}));
    }
  }
  has_sent_outside_ = true;
  return true;
}

/// The way inward goes to the nearest support, down the tree if there are two.
void FreeFaces::find_inward(const Workspace& ws) {
  if (leads_parent_) {
    outward_ = ws.tree.parent();
  }
  if (is_support(ws.node(0))) {
    return;
  }
  if (supports_here_ == 0) {
    inward_ = ws.tree.parent();
    return;
  }
  int hops = kFar + 1;
  for (const Direction face : ws.tree.children()) {
    if (supports_below_[at(face)] > 0 && hops_below_[at(face)] < hops) {
      hops = hops_below_[at(face)];
      inward_ = Faces::only(face);
    }
  }
  // As the parent knows them: kFar stands for more.
  const int hops_told = hops < kFar ? hops : kFar - 1;
  if (hops_outside_ < hops_told) {
    inward_ = ws.tree.parent();
  }
}

/// Does this connection alone hold, or is it held by, what is behind it or here?
bool FreeFaces::is_alone(const Workspace& ws, Direction face) const {
  return ws.tree.parent().has(face)
             ? label_here_ == 0 && supports_here_ == 0
             : label_below_[at(face)] == 0 && supports_below_[at(face)] == order_.count;
}

LoadWay FreeFaces::way_of_support(const Workspace& ws) const {
  const Node& node = ws.node(0);
  const bool is_only_foot =
      order_.count == 1 && is_stuck(node) && (order_.flags & kIsUnilateral) == 0;
  return node.is_fixed || is_only_foot
             ? LoadWay::certain()
             : LoadWay::from_foot(ws.setup, from(ws.tree.cell(), ws.tree.root_cell()),
                                  facet_load(ws));
}

/// The way begins here, or has come and goes on to this module.
bool FreeFaces::continue_way(const Workspace& ws) {
  const bool is_here = inward_.is_empty() ? is_support(ws.node(0))
                                          : reach_parts_ >= LoadWay::kCertainParts &&
                                                reach_parts_ == way_.part_count();
  if (has_way_ || !is_here || !has_sent_outside_) {
    return false;
  }
  if (inward_.is_empty()) {
    way_ = way_of_support(ws);
  }
  for (const Direction face : inward_) {
    way_.pass(ws.setup, from(ws.tree.cell(), ws.tree.root_cell()), face, ws.middle(face),
              is_alone(ws, face));
  }
  has_way_ = true;
  return true;
}

bool FreeFaces::send_reach(Workspace& ws) {
  if (has_sent_way_ || !has_way_) {
    return false;
  }
  for (const Direction face : outward_) {
    const float elsewhere = larger(elsewhere_, largest_but(ws, inward_ | Faces::only(face)));
    for (int part = 0; part < way_.part_count(); ++part) {
      ws.links.send(Faces::only(face),
                    vector_message(MessageType::kReach, static_cast<std::uint8_t>(part),
                                   way_.part(part, elsewhere)));
    }
  }
  has_sent_way_ = true;
  return true;
}

// ---- Judgement.

bool FreeFaces::has_all_parts(const Workspace& ws) const {
  return parts_up_ == cells_.part_count() && parts_down_ == cells_.part_count() &&
         (ws.tree.is_root() || parts_here_ == cells_.part_count());
}

bool FreeFaces::judge_next(const Workspace& ws) {
  if (!has_all_parts(ws) || !has_sent_way_) {
    return false;
  }
  if (next_face_ == base::kDirectionCount) {
    is_under_way_ = false;
    return true;
  }
  const Direction direction = base::kDirections[next_face_++];
  Candidate candidate;
  if (find_candidate(ws, direction, candidate)) {
    faces_[at(direction)] = judge(ws, candidate);
  }
  return true;
}

bool FreeFaces::find_candidate(const Workspace& ws, Direction direction,
                               Candidate& candidate) const {
  const Cell cell = base::neighbour(ws.tree.cell(), direction);
  const bool is_floor = direction == Direction::kMinusZ && ws.node(0).is_ground;
  if (ws.links.is_used(direction) || cells_.has(cell) || is_floor) {
    return false;
  }
  candidate = {.cell = cell, .direction = direction};
  for (const Direction side : base::kDirections) {
    candidate.touching += cells_.has(base::neighbour(cell, side)) ? 1 : 0;
  }
  candidate.is_ground = cell.z == ws.setup.support_z;
  return true;
}

FreeFace FreeFaces::judge(const Workspace& ws, const Candidate& candidate) const {
  FreeFace face{.verdict = Verdict::kUndecided};
  const bool is_held = (order_.flags & kIsHeld) != 0;
  if (!is_held && !weigh(ws, candidate, face)) {
    return face;
  }
  if ((order_.flags & kHasForces) != 0 && candidate.touching == 1 && !candidate.is_ground) {
    judge_load(ws, candidate, face);
  }
  return face;
}

/// Is false if with the candidate the robot topples, or cannot be weighed.
bool FreeFaces::weigh(const Workspace& ws, const Candidate& candidate, FreeFace& face) const {
  const Cell& root = ws.tree.root_cell();
  std::int32_t mass = 1;
  std::array<std::int32_t, 2> moment = {candidate.cell.x - root.x, candidate.cell.y - root.y};
  cells_.visit([&](const Cell& cell) {
    ++mass;
    moment[0] += cell.x - root.x;
    moment[1] += cell.y - root.y;
  });
  if (!fits_exact_check(ws.setup, mass)) {
    return false;
  }
  const FeetCheck check(ws.setup, mass, moment);
  SafeCorners feet;
  SupportMargin margin(ws.setup.section.length, ws.setup.facet_mm, mass, moment);
  const auto add_foot = [&](const Cell& cell) {
    const Cell away = from(cell, root);
    feet = check.merge(feet, check.of_foot(away.x, away.y));
  };
  const auto visit_feet = [&](auto&& visit) {
    cells_.visit_layer(ws.setup.support_z, visit);
    if (candidate.is_ground) {
      visit(candidate.cell);
    }
  };
  visit_feet(add_foot);
  face.margin_mm = static_cast<float>(margin.find(
      [&](auto&& visit) { visit_feet([&](const Cell& cell) { visit(from(cell, root)); }); }));
  face.has_margin = true;
  if (feet.range != mechanics::SafeRange::kFull) {
    face.verdict = Verdict::kUnstable;
    return false;
  }
  return true;
}

/// The candidate's weight goes the way inward.
void FreeFaces::judge_load(const Workspace& ws, const Candidate& candidate, FreeFace& face) const {
  const Cell away = from(candidate.cell, ws.tree.root_cell());
  const auto doubt = static_cast<double>(order_.ratio_error());
  const double hanging = hanging_ratio(ws.setup, base::opposite(candidate.direction));
  const double on_way = way_.alone_with(ws.setup, away);
  const double alone = hanging > on_way ? hanging : on_way;
  if (way_.is_certain()) {
    judge_certain(ws, alone, face);
  } else if (alone > 1 + doubt) {
    face.verdict = Verdict::kOverload;
  } else if (is_safe_by_bounds(ws, away, alone)) {
    face.verdict = Verdict::kSafe;
  }
}

/// Nothing but the way changes.
void FreeFaces::judge_certain(const Workspace& ws, double alone, FreeFace& face) const {
  const auto doubt = static_cast<double>(order_.ratio_error());
  const auto elsewhere = static_cast<double>(larger(elsewhere_, largest_but(ws, inward_)));
  const double ratio = elsewhere > alone || elsewhere != elsewhere ? elsewhere : alone;
  face.load_ratio_max = static_cast<float>(ratio);
  face.has_load_ratio = true;
  face.verdict = ratio < 1 - doubt   ? Verdict::kSafe
                 : ratio > 1 + doubt ? Verdict::kOverload
                                     : Verdict::kUndecided;
}

bool FreeFaces::is_safe_by_bounds(const Workspace& ws, const Cell& away, double alone) const {
  const auto doubt = static_cast<double>(order_.ratio_error());
  const auto margin = static_cast<double>(order_.facet_margin());
  const auto now = static_cast<double>(order_.ratio_now());
  const double strength = ws.setup.strength_lateral_n > ws.setup.strength_vertical_n
                              ? ws.setup.strength_lateral_n
                              : ws.setup.strength_vertical_n;
  return margin > 0 && (order_.flags & kIsUnilateral) == 0 && alone < 1 - doubt &&
         way_.bound_with(ws.setup, away, now) < 1 - doubt &&
         (margin >= static_cast<double>(kNoFacetMargin) ||
          way_.tension_with(ws.setup, away, margin) < -doubt * strength);
}

}  // namespace holdfast::agent
