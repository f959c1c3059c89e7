// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/wire/wire.hpp"

/// Packets as bytes on a serial line, framed in the manner of Blinky Blocks 2 but with
/// marks of our own:
///
///     '~'  kind, 0, size low, size high  payload  checksum low, checksum high  '.'
///
/// Between the two marks, '~', '.' and '}' are sent as '}' and the byte xor 0x20. The checksum is
/// CRC-16/CCITT from 0xffff over header and payload. Outside a frame the byte kHelloByte says "I am
/// here"; every other byte there is noise. What is not a whole, sound frame is dropped: the links
/// of the agents repeat it.
namespace holdfast::module {

enum class FrameKind : std::uint8_t {
  kPacket = 1,  ///< What an agent's link says to its neighbour's; docs/wire.md.
  kPlan = 2,    ///< From outside: a module is planned; three i32, the cell.
  // Between a module and an instrument, and between modules that are told a configuration; see
  // status_report.hpp.
  kAsk = 3,        ///< From an instrument: say how you are.
  kStatus = 4,     ///< The answer.
  kLog = 5,        ///< The other answer: what has happened.
  kWho = 6,        ///< From an instrument: who you are.
  kRevision = 7,   ///< Which configuration I have.
  kConfigure = 8,  ///< A part of a configuration.
};

inline constexpr std::uint8_t kFrameBegin = '~';
inline constexpr std::uint8_t kFrameEnd = '.';
inline constexpr std::uint8_t kFrameEscape = '}';
inline constexpr std::uint8_t kFrameFlip = 0x20;
inline constexpr std::uint8_t kHelloByte = 0x05;

/// The most bytes of a packet; with HOLDFAST_BLINKY_BLOCKS_1, for little memory, no more than
/// version 1's.
#ifdef HOLDFAST_BLINKY_BLOCKS_1
inline constexpr int kPayloadBytesMax = agent::wire::kPacketBytesMin;
#else
inline constexpr int kPayloadBytesMax = agent::wire::kPacketBytesMax;
#endif
inline constexpr int kFrameHeaderBytes = 4;
inline constexpr int kBodyBytesMax =
    kFrameHeaderBytes + kPayloadBytesMax + agent::wire::kChecksumBytes;
inline constexpr int kFrameBytesMax = 2 + 2 * kBodyBytesMax;  ///< If every byte is escaped.

/// Writes a frame, at most kFrameBytesMax bytes, and returns its size.
int write_frame(FrameKind kind, std::span<const std::uint8_t> payload,
                std::span<std::uint8_t, kFrameBytesMax> frame);

/// Finds frames in the bytes of one line.
class FrameReader {
 public:
  enum class Found : std::uint8_t { kNothing, kHello, kFrame };

  /// Takes the next byte.
  Found take(std::uint8_t byte);

  /// The kind of the frame just found, until the next byte is taken.
  FrameKind kind() const { return static_cast<FrameKind>(body_[0]); }

  std::span<const std::uint8_t> payload() const;

 private:
  bool is_sound() const;

  std::array<std::uint8_t, kBodyBytesMax> body_{};
  std::uint16_t size_ = 0;
  bool is_inside_ = false;
  bool is_escaped_ = false;
};

}  // namespace holdfast::module
