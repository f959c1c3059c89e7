// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/legal.hpp"

#include "holdfast/agent/messages.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/wire.hpp"

namespace holdfast::agent::wire {
namespace {

template <class Message>
bool is_legal_as(std::span<const std::uint8_t> message) {
  Message value;
  return decode(message, value);
}

}  // namespace

bool is_legal(std::span<const std::uint8_t> message) {
  switch (static_cast<MessageType>(message[0])) {
    case MessageType::kVector:
      return true;  // Most messages are.
    case MessageType::kJoin:
      return is_legal_as<Join>(message);
    case MessageType::kEcho:
      return is_legal_as<Echo>(message);
    case MessageType::kAppoint:
      return is_legal_as<Appointment>(message);
    case MessageType::kMark:
      return is_legal_as<Mark>(message);
    case MessageType::kOrder:
      return is_legal_as<Order>(message);
    case MessageType::kReport:
      return is_legal_as<Report>(message);
    case MessageType::kLoop:
      return is_legal_as<Loop>(message);
    case MessageType::kPlannedDown:
    case MessageType::kPlannedUp:
    case MessageType::kColumn:
    case MessageType::kBranchUp:
    case MessageType::kBranchDown:
      return is_legal_as<LabelledVector>(message);
  }
  return false;
}

}  // namespace holdfast::agent::wire
