// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "ensemble.hpp"
#include "holdfast/agent/agent.hpp"
#include "holdfast/sim/recorder.hpp"
#include "holdfast/sim/wake_timer.hpp"

/// One module's agent in somebody else's simulator: from that simulator's events to the agent's,
/// and back. Knows nothing of VisibleSim, so that it is tested without it.
namespace holdfast::visiblesim {

using agent::Time;

/// A packet that goes over a line.
struct Packet {
  std::span<const std::uint8_t> bytes = {};
  std::uint64_t rounds = 0;  ///< Of the chain of packets that ends with this one.
};

class Block;

/// The simulator, as one block needs it. Times are microseconds.
class BlockHost {
 public:
  virtual Time now() = 0;

  /// A number for whoever is attached at the face: another one after every exchange; 0: nobody.
  virtual std::uint64_t neighbour(base::Direction face) = 0;

  /// Puts a packet on the line of a face that has a neighbour. Block::line_free() follows when the
  /// line can take the next one, and always does.
  virtual void send(base::Direction face, const Packet& packet) = 0;

  /// Asks for Block::called(at), which follows at that time, or later if the module computes then.
  virtual void call_at(Time at) = 0;

  /// The verdict or the colour may have changed.
  virtual void show(const Block& block) = 0;

 protected:
  ~BlockHost() = default;
};

/// Events come from outside in the order of their times; those of a module that computes wait until
/// busy_until(). One packet at a time is on a line. What a module has worked out leaves when it has
/// computed.
class Block {
 public:
  /// Link-ups are numbered from `random` on, which should differ from block to block.
  Block(Ensemble& ensemble, BlockHost& host, std::uint32_t id, const base::Cell& cell,
        std::uint16_t random);
  ~Block();
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;

  /// The module wakes up in its place and looks around.
  void start();

  /// Looks for modules that have come or gone at any face.
  void look_around();

  void receive(base::Direction face, const Packet& packet);
  void line_free(base::Direction face);

  /// Handles a call; `at` is the time that was asked for.
  void called(Time at);

  void plan(const base::Cell& cell);

  /// The module falls silent for ever; nobody is told.
  void fall_silent();

  /// The module is taken off.
  void take_off();

  bool takes_part() const { return is_attached_ && !is_silent_; }

  bool is_attached() const { return is_attached_; }

  /// Whether the block has something to do but watching over a verdict.
  bool has_work() const { return timer_.wake_at != agent::kNever && !is_watching_; }

  Time busy_until() const { return busy_until_; }

  const base::Cell& cell() const { return cell_; }

  const agent::Agent& agent() const { return agent_; }

  sim::ModuleOutcome outcome() const {
    return {.agent = agent_,
            .takes_part = takes_part(),
            .packets_sent = packets_sent_,
            .bytes_sent = bytes_sent_};
  }

  /// The text that a tap shows: the robot's verdict and the load ratios of this module's
  /// connections.
  std::string describe() const;

 private:
  agent::Event event_of(agent::EventKind kind, base::Direction face = base::Direction::kPlusX);
  void hand_in(const agent::Event& event);
  void step(const agent::Event& event);
  void settle();
  void flush();
  void send_one(base::Direction face);
  void arm_timer();
  void set_wake(Time wake_at, bool is_watching);
  bool begin();
  void stop();

  Ensemble& ensemble_;
  BlockHost& host_;
  base::Cell cell_;
  std::int32_t index_;
  agent::Agent agent_;
  agent::Actions actions_;
  sim::WakeTimer timer_;
  sim::Seen seen_;
  std::array<std::uint64_t, base::kDirectionCount> neighbours_{};
  Time busy_until_ = 0;
  std::uint64_t rounds_ = 0;
  std::uint64_t packets_sent_ = 0;
  std::uint64_t bytes_sent_ = 0;
  std::uint16_t random_;
  std::uint16_t wanted_ = 0;  ///< Faces on which a packet waits.
  std::uint8_t taken_ = 0;    ///< Faces whose line has a packet on it.
  bool is_watching_ = false;
  bool is_attached_ = true;
  bool is_silent_ = false;
};

}  // namespace holdfast::visiblesim
