// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "holdfast/agent/wire/operations.hpp"
#include "test_network.hpp"

namespace holdfast::agent::test {

using Message = std::vector<std::uint8_t>;

/// A robot one of whose modules is faulty. On each of its lines sits a tap with two ends of a link,
/// so that whatever is said in its place has the right numbers and checksums.
class TamperedNetwork {
 public:
  /// What goes on instead of a message that the faulty module sends through a face.
  using Tamper = std::function<std::vector<Message>(base::Direction face, const Message& message)>;

  TamperedNetwork(const Setup& setup, std::vector<Place> places, std::size_t faulty, Tamper tamper)
      : setup_(setup),
        faulty_(faulty),
        tamper_(std::move(tamper)),
        network_(setup, std::move(places)) {
    for (const base::Direction face : base::kDirections) {
      const int other = network_.neighbour(faulty_, face);
      if (other >= 0) {
        Tap& tap = taps_[index(face)];
        tap.other = static_cast<std::size_t>(other);
        tap.is_used = true;
        tap.near.set_face(base::opposite(face));
        tap.far.set_face(face);
        tap.near.bring_up(random_++, 0);
        tap.far.bring_up(random_++, 0);
      }
    }
    network_.divert = [this](std::size_t from, base::Direction face,
                             std::span<const std::uint8_t> packet) {
      return divert(from, face, packet);
    };
  }

  TestNetwork& network() { return network_; }

  std::size_t faulty() const { return faulty_; }

  void tick() {
    network_.tick();
    for (const base::Direction face : base::kDirections) {
      Tap& tap = taps_[index(face)];
      if (tap.far.state() == Link::State::kLost) {
        tap.near.bring_down();  // Silence on one side of the line is silence on the other.
      }
      if (tap.is_used) {
        serve(tap.near, tap.to_near, faulty_, face);
        serve(tap.far, tap.to_far, tap.other, base::opposite(face));
      }
    }
  }

  /// Says a message in the faulty module's place that it has not sent.
  void say(base::Direction face, Message message) {
    taps_[index(face)].to_far.push_back(std::move(message));
  }

  /// Messages refused, by all modules but the faulty one.
  int refused_count() const {
    int count = 0;
    for (std::size_t i = 0; i < network_.size(); ++i) {
      count += i == faulty_ ? 0 : network_.agent(i).refused_count();
    }
    return count;
  }

 private:
  struct Tap {
    bool is_used = false;
    std::size_t other = 0;
    Link near;  ///< Stands in for the neighbour.
    Link far;   ///< Stands in for the faulty module.
    std::deque<Message> to_near;
    std::deque<Message> to_far;
  };

  static std::size_t index(base::Direction face) {
    return static_cast<std::size_t>(base::index(face));
  }

  bool divert(std::size_t from, base::Direction face, std::span<const std::uint8_t> packet) {
    const bool is_own = from == faulty_;
    const base::Direction there = is_own ? face : base::opposite(face);
    Tap& tap = taps_[index(there)];
    if (!tap.is_used || (!is_own && tap.other != from)) {
      return false;
    }
    Link& link = is_own ? tap.near : tap.far;
    auto stream = link.receive(packet, setup_.timing, network_.now());
    for (auto message = link.next_message(stream); !message.empty();
         message = link.next_message(stream)) {
      Message whole(message.begin(), message.end());
      if (!is_own) {
        tap.to_near.push_back(std::move(whole));
        continue;
      }
      for (Message& other : tamper_(there, whole)) {
        tap.to_far.push_back(std::move(other));
      }
    }
    if (link.take_restarted()) {
      link.bring_up(random_++, network_.now());
    }
    return true;
  }

  void serve(Link& link, std::deque<Message>& waiting, std::size_t to, base::Direction face) {
    const Time now = network_.now();
    if (link.deadline(setup_.timing, true) <= now) {
      link.on_time(setup_.timing, true, now);
    }
    while (link.is_used() && !waiting.empty() &&
           link.has_room(static_cast<int>(waiting.front().size()))) {
      static_cast<void>(link.send(waiting.front()));
      waiting.pop_front();
    }
    std::array<std::uint8_t, wire::kPacketBytesMax> packet;
    const int size = link.write_packet(packet, setup_.timing, now);
    if (size > 0) {
      network_.inject(to, face, std::span(packet).first(static_cast<std::size_t>(size)));
    }
  }

