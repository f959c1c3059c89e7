// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "block.hpp"
#include "comm/network.h"

namespace holdfast::visiblesim {

inline constexpr int kPacketType = 17'001;

/// A packet as VisibleSim carries it. Its size is what its line takes time for. While it is there
/// the robot is not at rest.
class PacketMessage final : public Message {
 public:
  PacketMessage(Ensemble& ensemble, const Packet& packet)
      : ensemble_(ensemble),
        bytes_(packet.bytes.begin(), packet.bytes.end()),
        rounds_(packet.rounds) {
    type = kPacketType;
    ensemble_.pending_changed(1);
  }

  PacketMessage(const PacketMessage& other)
      : Message(other), ensemble_(other.ensemble_), bytes_(other.bytes_), rounds_(other.rounds_) {
    adjustClonedMessageCount();
    ensemble_.pending_changed(1);
  }

  PacketMessage& operator=(const PacketMessage&) = delete;

  ~PacketMessage() override { ensemble_.pending_changed(-1); }

  unsigned int size() const override { return static_cast<unsigned int>(bytes_.size()); }

  Message* clone() const override { return new PacketMessage(*this); }

  std::string getMessageName() const override { return "holdfast packet"; }

  Packet packet() const { return {.bytes = bytes_, .rounds = rounds_}; }

 private:
  Ensemble& ensemble_;
  std::vector<std::uint8_t> bytes_;
  std::uint64_t rounds_;
};

}  // namespace holdfast::visiblesim
