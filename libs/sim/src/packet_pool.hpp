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

/// Packets under way, side by side in blocks that are used again when all their packets are gone.
namespace holdfast::sim {

struct PacketTag {
  std::uint64_t number = 0;  ///< Counts the packets sent; copies share it.
  std::uint64_t rounds = 0;  ///< Length of the longest chain of packets that ends with this one.
  std::uint16_t size = 0;
};

class PacketPool {
 public:
  /// Places are below this.
  static constexpr std::uint32_t kPlaceMax = 1U << 26U;

  /// The place of a copy of `bytes`. Other packets stay where they are, so that one thread may put
  /// packets into a pool while others read those that are there.
  std::uint32_t put(const PacketTag& tag, std::span<const std::uint8_t> bytes) {
    const std::size_t units = (sizeof(tag) + bytes.size() + kUnitBytes - 1) / kUnitBytes;
    if (used_ + units > kBlockUnits) {
      take_block();
    }
    const auto place = static_cast<std::uint32_t>(block_ * kBlockUnits + used_);
    used_ += units;
    ++live_[block_];
    std::memcpy(at(place), &tag, sizeof(tag));
    std::memcpy(at(place) + sizeof(tag), bytes.data(), bytes.size());
    return place;
  }

  PacketTag tag(std::uint32_t place) const {
    PacketTag tag;
    std::memcpy(&tag, at(place), sizeof(tag));
    return tag;
  }

  std::span<const std::uint8_t> bytes(std::uint32_t place) const {
    return {at(place) + sizeof(PacketTag), tag(place).size};
  }

  std::span<std::uint8_t> bytes(std::uint32_t place) {
    return {at(place) + sizeof(PacketTag), tag(place).size};
  }

  void release(std::uint32_t place) {
    const std::size_t block = place / kBlockUnits;
    if (--live_[block] == 0 && block != block_) {
      spare_.push_back(static_cast<std::uint32_t>(block));
    }
  }

  void prefetch(std::uint32_t place) const { __builtin_prefetch(at(place)); }

 private:
  static constexpr std::size_t kUnitBytes = 16;
  static constexpr std::size_t kBlockUnits = 256;
  static constexpr std::size_t kBlockBytes = kUnitBytes * kBlockUnits;
  static constexpr int kChunkCount = 18;  ///< Chunk i has 2^i blocks.

  static int chunk_of(std::size_t block) { return static_cast<int>(std::bit_width(block + 1)) - 1; }

  std::uint8_t* at(std::uint32_t place) const {
    const std::size_t block = place / kBlockUnits;
    const int chunk = chunk_of(block);
    const std::size_t first = (std::size_t{1} << chunk) - 1;
    return chunks_[static_cast<std::size_t>(chunk)].get() +
           (place - first * kBlockUnits) * kUnitBytes;
  }

  void take_block() {
    if (!live_.empty() && live_[block_] == 0) {
      used_ = 0;  // All that was in it is gone.
      return;
    }
    if (spare_.empty()) {
      block_ = live_.size();
      HOLDFAST_CHECK((block_ + 1) * kBlockUnits < kPlaceMax);
      live_.push_back(0);
      const int number = chunk_of(block_);
      auto& chunk = chunks_[static_cast<std::size_t>(number)];
      if (chunk == nullptr) {
        const std::size_t bytes = kBlockBytes << number;
        chunk = std::unique_ptr<std::uint8_t[]>(new std::uint8_t[bytes]);  // Without writing to it.
      }
    } else {
      block_ = spare_.back();
      spare_.pop_back();
    }
    used_ = 0;
  }

  std::size_t block_ = 0;            ///< That is being filled, ...
  std::size_t used_ = kBlockUnits;   ///< ... up to here.
  std::vector<std::uint32_t> live_;  ///< Packets in each block.
  std::array<std::unique_ptr<std::uint8_t[]>, kChunkCount> chunks_;
  std::vector<std::uint32_t> spare_;  ///< Blocks.
};

}  // namespace holdfast::sim
