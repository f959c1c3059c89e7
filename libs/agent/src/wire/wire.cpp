// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/wire/wire.hpp"

#include <bit>

#include "holdfast/agent/wire/operations.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::agent::wire {
namespace {

/// Table k: what a byte becomes that k more bytes follow, so that four go at once [Kounavis,
/// Berry 2005].
using ChecksumTables = std::array<std::array<std::uint16_t, 256>, 4>;

constexpr ChecksumTables checksum_tables() {
  ChecksumTables tables{};
  for (std::uint32_t byte = 0; byte < 256; ++byte) {
    std::uint32_t value = byte << 8U;
    for (int bit = 0; bit < 8 * 4; ++bit) {
      value = (value & 0x8000U) != 0 ? (value << 1U) ^ 0x1021U : value << 1U;
      if (bit % 8 == 7) {
        tables[static_cast<std::size_t>(bit / 8)][byte] = static_cast<std::uint16_t>(value);
      }
    }
  }
  return tables;
}

constexpr ChecksumTables kChecksumTables = checksum_tables();

/// Sizes by type, without orders and reports.
constexpr std::array<std::uint8_t, 21> kMessageBytes = {0,  19, 19, 8,  12, 0,  0,  26, 26, 26, 11,
                                                        26, 26, 26, 26, 26, 35, 13, 26, 26, 26};

/// Sizes of orders or reports; 0 of what a program has no room for, and so does not know.
constexpr auto room_for(std::uint8_t OperationInfo::*bytes) {
  auto sizes = column(bytes);
  for (std::uint8_t& size : sizes) {
    size = size <= kMessageBytesMax ? size : std::uint8_t{0};
  }
  return sizes;
}

constexpr auto kOrderBytes = room_for(&OperationInfo::order_bytes);
constexpr auto kReportBytes = room_for(&OperationInfo::report_bytes);

/// The checksum with a table of 32 bytes instead of 2,048: four bits at a time.
std::uint16_t small_checksum(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  static constexpr std::array<std::uint16_t, 16> kTable = [] {
    std::array<std::uint16_t, 16> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
      table[i] = checksum_tables()[0][i];
    }
    return table;
  }();
  std::uint32_t value = start;
  for (const std::uint8_t byte : bytes) {
    value = (value << 4U) ^ kTable[((value >> 12U) ^ (byte >> 4U)) & 15U];
    value = (value << 4U) ^ kTable[((value >> 12U) ^ byte) & 15U];
  }
  return static_cast<std::uint16_t>(value);
}

std::uint16_t fast_checksum(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  const auto& [last, third, second, first] = kChecksumTables;
  std::uint32_t value = start;
  for (; bytes.size() >= 4; bytes = bytes.subspan(4)) {
    value = static_cast<std::uint32_t>(first[bytes[0] ^ (value >> 8U)]) ^
            second[bytes[1] ^ (value & 0xffU)] ^ third[bytes[2]] ^ last[bytes[3]];
  }
  for (const std::uint8_t byte : bytes) {
    value = ((value << 8U) & 0xffffU) ^ last[(value >> 8U) ^ byte];
  }
  return static_cast<std::uint16_t>(value);
}

}  // namespace

int message_bytes(std::uint8_t type, std::uint8_t second) {
  if (type >= kMessageBytes.size()) {
    return 0;
  }
  const bool is_order = type == static_cast<std::uint8_t>(MessageType::kOrder);
  const bool is_report = type == static_cast<std::uint8_t>(MessageType::kReport);
  if (!is_order && !is_report) {
    return kMessageBytes[type];
  }
  return second > kOperationLast ? 0 : (is_order ? kOrderBytes : kReportBytes)[second];
}

std::uint16_t checksum(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  return kHasFastChecksum ? fast_checksum(bytes, start) : small_checksum(bytes, start);
}

void Writer::u8(std::uint8_t value) {
  HOLDFAST_CHECK(size_ < bytes_.size());
  bytes_[size_++] = value;
}

void Writer::u16(std::uint16_t value) {
  u8(static_cast<std::uint8_t>(value & 0xffU));
  u8(static_cast<std::uint8_t>(value >> 8U));
}

void Writer::u32(std::uint32_t value) {
  HOLDFAST_CHECK(size_ + 4 <= bytes_.size());
  for (unsigned i = 0; i < 4; ++i) {
    bytes_[size_ + i] = static_cast<std::uint8_t>((value >> (8 * i)) & 0xffU);
  }
  size_ += 4;
}

void Writer::real(double value) { u32(std::bit_cast<std::uint32_t>(static_cast<float>(value))); }

void Writer::long_real(double value) {
  const auto leading = static_cast<float>(value);
  real(static_cast<double>(leading));
  real(value - static_cast<double>(leading));
}

void Writer::cell(const base::Cell& cell) {
  for (const std::int32_t coordinate : {cell.x, cell.y, cell.z}) {
    const auto bits = static_cast<std::uint32_t>(coordinate);
    u16(static_cast<std::uint16_t>(bits & 0xffffU));
    u8(static_cast<std::uint8_t>((bits >> 16U) & 0xffU));
  }
}

void Writer::pad() {
  const auto size = static_cast<std::size_t>(message_bytes(bytes_[0], bytes_[1]));
  HOLDFAST_CHECK(size_ <= size);
  size_ = size;
}

std::uint8_t Reader::u8() { return at_ < bytes_.size() ? bytes_[at_++] : std::uint8_t{0}; }

std::uint16_t Reader::u16() {
  const std::uint16_t low = u8();
  return static_cast<std::uint16_t>(low | (u8() << 8U));
}

std::uint32_t Reader::u32() {
  std::uint32_t value = 0;
  if (at_ + 4 <= bytes_.size()) {
    for (unsigned i = 0; i < 4; ++i) {
      value |= static_cast<std::uint32_t>(bytes_[at_ + i]) << (8 * i);
    }
    at_ += 4;
    return value;
  }
  for (unsigned i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(u8()) << (8 * i);
  }
  return value;
}

float Reader::real() { return std::bit_cast<float>(u32()); }

double Reader::long_real() {
  const auto leading = static_cast<double>(real());
  return leading + static_cast<double>(real());
}

base::Cell Reader::cell() {
  std::array<std::int32_t, 3> values{};
  for (std::int32_t& value : values) {
    const std::uint32_t low = u16();
    const std::uint32_t bits = low | (static_cast<std::uint32_t>(u8()) << 16U);
    value = static_cast<std::int32_t>(bits << 8U) >> 8;
  }
  return {values[0], values[1], values[2]};
}

}  // namespace holdfast::agent::wire
