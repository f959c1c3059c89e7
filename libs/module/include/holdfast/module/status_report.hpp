// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <span>

#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/module/frame.hpp"

/// What a module and an instrument at one of its free faces say to each other, in frames of their
/// own (frame.hpp). Numbers are little-endian, reals IEEE 754 binary32; docs/instrument.md lists
/// the bytes. Both ends use these functions.
namespace holdfast::module {

inline constexpr std::uint8_t kReportFormat = 1;

/// FrameKind::kAsk: what an instrument wants to know.
struct Ask {
  static constexpr std::uint8_t kStatus = 1;
  static constexpr std::uint8_t kLog = 2;

  std::uint8_t format = kReportFormat;
  std::uint8_t what = kStatus;  ///< kStatus, kLog or both.
  std::uint16_t log_from = 0;   ///< The number of the first entry that it does not know.
};

/// FrameKind::kStatus: what a module has come to. What may be of a later program (verdict, reason,
/// phase, directions) is kept as bytes, and asked for its name by those who show it.
struct StatusReport {
  static constexpr std::uint8_t kHasConfiguration = 1;
  static constexpr std::uint8_t kHasCell = 2;
  static constexpr std::uint8_t kIsRoot = 4;
  static constexpr std::uint8_t kIsFixed = 8;
  static constexpr std::uint8_t kIsAnchor = 16;

  std::uint8_t format = kReportFormat;
  std::uint8_t wire_version = agent::wire::kVersion;
  std::uint8_t verdict = 0;
  std::uint8_t reason = 0;
  std::uint8_t phase = 0;
  std::uint8_t flags = 0;
  std::uint8_t connected = 0;  ///< Faces at which a neighbour is heard, by bit.
  std::uint8_t worst_direction = 0;
  std::uint16_t epoch = 0;
  std::uint8_t refused_count = 0;  ///< Messages of neighbours that a working one would not send.
  std::uint8_t reset_reason = 0;   ///< The board's flags; 0: it does not say.
  std::uint16_t stack_bytes = 0;   ///< At its deepest; 0: the board does not say.
  std::uint16_t log_next = 0;      ///< The number that the next entry of the log will have.
  std::uint16_t revision = 0;      ///< Of its configuration; 0: a page that was flashed.
  std::uint16_t setup_sum = 0;     ///< setup_sum(): the same for all modules of a robot.
  std::uint32_t id = 0;
  std::uint32_t time_us = 0;  ///< Since its start, counting over.
  std::uint32_t plan_count = 0;
  base::Cell cell;
  base::Cell worst_cell;
  float load_ratio_max = 0;
  float own_load_ratio = 0;

  bool has(std::uint8_t flag) const { return (flags & flag) != 0; }
};

/// One thing that has happened at a module.
struct LogEntry {
  enum class What : std::uint8_t {
    kStarted,      ///< value: the reset's reason, 0 if the board does not say.
    kJoined,       ///< number: the epoch of the round.
    kPhase,        ///< value: agent::Phase
    kVerdict,      ///< value: agent::Verdict; number: agent::Reason
    kPlan,         ///< cell
    kWithdraw,     ///< cell
    kHeard,        ///< value: the face at which a neighbour is heard.
    kUnheard,      ///< value: the face at which it is heard no more.
    kConfigured,   ///< number: the revision that the module has taken.
    kOtherVersion  ///< value: the face at which packets of another version come; number: which.
  };

  std::uint32_t time_us = 0;
  What what = What::kStarted;
  std::uint8_t value = 0;
  std::uint16_t number = 0;
  base::Cell cell;
};

inline constexpr int kLogEntryBytes = 20;
/// FrameKind::kLog: a u16, the number of the first entry, then entries one behind the other.
inline constexpr int kLogHeaderBytes = 2;
inline constexpr int kLogEntriesMax = (kPayloadBytesMax - kLogHeaderBytes) / kLogEntryBytes;

/// FrameKind::kWho: an instrument tells a module who it is.
struct Who {
  enum class What : std::uint8_t {
    kNoAnchor,  ///< It does not know its cell by itself any more.
    kAnchor,    ///< It sits in `cell`.
    kFree,      ///< Nothing outside holds it.
    kFixed,     ///< It is held from outside.
  };

  What what = What::kNoAnchor;
  base::Cell cell;
};

/// FrameKind::kRevision: which configuration a module has.
struct Revision {
  static constexpr std::uint8_t kIsThere = 1;  ///< It has one.
  static constexpr std::uint8_t kAsks = 2;     ///< Say yours.

