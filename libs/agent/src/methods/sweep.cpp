// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/sweep.hpp"

#include "equilibrium/survey.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/free_faces/free_faces.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "messages/resume_masks.hpp"
#include "methods/condensed.hpp"
#include "methods/method.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;

/// Whether an order with exchanges begins with them: kTreeIterate first finds displacements,
/// kClusters clusters.
bool starts_at_once(Operation operation) {
  return operation != Operation::kTreeIterate && operation != Operation::kClusters;
}

// Constants in a program without fronts.

bool makes_fronts(Course course) { return kHasAllMethods && course == Course::kFronts; }

/// Are planned modules condensed behind this order?
bool condenses(const Workspace& ws, const Order& order) {
  return moves_between_others(order.operation) && ws.planned.is_any_remote();
}

bool has_fronts(const Order& begin) { return kHasAllMethods && (begin.flags & kWithFronts) != 0; }

/// Constant in a program that does not judge free faces.
bool judges_faces(const Workspace& ws) { return ws.free_faces() != nullptr; }

/// Where an order leads; what it must not lead to has been refused before.
Course course_after(const Order& order, Course course) {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return Course::kPlanned;
    case Operation::kStage:
      return Course::kStaged;
    case Operation::kHosts:
      return Course::kHosted;
    case Operation::kMass:
    case Operation::kRenew:
      return Course::kWeighed;
    case Operation::kResume:
    case Operation::kResumeDeflated:
      return (order.flags & kWithIterations) == 0 ? Course::kElimination : Course::kPolynomial;
    case Operation::kBegin:
      return has_fronts(order)                      ? Course::kFronts
             : (order.flags & kWithIterations) == 0 ? Course::kElimination
                                                    : Course::kPolynomial;
    case Operation::kClusters:
      return Course::kClusters;
    case Operation::kVerdict:
      return Course::kAnswered;
    default:
      return course;
  }
}

}  // namespace

const MethodTable* Sweep::method() const { return method_in(course_); }

PlannedPart Sweep::planned_part(const Workspace& ws) const {
  const MethodTable* own = method();
  return own == nullptr ? PlannedPart::kTogether : own->planned_part(ws, order_);
}

Pending Sweep::pending() const {
  const MethodTable* own = method();
  return own == nullptr ? Pending::kNothing : own->pending(state_);
}

bool Sweep::is_busy(const Workspace& ws) const {
  return ws.exchange.is_under_way() || pending() == Pending::kBehindReport;
}

void Sweep::adopt(Workspace& ws) {
  course_ = Course::kWeighed;
  make_method(ws);
  has_tree_ = true;
  prepare_node(ws, 0);
  reset(ws.node(0));
}

void Sweep::make_method(Workspace& ws) {
  method()->make(state_);
  if (MoreFaces* more = ws.links.more(); more != nullptr) {
    more->child_cut_count = {};
  }
  if (MorePlanned* more = ws.planned.more_planned(); more != nullptr) {
    more->clear_methods();
  }
}

void Sweep::leave(Workspace& ws) {
  is_under_way_ = false;
  has_ended_ = false;
  work_ = Work::kNone;
  course_ = Course::kWaves;
  ws.exchange.leave();
  ws.reports.await({});
}

// ---- What may be said now.

