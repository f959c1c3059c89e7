// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/agent/agent.hpp"
#include "holdfast/base/rng.hpp"
#include "test_setup.hpp"

namespace holdfast::agent::test {

/// One module of the robot under test. Ids count from `id_first` in the order of the list; the
/// first module is the anchor.
struct Place {
  base::Cell cell;
  bool is_fixed = false;
  bool is_mute = false;  ///< It is there and never does anything.
};

struct NetworkOptions {
  double loss = 0;  ///< Share of packets that vanish.
  std::uint64_t seed = 1;
  std::uint32_t id_first = 100;
  bool in_parts = false;  ///< Modules work a piece each tick; packets interrupt them.
};

/// The plainest network: time counts ticks, every line takes one packet a tick, and a packet is on
/// the other side one tick later, or never. Keeps a reference to the setup.
class TestNetwork {
 public:
  TestNetwork(const Setup& setup, std::vector<Place> places, NetworkOptions options = {})
      : setup_(setup), places_(std::move(places)), options_(options), rng_(options.seed) {
    agents_.resize(places_.size());
    actions_.resize(places_.size());
    for (std::size_t i = 0; i < places_.size(); ++i) {
      by_cell_.emplace(places_[i].cell, static_cast<int>(i));
    }
    for (std::size_t i = 0; i < places_.size(); ++i) {
      start(i);
    }
  }

  const Agent& agent(std::size_t i) const { return *agents_[i]; }

  /// The module forgets everything and begins anew; its neighbours are not told.
  void start(std::size_t i) {
    const bool is_anchor = i == 0;
    agents_[i].emplace(setup_, Identity{.id = options_.id_first + static_cast<std::uint32_t>(i),
                                        .is_fixed = places_[i].is_fixed,
                                        .is_anchor = is_anchor,
                                        .cell = is_anchor ? places_[i].cell : base::Cell{}});
    actions_[i] = {};
    step(i, event(EventKind::kStart));
    for (const base::Direction face : base::kDirections) {
      if (find(base::neighbour(places_[i].cell, face)) >= 0) {
        Event up = event(EventKind::kLinkUp, face);
        up.random = ++link_up_count_;  // Different each time, as agent.hpp demands.
        step(i, up);
      }
    }
  }

  const std::vector<Place>& places() const { return places_; }

  std::size_t size() const { return agents_.size(); }

  Time now() const { return now_; }

  void plan(std::size_t i, const base::Cell& cell) {
    Event plan = event(EventKind::kPlan);
    plan.cell = cell;
    step(i, plan);
  }

  void withdraw(std::size_t i, const base::Cell& cell) {
    Event withdrawal = event(EventKind::kWithdraw);
    withdrawal.cell = cell;
    step(i, withdrawal);
  }

  /// Takes a module off; its neighbours feel it.
  void remove(std::size_t i) {
    const base::Cell cell = places_[i].cell;
    by_cell_.erase(cell);
    places_[i] = {.cell = {0, 0, -1000 - static_cast<std::int32_t>(i)}, .is_mute = true};
    for (const base::Direction face : base::kDirections) {
      const int other = find(base::neighbour(cell, face));
      if (other >= 0) {
        step(static_cast<std::size_t>(other), event(EventKind::kLinkDown, base::opposite(face)));
      }
    }
  }

  /// A module comes; its neighbours feel it.
  void attach(const Place& place) {
    by_cell_.emplace(place.cell, static_cast<int>(places_.size()));
    places_.push_back(place);
    agents_.emplace_back();
    actions_.emplace_back();
    start(size() - 1);
    for (const base::Direction face : base::kDirections) {
      const int other = neighbour(size() - 1, face);
      if (other >= 0) {
        Event up = event(EventKind::kLinkUp, base::opposite(face));
        up.random = ++link_up_count_;
        step(static_cast<std::size_t>(other), up);
      }
    }
  }

  /// Opens a connection and closes it again; both ends feel it.
  void reconnect(std::size_t i, base::Direction face) {
    const auto other = static_cast<std::size_t>(neighbour(i, face));
    for (const EventKind kind : {EventKind::kLinkDown, EventKind::kLinkUp}) {
      Event own = event(kind, face);
      Event theirs = event(kind, base::opposite(face));
      own.random = ++link_up_count_;
      theirs.random = ++link_up_count_;
      step(i, own);
      step(other, theirs);
    }
  }

  /// The module is still there, but does nothing any more.
  void mute(std::size_t i) { places_[i].is_mute = true; }

  bool is_every(const std::function<bool(const Agent&)>& holds) const {
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      if (!places_[i].is_mute && !holds(*agents_[i])) {
        return false;
      }
    }
    return true;
  }

  /// Ticks until every module that is not mute fulfils `holds`; false if that takes too long.
  bool run_until(const std::function<bool(const Agent&)>& holds, Time ticks_max = 200'000) {
    for (const Time end = now_ + ticks_max; !is_every(holds); tick()) {
      if (now_ >= end) {
        return false;
      }
    }
    return true;
  }

