// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "environment_map.hpp"
#include "holdfast/sim/event_queue.hpp"
#include "holdfast/sim/recorder.hpp"
#include "holdfast/sim/simulation.hpp"
#include "noise.hpp"
#include "packet_pool.hpp"
#include "port.hpp"

namespace holdfast::sim {

/// The simulation behind its interface: takes events from the queue, steps agents, and carries what
/// they send to the queue again.
class Engine {
 public:
  Engine(const model::Robot& robot, SimulationOptions options);

  /// Hands about `event_count` events to modules; returns false if the simulation is over.
  bool run_for(std::uint64_t event_count);

  void happen(const Fault& fault);
  void happen(const Announcement& announcement);

  SimulationResult result() const;

  const agent::Agent& agent(std::int32_t module) const { return agents_[at(module)]; }

  const Port& port(std::int32_t module) const { return ports_[at(module)]; }

  std::int32_t agent_count() const { return static_cast<std::int32_t>(agents_.size()); }

 private:
  enum class Kind : std::uint8_t {
    kDeliver,   ///< A packet arrives; item: its slot.
    kLine,      ///< A line is free again.
    kTimer,     ///< An agent may want to wake.
    kReady,     ///< A module has finished computing.
    kFault,     ///< item: index in the options.
    kAnnounce,  ///< item: index in the options.
  };

  /// An item of the queue, packed into 64 bits: item, module, face, kind.
  struct Happening {
    Kind kind{};
    base::Direction face{};
    std::int32_t module = 0;
    std::uint32_t item = 0;
  };

  /// An event of a busy module.
  struct Waiting {
    Happening what;
    std::uint32_t next = Port::kNoEvent;
  };

  /// A burst on an unlimited line: more than a link's window, so that it never matters.
  static constexpr int kBurstMax = 64;
  static constexpr int kModuleBits = 25;
  static constexpr std::uint32_t kPrefetchAhead = 2;

  static std::size_t at(std::int32_t module) { return static_cast<std::size_t>(module); }

  Lines& lines(std::int32_t module, int face) {
    return face < base::kDirectionCount ? ports_[at(module)].lines : more_lines_[at(module)];
  }

  static std::uint64_t pack(const Happening& what);
  static Happening unpack(std::uint64_t content);

  // engine.cpp: the loop, steps, timers, computing.
  void push(Time time, const Happening& what) {
    work_count_ += what.kind == Kind::kTimer ? 0 : 1;
    queue_.push(time, pack(what));
  }

  bool is_at_rest(Time next) const;
  void set_wake(Port& port, Time wake_at, bool is_watching);

  void prefetch() const;
  void handle(const Happening& what);
  void attend(const Happening& what);
  void serve(const Happening& what);
  void hand_in(std::int32_t module, const agent::Event& event);
  const Misplaced* find_misplaced(std::int32_t module) const;
  void step(std::int32_t module);
  void settle(std::int32_t module);
  void arm_timer(std::int32_t module);
  void take_timer(std::int32_t module);
  void wait(const Happening& what);
  Happening take_waiting(std::int32_t module);
  void ready(std::int32_t module);
  bool is_due(std::int32_t module) const;

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

  // changes.cpp: starting, faults.
  void boot();
  void tell_step();
  void start(std::int32_t module);
  void link_up(std::int32_t module, base::Direction face);
  void make_fault(const Fault& fault);
  void make_link_fault(const Fault& fault);
  void tell_neighbours(std::int32_t module, agent::EventKind kind);
  void silence(std::int32_t module);
  void detach(std::int32_t module);
  void attach(std::int32_t module);
  void begin_anew(std::int32_t module);
  void announce(const Announcement& announcement);
  std::int32_t neighbour(std::int32_t module, base::Direction face) const;

  // outcome.cpp
  void finish();

  const model::Robot& robot_;
  SimulationOptions options_;
  agent::Setup setup_;
  Noise noise_;
  bool is_noisy_;
  std::array<Time, agent::wire::kPacketBytesMax + 1> line_times_{};  ///< By packet size.

  std::vector<agent::Agent> agents_;
  LentStore lent_;
  std::vector<Port> ports_;
  std::vector<Lines> more_lines_;  ///< Of faces that cubes do not have.
  EventQueue queue_;
  PacketPool pool_;
  std::vector<Waiting> waiting_;
  std::vector<std::uint32_t> waiting_spare_;
  Recorder recorder_;
  agent::Event step_event_{};  ///< One of each for all steps; they are not small.
  agent::Actions actions_{};
  Time now_ = 0;
  std::uint64_t packet_count_ = 0;
  /// The amount of work to be done besides watching: events in the queue that are no timers, and
  /// modules that want to wake.
  std::size_t work_count_ = 0;
  Time break_at_ = agent::kNever;  ///< Of the last thing that nobody was told of.
  bool is_booted_ = false;
  bool is_quiet_ = false;
  bool is_over_ = false;
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
