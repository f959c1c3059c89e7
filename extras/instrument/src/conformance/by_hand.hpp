// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// The bytes on a line written a second time, after docs/wire.md and docs/firmware.md alone: no
/// code of modules is used here, so that what they do is compared with something else.
namespace holdfast::instrument::by_hand {

using Bytes = std::vector<std::uint8_t>;

/// CRC-16/CCITT, bit by bit.
std::uint16_t crc(std::span<const std::uint8_t> bytes, std::uint16_t start);

/// A frame of a kind, with its marks.
Bytes frame(std::uint8_t kind, const Bytes& payload);

struct Cell {
  int x = 0;
  int y = 0;
  int z = 0;
};

/// A packet as a greeting of a module by its face -x, or with other fields.
struct Greeting {
  int number = 0;
  int heard = 0;
  bool is_open = false;
  int version = 1;
  int lattice = 0;
  int face = 1;
};

Bytes packet(const Greeting& greeting);

/// The start of the checksum of what a sender says to a receiver.
std::uint16_t session(int sender, int receiver);

/// Kinds 0 data, 1 acknowledgement, 2 ping.
Bytes packet(int kind, int sequence, int expected, const Bytes& payload, std::uint16_t session);

struct Join {
  int epoch = 0;
  int id = 0;
  int wave = 1;
  Cell cell;
  int hops = 0;
};

Bytes message(const Join& join);

struct Echo {
  int epoch = 0;
  int id = 0;
  int wave = 1;
  int count = 1;
  int hops = 0;
  int furthest = 0;
};

Bytes message(const Echo& echo);

/// Hexadecimal bytes, as docs/evidence/wire.md shows them.
Bytes hex(std::string_view text);
std::string text(std::span<const std::uint8_t> bytes);

/// Frames among the bytes of a line.
class Reader {
 public:
  struct Frame {
    std::uint8_t kind = 0;
    Bytes payload;
  };

  /// Takes a byte; true: a whole frame is there, frame().
  bool take(std::uint8_t byte);

  const Frame& frame() const { return frame_; }

  /// Counts bytes outside of frames: hello bytes, and others.
  int hello_count = 0;
  int noise_count = 0;

 private:
  bool end();

  bool is_inside_ = false;
  bool is_escaped_ = false;
  Bytes body_;
  Frame frame_;
};

}  // namespace holdfast::instrument::by_hand
