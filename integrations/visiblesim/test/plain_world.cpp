// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "plain_world.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::visiblesim {

PlainWorld::Host& PlainWorld::add(const Place& place) {
  hosts_.push_back(std::make_unique<Host>(*this, hosts_.size()));
  Host& host = *hosts_.back();
  host_at_[place.cell] = host.index;
  host.block = std::make_unique<Block>(ensemble_, host, static_cast<std::uint32_t>(host.index + 1),
                                       place.cell, place.random);
  return host;
}

void PlainWorld::attach_all(const std::vector<Place>& places) {
  for (const Place& place : places) {
    add(place);
  }
  for (const Place& place : places) {
    block(place.cell).start();
  }
}

void PlainWorld::attach(const base::Cell& cell, std::uint16_t random) {
  add({.cell = cell, .random = random}).block->start();
  look_around(cell);
}

void PlainWorld::detach(const base::Cell& cell) {
  block(cell).take_off();
  host_at_.erase(cell);
  look_around(cell);
}

void PlainWorld::kill(const base::Cell& cell) { block(cell).fall_silent(); }

void PlainWorld::exchange(const base::Cell& cell, std::uint16_t random) {
  block(cell).take_off();
  attach(cell, random);
}

/// The neighbours of a cell notice what has happened there.
void PlainWorld::look_around(const base::Cell& cell) {
  for (const base::Direction direction : base::kDirections) {
    const auto found = host_at_.find(base::neighbour(cell, direction));
    if (found != host_at_.end()) {
      hosts_[found->second]->block->look_around();
    }
  }
}

std::uint64_t PlainWorld::Host::neighbour(base::Direction face) {
  const auto found = world.host_at_.find(base::neighbour(block->cell(), face));
  return found == world.host_at_.end() ? 0 : found->second + 1;
}

void PlainWorld::Host::send(base::Direction face, const Packet& packet) {
  const Time at = world.now_ + sim::line_time(world.ensemble_.options().link,
                                              static_cast<int>(packet.bytes.size()));
  int& line_count = line_counts[static_cast<std::size_t>(base::index(face))];
  world.packet_bytes_max_ =
      std::max(world.packet_bytes_max_, static_cast<int>(packet.bytes.size()));
  world.line_count_max_ = std::max(world.line_count_max_, ++line_count);
  const std::uint64_t other = neighbour(face);
  world.push(at, {.kind = Kind::kDeliver,
                  .face = base::opposite(face),
                  .host = other == 0 ? 0 : other - 1,
                  .bytes = {packet.bytes.begin(), packet.bytes.end()},
                  .rounds = packet.rounds});
  world.push(at, {.kind = Kind::kLine, .face = face, .host = index});
}

void PlainWorld::Host::call_at(Time at) {
  world.push(at, {.kind = Kind::kCall, .host = index, .at = at});
}

void PlainWorld::push(Time at, Happening what) {
  ensemble_.pending_changed(what.kind == Kind::kDeliver ? 1 : 0);
  happenings_.push_back(std::move(what));
  queue_.push(at, happenings_.size() - 1);
}

void PlainWorld::run(Time until) {
  const int change_count = until == agent::kNever ? 0 : 1;
  ensemble_.pending_changed(change_count);
  while (!queue_.is_empty() && queue_.next_time() <= until) {
    const sim::QueuedEvent event = queue_.pop();
    now_ = event.time;
    const Happening what = std::move(happenings_[event.content]);
    ensemble_.pending_changed(what.kind == Kind::kDeliver ? -1 : 0);
    const Time busy_until = hosts_[what.host]->block->busy_until();
    if (what.kind != Kind::kLine && busy_until > now_) {
      push(busy_until, what);
    } else {
      handle(what);
    }
  }
  now_ = change_count > 0 ? until : now_;
  ensemble_.pending_changed(-change_count);
}

void PlainWorld::handle(const Happening& what) {
  Block& block = *hosts_[what.host]->block;
  switch (what.kind) {
    case Kind::kDeliver:
      block.receive(what.face, {.bytes = what.bytes, .rounds = what.rounds});
      break;
    case Kind::kLine:
      --hosts_[what.host]->line_counts[static_cast<std::size_t>(base::index(what.face))];
      block.line_free(what.face);
      break;
    case Kind::kCall:
      block.called(what.at);
      break;
  }
}

}  // namespace holdfast::visiblesim
