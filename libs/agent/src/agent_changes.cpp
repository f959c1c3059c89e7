// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What changes after a verdict. A module that is told of a plan, or finds a new neighbour,
// withdraws its verdict and tells the root, which begins the next one from what all modules keep
// (conductor/renewal.hpp). Whatever does not fit, here or on the way, is left to a new round.
#include "equilibrium/kept_changes.hpp"
#include "equilibrium/survey.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/equilibrium/deflation.hpp"

namespace holdfast::agent {
namespace {

/// How a module that comes to `cell` moves: as the planned one did if that is known here.
base::Vec6<double> motion_at(const Workspace& ws, const base::Cell& cell) {
  const int k = ws.planned.find(cell);
  if (k >= 0 && (ws.planned.node_of(k) > 0 || ws.planned.is_from_above(k))) {
    return ws.node(ws.planned.slot_of(k)).u;
  }
  return stiff_motion(ws, ws.node(0).u, cell);
}

}  // namespace

/// Does the verdict stand here, and can it be told that something changes?
bool Agent::can_keep() const {
  const Verdict verdict = answer().verdict;
  const bool is_decided = verdict != Verdict::kNone && verdict != Verdict::kUndecided;
  return ws_.setup.keeps_answers && is_decided && phase() == Phase::kDone && !rounds_.is_left() &&
         !has_next_order_ && ws_.tree.wave() == SpanningTree::Wave::kTree &&
         ws_.links.silent().is_empty() && (ws_.stages() == nullptr || ws_.stages()->total() == 0);
}

/// This module was told of a plan, or of its end. Before the kRenew has come that another change
/// has asked for there is nothing to tell: the report to that will.
void Agent::change(const News& news) {
  if (!announcements_.has(news.cell) || news.cell == kEveryCell || !(can_keep() || is_withdrawn_)) {
    return leave_round();
  }
  if (!is_withdrawn_) {
    withdraw();
    tell(news);
  }
}

void Agent::withdraw() {
  is_withdrawn_ = true;
  watch_.withdraw(clock_);
  ws_.links.touch_all();
}

void Agent::tell(const News& news) {
  if (!ws_.tree.is_root()) {
    ws_.links.send(ws_.tree.parent(), encode(news));
  } else if (conductor_.can_renew(ws_.setup)) {
    go_on_with(conductor_.renew(ws_.setup, news, ws_.planned, ws_.environment()));
  } else {
    leave_round();
  }
}

/// News of the parent, to a module that has come: what is planned. News of a child, for the root:
/// if the root has begun to renew its verdict already, a plan will be reported to it all the same.
void Agent::take_news(Direction face, const News& news) {
  if (!ws_.tree.children().has(face)) {
    if (ws_.tree.parent().has(face) && ws_.planned.find(news.cell) < 0) {
      ws_.planned.add(news.cell, cell());
    }
    return;
  }
  const bool is_known = is_withdrawn_ && ws_.tree.is_root();
  if (is_known && news.flags == 0) {
    return;
  }
  if (is_known || !(is_withdrawn_ || can_keep())) {
    return leave_round();
  }
  withdraw();
  tell(news);
}

void Agent::go_on_with(const Order& order) {
  if (order.operation == wire::Operation{}) {
    return leave_round();
  }
  keep_order(order);
  is_busy_ = true;
}

// ---- A module comes.

/// What a neighbour that has come needs to take its place in the tree: where it is, and how it
/// moves.
void Agent::welcome(Direction face) {
  withdraw();
  welcomed_ = Faces::only(face);
  Adoption adoption = ws_.tree.adoption(rounds_.current());
  adoption.wave_time = watch_.wave_time();
  find_load_ratio(cell(), face, adoption.load_ratio);
  ws_.links.send(welcomed_, encode(adoption));
  const base::Cell there = neighbour(ws_.links.more(), cell(), face);
  for (int k = 0; k < ws_.planned.count(); ++k) {
    if (ws_.planned.cell(k) != there) {
      ws_.links.send(welcomed_, encode(News{.cell = ws_.planned.cell(k)}));
    }
  }
  if (const KeptChanges* kept = ws_.kept_changes(); kept != nullptr) {
    std::uint8_t label = 0;
    for (const base::Vec6<float>& change : kept->changes) {
      ws_.links.send(welcomed_, vector_message(wire::MessageType::kVector, ++label, change));
    }
  }
  ws_.links.send(welcomed_, vector_message(wire::MessageType::kVector, 0,
                                           base::converted<float>(motion_at(ws_, there))));
}

/// The third wave of a round that this module knows nothing of: the neighbour has come as well, and
/// has found its place before this module has.
bool Agent::is_of_newcomer(const Join& join) const {
  return ws_.setup.keeps_answers &&
         join.wave == static_cast<std::uint8_t>(SpanningTree::Wave::kTree) &&
         is_newer(join.round, rounds_.current());
}

/// Who hears of a module without a place, on the way up the tree, starts a new round.
void Agent::decline(Direction face, const Join& join) {
  ws_.links.send(Faces::only(face), encode(Echo{.round = join.round,
                                                .wave = join.wave,
                                                .count = 1,
                                                .hops = join.hops,
                                                .id = identity_.id,
                                                .doubt = Doubt::kNeighbourSilent}));
}

/// A neighbour has sent what welcome() sends. False: no working one does.
bool Agent::take_adoption(Direction face, const Adoption& adoption) {
  rounds_.hear(ws_.links.more(), face, adoption.round);
  const bool is_ours = adoption.round == rounds_.current();
  if (!ws_.setup.keeps_answers || (!is_ours && !is_newer(adoption.round, rounds_.current()))) {
    return ws_.setup.keeps_answers;
  }
  if (is_ours && !welcomed_.is_empty()) {
    leave_round();  // A new link between two that have been there before.
    return true;
  }
  if (is_ours) {
    welcoming_.add(face);
    ws_.own_load_ratio = larger(ws_.own_load_ratio, adoption.load_ratio);
    ws_.tree.take_adoption(ws_.links, face, adoption);
    return true;
  }
  const bool is_first = epoch() == 0 && !ws_.is_fixed;
  enter_round(adoption.round);
  ws_.tree.adopt(ws_.links, face, adoption);
  if (!is_first) {
    leave_round();  // It has a past, or stands apart from what was planned.
    return true;
  }
  welcoming_.add(face);
  sweep_.adopt(ws_);
  watch_.set_wave_time(adoption.wave_time, ws_.tree.hops_max(), clock_.timing);
  ws_.own_load_ratio = adoption.load_ratio;
  withdraw();
  return true;
}

/// The last of what welcome() sends; the parent's counts. Others' may come when this module has had
/// its place for long, and is no vector of an exchange then either.
void Agent::take_motion(Direction face, std::uint8_t label, const base::Vec6<float>& motion) {
  if (label != 0) {
    return hear_change(ws_, face, label - 1, motion);
  }
  welcoming_.remove(face);
  if (ws_.tree.parent().has(face)) {
    ws_.node(0).u = base::converted<double>(motion);
  }
}

/// The neighbour that has come has its place below this module.
void Agent::take_newcomer(Direction face, const Echo& echo) {
  ws_.tree.take_echo(ws_.links, face, echo);
  welcomed_.remove(face);
  const base::Cell there = neighbour(ws_.links.more(), cell(), face);
  const bool is_planned = ws_.planned.find(there) >= 0;
  if (echo.count != 1 || echo.doubt != Doubt::kNone) {
    return leave_round();
  }
  tell({.flags = static_cast<std::uint8_t>(kIsGrown | (is_planned ? kIsEnded | kIsFulfilled : 0U)),
        .hops = static_cast<std::uint16_t>(depth() + 1),
        .cell = there});
}

}  // namespace holdfast::agent
