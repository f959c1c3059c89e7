// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "holdfast/agent/features.hpp"
#include "holdfast/base/cell.hpp"

/// The bytes that modules exchange. docs/wire.md specifies them; this is the only code that knows.
///
/// A packet is 2 bytes of header, up to `payload` bytes, 2 bytes of checksum. The payloads of the
/// packets of one link, in order, are one stream of messages: a message is one type byte (orders
/// and reports: a second one for the operation), then a body whose size the type gives. Numbers are
/// little-endian; reals are IEEE 754 binary32 whatever the modules compute with.
namespace holdfast::agent::wire {

inline constexpr std::uint8_t kVersion = 1;

/// What the modules are, as greetings say it. Others have other directions and facets.
inline constexpr std::uint8_t kCubicLattice = 0;
inline constexpr std::uint8_t kFaceCentredLattice = 1;
inline constexpr std::uint8_t kHexagonalLattice = 2;
inline constexpr std::uint8_t kHexagonalPrismLattice = 3;

inline constexpr int kHeaderBytes = 2;
inline constexpr int kChecksumBytes = 2;
inline constexpr int kPacketBytesMin = 17;   ///< Blinky Blocks version 1
inline constexpr int kPacketBytesMax = 228;  ///< Blinky Blocks version 2
/// Changes of displacement that a module keeps (deflation.hpp), and pairs of them.
inline constexpr int kKeptMax = 4;
inline constexpr int kKeptPairs = kKeptMax * (kKeptMax + 1) / 2;
/// The largest message but those about changes that are kept.
inline constexpr int kPlainBytesMax = 41;
inline constexpr int kMessageBytesMax = kKeepsAnswers ? 70 + 4 * kKeptMax : kPlainBytesMax;
inline constexpr int kVectorBytes = 26;  ///< Size of the messages with six reals.
inline constexpr int kCellBytes = 9;

/// A greeting differs in two bits from data, so that few errors make one of the other.
enum class PacketKind : std::uint8_t { kData, kAcknowledge, kPing, kHello };

/// The two bytes in front of every packet.
struct PacketHeader {
  PacketKind kind = PacketKind::kData;
  std::uint8_t sequence = 0;  ///< Sequence number of a data packet.
  std::uint8_t version = 0;
  std::uint8_t expected = 0;  ///< The sequence number that is expected from the other side.
};

inline constexpr int kSequenceCount = 64;

/// `packet` has two bytes at least.
constexpr PacketHeader header_of(std::span<const std::uint8_t> packet) {
  constexpr unsigned kMask = kSequenceCount - 1;
  return {.kind = static_cast<PacketKind>(packet[0] >> 6U),
          .sequence = static_cast<std::uint8_t>(packet[0] & kMask),
          .version = static_cast<std::uint8_t>(packet[1] >> 6U),
          .expected = static_cast<std::uint8_t>(packet[1] & kMask)};
}

enum class MessageType : std::uint8_t {
  kJoin = 1,     ///< A wave: take part in a round, and where you are.
  kEcho,         ///< The wave's answer: who is behind me.
  kAppoint,      ///< Down the tree: this module starts the next wave.
  kMark,         ///< Along a path: after so many hops, start the next wave.
  kOrder,        ///< Down the tree: do this.
  kReport,       ///< Up the tree: done, with these sums.
  kVector,       ///< To every neighbour: six reals.
  kPlannedDown,  ///< From the host of a planned module: its six reals.
  kPlannedUp,    ///< To the host of a planned module: the force on it.
  kLoop,         ///< Up the tree: a cut whose other end is not below.
  kColumn,       ///< Up the tree: one column of a branch's condensed stiffness.
  kBranchUp,     ///< Up the tree: a branch's condensed load, or a loop's gap.
  kBranchDown,   ///< Down the tree: the parent's displacement, or the force in a loop's cut.
  kFrontUp,      ///< Up the tree: a node of a front, six reals of its matrix, or a load.
  kFrontDown,    ///< Down the tree: the shift of a node in the child's front.
  kAdopt,        ///< To a neighbour that has come: take your place in the tree that stands.
  kNews,         ///< Up the tree: a plan begins or ends, or a module has come.
  kCellsUp,      ///< Up the tree: a part of the cells that are occupied below.
  kCellsDown,    ///< Down the tree: that part of the whole robot.
  kReach,        ///< Along the tree, away from the supports: what more the way inward can carry.
};

/// What an order asks for. Each has a body for the way down and one for the way up; operations.hpp
/// has all that is known of them. Numbers 6 to 11 belonged to methods that exist no longer.
enum class Operation : std::uint8_t {
  kPlan = 1,         ///< Learn one planned cell, find the next.
  kHosts,            ///< Which faces of planned modules touch; who emulates them.
  kMass,             ///< Count, centre of mass, supports, extent.
  kAngles,           ///< Safe angles of the simplified stability check.
  kBegin,            ///< Start an equilibrium: law, weak spring.
  kHold = 12,        ///< Release open facets, hold pressed ones.
  kCorners,          ///< Support corners of the model-based stability check.
  kLoads,            ///< The worst connection.
  kVerdict,          ///< The answer, for every module.
  kFactor,           ///< Condense every branch: stiffness and load.
  kIterate,          ///< One iteration of the polynomial: move, residual, sums.
  kTreeIterate,      ///< One iteration of the elimination: move, residual.
  kClusters,         ///< kBegin, and find rigid clusters.
  kForget,           ///< A plan has ended; learn from the first one on.
  kRenew,            ///< After a verdict: one plan more or less; count, centre of mass, extent.
  kResume,           ///< kHosts, kAngles and kBegin (with kFactor) in one, from what is kept.
  kClose,            ///< kCorners and kLoads in one.
  kWord,             ///< Learn one word of a step, find the next.
  kStage,            ///< Know the verdict on a stage of a step; the next stage, or scene of one.
  kShape,            ///< Box, supports and largest load ratio of every subtree.
  kNext,             ///< Where the next module may go: every free face judges itself.
  kSeek,             ///< Contact states as they were found, one facet in another state.
  kResumeDeflated,   ///< kResume, and the energies of the changes that modules keep.
  kIterateDeflated,  ///< kIterate, and along those changes.
  kIterateLast,      ///< kIterateDeflated and kClose in one: probably the last one.
  kBend,             ///< How far beams turn and what they store: may bending matter?
};
inline constexpr int kOperationLast = static_cast<int>(Operation::kBend);

/// Sizes of whole messages, type byte included; 0 for what is not a message. `second` is the byte
/// after the type and matters for orders and reports only.
int message_bytes(std::uint8_t type, std::uint8_t second);

/// CRC-16/CCITT (polynomial 0x1021, most significant bit first) from a start value.
std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t start);

