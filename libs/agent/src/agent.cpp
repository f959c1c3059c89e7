// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/agent.hpp"

#include "equilibrium/beams.hpp"
#include "equilibrium/kept_changes.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/messages/messages.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;

Phase phase_of(SpanningTree::Wave wave) {
  switch (wave) {
    case SpanningTree::Wave::kFirst:
      return Phase::kCoordinates;
    case SpanningTree::Wave::kFar:
      return Phase::kElection;
    default:
      return Phase::kTree;
  }
}

/// Both enumerations have the last two in the same order.
Reason reason_of(Doubt doubt) {
  static_assert(
      static_cast<int>(Reason::kFacesMismatch) - static_cast<int>(Reason::kCellsContradict) ==
      static_cast<int>(Doubt::kFacesMismatch) - static_cast<int>(Doubt::kCellsContradict));
  constexpr int kAhead =
      static_cast<int>(Reason::kFacesMismatch) - static_cast<int>(Doubt::kFacesMismatch);
  return doubt == Doubt::kNeighbourSilent ? Reason::kNeighbourSilent
                                          : static_cast<Reason>(static_cast<int>(doubt) + kAhead);
}

}  // namespace

Agent::Agent(const Setup& setup, const Identity& identity, const LentMemory* lent)
    : identity_(identity), clock_{.timing = setup.timing}, ws_(setup, identity, lent) {
  if (MorePlanned* more = ws_.planned.more_planned(); more != nullptr) {
    announcements_.lend(&more->announced);
  }
  if (ws_.free_faces() != nullptr) {
    ws_.free_faces()->forget();
  }
}

// ---- An event comes in.

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
  clock_.now = event.now;
  actions.packet_bytes = 0;
  if (event.kind == EventKind::kLineFree) {
    actions.packet_bytes = ws_.links.write_packet(event.face, actions.packet, clock_);
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
  if (rounds_.restart_at() <= clock_.now) {
    start_round();
  }
  if (watch_.at() <= clock_.now) {
    run_out();
  }
}

void Agent::handle(const Event& event) {
  switch (event.kind) {
    case EventKind::kStart:
      watch_.start(clock_);
      if (identity_.is_anchor) {
        rounds_.leave_until(clock_.now + clock_.timing.acknowledge_after);
      }
      break;
    case EventKind::kLinkUp:
      ws_.links.bring_up(event.face, event.random, clock_.now);
      forget_packet(event.face);
      kKeepsAnswers&& can_keep() ? welcome(event.face) : leave_round();
      break;
    case EventKind::kLinkDown:
      ws_.links.bring_down(event.face);
      forget_packet(event.face);
      leave_round();
      break;
    case EventKind::kPlan:
      announcements_.plan(event.cell);
      kKeepsAnswers ? change({.cell = event.cell}) : leave_round();
      break;
    case EventKind::kWithdraw:
      announcements_.withdraw(event.cell);
      if (event.cell == kEveryCell && ws_.stages() != nullptr) {
        ws_.stages()->forget_told(false);
      }
      kKeepsAnswers ? change({.flags = kIsEnded, .cell = event.cell}) : leave_round();
      break;
    case EventKind::kRecall:
      announcements_.recall(event.cell, event.told);
      break;
    case EventKind::kStep:
      kKeepsAnswers ? tell_step(event) : void();
      break;
    case EventKind::kReceive:
      receive(event.face, event.bytes);
      break;
    case EventKind::kTime:
      for (const Direction face : ws_.links.due(clock_.now)) {
        ws_.links.on_time(face, clock_, is_waiting());
        notice_change(face);
      }
      break;
    case EventKind::kLineFree:
    case EventKind::kContinue:
      break;
  }
}

void Agent::finish_step(Actions& actions) {
  ws_.links.finish_step(clock_, is_waiting());
  actions.is_unfinished = is_busy_;
  actions.send_faces = ws_.links.waiting().mask();
  actions.wake_at = ws_.links.deadline();
  for (const Time at : {rounds_.restart_at(), watch_.at()}) {
    actions.wake_at = at < actions.wake_at ? at : actions.wake_at;
  }
}

bool Agent::is_waiting() const {
  return ws_.tree.wave() != SpanningTree::Wave::kNone && phase() != Phase::kDone &&
         watch_.at() != kNever;
}

