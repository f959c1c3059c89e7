// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "sweep.hpp"

namespace holdfast::agent {

void Agent::take_order(const Order& order) {
  order_ = order;
  course_ = course_after(order);
  announcements_.finish_forgetting();
  is_sweeping_ = true;
  begin_waiting();
  reports_awaited_ = children_;
  exchanges_left_ = exchange_count(order);
  exchanges_behind_ = exchanges_behind(order);
  down_awaited_ = 0;
  send_to_children(encode(order));
  prepare(order);
  // Displacements of a kTreeStep have to be found first, and clusters.
  if (exchanges_left_ > 0 && order.operation != wire::Operation::kTreeStep &&
      order.operation != wire::Operation::kClusters) {
    start_exchange();
  }
}

void Agent::start_exchange() {
  is_exchanging_ = true;
  ++tag_;
  const base::Vec6<float> own = nodes_[0].shared;
  const std::uint8_t faces = used_faces();
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((faces & bit(face)) != 0) {
      send(face, vector_message(wire::MessageType::kVector, tag_, own));
    }
  }
  if (!is_apart()) {
    start_planned_exchange();
  }
}

/// What the planned modules emulated here share, to all that touch them.
void Agent::start_planned_exchange() {
  planned_force_ = {};
  for (int i = 0; i < planned_.hosted_count(); ++i) {
    planned_vector_[static_cast<std::size_t>(planned_.hosted(i))] =
        nodes_[static_cast<std::size_t>(1 + i)].shared;
  }
  for (int k = 0; k < planned_.count(); ++k) {
    if (planned_.node_of(k) >= 0) {
      send_planned_down(k);
    }
  }
}

/// Hands the reals of a planned module, emulated here or come from above, on to children that need
/// them.
void Agent::send_planned_down(int k) {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) != 0 && planned_.is_needed_below(face, k)) {
      send(face, vector_message(wire::MessageType::kPlannedDown, static_cast<std::uint8_t>(k),
                                planned_vector_[static_cast<std::size_t>(k)]));
    }
  }
}

void Agent::take_planned_down(std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int k = in.label;
  if (kHasAllMethods && (k & ~kPlannedIndexMask) != 0) {
    return take_remote_down(static_cast<std::uint8_t>(k), in.vector);
  }
  planned_vector_[static_cast<std::size_t>(k)] = in.vector;
  planned_here_ = static_cast<std::uint8_t>(planned_here_ | bit(k));
  send_planned_down(k);
}

/// The beams' forces on planned modules from here down, to their hosts above; where digits count,
/// what single precision leaves over follows in a second message.
void Agent::send_planned_up() {
  for (int k = 0; k < planned_.count(); ++k) {
    if (!planned_.is_from_above(k)) {
      continue;
    }
    base::Vec6<double>& force = planned_force_[static_cast<std::size_t>(k)];
    const int parts = is_precise(order_.operation) ? 2 : 1;
    for (int part = 0; part < parts; ++part) {
      base::Vec6<double> leading = force;
      for (std::size_t i = 0; i < 6; ++i) {
        leading[i] = part + 1 < parts ? leading_part(force[i]) : force[i];
        force[i] -= leading[i];
      }
      send(parent_, vector_message(wire::MessageType::kPlannedUp, static_cast<std::uint8_t>(k),
                                   base::converted<float>(leading)));
    }
  }
}

void Agent::take_planned_up(std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int k = in.label;
  const base::Vec6<float> force = in.vector;
  for (std::size_t i = 0; i < 6; ++i) {
    planned_force_[static_cast<std::size_t>(k)][i] += static_cast<double>(force[i]);
  }
  if (kHasAllMethods && order_.operation == wire::Operation::kStep && --planned_up_awaited_ == 0) {
    pass_condensed();
  }
}

void Agent::take_vector(int face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const std::uint8_t tag = in.label;
  const std::size_t slot = tag & 1U;
  vectors_[slot][static_cast<std::size_t>(face)] = in.vector;
  vectors_here_[slot] = static_cast<std::uint8_t>(vectors_here_[slot] | bit(face));
}

void Agent::take_report(int face, std::span<const std::uint8_t> message) {
  auto& stored = reports_[static_cast<std::size_t>(face)];
  for (std::size_t i = 0; i < message.size(); ++i) {
    stored[i] = message[i];
  }
  reports_awaited_ = static_cast<std::uint8_t>(reports_awaited_ & ~bit(face));
}

/// The next exchange, if all that it needs is here.
bool Agent::exchange() {
  const std::size_t slot = tag_ & 1U;
  const std::uint8_t faces = used_faces();
  // What children add to planned modules emulated here comes before their reports. It belongs to an
  // order's last exchange.
  const bool waits_for_children = exchanges_left_ == 1 && exchanges_behind_ == 0;
  if (!is_exchanging_ || (vectors_here_[slot] & faces) != faces || is_waiting_for_hosts() ||
      (waits_for_children && reports_awaited_ != 0)) {
    return false;
  }
  exchange_forces();
  vectors_here_[slot] = 0;
  planned_here_ = needs_hosts() ? std::uint8_t{0} : planned_here_;
  is_exchanging_ = false;
  if (!is_apart()) {
    send_planned_up();
  }
  after_exchange();
  if (--exchanges_left_ > 0 && !is_coarse()) {
    start_exchange();
  }
  return true;
}

bool Agent::take_next_order() {
  if (!has_next_order_ || is_exchanging_ || is_coarse()) {
    return false;
  }
  has_next_order_ = false;
  take_order(next_order_);
  return true;
}

/// Reports, if all is done here and below.
bool Agent::finish_sweep() {
  const bool is_done_here = exchanges_left_ <= exchanges_behind_;
  if (!is_sweeping_ || reports_awaited_ != 0 || down_awaited_ != 0 || piece_ != Piece::kNone ||
      is_clustering() || !is_done_here) {
    return false;
  }
  is_sweeping_ = false;
  Report report = conclude(order_);
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) != 0) {
      const Report theirs = decode_report(reports_[static_cast<std::size_t>(face)]);
      add_report(report, theirs);
      if (order_.operation == wire::Operation::kPlan && order_.index != kNoPlanned) {
        planned_.add_below(face, order_.index, theirs.mask);
      }
    }
  }
  if (parent_ >= 0) {
    send(parent_, encode(order_.operation, report));
  } else if (order_.operation != wire::Operation::kVerdict) {
    next_order_ = conductor_.next(setup_, report);
    has_next_order_ = true;
  }
  if (order_.operation == wire::Operation::kVerdict) {
    watch_verdict();
  }
  return true;
}

}  // namespace holdfast::agent
