// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "by_hand.hpp"

#include <fmt/format.h>

namespace holdfast::instrument::by_hand {
namespace {

constexpr std::uint8_t kBegin = 0x7e;
constexpr std::uint8_t kEnd = 0x2e;
constexpr std::uint8_t kEscape = 0x7d;
constexpr std::uint8_t kHello = 0x05;

/// A whole number in so many bytes, the lowest first.
void put(Bytes& bytes, int value, int size) {
  for (int i = 0; i < size; ++i) {
    bytes.push_back(static_cast<std::uint8_t>(static_cast<unsigned>(value) >> (8 * i) & 0xffU));
  }
}

void put(Bytes& bytes, const Cell& cell) {
  put(bytes, cell.x, 3);
  put(bytes, cell.y, 3);
  put(bytes, cell.z, 3);
}

Bytes summed(Bytes bytes, std::uint16_t start) {
  put(bytes, crc(bytes, start), 2);
  return bytes;
}

}  // namespace

std::uint16_t crc(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  unsigned value = start;
  for (const std::uint8_t byte : bytes) {
    value ^= static_cast<unsigned>(byte) << 8U;
    for (int bit = 0; bit < 8; ++bit) {
      value = (value & 0x8000U) != 0 ? value << 1U ^ 0x1021U : value << 1U;
    }
    value &= 0xffffU;
  }
  return static_cast<std::uint16_t>(value);
}

Bytes frame(std::uint8_t kind, const Bytes& payload) {
  Bytes body = {kind, 0};
  put(body, static_cast<int>(payload.size()), 2);
  body.insert(body.end(), payload.begin(), payload.end());
  Bytes out = {kBegin};
  for (const std::uint8_t byte : summed(std::move(body), 0xffff)) {
    if (byte == kBegin || byte == kEnd || byte == kEscape) {
      out.push_back(kEscape);
    }
    const bool is_mark = byte == kBegin || byte == kEnd || byte == kEscape;
    out.push_back(static_cast<std::uint8_t>(is_mark ? byte ^ 0x20U : byte));
  }
  out.push_back(kEnd);
  return out;
}

Bytes packet(const Greeting& greeting) {
  Bytes bytes = {0xc0, static_cast<std::uint8_t>(greeting.version << 6)};
  put(bytes, greeting.number, 2);
  put(bytes, greeting.heard, 2);
  put(bytes, greeting.is_open ? 1 : 0, 1);
  put(bytes, greeting.lattice | greeting.face << 2, 1);
  return summed(std::move(bytes), 0xffff);
}

std::uint16_t session(int sender, int receiver) {
  const auto from = static_cast<unsigned>(sender);
  const auto to = static_cast<unsigned>(receiver);
  unsigned value = from ^ ((to << 5U | to >> 11U) & 0xffffU);
  unsigned ones = 0;
  for (unsigned rest = value; rest != 0; rest >>= 1U) {
    ones += rest & 1U;
  }
  value ^= ones & 1U;
  return static_cast<std::uint16_t>(value);
}

Bytes packet(int kind, int sequence, int expected, const Bytes& payload, std::uint16_t session) {
  Bytes bytes = {static_cast<std::uint8_t>(kind << 6 | sequence % 64),
                 static_cast<std::uint8_t>(1 << 6 | expected % 64)};
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return summed(std::move(bytes), session);
}

Bytes message(const Join& join) {
  Bytes bytes = {1};
  put(bytes, join.epoch, 2);
  put(bytes, join.id, 4);
  put(bytes, join.wave, 1);
  put(bytes, join.cell);
  put(bytes, join.hops, 2);
  return bytes;
}

Bytes message(const Echo& echo) {
  Bytes bytes = {2};
  put(bytes, echo.epoch, 2);
  put(bytes, echo.id, 4);
  put(bytes, echo.wave, 1);
  put(bytes, echo.count, 4);
  put(bytes, echo.hops, 2);
  put(bytes, echo.furthest, 4);
  put(bytes, 0, 1);
  return bytes;
}

Bytes hex(std::string_view text) {
  Bytes bytes;
  int nibbles = 0;
  unsigned value = 0;
  for (const char sign : text) {
    if (sign == ' ') {
      continue;
    }
    value = value << 4U | static_cast<unsigned>(sign <= '9' ? sign - '0' : sign - 'a' + 10);
    if (++nibbles % 2 == 0) {
      bytes.push_back(static_cast<std::uint8_t>(value & 0xffU));
    }
  }
  return bytes;
}

std::string text(std::span<const std::uint8_t> bytes) {
  return fmt::format("{:02x}", fmt::join(bytes, " "));
}

bool Reader::take(std::uint8_t byte) {
  if (byte == kBegin) {
    is_inside_ = true;
    is_escaped_ = false;
    body_.clear();
    return false;
  }
  if (!is_inside_) {
    ++(byte == kHello ? hello_count : noise_count);
    return false;
  }
  if (byte == kEnd) {
    is_inside_ = false;
    return end();
  }
  if (byte == kEscape) {
    is_escaped_ = true;
    return false;
  }
  body_.push_back(static_cast<std::uint8_t>(is_escaped_ ? byte ^ 0x20U : byte));
  is_escaped_ = false;
  return false;
}

/// Is what lies between the marks whole?
bool Reader::end() {
  constexpr std::size_t kAround = 6;  // Kind, 0, size; checksum
  if (body_.size() < kAround ||
      (body_[2] | body_[3] << 8) != static_cast<int>(body_.size() - kAround)) {
    ++noise_count;
    return false;
  }
  const Bytes content(body_.begin(), body_.end() - 2);
  if (summed(content, 0xffff) != body_) {
    ++noise_count;
    return false;
  }
  frame_ = {.kind = body_[0], .payload = Bytes(content.begin() + 4, content.end())};
  return true;
}

}  // namespace holdfast::instrument::by_hand