bool Agent::is_only_watching(Time wake_at) const {
  const bool is_done = phase() == Phase::kDone;
  const Faces silent = ws_.links.silent();
  if (silent.is_empty() || (is_done && wake_at == watch_at())) {
    return is_done && wake_at == watch_at();
  }
  return wake_at == ws_.links.deadline(silent) &&
         ws_.links.deadline(ws_.links.all() - silent) == kNever && !rounds_.is_left() &&
         (is_done || watch_at() == kNever);
}

void Agent::receive(Direction face, std::span<const std::uint8_t> packet) {
  Links& links = ws_.links;
  was_used_ = links.is_used(face);
  packet_face_ = face;
  packet_rest_ = links.receive(face, packet, clock_);
  is_receiving_ = true;
  receive_rest();
}

/// Messages of the packet, up to one that sets off work.
bool Agent::receive_rest() {
  if (!is_receiving_) {
    return false;
  }
  Links& links = ws_.links;
  const Direction face = packet_face_;
  is_busy_ = true;
  while (!sweep_.is_working()) {
    const auto message = links.next_message(face, packet_rest_);
    if (message.empty() || !links.is_used(face)) {
      is_receiving_ = false;
      if (was_used_) {
        links.count_if_lost(face);
      }
      notice_change(face);
      return true;
    }
    if (!is_legal(message, face_count(links.more())) || !take(face, message)) {
      links.refuse(face);
    }
    if (links.take_refusal()) {
      leave_round();
    }
  }
  return true;
}

/// A neighbour that is there and does not answer makes every verdict uncertain.
void Agent::notice_change(Direction face) {
  const auto nonce = static_cast<std::uint16_t>(clock_.now ^ identity_.id ^ 0x5a5aU);
  if (ws_.links.notice_change(face, nonce, clock_.now)) {
    forget_packet(face);
    leave_round();
  }
}

/// What is left of a packet belongs to a link that is no more.
void Agent::forget_packet(Direction face) { is_receiving_ = is_receiving_ && packet_face_ != face; }

/// Is false if no working neighbour sends this message now.
bool Agent::take(Direction face, std::span<const std::uint8_t> message) {
  const auto type = static_cast<MessageType>(message[0]);
  if (type == MessageType::kJoin) {
    return take_join(face, decoded<Join>(message));
  }
  if (kKeepsAnswers && type == MessageType::kAdopt) {
    return take_adoption(face, decoded<Adoption>(message));
  }
  if (type == MessageType::kEcho) {
    rounds_.hear(ws_.links.more(), face, decoded<Echo>(message).round);
  }
  const bool is_ours = rounds_.of(ws_.links.more(), face) == rounds_.current();
  if (!is_ours || rounds_.is_left() || ws_.tree.wave() == SpanningTree::Wave::kNone) {
    return true;
  }
  if (!expects(face, message)) {
    return false;
  }
  watch_.keep_waiting(clock_);
  take_expected(face, message);
  return true;
}

bool Agent::take_join(Direction face, const Join& join) {
  rounds_.hear(ws_.links.more(), face, join.round);
  if (kKeepsAnswers && is_of_newcomer(join)) {
    decline(face, join);
    return true;
  }
  if (is_newer(join.round, rounds_.current())) {
    if (kKeepsAnswers && join.stage != 0) {
      if (!enter_stage(join)) {
        return true;
      }
    } else {
      enter_round(join.round);
    }
  } else if (!(join.round == rounds_.current()) || rounds_.is_left()) {
    return true;
  }
  if (kKeepsAnswers && static_cast<Stage>(join.stage) != ws_.stage()) {
    return false;
  }
  const SpanningTree::Wave before = ws_.tree.wave();
  if (!ws_.tree.take_join(ws_.links, face, join, sweep_.has_begun())) {
    return false;
  }
  if (kKeepsAnswers && join.hops <= depth() + 1) {
    welcomed_.remove(face);  // A newcomer that has taken its place elsewhere.
  }
  watch_.keep_waiting(clock_);
  follow_wave(before);
  return true;
}

