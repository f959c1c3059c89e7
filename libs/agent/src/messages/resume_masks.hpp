// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "holdfast/agent/cells/planned_set.hpp"

/// The masks of planned modules in kResume, which has a byte for each of kPlannedMax. Those of
/// modules with up to 8 faces stand there as they are; of modules with more faces there is room for
/// fewer, 12 bits each.
namespace holdfast::agent {

inline constexpr int kByteFaceCount = 8;
inline constexpr unsigned kWideMaskBits = 12;

/// How many planned modules have room.
constexpr int resumed_planned_max(int face_count) {
  return face_count <= kByteFaceCount ? kPlannedMax
                                      : static_cast<int>(8U * kPlannedMax / kWideMaskBits);
}

/// `to` bits for each mask in place of `from`.
constexpr PlannedMasks repacked(const PlannedMasks& masks, unsigned from, unsigned to) {
  std::uint64_t bits = 0;
  PlannedMasks packed{};
  for (std::size_t k = 0; k < masks.size() && (k + 1) * from <= 64; ++k) {
    bits |= std::uint64_t{masks[k]} << (k * from);
  }
  for (std::size_t k = 0; k < masks.size() && (k + 1) * to <= 64; ++k) {
    packed[k] = static_cast<FaceMask>((bits >> (k * to)) & ((1U << to) - 1));
  }
  return packed;
}

/// The masks as they go over the wire, and back.
constexpr PlannedMasks resume_masks(const PlannedMasks& masks, int face_count) {
  return face_count <= kByteFaceCount ? masks : repacked(masks, kWideMaskBits, 8);
}

constexpr PlannedMasks masks_of_resume(const PlannedMasks& masks, int face_count) {
  return face_count <= kByteFaceCount ? masks : repacked(masks, 8, kWideMaskBits);
}

}  // namespace holdfast::agent
