// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "tampered_network.hpp"

namespace holdfast::agent::test {

/// What happens to the packets of one direction of one line, from any bytes: the first ones choose
/// robot, method and line; then each record says how many packets pass before one is changed, and
/// how: lost, doubled, replaced by any bytes, or by any contents with the right checksum, so that
/// they get through. No more bytes: the line works again.
class PacketScript {
 public:
  explicit PacketScript(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  /// Is false if a module says what there is not, or does not come to a verdict although the line
  /// has worked for long enough again.
  bool run() {
    constexpr Time kTamperedMax = 3000;
    constexpr Time kQuietMax = 40'000;
    Setup setup = table_setup();
    setup.method = static_cast<Method>(next() % 2);
    setup.timing.packet_bytes = next() % 2 == 0 ? wire::kPacketBytesMin : wire::kPacketBytesMax;
    const std::vector<ScriptRobot> robots = script_robots();
    const ScriptRobot& robot = robots[next() % robots.size()];
    TestNetwork network(setup, robot.places);
    choose_line(network, next());
    left_ = next();
    network.divert = [&](std::size_t from, base::Direction face,
                         std::span<const std::uint8_t> packet) {
      return tamper(network, from, face, packet);
    };
    for (const base::Cell& cell : robot.planned) {
      network.plan(0, cell);
    }
    for (Time tick = 0; tick < kTamperedMax && at_ < bytes_.size(); ++tick) {
      network.tick();
    }
    at_ = bytes_.size();
    const auto knows_verdict = [](const Agent& agent) {
      return agent.answer().verdict != Verdict::kNone;
    };
    return network.run_until(knows_verdict, kQuietMax) && are_answers_known(network);
  }

  int changed_count() const { return changed_count_; }

 private:
  using Packet = std::vector<std::uint8_t>;

  /// Room for a checksum.
  static constexpr std::size_t kBodyMax = wire::kPacketBytesMax - wire::kChecksumBytes;

  std::uint8_t next() { return at_ < bytes_.size() ? bytes_[at_++] : std::uint8_t{0}; }

  void choose_line(const TestNetwork& network, std::uint8_t choice) {
    from_ = choice % network.size();
    face_ = static_cast<base::Direction>(choice / 16 % base::kDirectionCount);
    while (network.neighbour(from_, face_) < 0) {
      face_ = static_cast<base::Direction>((base::index(face_) + 1) % base::kDirectionCount);
    }
    to_ = static_cast<std::size_t>(network.neighbour(from_, face_));
  }

  bool tamper(TestNetwork& network, std::size_t from, base::Direction face,
              std::span<const std::uint8_t> packet) {
    const bool is_ours = from == from_ && face == face_;
    if (is_ours || (from == to_ && face == base::opposite(face_))) {
      if (static_cast<wire::PacketKind>(packet[0] >> 6U) == wire::PacketKind::kHello) {
        (is_ours ? own_number_ : their_number_) =
            static_cast<std::uint16_t>(packet[2] | packet[3] << 8U);
      }
    }
    if (!is_ours || left_ > 0 || at_ >= bytes_.size()) {
      left_ -= is_ours && left_ > 0 ? 1 : 0;
      return false;
    }
    ++changed_count_;
    const bool is_replaced = change(network, packet);
    left_ = next();
    return is_replaced;
  }

  /// True: the packet itself does not go on.
  bool change(TestNetwork& network, std::span<const std::uint8_t> packet) {
    const std::uint8_t action = next();
    const auto put = [&](const Packet& other) {
      network.inject(to_, base::opposite(face_), other);
    };
    const auto body = packet.first(packet.size() - wire::kChecksumBytes);
    Packet other;
    switch (action % 8) {
      case 0:
        return true;
      case 1:  // Any bytes, instead or before.
        add_any(other);
        put(other);
        return action >= 128;
      case 2:
        put(Packet(packet.begin(), packet.end()));
        return false;
      case 3:  // Another greeting.
        other = {static_cast<std::uint8_t>(3U << 6U), static_cast<std::uint8_t>(1U << 6U)};
        add_any(other, 5);
        put(summed(other, 0xffff));
        return action >= 128;
      case 4:  // Any header.
        other = {next(), static_cast<std::uint8_t>((1U << 6U) | (next() & 63U))};
        break;
      case 5:  // One byte is another one.
        other.assign(body.begin(), body.end());
        other[next() % other.size()] = next();
        put(summed(other, session()));
        return true;
      default:  // The right header.
        other.assign(body.begin(), body.begin() + wire::kHeaderBytes);
    }
    add_any(other);
    put(summed(other, session()));
    return action >= 64;
  }

  void add_any(Packet& packet, std::size_t count) {
    for (; count > 0 && packet.size() < kBodyMax; --count) {
      packet.push_back(next());
    }
  }

  void add_any(Packet& packet) { add_any(packet, next()); }

  static Packet summed(Packet packet, std::uint16_t start) {
    const std::uint16_t sum = wire::checksum(packet, start);
    packet.push_back(static_cast<std::uint8_t>(sum & 0xffU));
    packet.push_back(static_cast<std::uint8_t>(sum >> 8U));
    return packet;
  }

  /// Where the checksum of a session starts: docs/wire.md, "Packets".
  std::uint16_t session() const {
    const auto mixed = static_cast<std::uint16_t>(own_number_ ^ std::rotl(their_number_, 5));
    return static_cast<std::uint16_t>(mixed ^ (std::popcount(mixed) & 1));
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  std::size_t from_ = 0;
  std::size_t to_ = 0;
  base::Direction face_ = base::Direction::kPlusX;
  std::uint16_t own_number_ = 0;
  std::uint16_t their_number_ = 0;
  int left_ = 0;
  int changed_count_ = 0;
};

}  // namespace holdfast::agent::test