/// What a neighbour may say at this moment.
///
/// A message that is legal by itself can still be one that no working program sends now: an order
/// from a child, a column of a loop that nobody has told of, an iteration before there is an
/// equilibrium. Taking it would work on memory that belongs to another method. Such a message, and
/// one that is_legal() refuses, has no effect but two: it is counted, and the neighbour, whose
/// faults are now known, counts as silent. Leaving it out alone would not do: a sum without it
/// could make a robot `safe` that is not.
bool Agent::expects(Direction face, std::span<const std::uint8_t> message) const {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kEcho:
      return ws_.tree.expects_echo(face) || welcomed_.has(face);
    case MessageType::kNews:
      return ws_.setup.keeps_answers && ws_.tree.wave() == SpanningTree::Wave::kTree &&
             (ws_.tree.children().has(face) || welcoming_.has(face));
    case MessageType::kAppoint:
      return ws_.tree.expects_appointment(face, message, sweep_.has_begun());
    case MessageType::kMark:
      return ws_.tree.expects_mark(face, sweep_.has_begun());
    case MessageType::kOrder:
      return ws_.tree.is_led_by(face) && !sweep_.is_under_way() && !has_next_order_ &&
             sweep_.is_in_course(ws_, decode_order(message));
    default:
      return sweep_.expects(ws_, face, message);
  }
}

void Agent::take_expected(Direction face, std::span<const std::uint8_t> message) {
  const Round& round = rounds_.current();
  const SpanningTree::Wave before = ws_.tree.wave();
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kEcho:
      return kKeepsAnswers && welcomed_.has(face)
                 ? take_newcomer(face, decoded<Echo>(message))
                 : ws_.tree.take_echo(ws_.links, face, decoded<Echo>(message));
    case MessageType::kNews:
      return kKeepsAnswers ? take_news(face, decoded<News>(message)) : void();
    case MessageType::kVector:
      return kKeepsAnswers && welcoming_.has(face)
                 ? take_motion(face, message[1], decoded<LabelledVector>(message).vector)
                 : sweep_.take(ws_, face, message);
    case MessageType::kAppoint:
      if (ws_.tree.take_appointment(ws_.links, round, decoded<Appointment>(message))) {
        watch_.enter_phase(Phase::kElection);
      }
      return follow_wave(before);
    case MessageType::kMark:
      ws_.tree.take_mark(ws_.links, round, decoded<Mark>(message));
      return follow_wave(before);
    case MessageType::kOrder:
      // What goes on behind the last report comes to its end first.
      return sweep_.is_busy(ws_) ? keep_order(decode_order(message))
                                 : take_order(decode_order(message));
    default:
      return sweep_.take(ws_, face, message);
  }
}

// ---- A piece of what follows.

/// Messages only leave something to do; it is done here, a piece at a time, none of which calls
/// another.
void Agent::go_on() {
  is_busy_ = sweep_.work(ws_, announcements_) || receive_rest() || sweep_.exchange(ws_) ||
             sweep_.do_piece(ws_) || finish_sweep() || end_wave() || take_next_order();
  if (ws_.links.take_refusal()) {
    leave_round();
  }
}

/// Reports, if all is done here and below; the root finds its next order.
bool Agent::finish_sweep() {
  if (!sweep_.take_end()) {
    return sweep_.begin_report(ws_);
  }
  const Order& order = sweep_.order();
  const bool is_root = ws_.tree.is_root();
  if (order.operation == wire::Operation::kVerdict) {
    const bool is_alone = is_root && ws_.tree.children().is_empty();
    const bool is_watched = order.answer.verdict != Verdict::kUndecided && !is_alone;
    if (!is_withdrawn_) {
      watch_.end_verdict(is_watched, is_root, clock_);
    }
    ws_.links.touch_all();
  } else if (is_root) {
    if (ws_.stages() != nullptr && go_on_in_stages(sweep_.sum())) {
      return true;
    }
    go_on_with(kKeepsAnswers && order.operation == wire::Operation::kRenew
                   ? conductor_.after_renew(ws_.setup, sweep_.sum(), ws_.planned, ws_.environment())
                   : conductor_.next(ws_.setup, sweep_.sum(), ws_.planned));
  }
  return true;
}

/// Once a wave has come back to where it started.
bool Agent::end_wave() {
  SpanningTree& tree = ws_.tree;
  if (!tree.take_return()) {
    return false;
  }
  const SpanningTree::Census& census = tree.census();
  if (ws_.stages() != nullptr && find_pieces()) {
    return true;
  }
  if (census.doubt != Doubt::kNone) {
    Order order{.operation = wire::Operation::kVerdict};
    order.answer = {.verdict = Verdict::kUndecided, .reason = reason_of(census.doubt)};
    keep_order(order);
  } else if (tree.wave() == SpanningTree::Wave::kTree) {
    keep_order(conductor_.begin(ws_.setup, tree.cell(), census.count, census.hops,
                                {.has_fronts = ws_.front_memory() != nullptr,
                                 .judges_faces = ws_.free_faces() != nullptr,
                                 .deflation = deflation_of(ws_)}));
  } else {
    const SpanningTree::Wave before = tree.wave();
    watch_.enter_phase(Phase::kElection);
    tree.appoint(ws_.links, rounds_.current());
    follow_wave(before);
  }
  return true;
}

