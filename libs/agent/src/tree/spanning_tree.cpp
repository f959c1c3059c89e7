// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/tree/spanning_tree.hpp"

#include "holdfast/agent/cells/feet.hpp"

namespace holdfast::agent {
namespace {

std::uint8_t number_of(SpanningTree::Wave wave) { return static_cast<std::uint8_t>(wave); }

/// One more; 65,535 stands for all that is further: too large (feet.hpp).
std::uint16_t hops_beyond(std::uint16_t hops) {
  return static_cast<std::uint16_t>(hops + (hops > kExtentMax ? 0 : 1));
}

Doubt graver(Doubt a, Doubt b) { return a < b ? b : a; }

}  // namespace

void SpanningTree::leave(std::uint8_t stage) {
  stage_ = stage;
  wave_ = Wave::kNone;
  parent_ = {};
  children_ = {};
  has_returned_ = false;
  has_other_cell_ = false;
}

void SpanningTree::start_wave(Links& links, const Round& round, Wave wave) {
  root_cell_ = cell_;
  begin_wave(links, round, wave, {}, 0);
}

void SpanningTree::begin_wave(Links& links, const Round& round, Wave wave, Faces parent,
                              std::uint16_t hops) {
  wave_ = wave;
  parent_ = parent;
  hops_ = hops;
  hops_max_ = wave != Wave::kFirst && hops_max_ > hops ? hops_max_ : hops;
  nearer_ = parent;
  children_ = {};
  has_returned_ = false;
  census_ = {.count = 1, .hops = hops, .id = id_};
  awaited_ = links.used() - parent;
  send_join(links, round, awaited_);
  await_less(links, round, {});
}

void SpanningTree::send_join(Links& links, const Round& round, Faces faces) const {
  links.send(faces, encode(Join{.round = round,
                                .wave = number_of(wave_),
                                .stage = stage_,
                                .cell = wave_ == Wave::kFirst ? cell_ : root_cell_,
                                .hops = hops_}));
}

/// Where the neighbour at `face`, which sits in `sender`, says that this module is. An anchor, and
/// who knows by another neighbour, stay where they are.
void SpanningTree::settle(const Links& links, Direction face, const base::Cell& sender,
                          bool is_first) {
  const base::Cell there = neighbour(links.more(), sender, base::opposite(face));
  if (is_first && !is_anchor_) {
    cell_ = there;
    has_cell_ = true;
  }
  has_other_cell_ = has_other_cell_ || there != cell_;
}

/// What this module itself doubts. Every neighbour has greeted it before it has answered.
Doubt SpanningTree::doubt(const Links& links) const {
  return links.has_mismatch()        ? Doubt::kFacesMismatch
         : has_other_cell_           ? Doubt::kCellsContradict
         : links.silent().is_empty() ? Doubt::kNone
                                     : Doubt::kNeighbourSilent;
}

bool SpanningTree::take_join(Links& links, Direction face, const Join& join, bool is_in_use) {
  const auto wave = static_cast<Wave>(join.wave);
  const std::uint16_t hops = hops_beyond(join.hops);
  const bool is_next = wave > wave_;
  if (is_next && (static_cast<int>(wave) > static_cast<int>(wave_) + 1 || is_in_use)) {
    return false;  // A wave has been left out, or the tree is in use.
  }
  if (is_next) {
    if (wave == Wave::kFirst) {
      settle(links, face, join.cell, true);
    } else {
      root_cell_ = join.cell;
    }
    begin_wave(links, join.round, wave, Faces::only(face), hops);
  } else if (wave == wave_) {
    if (hops <= hops_) {
      nearer_.add(face);
    }
    if (wave == Wave::kFirst) {
      settle(links, face, join.cell, false);
    }
    await_less(links, join.round, Faces::only(face));
  }
  return true;
}

void SpanningTree::adopt(Links& links, Direction face, const Adoption& adoption) {
  settle(links, face, adoption.sender, true);
  root_cell_ = adoption.root;
  hops_max_ = 0;
  begin_wave(links, adoption.round, Wave::kTree, Faces::only(face), hops_beyond(adoption.hops));
}

void SpanningTree::take_adoption(Links& links, Direction face, const Adoption& adoption) {
  const std::uint16_t hops = hops_beyond(adoption.hops);
  settle(links, face, adoption.sender, false);
  Faces others = Faces::only(face);
  if (hops < hops_ && awaited_.has(face)) {
    others = parent_;
    parent_ = Faces::only(face);
    nearer_ = parent_;
    hops_ = hops;
    census_.hops = hops;
  } else if (hops <= hops_) {
    nearer_.add(face);
  }
  // They have welcomed this module, and may wait for it since its first join, which was worse.
  send_join(links, adoption.round, others);
  await_less(links, adoption.round, Faces::only(face));
}

void SpanningTree::take_echo(Links& links, Direction face, const Echo& echo) {
  if (echo.wave != number_of(wave_)) {
    return;
  }
  census_.count += echo.count;
  if (echo.hops > census_.hops || (echo.hops == census_.hops && echo.id < census_.id)) {
    census_.hops = echo.hops;
    census_.id = echo.id;
  }
  census_.doubt = graver(census_.doubt, echo.doubt);
  children_.add(face);
  await_less(links, echo.round, Faces::only(face));
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
  census_.doubt = graver(census_.doubt, doubt(links));
  if (is_root()) {
    has_returned_ = true;
  } else {
    send_echo(links, round);
  }
}

void SpanningTree::send_echo(Links& links, const Round& round) const {
  links.send(parent_, encode(Echo{.round = round,
                                  .wave = number_of(wave_),
                                  .count = census_.count,
                                  .hops = census_.hops,
                                  .id = census_.id,
                                  .doubt = census_.doubt}));
}

bool SpanningTree::take_return() {
  const bool has_returned = has_returned_;
  has_returned_ = false;
  return has_returned;
}

void SpanningTree::appoint(Links& links, const Round& round) {
  take_appointment(links, round,
                   {.wave = number_of(wave_),
                    .id = census_.id,
                    .hops = static_cast<std::uint16_t>(census_.hops / 2)});
}

/// One of an earlier wave is late: the next wave was here before it.
bool SpanningTree::expects_appointment(Direction face, std::span<const std::uint8_t> message,
                                       bool is_in_use) const {
  const auto wave = static_cast<Wave>(message[1]);
  return wave < wave_ || (wave == wave_ && is_led_by(face) && !is_in_use);
}

bool SpanningTree::expects_mark(Direction face, bool is_in_use) const {
  return wave_ == Wave::kFar && !nearer_.has(face) && awaited_.is_empty() && !is_in_use;
}

bool SpanningTree::take_appointment(Links& links, const Round& round,
                                    const Appointment& appointment) {
  if (appointment.wave != number_of(wave_)) {
    return false;
  }
  if (appointment.id != id_) {
    links.send(children_, encode(appointment));
  } else if (wave_ == Wave::kFirst) {
    start_wave(links, round, Wave::kFar);
  } else {
    take_mark(links, round, {.hops = appointment.hops, .sender = cell_});
  }
  return true;
}

/// One hop towards the wave's root: of the neighbours nearer to it the one that is nearest to the
/// place half way between it and `end`.
Faces SpanningTree::towards_root(const Links& links, const base::Cell& end) const {
  Faces best = parent_;
  std::int64_t least = ~(std::int64_t{1} << 63U);
  for (const Direction face : nearer_) {
    const base::Cell there = neighbour(links.more(), cell_, face);
    const std::int64_t x = 2 * there.x - root_cell_.x - end.x;
    const std::int64_t y = 2 * there.y - root_cell_.y - end.y;
    const std::int64_t z = 2 * there.z - root_cell_.z - end.z;
    const std::int64_t square = x * x + y * y + z * z;
    if (square < least) {
      least = square;
      best = Faces::only(face);
    }
  }
  return best;
}

/// The mark has so many hops more to the middle of the way from the sender to the wave's root.
void SpanningTree::take_mark(Links& links, const Round& round, const Mark& mark) {
  if (mark.hops == 0 || is_root()) {
    start_wave(links, round, Wave::kTree);
    return;
  }
  const auto hops = static_cast<std::uint16_t>(mark.hops - 1);
  links.send(towards_root(links, mark.sender), encode(Mark{.hops = hops, .sender = mark.sender}));
}

}  // namespace holdfast::agent
