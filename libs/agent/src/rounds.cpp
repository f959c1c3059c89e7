// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/messages.hpp"
#include "methods.hpp"
#include "watch.hpp"

namespace holdfast::agent {

using wire::MessageType;

Agent::Agent(const Setup& setup, const Identity& identity) : setup_(setup), identity_(identity) {
  deadline_.fill(kNever);
  has_cell_ = identity.is_anchor;
  nodes_[0].cell = identity.cell;
}

void Agent::step(const Event& event, Actions& actions) {
  begin(event, actions);
  while (is_busy_) {
    go_on();
  }
  finish_step(actions);
}

void Agent::step_part(const Event& event, Actions& actions) {
  begin(event, actions);
  finish_step(actions);
}

void Agent::begin(const Event& event, Actions& actions) {
  now_ = event.now;
  actions.packet_bytes = 0;
  if (event.kind == EventKind::kLineFree) {
    const int face = base::index(event.face);
    actions.packet_bytes =
        links_[static_cast<std::size_t>(face)].write_packet(actions.packet, setup_.timing, now_);
    touched_ = static_cast<std::uint8_t>(touched_ | bit(face));
    return;
  }
  if (event.kind == EventKind::kContinue) {
    go_on();
    return;
  }
  while (event.kind == EventKind::kReceive && is_busy_) {
    go_on();
  }
  handle(event);
  if (restart_at_ <= now_) {
    start_round();
  }
  if (watch_at_ <= now_) {
    end_watch();
  }
}

/// Messages only leave something to do; it is done here, a piece at a time, none of which calls
/// another.
void Agent::go_on() {
  is_busy_ = exchange() || do_piece() || (kHasAllMethods && do_cluster_piece()) || finish_sweep() ||
             end_stage() || take_next_order();
}

void Agent::handle(const Event& event) {
  const int face = base::index(event.face);
  Link& link = links_[static_cast<std::size_t>(face)];
  switch (event.kind) {
    case EventKind::kStart:
      watch_at_ = now_ + watch::silence(setup_.timing);
      if (identity_.is_anchor) {
        restart_at_ = now_ + setup_.timing.acknowledge_after;
      }
      break;
    case EventKind::kLinkUp:
    case EventKind::kLinkDown:
      event.kind == EventKind::kLinkUp ? link.bring_up(event.random, now_) : link.bring_down();
      silent_faces_ = static_cast<std::uint8_t>(silent_faces_ & ~bit(face));
      touched_ = static_cast<std::uint8_t>(touched_ | bit(face));
      leave_round();
      break;
    case EventKind::kPlan:
    case EventKind::kWithdraw:
      event.kind == EventKind::kPlan ? announcements_.plan(event.cell)
                                     : announcements_.withdraw(event.cell);
      leave_round();
      break;
    case EventKind::kRecall:
      announcements_.recall(event.cell, event.told);
      break;
    case EventKind::kReceive:
      receive(face, event.bytes);
      break;
    case EventKind::kTime:
      for (int f = 0; f < base::kDirectionCount; ++f) {
        if (deadline_[static_cast<std::size_t>(f)] <= now_) {
          links_[static_cast<std::size_t>(f)].on_time(setup_.timing, is_working(), now_);
          touched_ = static_cast<std::uint8_t>(touched_ | bit(f));
          check_link(f);
        }
      }
      break;
    case EventKind::kLineFree:
    case EventKind::kContinue:
      break;
  }
}

void Agent::finish_step(Actions& actions) {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((touched_ & bit(face)) != 0) {
      const Link& link = links_[static_cast<std::size_t>(face)];
      send_faces_ = static_cast<std::uint8_t>(send_faces_ & ~bit(face));
      if (link.has_packet(now_)) {
        send_faces_ = static_cast<std::uint8_t>(send_faces_ | bit(face));
      }
      deadline_[static_cast<std::size_t>(face)] = link.deadline(setup_.timing, is_working());
    }
  }
  touched_ = 0;
  actions.is_unfinished = is_busy_;
  actions.send_faces = send_faces_;
  actions.wake_at = restart_at_ < watch_at_ ? restart_at_ : watch_at_;
  for (const Time at : deadline_) {
    actions.wake_at = at < actions.wake_at ? at : actions.wake_at;
  }
}

void Agent::receive(int face, std::span<const std::uint8_t> packet) {
  Link& link = links_[static_cast<std::size_t>(face)];
  touched_ = static_cast<std::uint8_t>(touched_ | bit(face));
  is_busy_ = true;
  const bool was_used = link.is_used();
  std::span<const std::uint8_t> stream = link.receive(packet, setup_.timing, now_);
  for (auto message = link.next_message(stream); !message.empty() && link.is_used();
       message = link.next_message(stream)) {
    is_legal(message) ? dispatch(face, message) : refuse(face);
  }
  if (was_used && link.state() == Link::State::kLost) {
    refused_count_ = static_cast<std::uint8_t>(refused_count_ < 0xff ? refused_count_ + 1 : 0xff);
  }
  check_link(face);
}

/// A neighbour that is there and does not answer makes every verdict uncertain.
void Agent::check_link(int face) {
  Link& link = links_[static_cast<std::size_t>(face)];
  if (link.take_restarted()) {
    link.bring_up(static_cast<std::uint16_t>(now_ ^ identity_.id ^ 0x5a5aU), now_);
    leave_round();
  }
  if (link.state() == Link::State::kLost && (silent_faces_ & bit(face)) == 0) {
    silent_faces_ = static_cast<std::uint8_t>(silent_faces_ | bit(face));
    leave_round();
  }
}