  std::uint8_t flags = 0;
  std::uint16_t number = 0;
  std::uint16_t sum = 0;
};

/// FrameKind::kConfigure: the header of a part of a configuration, behind which its bytes follow.
struct ConfigurationPart {
  std::uint16_t revision = 0;
  std::uint16_t sum = 0;  ///< Of the whole setup.
  std::uint8_t index = 0;
};

inline constexpr std::size_t kPartHeaderBytes = 5;

/// Writes the payload of a part of a setup, kSetupBytes as they lie in a page. Returns its size;
/// 0: there are not so many parts.
std::size_t write_part(std::span<const std::uint8_t> setup, std::uint16_t revision,
                       std::uint8_t index, std::span<std::uint8_t, kPayloadBytesMax> payload);

/// Calls the codec for every field of a frame, in the order of the bytes: the one place that knows.
template <class Codec>
constexpr void each_field(auto&& ask, Codec& codec) requires requires {
  ask.log_from;
}

{
  codec.u8(ask.format);
  codec.u8(ask.what);
  codec.u16(ask.log_from);
}

template <class Codec>
constexpr void each_field(auto&& report, Codec& codec) requires requires {
  report.own_load_ratio;
}

{
  codec.u8(report.format);
  codec.u8(report.wire_version);
  codec.u8(report.verdict);
  codec.u8(report.reason);
  codec.u8(report.phase);
  codec.u8(report.flags);
  codec.u8(report.connected);
  codec.u8(report.worst_direction);
  codec.u16(report.epoch);
  codec.u8(report.refused_count);
  codec.u8(report.reset_reason);
  codec.u16(report.stack_bytes);
  codec.u16(report.log_next);
  codec.u16(report.revision);
  codec.u16(report.setup_sum);
  codec.u32(report.id);
  codec.u32(report.time_us);
  codec.u32(report.plan_count);
  codec.cell(report.cell);
  codec.cell(report.worst_cell);
  codec.real(report.load_ratio_max);
  codec.real(report.own_load_ratio);
}

template <class Codec>
constexpr void each_field(auto&& entry, Codec& codec) requires requires {
  entry.time_us;
  entry.what;
}

{
  codec.u32(entry.time_us);
  codec.u8(entry.what);
  codec.u8(entry.value);
  codec.u16(entry.number);
  codec.cell(entry.cell);
}

template <class Codec>
constexpr void each_field(auto&& who, Codec& codec) requires(
    requires {
      who.what;
      who.cell;
    } &&
    !requires { who.time_us; }) {
  codec.u8(who.what);
  codec.cell(who.cell);
}

template <class Codec>
constexpr void each_field(auto&& revision, Codec& codec) requires(
    requires { revision.sum; } && !requires { revision.index; }) {
  codec.u8(revision.flags);
  codec.u16(revision.number);
  codec.u16(revision.sum);
}

template <class Codec>
constexpr void each_field(auto&& part, Codec& codec) requires requires {
  part.index;
}

{
  codec.u16(part.revision);
  codec.u16(part.sum);
  codec.u8(part.index);
}

/// Fills a payload from the front. Writing past its end is a bug.
class PayloadWriter {
 public:
  explicit PayloadWriter(std::span<std::uint8_t> bytes) : bytes_(bytes) {}

  void u8(auto value) { bytes_[size_++] = static_cast<std::uint8_t>(value); }

  void u16(std::uint16_t value) {
    u8(value & 0xffU);
    u8(value >> 8U);
  }

  void u32(std::uint32_t value) {
    u16(static_cast<std::uint16_t>(value & 0xffffU));
    u16(static_cast<std::uint16_t>(value >> 16U));
  }

  void real(float value) { u32(std::bit_cast<std::uint32_t>(value)); }

  void cell(const base::Cell& value) {
    u32(static_cast<std::uint32_t>(value.x));
    u32(static_cast<std::uint32_t>(value.y));
    u32(static_cast<std::uint32_t>(value.z));
  }

  void bytes(std::span<const std::uint8_t> values) {
    for (const std::uint8_t value : values) {
      u8(value);
    }
  }

  std::span<const std::uint8_t> written() const { return bytes_.first(size_); }

 private:
  std::span<std::uint8_t> bytes_;
  std::size_t size_ = 0;
};

/// Reads a payload from the front. What is not there is zero, and is_whole() says so.
class PayloadReader {
 public:
  explicit PayloadReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class Byte>
  void u8(Byte& value) {
    value = static_cast<Byte>(take());
  }

  void u16(std::uint16_t& value) {
    value = take();
    value = static_cast<std::uint16_t>(value | take() << 8);
  }

  void u32(std::uint32_t& value) {
    std::uint16_t low = 0;
    std::uint16_t high = 0;
    u16(low);
    u16(high);
    value = low | std::uint32_t{high} << 16U;
  }

  void real(float& value) {
    std::uint32_t bits = 0;
    u32(bits);
    value = std::bit_cast<float>(bits);
  }

  void cell(base::Cell& value) {
    for (std::int32_t* const coordinate : {&value.x, &value.y, &value.z}) {
      std::uint32_t bits = 0;
      u32(bits);
      *coordinate = static_cast<std::int32_t>(bits);
    }
  }

  std::span<const std::uint8_t> rest() const { return bytes_.subspan(at_); }

  bool is_whole() const { return is_whole_; }

 private:
  std::uint8_t take() {
    is_whole_ = is_whole_ && at_ < bytes_.size();
    return at_ < bytes_.size() ? bytes_[at_++] : std::uint8_t{0};
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool is_whole_ = true;
};

/// Reads one of the frames above; false: the payload is shorter than it.
template <class Frame>
bool read_fields(std::span<const std::uint8_t> payload, Frame& frame) {
  PayloadReader reader(payload);
  each_field(frame, reader);
  return reader.is_whole();
}

}  // namespace holdfast::module
