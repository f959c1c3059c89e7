// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/agent/messages.hpp"
#include "methods.hpp"

/// Three waves with echo [Segall 1983], one after the other.
///
/// A wave starts at one module. Who hears of it first from a neighbour makes that its parent and
/// passes it on to all others; who has heard from all neighbours answers its parent (echo), adding
/// up what its children say. Two messages cross every connection.
///   1  from the starter: every module learns its cell; the echo counts modules, and names one that
///      is furthest away, A.
///   2  from A: names one that is furthest from A, B. (A path from A to B is nearly a longest one.)
///   3  from the module half way from B to A: near the topological centre. Its tree is used.
/// The double sweep finds the centre of any tree exactly [Handler 1973]. In a lattice there are
/// many shortest ways from B to A, and those along its edges have their middle in a corner, at the
/// end of everything: so of all of them one is taken that keeps to the straight line between the
/// two (test/waves_test.cpp measures how near the centre it is).
namespace holdfast::agent {

void Agent::start_wave(std::uint8_t stage) {
  root_cell_ = nodes_[0].cell;
  begin_stage(stage, -1, 0);
}

void Agent::begin_stage(std::uint8_t stage, int parent, std::uint16_t hops) {
  stage_ = stage;
  phase_ = stage == kFirstStage ? Phase::kCoordinates
           : stage == kFarStage ? Phase::kElection
                                : Phase::kTree;
  parent_ = static_cast<std::int8_t>(parent);
  hops_ = hops;
  nearer_ = parent < 0 ? std::uint8_t{0} : bit(parent);
  children_ = 0;
  is_stage_over_ = false;
  census_count_ = 1;
  census_hops_ = hops;
  census_id_ = identity_.id;
  is_anyone_silent_ = silent_faces_ != 0;
  awaited_ = used_faces();
  if (parent >= 0) {
    awaited_ = static_cast<std::uint8_t>(awaited_ & ~bit(parent));
  }
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((awaited_ & bit(face)) == 0) {
      continue;
    }
    send(face, encode(Join{.round = round_,
                           .wave = stage,
                           .cell = stage == kFirstStage ? nodes_[0].cell : root_cell_,
                           .hops = hops}));
  }
  await_less(-1);
}

void Agent::take_join(int face, std::span<const std::uint8_t> message) {
  const auto [round, stage, theirs, theirs_hops] = decoded<Join>(message);
  peer_round_[static_cast<std::size_t>(face)] = round;
  // 65,535 stands for all that is further: too large (feet.hpp).
  const auto hops = static_cast<std::uint16_t>(theirs_hops + (theirs_hops > kExtentMax ? 0 : 1));
  if (is_newer(round, round_)) {
    enter_round(round);
  } else if (!(round == round_) || restart_at_ != kNever) {
    return;
  }
  if (stage > stage_ + 1 || (stage > stage_ && course_ != Course::kWaves)) {
    return refuse(face);  // A wave has been left out, or the tree is in use.
  }
  keep_waiting();
  if (stage > stage_) {
    if (stage == kFirstStage) {
      const auto direction = static_cast<base::Direction>(face);
      nodes_[0].cell = base::neighbour(theirs, base::opposite(direction));
      has_cell_ = true;
    } else {
      root_cell_ = theirs;
    }
    begin_stage(stage, face, hops);
  } else if (stage == stage_) {
    nearer_ = static_cast<std::uint8_t>(nearer_ | (hops <= hops_ ? bit(face) : 0U));
    await_less(face);
  }
}

void Agent::take_echo(int face, std::span<const std::uint8_t> message) {
  const auto echo = decoded<Echo>(message);
  if (echo.wave != stage_) {
    return;
  }
  census_count_ += echo.count;
  if (echo.hops > census_hops_ || (echo.hops == census_hops_ && echo.id < census_id_)) {
    census_hops_ = echo.hops;
    census_id_ = echo.id;
  }
  is_anyone_silent_ = echo.is_anyone_silent != 0 || is_anyone_silent_;
  children_ = static_cast<std::uint8_t>(children_ | bit(face));
  await_less(face);
}

/// One neighbour less to wait for; -1 only looks.
void Agent::await_less(int face) {
  if (face >= 0) {
    if ((awaited_ & bit(face)) == 0) {
      return;
    }
    awaited_ = static_cast<std::uint8_t>(awaited_ & ~bit(face));
  }
  if (awaited_ != 0) {
    return;
  }
  if (parent_ < 0) {
    is_stage_over_ = true;
    return;
  }
  send(parent_,
       encode(Echo{.round = round_,
                   .wave = stage_,
                   .count = census_count_,
                   .hops = census_hops_,
                   .id = census_id_,
                   .is_anyone_silent = is_anyone_silent_ ? std::uint8_t{1} : std::uint8_t{0}}));
}

/// Once the wave has come back to where it started.
bool Agent::end_stage() {
  if (!is_stage_over_) {
    return false;
  }
  is_stage_over_ = false;
  if (is_anyone_silent_) {
    next_order_ = {.operation = wire::Operation::kVerdict};
    next_order_.answer = {.verdict = Verdict::kUndecided, .reason = Reason::kNeighbourSilent};
    has_next_order_ = true;
    return true;
  }
  if (stage_ == kTreeStage) {
    next_order_ = conductor_.begin(setup_, nodes_[0].cell, census_count_, census_hops_);
    has_next_order_ = true;
    return true;
  }
  take_appointment(
      {.wave = stage_, .id = census_id_, .hops = static_cast<std::uint16_t>(census_hops_ / 2)});
  return true;
}

void Agent::take_appointment(const Appointment& appointment) {
  if (appointment.wave != stage_) {
    return;  // Too late: the next wave was here already.
  }
  phase_ = Phase::kElection;
  if (appointment.id != identity_.id) {
    send_to_children(encode(appointment));
  } else if (stage_ == kFirstStage) {
    start_wave(kFarStage);
  } else {
    take_mark({.hops = appointment.hops, .sender = nodes_[0].cell});
  }
}

/// One step towards the wave's root: of the neighbours nearer to it the one that is nearest to the
/// place half way between it and `end`.
int Agent::face_towards_root(const base::Cell& end) const {
  int best = parent_;
  std::int64_t least = ~(std::int64_t{1} << 63U);
  for (const base::Direction direction : base::kDirections) {
    if ((nearer_ & bit(base::index(direction))) == 0) {
      continue;
    }
    const base::Cell there = base::neighbour(nodes_[0].cell, direction);
    const std::int64_t x = 2 * there.x - root_cell_.x - end.x;
    const std::int64_t y = 2 * there.y - root_cell_.y - end.y;
    const std::int64_t z = 2 * there.z - root_cell_.z - end.z;
    const std::int64_t square = x * x + y * y + z * z;
    if (square < least) {
      least = square;
      best = base::index(direction);
    }
  }
  return best;
}

/// So many hops more to the middle of the way from the sender to the wave's root.
void Agent::take_mark(const Mark& mark) {
  if (mark.hops == 0 || parent_ < 0) {
    start_wave(kTreeStage);
    return;
  }
  send(face_towards_root(mark.sender),
       encode(Mark{.hops = static_cast<std::uint16_t>(mark.hops - 1), .sender = mark.sender}));
}

}  // namespace holdfast::agent
