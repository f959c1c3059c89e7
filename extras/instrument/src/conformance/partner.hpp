// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <deque>
#include <optional>

#include "../serial_device.hpp"
#include "by_hand.hpp"

namespace holdfast::instrument {

/// The neighbour of a module under test, at its face +x: says what a case tells it to, and keeps
/// what it hears.
class Partner {
 public:
  using Bytes = by_hand::Bytes;

  /// The module under test and its place: module 10 of the conversation in docs/evidence/wire.md.
  static constexpr int kTheirId = 10;
  static constexpr by_hand::Cell kTheirCell = {-1, 2, 0};
  static constexpr by_hand::Cell kMyCell = {0, 2, 0};

  explicit Partner(SerialDevice device) : device_(std::move(device)) {}

  /// Says nothing until the module must have noticed, and forgets all about it.
  void leave();

  /// Says hello bytes from now on, and waits for the module's greeting; false: there is none.
  bool meet();

  /// meet(), and both sides open.
  bool open();

  /// open(), and the module's wave, which is acknowledged.
  bool join();

  /// Lets time pass.
  void wait(int time_ms);

  void say(const Bytes& raw);

  void say_packet(const Bytes& packet) { say(by_hand::frame(1, packet)); }

  /// A greeting of mine; what is not said otherwise is as it should be.
  by_hand::Greeting greeting(bool is_open) const {
    return {.number = mine, .heard = theirs, .is_open = is_open, .face = face};
  }

  /// Messages in a data packet of this session.
  void tell(const Bytes& messages);

  /// A data packet that is anything, of this session.
  Bytes data(int number, const Bytes& payload) const {
    return by_hand::packet(0, number, expected_, payload, by_hand::session(mine, theirs));
  }

  Bytes ping() const {
    return by_hand::packet(2, 0, expected_, {}, by_hand::session(mine, theirs));
  }

  Bytes acknowledgement() const {
    return by_hand::packet(1, 0, expected_, {}, by_hand::session(mine, theirs));
  }

  /// What the module's side would say: an acknowledgement of all before that number.
  Bytes their_acknowledgement(int expected) const {
    return by_hand::packet(1, 0, expected, {}, by_hand::session(theirs, mine));
  }

  /// The next packet of a kind (3 greeting, 0 data, 1 acknowledgement, 2 ping) within that time;
  /// those of other kinds before it are dropped, as are old ones by drop().
  std::optional<Bytes> packet(int kind, int time_ms);

  /// The next greeting that names a number of mine; else the last one, as some may be under way.
  std::optional<Bytes> answered_greeting(int time_ms);

  /// The next packet whatever it is.
  std::optional<Bytes> any_packet(int time_ms);

  /// The next frame of another kind than packets.
  std::optional<Bytes> frame(std::uint8_t kind, int time_ms);

  void drop() { frames_.clear(); }

  /// The next bytes of the module's messages, acknowledged; fewer: they did not come within 2 s.
  Bytes take(std::size_t size);

  int hello_count() const { return reader_.hello_count; }

  int noise_count() const { return reader_.noise_count; }

  const Bytes& said() const { return said_; }

  int mine = 0x1234;
  int theirs = 0;
  int face = 1;      ///< That I say is mine: -x.
  int epoch = 0;     ///< Of the module's wave.
  int sequence = 0;  ///< Of my next data packet.
  bool acknowledges = true;

 private:
  using Clock = std::chrono::steady_clock;

  void pump(int time_ms);

  SerialDevice device_;
  by_hand::Reader reader_;
  std::deque<by_hand::Reader::Frame> frames_;
  Bytes said_;  ///< Last.
  Bytes stream_;
  int expected_ = 0;
  bool says_hello_ = false;
  Clock::time_point hello_at_ = Clock::now();
};

}  // namespace holdfast::instrument