bool Sweep::is_in_course(const Workspace& ws, const Order& order) const {
  if (order.operation == Operation::kVerdict) {  // Said again, it is the same one.
    return course_ == Course::kAnswered ? order.answer == order_.answer
                                        : is_good_answer(ws, order.answer);
  }
  if (ws.tree.wave() != SpanningTree::Wave::kTree) {
    return false;
  }
  switch (order.operation) {
    case Operation::kPlan:
      return order.index == kNoPlanned
                 ? course_ == Course::kWaves || (kKeepsAnswers && course_ == Course::kStaged)
                 : course_ == Course::kPlanned && order.index == ws.planned.count();
    case Operation::kForget:
      return course_ == Course::kPlanned;
    case Operation::kWord:
      return ws.stages() != nullptr && course_ == Course::kPlanned &&
             order.index == (order.count == 0 ? kNoWord : ws.stages()->learned_count()) &&
             ws.stages()->is_possible(word_of(static_cast<std::uint32_t>(order.mass), order.cell));
    case Operation::kStage:
      return ws.stages() != nullptr && course_ != Course::kWaves && course_ != Course::kAnswered &&
             ws.stages()->total() > 0 && ws.stages()->learned_count() == ws.stages()->total();
    case Operation::kHosts:
      return is_good_hosts(ws, order);
    case Operation::kMass:
      return (course_ == Course::kHosted && ws.planned.has_all_parts()) ||
             (kKeepsAnswers && course_ == Course::kStaged);
    case Operation::kAngles:
      return course_ == Course::kWeighed && fits_exact_check(ws.setup, order.mass) &&
             mass_report(ws).extent <= kExtentMax;
    case Operation::kRenew:
      return kKeepsAnswers && ws.setup.keeps_answers &&
             (course_ == Course::kAnswered || course_ == Course::kWeighed) &&
             (has_tree_ || (order.flags & kKeepsFactors) == 0);
    case Operation::kResume:
    case Operation::kResumeDeflated:
    case Operation::kIterateDeflated:
    case Operation::kIterateLast:
      return kKeepsAnswers && ws.setup.keeps_answers && is_good_from_kept(ws, order);
    case Operation::kBegin:
      return is_good_begin(ws, order);
    case Operation::kFactor:
    case Operation::kTreeIterate:
      return course_ == Course::kElimination || makes_fronts(course_);
    case Operation::kCorners:
    case Operation::kLoads:
    case Operation::kClose:
      return course_ >= Course::kElimination && course_ != Course::kAnswered;
    case Operation::kBend:
      return ws.setup.judges_bending && course_ >= Course::kElimination &&
             course_ != Course::kAnswered;
    case Operation::kShape:
      return judges_faces(ws) && course_ >= Course::kWeighed && course_ != Course::kAnswered &&
             ws.planned.count() == 0;
    case Operation::kNext:
      return judges_faces(ws) && course_ != Course::kAnswered &&
             ws.free_faces()->is_good_next(ws, order);
    case Operation::kClusters:
      return is_good_begin(ws, order) && ws.planned.count() <= kClusterPlannedMax;
    case Operation::kIterate:
      return course_ == Course::kClusters ||
             (course_ == Course::kPolynomial && (order.flags & kWithClusters) == 0);
    case Operation::kSeek:
      return kHasAllMethods && is_good_seek(ws, order);
    default:
      return order.operation == Operation::kHold &&
             (course_ == Course::kPolynomial || makes_fronts(course_));
  }
}

/// Whether these can be the faces that touch planned modules, or the next part of them.
bool Sweep::is_good_hosts(const Workspace& ws, const Order& order) const {
  const bool is_next = !kIsGeneral || order.index == ws.planned.parts_here();
  const bool is_first = course_ == Course::kPlanned;
  return is_next && (is_first || (course_ == Course::kHosted && !ws.planned.has_all_parts())) &&
         ws.planned.agrees_with(order.masks, order.index);
}

/// Whether this can be the verdict now: none is found before what decides it, but for one that is
/// said again, as the robot's shape is the same or a module has come, and that on all stages of a
/// step together, which this module knows, too; and no robot is safe whose connection here breaks.
bool Sweep::is_good_answer(const Workspace& ws, const Answer& answer) const {
  const bool is_overall = kKeepsAnswers && course_ == Course::kStaged && ws.stages() != nullptr &&
                          answer == ws.stages()->overall();
  if (is_overall) {
    return true;
  }
  const bool is_judged =
      course_ >= Course::kElimination || (is_renewed_ && course_ == Course::kWeighed);
  switch (answer.verdict) {
    case Verdict::kSafe:
      return is_judged && !mechanics::breaks(static_cast<double>(ws.own_load_ratio));
    case Verdict::kOverload:
      return is_judged;
    case Verdict::kUnstable:
      return course_ >= Course::kWeighed;
    default:
      return true;
  }
}

