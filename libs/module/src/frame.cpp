// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/frame.hpp"

#include "holdfast/base/check.hpp"

namespace holdfast::module {
namespace {

constexpr std::uint16_t kChecksumStart = 0xffff;

bool is_mark(std::uint8_t byte) {
  return byte == kFrameBegin || byte == kFrameEnd || byte == kFrameEscape;
}

std::uint8_t low(int value) { return static_cast<std::uint8_t>(value & 0xff); }

std::uint8_t high(int value) { return static_cast<std::uint8_t>((value >> 8) & 0xff); }

}  // namespace

int write_frame(FrameKind kind, std::span<const std::uint8_t> payload,
                std::span<std::uint8_t, kFrameBytesMax> frame) {
  const auto payload_bytes = static_cast<int>(payload.size());
  HOLDFAST_CHECK(payload_bytes <= kPayloadBytesMax);
  std::size_t size = 0;
  const auto put = [&](std::uint8_t byte) {
    if (is_mark(byte)) {
      frame[size++] = kFrameEscape;
      byte = byte ^ kFrameFlip;
    }
    frame[size++] = byte;
  };
  const std::array<std::uint8_t, kFrameHeaderBytes> header = {
      static_cast<std::uint8_t>(kind), 0, low(payload_bytes), high(payload_bytes)};
  const int sum = agent::wire::checksum(payload, agent::wire::checksum(header, kChecksumStart));
  frame[size++] = kFrameBegin;
  for (const std::uint8_t byte : header) {
    put(byte);
  }
  for (const std::uint8_t byte : payload) {
    put(byte);
  }
  put(low(sum));
  put(high(sum));
  frame[size++] = kFrameEnd;
  return static_cast<int>(size);
}

FrameReader::Found FrameReader::take(std::uint8_t byte) {
  if (byte == kFrameBegin) {
    is_inside_ = true;
    is_escaped_ = false;
    size_ = 0;
    return Found::kNothing;
  }
  if (!is_inside_) {
    return byte == kHelloByte ? Found::kHello : Found::kNothing;
  }
  if (byte == kFrameEnd) {
    is_inside_ = false;
    return is_sound() ? Found::kFrame : Found::kNothing;
  }
  if (byte == kFrameEscape) {
    is_escaped_ = true;
    return Found::kNothing;
  }
  if (size_ == body_.size()) {
    is_inside_ = false;
    return Found::kNothing;
  }
  body_[size_++] = is_escaped_ ? byte ^ kFrameFlip : byte;
  is_escaped_ = false;
  return Found::kNothing;
}

bool FrameReader::is_sound() const {
  constexpr int kEmpty = kFrameHeaderBytes + agent::wire::kChecksumBytes;
  if (size_ < kEmpty || (body_[2] | body_[3] << 8) != size_ - kEmpty) {
    return false;
  }
  const std::size_t end = size_ - static_cast<std::size_t>(agent::wire::kChecksumBytes);
  const int sum = agent::wire::checksum(std::span(body_).first(end), kChecksumStart);
  return body_[end] == low(sum) && body_[end + 1] == high(sum);
}

std::span<const std::uint8_t> FrameReader::payload() const {
  return std::span(body_).subspan(kFrameHeaderBytes,
                                  static_cast<std::size_t>(body_[2] | body_[3] << 8));
}

}  // namespace holdfast::module
