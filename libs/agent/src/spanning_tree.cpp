// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/spanning_tree.hpp"

#include "holdfast/agent/feet.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Reader;
using wire::Writer;

/// Joins and echoes begin with the type and the round.
constexpr std::size_t kRoundBytes = 7;

Writer wave_message(MessageType type, const Round& round, SpanningTree::Stage stage) {
  Writer message(type);
  message.u16(round.epoch);
  message.u32(round.starter);
  message.u8(static_cast<std::uint8_t>(stage));
  return message;
}

}  // namespace

void SpanningTree::leave() {
  stage_ = Stage::kNone;
  parent_ = {};
  children_ = {};
  has_returned_ = false;
}

void SpanningTree::start_wave(Links& links, const Round& round, Stage stage) {
  root_cell_ = cell_;
  begin_stage(links, round, stage, {}, 0);
}

void SpanningTree::begin_stage(Links& links, const Round& round, Stage stage, Faces parent,
                               std::uint16_t hops) {
  stage_ = stage;
  parent_ = parent;
  hops_ = hops;
  nearer_ = parent;
  children_ = {};
  has_returned_ = false;
  census_ = {.count = 1, .hops = hops, .id = id_, .is_anyone_silent = !links.silent().is_empty()};
  awaited_ = links.used() - parent;
  Writer join = wave_message(MessageType::kJoin, round, stage);
  join.cell(stage == Stage::kFirst ? cell_ : root_cell_);
  join.u16(hops);
  links.send(awaited_, join);
  await_less(links, round, {});
}

bool SpanningTree::take_join(Links& links, const Round& round, Direction face,
                             std::span<const std::uint8_t> message, bool is_in_use) {
  Reader in(message, kRoundBytes);
  const auto stage = static_cast<Stage>(in.u8());
  const base::Cell theirs = in.cell();
  // 65,535 stands for all that is further: too large (feet.hpp).
  const std::uint16_t theirs_hops = in.u16();
  const auto hops = static_cast<std::uint16_t>(theirs_hops + (theirs_hops > kExtentMax ? 0 : 1));
  const bool is_next = stage > stage_;
  if (is_next && (static_cast<int>(stage) > static_cast<int>(stage_) + 1 || is_in_use)) {
    return false;  // A wave has been left out, or the tree is in use.
  }
  if (is_next) {
    if (stage == Stage::kFirst) {
      cell_ = base::neighbour(theirs, base::opposite(face));
      has_cell_ = true;
    } else {
      root_cell_ = theirs;
    }
    begin_stage(links, round, stage, {face}, hops);
  } else if (stage == stage_) {
    if (hops <= hops_) {
      nearer_.add(face);
    }
    await_less(links, round, {face});
  }
  return true;
}

void SpanningTree::take_echo(Links& links, const Round& round, Direction face,
                             std::span<const std::uint8_t> message) {
  Reader in(message, kRoundBytes);
  if (static_cast<Stage>(in.u8()) != stage_) {
    return;
  }
  census_.count += in.u32();
  const std::uint16_t hops = in.u16();
  const std::uint32_t id = in.u32();
  if (hops > census_.hops || (hops == census_.hops && id < census_.id)) {
    census_.hops = hops;
    census_.id = id;
  }
  census_.is_anyone_silent = in.u8() != 0 || census_.is_anyone_silent;
  children_.add(face);
  await_less(links, round, {face});
}

/// These neighbours less to wait for; when none is left the wave has come back.
void SpanningTree::await_less(Links& links, const Round& round, Faces faces) {
  if (!faces.is_empty() && (awaited_ & faces).is_empty()) {
    return;
  }
  awaited_ -= faces;
  if (!awaited_.is_empty()) {
    return;
  }
  if (is_root()) {
    has_returned_ = true;
  } else {
    send_echo(links, round);
  }
}

void SpanningTree::send_echo(Links& links, const Round& round) const {
  Writer echo = wave_message(MessageType::kEcho, round, stage_);
  echo.u32(census_.count);
  echo.u16(census_.hops);
  echo.u32(census_.id);
  echo.u8(census_.is_anyone_silent ? 1 : 0);
  links.send(parent_, echo);
}

bool SpanningTree::take_return() {
  const bool has_returned = has_returned_;
  has_returned_ = false;
  return has_returned;
}

void SpanningTree::appoint(Links& links, const Round& round) {
  Writer appointment(MessageType::kAppoint);
  appointment.u8(static_cast<std::uint8_t>(stage_));
  appointment.u32(census_.id);
  appointment.u16(static_cast<std::uint16_t>(census_.hops / 2));
  take_appointment(links, round, appointment.bytes());
}

/// One of an earlier stage is late: the next wave was here before it.
bool SpanningTree::expects_appointment(Direction face, std::span<const std::uint8_t> message,
                                       bool is_in_use) const {
  const auto stage = static_cast<Stage>(message[1]);
  return stage < stage_ || (stage == stage_ && is_led_by(face) && !is_in_use);
}

bool SpanningTree::expects_mark(Direction face, bool is_in_use) const {
  return stage_ == Stage::kFar && !nearer_.has(face) && awaited_.is_empty() && !is_in_use;
}

bool SpanningTree::take_appointment(Links& links, const Round& round,
                                    std::span<const std::uint8_t> message) {
  Reader in(message);
  const auto stage = static_cast<Stage>(in.u8());
  const std::uint32_t id = in.u32();
  const std::uint16_t hops = in.u16();
  if (stage != stage_) {
    return false;
  }
  if (id != id_) {
    Writer onward(MessageType::kAppoint);
    onward.u8(static_cast<std::uint8_t>(stage));
    onward.u32(id);
    onward.u16(hops);
    links.send(children_, onward);
  } else if (stage == Stage::kFirst) {
    start_wave(links, round, Stage::kFar);
  } else {
    mark(links, round, hops, cell_);
  }
  return true;
}

/// One hop towards the wave's root: of the neighbours nearer to it the one that is nearest to the
/// place half way between it and `end`.
Faces SpanningTree::towards_root(const base::Cell& end) const {
  Faces best = parent_;
  std::int64_t least = ~(std::int64_t{1} << 63U);
  for (const Direction face : nearer_) {
    const base::Cell there = base::neighbour(cell_, face);
    const std::int64_t x = 2 * there.x - root_cell_.x - end.x;
    const std::int64_t y = 2 * there.y - root_cell_.y - end.y;
    const std::int64_t z = 2 * there.z - root_cell_.z - end.z;
    const std::int64_t square = x * x + y * y + z * z;
    if (square < least) {
      least = square;
      best = {face};
    }
  }
  return best;
}

void SpanningTree::take_mark(Links& links, const Round& round,
                             std::span<const std::uint8_t> message) {
  Reader in(message);
  const std::uint16_t hops = in.u16();
  mark(links, round, hops, in.cell());
}

/// So many hops more to the middle of the way from `end` to the wave's root.
void SpanningTree::mark(Links& links, const Round& round, std::uint16_t hops,
                        const base::Cell& end) {
  if (hops == 0 || is_root()) {
    start_wave(links, round, Stage::kTree);
    return;
  }
  Writer onward(MessageType::kMark);
  onward.u16(static_cast<std::uint16_t>(hops - 1));
  onward.cell(end);
  links.send(towards_root(end), onward);
}

}  // namespace holdfast::agent