bool Agent::take_next_order() {
  if (!has_next_order_ || sweep_.is_busy(ws_) || sweep_.is_under_way()) {
    return false;
  }
  has_next_order_ = false;
  take_order(next_order_);
  return true;
}

void Agent::keep_order(const Order& order) {
  next_order_ = order;
  has_next_order_ = true;
}

void Agent::take_order(const Order& order) {
  const bool is_renewal = order.operation == wire::Operation::kRenew;
  if (is_renewal && !welcomed_.is_empty()) {
    return leave_round();
  }
  is_withdrawn_ = is_withdrawn_ && !is_renewal;
  if (!is_withdrawn_) {
    watch_.begin_order(order.operation, ws_.tree.hops_max(), clock_);
  }
  sweep_.take_order(ws_, announcements_, order);
  if (order.operation == wire::Operation::kVerdict && !is_withdrawn_) {
    watch_.set_answer(order.answer);
  }
}

/// The clock has run out, or it is time to say the verdict again.
void Agent::run_out() {
  if (kKeepsAnswers && is_withdrawn_) {
    return leave_round();  // The news has not reached the root, or its answer not this module.
  }
  if (phase() == Phase::kDone && ws_.tree.is_root() && !sweep_.is_under_way()) {
    keep_order(sweep_.order());
    is_busy_ = true;
    watch_.stop();
    return;
  }
  ws_.links.touch_all();
  watch_.give_up(has_cell());
}

bool Agent::find_load_ratio(const base::Cell& cell, Direction direction, float& ratio) const {
  bool is_found = false;
  visit_loads(ws_, [&](const base::Cell& here, Direction there, double value) {
    if (here == cell && there == direction) {
      ratio = static_cast<float>(value);
      is_found = true;
    }
  });
  return is_found;
}

FreeFace Agent::free_face(Direction direction) const {
  const bool is_decided =
      answer().verdict != Verdict::kNone && answer().verdict != Verdict::kUndecided;
  return is_decided && ws_.free_faces() != nullptr ? ws_.free_faces()->face(direction) : FreeFace{};
}

// ---- Rounds.

/// The robot is not what it was when the round began. Until the next one this module takes no part
/// in anything; it waits a little, as changes come together.
void Agent::leave_round() {
  if (epoch() > 0 || !ws_.links.silent().is_empty()) {
    watch_.leave_round(clock_);
    abandon_work();
    rounds_.leave_until(clock_.now + clock_.timing.acknowledge_after);
  }
}

void Agent::abandon_work() {
  if (ws_.free_faces() != nullptr) {
    ws_.free_faces()->forget();
  }
  sweep_.leave(ws_);
  ws_.tree.take_return();
  has_next_order_ = false;
  is_withdrawn_ = false;
  welcomed_ = {};
  welcoming_ = {};
}

void Agent::start_round(Stage stage) {
  if (!has_cell()) {
    // Others must start; if nobody is left who can, this is the last word.
    rounds_.leave_until(kNever);
    if (!ws_.links.silent().is_empty()) {
      watch_.set_answer({.verdict = Verdict::kUndecided, .reason = Reason::kNeighbourSilent});
    }
    return;
  }
  enter_round({.epoch = epoch_after(epoch()), .starter = identity_.id}, stage);
  ws_.tree.start_wave(ws_.links, rounds_.current(), SpanningTree::Wave::kFirst);
  follow_wave(SpanningTree::Wave::kNone);
  is_busy_ = true;
}

void Agent::enter_round(const Round& round, Stage stage) {
  rounds_.enter(round);
  if (ws_.stages() != nullptr) {
    hide_links(round, stage);
  }
  announcements_.begin_anew();
  abandon_work();
  ws_.tree.leave(static_cast<std::uint8_t>(stage));
  ws_.exchange.enter();
  ws_.planned_exchange.enter();
  ws_.planned.clear();
  ws_.links.drop_unsent();
  watch_.enter_round(clock_);
}

/// A wave has been here: another phase if it was a new one.
void Agent::follow_wave(SpanningTree::Wave before) {
  if (ws_.tree.wave() != before) {
    watch_.enter_phase(phase_of(ws_.tree.wave()));
  }
}

}  // namespace holdfast::agent