/// Fills a message from the front. Writing past kMessageBytesMax is a bug.
class Writer {
 public:
  explicit Writer(MessageType type) { u8(static_cast<std::uint8_t>(type)); }

  Writer(MessageType type, Operation operation) : Writer(type) {
    u8(static_cast<std::uint8_t>(operation));
  }

  void u8(std::uint8_t value);
  void u16(std::uint16_t value);
  void u32(std::uint32_t value);

  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }

  void real(double value);            ///< Rounded to binary32.
  void long_real(double value);       ///< As binary32, and what that leaves as another.
  void cell(const base::Cell& cell);  ///< Three times 24 bits, two's complement.
  void pad();                         ///< Zeros up to the size of the message.

  std::span<const std::uint8_t> bytes() const { return {bytes_.data(), size_}; }

 private:
  std::array<std::uint8_t, kMessageBytesMax> bytes_{};
  std::size_t size_ = 0;
};

/// Reads a message from behind the type byte. Reading past the end gives zeros.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> message, std::size_t at = 1)
      : bytes_(message), at_(at) {}

  std::uint8_t u8();
  std::uint16_t u16();
  std::uint32_t u32();

  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }

  float real();
  double long_real();
  base::Cell cell();

 private:
  std::span<const std::uint8_t> bytes_;
  std::size_t at_;
};

}  // namespace holdfast::agent::wire
