// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Frames on a line: what is sent is found, what is damaged is not. Expected bytes are worked out
// from the format's description.
#include "holdfast/module/frame.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::module {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes framed(const Bytes& payload, FrameKind kind = FrameKind::kPacket) {
  std::array<std::uint8_t, kFrameBytesMax> frame{};
  const int size = write_frame(kind, payload, frame);
  return {frame.begin(), frame.begin() + size};
}

/// The payload of the first frame among these bytes.
std::optional<Bytes> first_payload(FrameReader& reader, const Bytes& bytes) {
  for (const std::uint8_t byte : bytes) {
    if (reader.take(byte) == FrameReader::Found::kFrame) {
      return Bytes(reader.payload().begin(), reader.payload().end());
    }
  }
  return std::nullopt;
}

Bytes draw(base::Rng& rng, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(rng.next());
  }
  return bytes;
}

TEST(Frame, has_the_bytes_of_its_format) {
  const Bytes frame = framed({'1', '.', '2'});
  const Bytes front(frame.begin(), frame.begin() + 9);
  EXPECT_EQ(front, (Bytes{'~', 1, 0, 3, 0, '1', '}', '.' ^ 0x20, '2'}));
  EXPECT_EQ(frame.back(), '.');
}

TEST(Frame, what_is_sent_is_found_again) {
  base::Rng rng(1);
  FrameReader reader;
  for (std::size_t size = 0; size <= kPayloadBytesMax; ++size) {
    const Bytes payload = draw(rng, size);
    EXPECT_EQ(first_payload(reader, framed(payload)), payload) << size;
    EXPECT_EQ(reader.kind(), FrameKind::kPacket);
  }
  EXPECT_EQ(first_payload(reader, framed({1}, FrameKind::kPlan)), Bytes{1});
  EXPECT_EQ(reader.kind(), FrameKind::kPlan);
}

/// CRC-16 finds every burst of up to 16 bits; a byte that becomes a mark cuts the frame instead.
TEST(Frame, with_one_wrong_byte_is_never_taken_for_another_and_the_next_is_found) {
  base::Rng rng(2);
  for (int i = 0; i < 2'000; ++i) {
    const Bytes payload = draw(rng, 1 + rng.below(40));
    Bytes bytes = framed(payload);
    const std::size_t place = rng.below(bytes.size());
    bytes[place] = static_cast<std::uint8_t>(bytes[place] ^ (1 + rng.below(255)));
    FrameReader reader;
    const auto found = first_payload(reader, bytes);
    EXPECT_TRUE(!found || *found == payload) << i;
    EXPECT_EQ(first_payload(reader, framed({7, 8})), (Bytes{7, 8})) << i;
  }
}

TEST(Frame, a_hello_is_heard_between_frames_only) {
  FrameReader reader;
  EXPECT_EQ(reader.take(kHelloByte), FrameReader::Found::kHello);
  EXPECT_EQ(reader.take(0x11), FrameReader::Found::kNothing);
  reader.take(kFrameBegin);
  EXPECT_EQ(reader.take(kHelloByte), FrameReader::Found::kNothing);
}

TEST(Frame, that_never_ends_is_given_up) {
  FrameReader reader;
  reader.take(kFrameBegin);
  for (int i = 0; i < 2 * kFrameBytesMax; ++i) {
    EXPECT_NE(reader.take(0x11), FrameReader::Found::kFrame);
  }
  EXPECT_EQ(first_payload(reader, framed({9})), Bytes{9});
}

}  // namespace
}  // namespace holdfast::module
