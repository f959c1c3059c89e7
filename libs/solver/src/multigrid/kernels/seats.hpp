// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "multigrid/kernels/vectors.hpp"

/// Where the nodes of a level sit in their clusters. In a solid there are a few dozen places, which
/// are stored once.
namespace holdfast::solver {

/// A node's cluster, and the number of its offset.
struct SeatCode {
  std::int32_t cluster = 0;
  std::uint32_t place = 0;
};

/// The vector from a cluster's centre to a node, mm.
template <class Real>
using Offset = std::array<Real, 3>;

template <class Real>
class Seats {
 public:
  void reserve(std::size_t count) { codes_.reserve(count); }

  void push_back(const Seat<Real>& seat) {
    const Offset<Real> offset = {seat.offset[0], seat.offset[1], seat.offset[2]};
    std::uint32_t& known = last_[hash(offset)];
    // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): equal bits are meant.
    if (known >= offsets_.size() || std::memcmp(&offsets_[known], &offset, sizeof offset) != 0) {
      known = static_cast<std::uint32_t>(offsets_.size());
      offsets_.push_back(offset);
    }
    codes_.push_back({.cluster = seat.cluster, .place = known});
  }

  /// Gives back memory after the last one.
  void finish() {
    last_ = std::vector<std::uint32_t>();
    offsets_.shrink_to_fit();
  }

  Seat<Real> operator[](std::size_t node) const {
    const Offset<Real>& offset = offsets_[codes_[node].place];
    return {.offset = {offset[0], offset[1], offset[2]}, .cluster = codes_[node].cluster};
  }

  const SeatCode* codes() const { return codes_.data(); }

  const Offset<Real>* offsets() const { return offsets_.data(); }

 private:
  /// The number of offsets that are remembered, each until another one takes its place: then it is
  /// stored twice.
  static constexpr std::size_t kKnownCount = 4096;

  static std::size_t hash(const Offset<Real>& offset) {
    std::uint64_t all = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &offset[k], sizeof(Real));
      all = (all ^ bits) * 0x9e3779b97f4a7c15U;
      all ^= all >> 29U;
    }
    return all % kKnownCount;
  }

  std::vector<SeatCode> codes_;
  std::vector<Offset<Real>> offsets_;
  std::vector<std::uint32_t> last_ = std::vector<std::uint32_t>(kKnownCount, 0xffffffffU);
};

}  // namespace holdfast::solver