/// Whether an equilibrium may begin by this order. What elimination knows of the tree lives until
/// another method begins.
bool Sweep::is_good_begin(const Workspace& ws, const Order& order) const {
  if (course_ < Course::kWeighed || course_ == Course::kAnswered ||
      (order.flags & kOneSweep) == 0) {
    return false;
  }
  const Course next = course_after(order, course_);
  if (next == Course::kElimination) {
    return course_ <= Course::kElimination && order.count == 0 &&
           !state_.elimination.has_too_many_loops();
  }
  if (makes_fronts(next)) {
    return method_in(next) != nullptr && ws.front_memory() != nullptr && order.count == 0;
  }
  return method_in(next) != nullptr && (order.flags & kWithIterations) != 0;
}

bool Sweep::is_good_resume(const Workspace& ws, const Order& order) const {
  const bool is_weighed = (order.flags & kRests) == 0 || fits_exact_check(ws.setup, order.mass);
  const bool is_possible = (order.flags & kWithIterations) != 0 ||
                           (order.count == 0 && !state_.elimination.has_too_many_loops());
  return course_ == Course::kWeighed && is_weighed &&
         ws.planned.agrees_with(masks_of_resume(order.masks, face_count(ws.setup))) &&
         is_possible && (order.flags & kOneSweep) != 0;
}

bool Sweep::is_good_seek(const Workspace& ws, const Order& order) const {
  return !ws.setup.only_one_sweep &&
         (order.flags == 0 || order.flags == kOneFoot ||
          (order.flags == kEachState &&
           (order.key() & kStateBits) < mechanics::ContactState::kCodeCount) ||
          (order.flags == kRemember && order.key() == 0)) &&
         (course_ == Course::kElimination || course_ == Course::kPolynomial ||
          makes_fronts(course_));
}

/// Whether an equilibrium may begin from what is kept, or an iteration go along it, for which a
/// module needs memory.
bool Sweep::is_good_from_kept(const Workspace& ws, const Order& order) const {
  const bool is_resumed_so = order.operation == Operation::kResumeDeflated;
  const bool needs_memory = is_resumed_so || order.operation == Operation::kIterateDeflated;
  if ((needs_memory && ws.kept_changes() == nullptr) ||
      (is_resumed_so && (order.flags & kWithIterations) == 0)) {
    return false;
  }
  return is_resume(order.operation) ? is_good_resume(ws, order) : course_ == Course::kPolynomial;
}

bool Sweep::expects(const Workspace& ws, Direction face, Message message) const {
  const MethodTable* own = method();
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kReport:
      return ws.reports.awaits(face) && message[1] == static_cast<std::uint8_t>(order_.operation);
    case MessageType::kPlannedDown: {
      // Parts are those of condensed modules.
      const bool is_part = message[1] > kPlannedIndexMask;
      return ws.tree.is_led_by(face) && (message[1] & kPlannedIndexMask) < ws.planned.count() &&
             (!is_part || (own != nullptr && own->condense != nullptr));
    }
    case MessageType::kPlannedUp:
      return ws.tree.children().has(face) && message[1] < ws.planned.count() &&
             (!moves_between_others(order_.operation) || ws.planned_exchange.awaits_forces());
    case MessageType::kVector:
      return true;
    case MessageType::kCellsUp:
    case MessageType::kCellsDown:
    case MessageType::kReach:
      return judges_faces(ws) && ws.free_faces()->expects(ws, face, message);
    default:
      return own != nullptr && own->expects(state_, ws, order_, face, message);
  }
}

// ---- What comes in.

void Sweep::take_order(Workspace& ws, Announcements& announcements, const Order& order) {
  order_ = order;
  if (order.operation != Operation::kShape && order.operation != Operation::kNext) {
    is_renewed_ = order.operation == Operation::kRenew;
  }
  course_ = course_after(order, course_);
  is_under_way_ = true;
  announcements.finish_forgetting();
  ws.reports.await(ws.tree.children());
  ws.exchange.plan(exchange_count(order), exchanges_behind(order));
  ws.links.send(ws.tree.children(), encode(order));
  if (is_survey(order.operation)) {
    begin_survey(ws, announcements, order);
  } else if (is_resume(order.operation)) {
    resume_survey(ws, announcements, order);
  }
  begin_faces(ws, order);
  begin_method(ws, order);
}