void Agent::dispatch(int face, std::span<const std::uint8_t> message) {
  const auto type = static_cast<MessageType>(message[0]);
  if (type == MessageType::kJoin) {
    return take_join(face, message);
  }
  if (type == MessageType::kEcho) {
    peer_round_[static_cast<std::size_t>(face)] = decoded<Echo>(message).round;
  }
  // A link delivers in order, so its last join or echo tells to which round this belongs.
  const bool is_ours = peer_round_[static_cast<std::size_t>(face)] == round_;
  if (!is_ours || restart_at_ != kNever || stage_ == kNoStage) {
    return;
  }
  if (!is_expected(face, message)) {
    return refuse(face);
  }
  keep_waiting();
  switch (type) {
    case MessageType::kEcho:
      return take_echo(face, message);
    case MessageType::kAppoint:
      return take_appointment(decoded<Appointment>(message));
    case MessageType::kMark:
      return take_mark(decoded<Mark>(message));
    case MessageType::kOrder:
      if (is_exchanging_ || is_coarse()) {
        // What goes on behind the last report comes to its end first.
        next_order_ = decode_order(message);
        has_next_order_ = true;
        return;
      }
      return take_order(decode_order(message));
    case MessageType::kReport:
      return take_report(face, message);
    case MessageType::kVector:
      return take_vector(face, message);
    case MessageType::kPlannedDown:
      return take_planned_down(message);
    case MessageType::kPlannedUp:
      return take_planned_up(message);
    case MessageType::kLoop:
      return take_loop(face, message);
    case MessageType::kColumn:
    case MessageType::kBranchUp:
    case MessageType::kBranchDown:
      return dispatch_branch(face, message);
    case MessageType::kJoin:
      break;
  }
}

/// What goes up and down a tree: the branches', or the clusters'.
void Agent::dispatch_branch(int face, std::span<const std::uint8_t> message) {
  const auto type = static_cast<MessageType>(message[0]);
  if (kHasAllMethods && is_clustered_) {
    return type == MessageType::kColumn     ? take_cluster_part(face, message)
           : type == MessageType::kBranchUp ? take_cluster_load(face, message)
                                            : take_cluster_shift(message);
  }
  return type == MessageType::kColumn     ? take_column(face, message)
         : type == MessageType::kBranchUp ? take_branch_up(face, message)
                                          : take_branch_down(message);
}

/// A neighbour that does not take what it is sent is as good as silent.
void Agent::send(int face, const wire::Writer& message) {
  touched_ = static_cast<std::uint8_t>(touched_ | bit(face));
  if (!links_[static_cast<std::size_t>(face)].send(message.bytes())) {
    silent_faces_ = static_cast<std::uint8_t>(silent_faces_ | bit(face));
    leave_round();
  }
}

void Agent::send_to_children(const wire::Writer& message) {
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) != 0) {
      send(face, message);
    }
  }
}

std::uint8_t Agent::used_faces() const {
  std::uint8_t faces = 0;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (links_[static_cast<std::size_t>(face)].is_used()) {
      faces = static_cast<std::uint8_t>(faces | bit(face));
    }
  }
  return faces;
}

/// The robot is not what it was when the round began. Until the next one this module takes no part
/// in anything; it waits a little, as changes come together.
void Agent::leave_round() {
  if (round_.epoch > 0 || silent_faces_ != 0) {
    phase_ = Phase::kDiscovery;
    forget_answer();
    is_sweeping_ = false;
    is_exchanging_ = false;
    leave_clusters();
    piece_ = Piece::kNone;
    is_stage_over_ = false;
    has_next_order_ = false;
    restart_at_ = now_ + setup_.timing.acknowledge_after;
  }
}

void Agent::start_round() {
  if (!has_cell_) {
    // Others must start; if nobody is left who can, this is the last word.
    restart_at_ = kNever;
    if (silent_faces_ != 0) {
      answer_ = {.verdict = Verdict::kUndecided, .reason = Reason::kNeighbourSilent};
    }
    return;
  }
  enter_round({.epoch = epoch_after(round_.epoch), .starter = identity_.id});
  start_wave(kFirstStage);
  is_busy_ = true;
}

void Agent::enter_round(const Round& round) {
  round_ = round;
  announcements_.begin_anew();
  restart_at_ = kNever;
  stage_ = kNoStage;
  parent_ = -1;
  children_ = 0;
  is_sweeping_ = false;
  is_exchanging_ = false;
  leave_clusters();
  piece_ = Piece::kNone;
  is_stage_over_ = false;
  has_next_order_ = false;
  tag_ = 0;
  vectors_here_ = {};
  planned_here_ = 0;
  planned_.clear();
  course_ = Course::kWaves;
  phase_ = Phase::kCoordinates;
  wave_time_ = static_cast<std::uint32_t>(now_);
  rounds_without_end_ = static_cast<std::uint8_t>(
      rounds_without_end_ + (rounds_without_end_ < watch::kRoundsWithoutEndMax ? 1 : 0));
  forget_answer();
  touched_ = 0x3f;
  for (Link& link : links_) {
    link.drop_unsent();
  }
}

}  // namespace holdfast::agent
