// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "holdfast/agent/wire/wire.hpp"

namespace holdfast::agent::wire {

/// What a data packet carries.
struct Carried {
  MessageType type = MessageType::kJoin;  ///< Type of the first message, whole or a part of it.
  std::optional<Operation> order = {};    ///< Operation of the first order that begins in it.
};

/// Follows one direction of a link from the side, packet by packet as they are sent.
class Listener {
 public:
  /// What the packet carries; nothing for a greeting, ping or acknowledgement. One that is sent
  /// again carries what the last new one did, without its order.
  std::optional<Carried> follow(std::span<const std::uint8_t> packet);

 private:
  Carried read(std::span<const std::uint8_t> payload);

  int number_ = 0;  ///< Number of the greeting; another one begins a new session.
  int next_sequence_ = 0;
  int bytes_left_ = 0;      ///< Bytes left of the message that the next packet goes on with.
  std::uint8_t first_ = 0;  ///< Its type, if the next packet tells the operation.
  MessageType type_ = MessageType::kJoin;
};

}  // namespace holdfast::agent::wire