/// What is known of free faces begins, ends, or is added to by the verdict on a single plan.
void Sweep::begin_faces(Workspace& ws, const Order& order) {
  FreeFaces* faces = ws.free_faces();
  if (faces == nullptr) {
    return;
  }
  const bool is_grown =
      order.operation == Operation::kRenew && (order.flags & (kIsGrown | kIsFulfilled)) != 0;
  if (order.operation == Operation::kShape || is_grown) {
    faces->forget();
  } else if (order.operation == Operation::kNext) {
    faces->begin_next(ws, order);
  } else if (order.operation == Operation::kVerdict && ws.planned.count() == 1) {
    faces->note(ws.planned.own_face(0), order.answer);
  }
}

void Sweep::begin_method(Workspace& ws, const Order& order) {
  const Operation operation = order.operation;
  // What elimination has learned with kMass it needs in its equilibrium.
  const bool is_begin = operation == Operation::kBegin || is_resume(operation);
  const bool is_renewed = operation == Operation::kRenew && (order.flags & kKeepsFactors) == 0;
  if (operation == Operation::kMass || is_renewed || operation == Operation::kClusters ||
      (is_begin && course_ != Course::kElimination)) {
    has_tree_ = course_ == Course::kWeighed;
    make_method(ws);
  }
  begin_work(Work::kBegin);
  if (is_survey(operation)) {
    end_work(ws);
  }
}

void Sweep::begin_work(Work work) {
  work_ = work;
  piece_ = 0;
}

bool Sweep::work(Workspace& ws, const Announcements& announcements) {
  bool has_more = false;
  switch (work_) {
    case Work::kNone:
      return false;
    case Work::kReport:
      has_more = report(ws, announcements);
      break;
    case Work::kSum:
      add_up(ws);
      break;
    case Work::kBegin:
      has_more = method()->begin(state_, ws, order_, piece_);
      break;
    case Work::kExchange:
      has_more = method()->take_exchange(state_, ws, order_, piece_);
      break;
    case Work::kBeginCondense:
    case Work::kCondense:
      has_more = method()->condense(state_, ws, order_, piece_);
  }
  piece_ = piece_ < 0xff ? static_cast<std::uint8_t>(piece_ + 1) : piece_;
  if (!has_more) {
    end_work(ws);
  }
  return true;
}

void Sweep::end_work(Workspace& ws) {
  const Work ended = work_;
  work_ = Work::kNone;
  if (ended == Work::kReport) {
    begin_work(Work::kSum);
  } else if (ended == Work::kExchange) {
    end_exchange(ws);
  } else if (ended == Work::kBegin && condenses(ws, order_) &&
             !ws.planned_exchange.awaits_forces()) {
    begin_work(Work::kBeginCondense);
  } else if (ended <= Work::kBeginCondense && ws.exchange.left() > 0 &&
             starts_at_once(order_.operation)) {
    ws.start_exchange(planned_part(ws));
  }
}

void Sweep::take(Workspace& ws, Direction face, Message message) {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kReport:
      return ws.reports.take(ws.links.more(), face, message);
    case MessageType::kVector:
      return ws.exchange.take(ws.links.more(), face, message);
    case MessageType::kPlannedDown:
      return take_planned_down(ws, message);
    case MessageType::kPlannedUp:
      return take_planned_up(ws, message);
    case MessageType::kCellsUp:
    case MessageType::kCellsDown:
    case MessageType::kReach:
      return kKeepsAnswers ? ws.free_faces()->take(ws, face, message) : void();
    default:
      return method()->take(state_, ws, order_, face, message);
  }
}

void Sweep::take_planned_down(Workspace& ws, Message message) {
  if (message[1] > kPlannedIndexMask) {
    take_condensed(ws, message);
  } else {
    ws.planned_exchange.take_down(ws.links, ws.tree.children(), ws.planned, message);
  }
}

void Sweep::take_planned_up(Workspace& ws, Message message) {
  if (ws.planned_exchange.take_up(ws.planned, message) && !makes_fronts(course_)) {
    begin_work(Work::kCondense);
  }
}

// ---- What follows.

