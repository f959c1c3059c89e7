// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "happening.hpp"
#include "ledger.hpp"
#include "modules.hpp"
#include "packet_pool.hpp"

namespace holdfast::sim {

/// Some of a robot's modules: hands events to their agents, and carries what these send.
///
/// What events lead to goes to the ledger at once. Or events are handled ahead of their turn, all
/// those of a window, module by module: as nothing that a module does reaches another one within
/// the window, modules need not wait for each other. What their events lead to is kept, and goes to
/// the ledger when their turn comes. Different regions may do this at the same time.
class Region {
 public:
  /// The most regions: a packet is known by region and slot, in 32 bits.
  static constexpr std::size_t kCountMax = 64;

  /// `all` are the regions of the robot by their number, of which this one is `number`. It has
  /// `module_count` modules from the first one on.
  Region(Modules& modules, Ledger& ledger, std::span<Region* const> all, std::uint32_t number,
         std::size_t first_module, std::size_t module_count)
      : modules_(modules),
        ledger_(ledger),
        all_(all),
        number_(number),
        first_module_(first_module),
        module_count_(module_count) {}

  // region.cpp: events, steps, timers, computing.

  /// Handles an event of a module of this region, when it is its turn.
  void handle(Time now, const Happening& what);
  void hand_in(Time now, std::int32_t module, const agent::Event& event);
  /// The agent of a module gets no more events; those that wait for it are void.
  void silence(Time now, std::int32_t module);
  void prefetch(const Happening& what) const;

  // ahead.cpp: ahead of their turn.

  /// Takes an event of the window, by ascending time; returns a content by which its turn is known.
  std::uint64_t give(const QueuedEvent& event);

  /// Handles all events that were given, of a window that ends at this time.
  void run_ahead(Time end);

  /// The turn of an event with such a content has come. The ledger's recorder counts packets that
  /// were sent when all have been told.
  static void tell(std::span<Region* const> all, const QueuedEvent& event);

  /// Events, if any, whose turn comes later, and soon.
  static void prefetch_turn(std::span<Region* const> all, const QueuedEvent* later,
                            const QueuedEvent* soon);

  /// All of them have had their turn.
  void end_window();

 private:
  using Kind = Happening::Kind;

  /// An event of a busy module.
  struct Waiting {
    Happening what;
    std::uint32_t next = Port::kNoEvent;
  };

  /// What an event has led to that was handled ahead of its turn.
  struct Effect {
    std::uint64_t content = 0;  ///< Of the event.
    std::uint32_t first_push = 0;
    std::uint32_t first_change = 0;
    std::uint16_t push_count = 0;
    std::uint16_t change_count = 0;
    std::uint16_t step_count = 0;
    bool is_lost = false;  ///< A packet that reached nobody.
  };

  /// An event of a module ahead of its turn.
  struct Given {
    Time time = 0;
    std::uint32_t effect = 0;
    std::uint32_t module = 0;
  };

  /// A burst on an unlimited line: more than a link's window, so that it never matters.
  static constexpr int kBurstMax = 64;
  static constexpr int kSlotBits = 26;
  static_assert(PacketPool::kPlaceMax == 1U << kSlotBits);
  static_assert(std::uint64_t{kCountMax} << kSlotBits == std::uint64_t{1} << 32U);

  static std::size_t at(std::int32_t module) { return Modules::at(module); }

  static PacketPool& pool_of(std::span<Region* const> all, std::uint32_t item) {
    return all[item >> kSlotBits]->pool_;
  }

  static std::uint32_t slot_of(std::uint32_t item) { return item & ((1U << kSlotBits) - 1); }

  Port& port(std::int32_t module) { return modules_.ports[at(module)]; }

  Recorder& recorder() { return is_ahead_ ? packets_ : ledger_.recorder; }

  void push(Time time, const Happening& what) {
    if (is_ahead_) {
      push_ahead(time, what);
    } else {
      ledger_.push(time, what);
    }
  }

  void handle(const Happening& what);
  void attend(const Happening& what);
  void serve(const Happening& what);
  void hand_in(std::int32_t module, const agent::Event& event);
  const Misplaced* find_misplaced(std::int32_t module) const;
  void step(std::int32_t module);
  void record_step(std::int32_t module, const agent::Agent& agent);
  void set_wake(Port& port, Time wake_at, bool is_watching);
  void settle(std::int32_t module);
  void arm_timer(std::int32_t module);
  void take_timer(std::int32_t module);
  void wait(const Happening& what);
  Happening take_waiting(std::int32_t module);
  void ready(std::int32_t module);

  bool is_due(std::int32_t module) { return port(module).timer.is_due(now_); }

  // lines.cpp: packets.
  void flush(std::int32_t module);
  void offer_line(std::int32_t module, int face);
  bool send_one(std::int32_t module, int face);
  void transmit(std::int32_t module, int face, std::span<const std::uint8_t> packet);
  void launch(std::int32_t module, int face, const PacketTag& tag,
              std::span<const std::uint8_t> packet, Time earliest);
  void arrive(const Happening& what);
  void drop(const Happening& what);
  PacketTrace trace_of(const Happening& what) const;

  // ahead.cpp
  void push_ahead(Time time, const Happening& what);
  void sort_given();
  std::size_t run_module(std::size_t given);
  void begin_effect(const Given& event);

  std::uint64_t content_of(std::size_t effect) const {
    return std::uint64_t{number_} << 32U | effect;
  }

  Modules& modules_;
  Ledger& ledger_;
  std::span<Region* const> all_;
  std::uint32_t number_;
  std::size_t first_module_;
  std::size_t module_count_;
  Time now_ = 0;
  agent::Event step_event_{};  ///< One of each for all steps; they are not small.
  agent::Actions actions_{};
  PacketPool pool_;  ///< What the region's modules have sent.
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> waiting_spare_;

  // Ahead of their turn.
  bool is_ahead_ = false;
  Time end_ = 0;
  std::uint32_t effect_ = 0;  ///< Of the event that is handled.
  std::vector<Effect> effects_;
  std::vector<QueuedEvent> pushes_;
  std::vector<Change> changes_;
  std::vector<Given> given_;
  std::vector<Given> sorted_;          ///< By module, then by time.
  std::vector<std::uint32_t> places_;  ///< Of each module, in them.
  std::vector<Given> own_;             ///< What the module makes for itself, by time.
  Recorder packets_{nullptr};
  std::ptrdiff_t wakeful_change_ = 0;
};

/// An event without more than this.
inline agent::Event event_of(agent::EventKind kind,
                             base::Direction face = base::Direction::kPlusX) {
  agent::Event event;
  event.kind = kind;
  event.face = face;
  return event;
}

}  // namespace holdfast::sim
