// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bits.hpp"
#include "holdfast/agent/agent.hpp"
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

using wire::MessageType;
using wire::Reader;
using wire::Writer;

/// Joins and echoes begin with the type and the round.
inline constexpr std::size_t kRoundBytes = 7;

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
    Writer join(MessageType::kJoin);
    join.u16(round_.epoch);
    join.u32(round_.starter);
    join.u8(stage);
    join.cell(stage == kFirstStage ? nodes_[0].cell : root_cell_);
    join.u16(hops);
    send(face, join);
  }
  await_less(-1);
}

void Agent::take_join(int face, std::span<const std::uint8_t> message) {
  Reader in(message, kRoundBytes);
  const Round round = peer_round_[static_cast<std::size_t>(face)];
  const std::uint8_t stage = in.u8();
  const base::Cell theirs = in.cell();
  // 65,535 stands for all that is further: too large (feet.hpp).
  const std::uint16_t theirs_hops = in.u16();
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
  Reader in(message, kRoundBytes);
  if (in.u8() != stage_) {
    return;
  }
  census_count_ += in.u32();
  const std::uint16_t hops = in.u16();
  const std::uint32_t id = in.u32();
  if (hops > census_hops_ || (hops == census_hops_ && id < census_id_)) {
    census_hops_ = hops;
    census_id_ = id;
  }
  is_anyone_silent_ = in.u8() != 0 || is_anyone_silent_;
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
  Writer echo(MessageType::kEcho);
  echo.u16(round_.epoch);
  echo.u32(round_.starter);
  echo.u8(stage_);
  echo.u32(census_count_);
  echo.u16(census_hops_);
  echo.u32(census_id_);
  echo.u8(is_anyone_silent_ ? 1 : 0);
  send(parent_, echo);
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
  Writer appoint(MessageType::kAppoint);
  appoint.u8(stage_);
  appoint.u32(census_id_);
  appoint.u16(static_cast<std::uint16_t>(census_hops_ / 2));
  take_appointment(appoint.bytes());
  return true;
}

void Agent::take_appointment(std::span<const std::uint8_t> message) {
  Reader in(message);
  const std::uint8_t stage = in.u8();
  const std::uint32_t id = in.u32();
  const std::uint16_t hops = in.u16();
  if (stage != stage_) {
    return;  // Too late: the next wave was here already.
  }
  phase_ = Phase::kElection;
  if (id == identity_.id) {
    if (stage == kFirstStage) {
      start_wave(kFarStage);
    } else {
      mark(hops, nodes_[0].cell);
    }
    return;
  }
  Writer onward(MessageType::kAppoint);
  onward.u8(stage);
  onward.u32(id);
  onward.u16(hops);
  send_to_children(onward);
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

void Agent::take_mark(std::span<const std::uint8_t> message) {
  Reader in(message);
  const std::uint16_t hops = in.u16();
  mark(hops, in.cell());
}

/// So many hops more to the middle of the way from `end` to the wave's root.
void Agent::mark(std::uint16_t hops, const base::Cell& end) {
  if (hops == 0 || parent_ < 0) {
    start_wave(kTreeStage);
    return;
  }
  Writer onward(MessageType::kMark);
  onward.u16(static_cast<std::uint16_t>(hops - 1));
  onward.cell(end);
  send(face_towards_root(end), onward);
}

}  // namespace holdfast::agent
