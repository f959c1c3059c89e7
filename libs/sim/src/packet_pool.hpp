// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

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

  /// A slot that holds a copy of `bytes`. Views of other slots become invalid.
  std::uint32_t put(const PacketTag& tag, std::span<const std::uint8_t> bytes) {
    std::uint32_t slot = slot_count_;
    if (spare_.empty()) {
      ++slot_count_;
      storage_.resize(slot_count_ * slot_bytes_);
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
    std::memcpy(&tag, storage_.data() + slot * slot_bytes_, sizeof(tag));
    return tag;
  }

  std::span<const std::uint8_t> bytes(std::uint32_t slot) const {
    return {storage_.data() + slot * slot_bytes_ + sizeof(PacketTag), tag(slot).size};
  }

  std::span<std::uint8_t> bytes(std::uint32_t slot) {
    return {at(slot) + sizeof(PacketTag), tag(slot).size};
  }

  void release(std::uint32_t slot) { spare_.push_back(slot); }

  void prefetch(std::uint32_t slot) const {
    __builtin_prefetch(storage_.data() + slot * slot_bytes_);
  }

 private:
  std::uint8_t* at(std::uint32_t slot) { return storage_.data() + slot * slot_bytes_; }

  std::size_t slot_bytes_;
  std::uint32_t slot_count_ = 0;
  std::vector<std::uint8_t> storage_;
  std::vector<std::uint32_t> spare_;
};

}  // namespace holdfast::sim