bool Sweep::exchange(Workspace& ws) {
  if (!ws.exchange.is_under_way()) {
    return false;
  }
  const PlannedPart part = planned_part(ws);
  const bool waits_for_hosts =
      part != PlannedPart::kApart && (!ws.planned_exchange.is_complete(ws.planned) ||
                                      ((part == PlannedPart::kCondensed || makes_fronts(course_)) &&
                                       ws.planned_exchange.awaits_forces()));
  // What children add to planned modules emulated here comes before their reports. It belongs to an
  // order's last exchange.
  const bool waits_for_children = ws.exchange.is_last() && !ws.reports.are_here();
  if (!ws.exchange.is_complete(ws.links.used()) || waits_for_hosts || waits_for_children) {
    return false;
  }
  begin_work(Work::kExchange);
  return true;
}

void Sweep::end_exchange(Workspace& ws) {
  const PlannedPart part = planned_part(ws);
  if (part != PlannedPart::kApart) {
    ws.planned_exchange.end();
  }
  if (part == PlannedPart::kTogether) {
    ws.planned_exchange.send_up(ws.links, ws.tree.parent(), ws.planned,
                                is_precise(order_.operation) || makes_fronts(course_));
  }
  ws.exchange.end();
  if (ws.exchange.left() > 0 && pending() != Pending::kBehindReport) {
    ws.start_exchange(planned_part(ws));
  }
}

bool Sweep::do_piece(Workspace& ws) {
  if (judges_faces(ws) && ws.free_faces()->do_piece(ws)) {
    return true;
  }
  const MethodTable* own = method();
  return own != nullptr && own->do_piece(state_, ws, order_);
}

bool Sweep::begin_report(const Workspace& ws) {
  if (!is_under_way_ || !ws.reports.are_here() || pending() == Pending::kBeforeReport ||
      ws.exchange.left_before_report() > 0 || (judges_faces(ws) && !ws.free_faces()->is_done())) {
    return false;
  }
  sum_ = {};
  begin_work(Work::kReport);
  return true;
}

/// A piece of what this module reports.
bool Sweep::report(Workspace& ws, const Announcements& announcements) {
  const Operation operation = order_.operation;
  if (is_resume(operation)) {
    sum_ = resume_report(ws, order_);
    return false;
  }
  if (kKeepsAnswers && operation == Operation::kShape) {
    sum_ = ws.free_faces()->shape_report(ws);
    return false;
  }
  if (kKeepsAnswers && operation == Operation::kNext) {
    sum_ = ws.free_faces()->next_report();
    return false;
  }
  if (!is_survey(operation)) {
    return method()->report(state_, ws, order_, piece_, sum_);
  }
  sum_ = survey_report(ws, announcements, order_);
  if (kKeepsAnswers && operation == Operation::kRenew && (order_.flags & kKeepsFactors) != 0) {
    sum_.flags = static_cast<std::uint8_t>(sum_.flags |
                                           (state_.elimination.has_new_loop(ws) ? kNewLoop : 0U));
  } else if (operation == Operation::kMass || operation == Operation::kRenew) {
    sum_.flags = static_cast<std::uint8_t>(sum_.flags | state_.elimination.survey_loops(ws));
  }
  return false;
}

void Sweep::add_up(Workspace& ws) {
  is_under_way_ = false;
  has_ended_ = true;
  for (const Direction face : ws.tree.children()) {
    const Report theirs = decode_report(ws.reports.of(ws.links.more(), face));
    add_report(ws.setup, order_, sum_, theirs);
    if (order_.operation == Operation::kPlan && order_.index != kNoPlanned) {
      ws.planned.add_below(face, order_.index, Faces::from_mask(theirs.mask));
    }
    if (order_.operation == Operation::kRenew && is_new_plan(order_)) {
      ws.planned.add_below(face, ws.planned.count() - 1, Faces::from_mask(theirs.mask));
    }
    if (kKeepsAnswers && order_.operation == Operation::kShape) {
      ws.free_faces()->take_shape(face, theirs);
    }
  }
  if (kKeepsAnswers && order_.operation == Operation::kShape) {
    ws.free_faces()->take_shape_here(sum_);
  }
  if (!ws.tree.is_root()) {
    ws.links.send(ws.tree.parent(), encode(order_.operation, sum_));
  }
}

bool Sweep::take_end() {
  const bool has_ended = has_ended_;
  has_ended_ = false;
  return has_ended;
}

}  // namespace holdfast::agent