  const Setup& setup_;
  std::size_t faulty_;
  Tamper tamper_;
  TestNetwork network_;
  std::array<Tap, base::kDirectionCount> taps_;
  std::uint16_t random_ = 0x4000;
};

struct ScriptRobot {
  std::vector<Place> places;
  std::vector<base::Cell> planned;
};

inline ScriptRobot script_robot(std::initializer_list<base::Cell> cells,
                                std::initializer_list<base::Cell> planned) {
  ScriptRobot robot{.places = {}, .planned = planned};
  for (const base::Cell& cell : cells) {
    robot.places.push_back({.cell = cell});
  }
  return robot;
}

/// A row, a ring, two rings, an arch with planned modules between its feet, a wall.
inline std::vector<ScriptRobot> script_robots() {
  return {
      script_robot({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}}, {{4, 0, 0}}),
      script_robot({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 2}}),
      script_robot({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}}, {}),
      script_robot({{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {2, 0, 0}}, {{1, 0, 0}, {3, 0, 1}}),
      script_robot({{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0, 0, 2}, {1, 0, 2}},
                   {{2, 0, 2}, {2, 0, 1}, {2, 0, 0}})};
}

/// Does every module know a verdict, and is at rest?
inline bool is_over(const TestNetwork& network) {
  return network.now() > 100 && network.is_every([](const Agent& agent) {
    return agent.phase() == Phase::kDone && agent.answer().verdict != Verdict::kNone;
  });
}

/// Does no module say what there is not?
inline bool are_answers_known(const TestNetwork& network) {
  return network.is_every([](const Agent& agent) {
    const Answer& answer = agent.answer();
    static_cast<void>(agent.colour());
    return answer.verdict <= Verdict::kUndecided &&
           static_cast<int>(answer.reason) < kReasonCount &&
           base::index(answer.worst_direction) < base::kDirectionCount &&
           agent.phase() <= Phase::kDone && agent.parent() < base::kDirectionCount;
  });
}

/// What a faulty module does, from any bytes: the first ones choose robot, method and module; then
/// each record says how many messages pass before one is changed, and how. No more bytes: no more
/// faults.
class FaultScript {
 public:
  explicit FaultScript(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// Runs the robot to its end, or as long as `ticks_max`. False: a module says what there is not.
  bool run(Time ticks_max) {
    Setup setup = table_setup();
    setup.method = static_cast<Method>(next() % 3);
    setup.timing.packet_bytes = next() % 2 == 0 ? wire::kPacketBytesMin : wire::kPacketBytesMax;
    const std::vector<ScriptRobot> robots = script_robots();
    const ScriptRobot& robot = robots[next() % robots.size()];
    const std::size_t faulty = next() % robot.places.size();
    left_ = next();
    TamperedNetwork tampered(
        setup, robot.places, faulty,
        [this](base::Direction, const Message& message) { return tampered_with(message); });
    for (const base::Cell& cell : robot.planned) {
      tampered.network().plan(0, cell);
    }
    for (Time tick = 0; tick < ticks_max && !is_over(tampered.network()); ++tick) {
      tampered.tick();
    }
    refused_count_ = tampered.refused_count();
    return are_answers_known(tampered.network());
  }

  int changed_count() const { return changed_count_; }

  int refused_count() const { return refused_count_; }

 private:
  std::uint8_t next() { return at_ < bytes_.size() ? bytes_[at_++] : std::uint8_t{0}; }

  /// Any message of a type and, of orders and reports, an operation.
  Message random_message() {
    Message message = {
        static_cast<std::uint8_t>(1 + next() % 13),
        static_cast<std::uint8_t>(kOperations[next() % std::size(kOperations)].operation)};
    const bool has_operation = message[0] == 5 || message[0] == 6;
    message.resize(static_cast<std::size_t>(wire::message_bytes(message[0], message[1])));
    for (std::size_t i = has_operation ? 2 : 1; i < message.size(); ++i) {
      message[i] = next();
    }
    return message;
  }

  /// Small numbers, powers of two and reals that are none are where limits are.
  std::uint8_t telling_byte() {
    constexpr std::uint8_t kBytes[] = {0, 1, 2, 3, 4, 5, 6, 7, 0x3f, 0x40, 0x7f, 0x80, 0xfe, 0xff};
    const std::uint8_t value = next();
    return value < 128 ? kBytes[value % sizeof kBytes] : next();
  }

  std::vector<Message> tampered_with(Message message) {
    if (left_ > 0 || at_ >= bytes_.size()) {
      left_ -= left_ > 0 ? 1 : 0;
      return {message};
    }
    ++changed_count_;
    const std::uint8_t action = next();
    std::vector<Message> result = {message};
    switch (action % 8) {
      case 0:
        result = {random_message()};
        break;
      case 1:
        result = {random_message(), message};
        break;
      case 2:
        result = {message, message};
        break;
      case 3:
        result = {};
        break;
      default: {
        const std::size_t at = 1 + next() % (message.size() - 1);
        result[0][at] = telling_byte();
        const int size = wire::message_bytes(result[0][0], result[0][1]);
        if (size == 0) {
          return {message};  // A link does not take what is no message.
        }
        result[0].resize(static_cast<std::size_t>(size));
      }
    }
    left_ = next();
    return result;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  int left_ = 0;
  int changed_count_ = 0;
  int refused_count_ = 0;
};

}  // namespace holdfast::agent::test
