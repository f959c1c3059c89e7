// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/colour.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/module/frame.hpp"

/// What a board offers to the program of a module: a clock, six links, a lamp. A board without
/// packets of its own derives from SerialPort (serial_port.hpp) instead. What a broken check does
/// is the board's too: it defines base::panic().
namespace holdfast::module {

using agent::Time;

/// A packet, or a message from outside, that came in. Valid until the next receive().
struct Incoming {
  int face = 0;  ///< base::Direction
  FrameKind kind = FrameKind::kPacket;
  std::span<const std::uint8_t> payload = {};
};

/// What a board can say of itself.
struct Health {
  std::uint8_t reset_reason = 0;  ///< Flags of its own; 0: it does not say.
  std::uint16_t stack_bytes = 0;  ///< At its deepest since the start; 0: it does not say.
};

class Port {
 public:
  /// Microseconds since the start; never goes back.
  virtual Time now() = 0;

  /// Differs from one call to the next and from one start to the next.
  virtual std::uint16_t random() = 0;

  /// The next thing that came in, of all faces in turn; false: nothing is there.
  virtual bool receive(Incoming& incoming) = 0;

  /// Is a neighbour heard at this face?
  virtual bool is_connected(int face) = 0;

  /// The program is at work and does not receive: who is connected is not silent meanwhile.
  virtual void stay_connected() {}

  /// Can a packet be sent on this face now?
  virtual bool is_line_free(int face) = 0;

  /// Sends a packet. The line must be free.
  virtual void send(int face, std::span<const std::uint8_t> packet) = 0;

  /// Sends a frame of another kind than a packet, as send() does. Boards whose lines carry packets
  /// alone do nothing, and have neither instruments nor configurations by message.
  virtual void tell(int /*face*/, FrameKind /*kind*/, std::span<const std::uint8_t> /*payload*/) {}

  /// Keeps the page of configuration, kConfigurationBytes, over a loss of power, if it can.
  virtual void keep(std::span<const std::uint8_t> /*page*/) {}

  virtual Health health() { return {}; }

  virtual void show(const agent::Colour& colour) = 0;

  /// Returns when something may have come in, a line has become free, or at `until`; or earlier.
  virtual void wait(Time until) = 0;

 protected:
  ~Port() = default;
};

}  // namespace holdfast::module