  /// Until every module knows a verdict.
  bool run() {
    return run_until([](const Agent& agent) {
      return agent.phase() == Phase::kDone && agent.answer().verdict != Verdict::kNone;
    });
  }

  /// Runs on after a change, once the news has gone round: until then an old verdict may stand.
  bool run_anew() {
    for (std::size_t i = 0; i < 10 + 4 * size(); ++i) {
      tick();
    }
    return run();
  }

  void tick() {
    ++now_;
    for (const Flight& flight : std::exchange(in_flight_, {})) {
      // The packet before, which may not be read to its end, stays where it is.
      Inbox& inbox = inboxes_[flight.to];
      inbox.last = 1 - inbox.last;
      Flight& kept = inbox.packets[inbox.last];
      kept = flight;
      Event receive = event(EventKind::kReceive, flight.face);
      receive.bytes = std::span(kept.bytes).first(flight.size);
      step(flight.to, receive);
    }
    for (std::size_t i = 0; i < agents_.size(); ++i) {
      if (actions_[i].wake_at <= now_) {
        step(i, event(EventKind::kTime));
      }
      for (int piece = 0; piece < kPiecesATick && actions_[i].is_unfinished; ++piece) {
        step(i, event(EventKind::kContinue));
        unfinished_count_ += actions_[i].is_unfinished ? 1 : 0;
      }
      for (const base::Direction face : base::kDirections) {
        if (((actions_[i].send_faces >> static_cast<unsigned>(base::index(face))) & 1U) != 0) {
          take_packet(i, face);
        }
      }
    }
  }

  /// Is there something that a module has not done yet?
  bool is_unfinished(std::size_t i) const { return actions_[i].is_unfinished; }

  /// How often a module had still more to do after a piece.
  int unfinished_count() const { return unfinished_count_; }

  /// A packet from outside; it is on the other side with the next tick.
  void inject(std::size_t to, base::Direction face, std::span<const std::uint8_t> packet) {
    Flight flight{.to = to, .face = face, .size = packet.size(), .bytes = {}};
    std::copy(packet.begin(), packet.end(), flight.bytes.begin());
    in_flight_.push_back(flight);
  }

  /// The module at a face, or -1.
  int neighbour(std::size_t i, base::Direction face) const {
    return find(base::neighbour(places_[i].cell, face));
  }

  /// Is this packet taken off its line?
  std::function<bool(std::size_t from, base::Direction face, std::span<const std::uint8_t>)> divert;

  /// Called with every packet before it gets lost.
  std::function<void(std::size_t from, base::Direction face, std::span<const std::uint8_t>)> watch;

 private:
  struct Flight {
    std::size_t to = 0;
    base::Direction face = base::Direction::kPlusX;
    std::size_t size = 0;
    std::array<std::uint8_t, wire::kPacketBytesMax> bytes;
  };

  /// Pieces of work that fit between two ticks; an exchange ends in some more.
  static constexpr int kPiecesATick = 4;

  struct Inbox {
    std::array<Flight, 2> packets;
    std::size_t last = 0;
  };

  int find(const base::Cell& cell) const {
    const auto found = by_cell_.find(cell);
    return found != by_cell_.end() ? found->second : -1;
  }

  Event event(EventKind kind, base::Direction face = base::Direction::kPlusX) const {
    Event result;
    result.kind = kind;
    result.now = now_;
    result.face = face;
    return result;
  }

  void step(std::size_t i, const Event& event) {
    if (!places_[i].is_mute) {
      options_.in_parts ? agents_[i]->step_part(event, actions_[i])
                        : agents_[i]->step(event, actions_[i]);
    }
  }

  void take_packet(std::size_t i, base::Direction face) {
    step(i, event(EventKind::kLineFree, face));
    const auto size = static_cast<std::size_t>(actions_[i].packet_bytes);
    const int to = size > 0 ? neighbour(i, face) : -1;
    if (to < 0) {
      return;
    }
    if (watch) {
      watch(i, face, std::span(actions_[i].packet).first(size));
    }
    if (divert && divert(i, face, std::span(actions_[i].packet).first(size))) {
      return;
    }
    if (static_cast<double>(rng_.below(1'000'000)) >= options_.loss * 1e6) {
      in_flight_.push_back({.to = static_cast<std::size_t>(to),
                            .face = base::opposite(face),
                            .size = size,
                            .bytes = actions_[i].packet});
    }
  }

  const Setup& setup_;
  std::vector<Place> places_;
  std::map<base::Cell, int> by_cell_;
  NetworkOptions options_;
  base::Rng rng_;
  std::vector<std::optional<Agent>> agents_;
  std::vector<Actions> actions_;
  std::vector<Flight> in_flight_;
  std::map<std::size_t, Inbox> inboxes_;
  std::uint16_t link_up_count_ = 0;
  Time now_ = 0;
  int unfinished_count_ = 0;
};

}  // namespace holdfast::agent::test
