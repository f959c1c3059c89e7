// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "holdfast/base/check.hpp"

/// Packets under way, in slots of one size that are used again and again.
namespace holdfast::sim {

struct PacketTag {
  std::uint64_t number = 0;  ///< Counts the packets sent; copies share it.
  std::uint64_t rounds = 0;  ///< Length of the longest chain of packets that ends with this one.
  std::uint16_t size = 0;
};

class PacketPool {
 public:
  /// The packets have at most `packet_bytes` bytes.
  explicit PacketPool(int packet_bytes)
      : slot_bytes_((sizeof(PacketTag) + static_cast<std::size_t>(packet_bytes) + 15) / 16 * 16) {}

  /// The most slots of a pool.
  static constexpr std::uint32_t kSlotCountMax = 1U << 26U;

  /// A slot that holds a copy of `bytes`. Other slots stay where they are, so that one thread may
  /// put packets into a pool while others read those that are there.
  std::uint32_t put(const PacketTag& tag, std::span<const std::uint8_t> bytes) {
    std::uint32_t slot = slot_count_;
    if (spare_.empty()) {
      grow();
    } else {
      slot = spare_.back();
      spare_.pop_back();
    }
    std::memcpy(at(slot), &tag, sizeof(tag));
    std::memcpy(at(slot) + sizeof(tag), bytes.data(), bytes.size());
    return slot;
  }

  PacketTag tag(std::uint32_t slot) const {
    PacketTag tag;
    std::memcpy(&tag, at(slot), sizeof(tag));
    return tag;
  }

  std::span<const std::uint8_t> bytes(std::uint32_t slot) const {
    return {at(slot) + sizeof(PacketTag), tag(slot).size};
  }

  std::span<std::uint8_t> bytes(std::uint32_t slot) {
    return {at(slot) + sizeof(PacketTag), tag(slot).size};
  }

  void release(std::uint32_t slot) { spare_.push_back(slot); }

  void prefetch(std::uint32_t slot) const { __builtin_prefetch(at(slot)); }

 private:
  static constexpr int kFirstBits = 6;  ///< Chunk i has 2^(kFirstBits + i) slots.
  static constexpr int kChunkCount = 21;

  static int chunk_of(std::uint32_t slot) {
    return static_cast<int>(std::bit_width(slot + (1U << kFirstBits))) - kFirstBits - 1;
  }

  std::uint8_t* at(std::uint32_t slot) const {
    const int chunk = chunk_of(slot);
    const std::size_t first = (std::size_t{1} << (kFirstBits + chunk)) - (1U << kFirstBits);
    return chunks_[static_cast<std::size_t>(chunk)].get() + (slot - first) * slot_bytes_;
  }

  void grow() {
    HOLDFAST_CHECK(slot_count_ < kSlotCountMax);
    const int number = chunk_of(slot_count_++);
    auto& chunk = chunks_[static_cast<std::size_t>(number)];
    if (chunk == nullptr) {
      const std::size_t bytes = slot_bytes_ << (kFirstBits + number);
      chunk = std::unique_ptr<std::uint8_t[]>(new std::uint8_t[bytes]);  // Without writing to it.
    }
  }

  std::size_t slot_bytes_;
  std::uint32_t slot_count_ = 0;
  std::array<std::unique_ptr<std::uint8_t[]>, kChunkCount> chunks_;
  std::vector<std::uint32_t> spare_;
};

}  // namespace holdfast::sim
