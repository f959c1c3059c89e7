// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "methods/front_codec.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/displacements.hpp"

namespace holdfast::agent {
namespace {

/// Bits in the fourth real of a node's message, above faces that are missing.
constexpr unsigned kFixedBit = 1U << 6U;
constexpr unsigned kKeptBit = 1U << 7U;
constexpr unsigned kHeldBit = 1U << 8U;
constexpr unsigned kReleasedBit = 1U << 9U;
/// Faces that cubes do not have, and how many facets have states of their own.
constexpr unsigned kMoreFacesShift = 10U;
constexpr unsigned kFacetCountShift = 16U;
constexpr unsigned kFacesMask = kFixedBit - 1;
constexpr unsigned kFacetCountMask = 15U;

/// The fifth real has two contact states.
constexpr int kCodeBase = mechanics::ContactState::kCodeCount;

/// The states of a facet in use and found, and what else is known of it, in twelve bits.
constexpr unsigned kStateBitCount = 4;
constexpr unsigned kFacetBitCount = 12;

/// Two facets in each real of a message.
constexpr int kFacetsPerMessage = 12;

std::size_t at_facet(int index) { return static_cast<std::size_t>(index); }

}  // namespace

base::Vec6<float> packed(const FrontNode& node) {
  const unsigned faces = node.missing.mask();
  const unsigned code = (faces & kFacesMask) | (node.is_fixed ? kFixedBit : 0U) |
                        (node.is_kept ? kKeptBit : 0U) | (node.is_held ? kHeldBit : 0U) |
                        (node.was_released ? kReleasedBit : 0U) |
                        (faces >> base::kDirectionCount) << kMoreFacesShift |
                        unsigned{node.facet_count} << kFacetCountShift;
  return {static_cast<float>(node.cell.x),
          static_cast<float>(node.cell.y),
          static_cast<float>(node.cell.z),
          static_cast<float>(code),
          static_cast<float>(node.state.code() + kCodeBase * node.found.code()),
          node.is_doubtful ? 1.0F : 0.0F};
}

bool unpack(const base::Vec6<float>& vector, FrontNode& node) {
  constexpr auto kMost = static_cast<float>(base::kCoordinateMax);
  for (std::size_t i = 0; i < 3; ++i) {
    if (!(vector[i] >= -kMost && vector[i] <= kMost)) {
      return false;
    }
  }
  constexpr auto kCodeMost = static_cast<float>(kFacetCountMask << kFacetCountShift);
  if (!(vector[3] >= 0 && vector[3] < kCodeMost)) {
    return false;
  }
  if (!(vector[4] >= 0 && vector[4] < static_cast<float>(kCodeBase * kCodeBase))) {
    return false;
  }
  const auto code = static_cast<unsigned>(vector[3]);
  const unsigned faces = (code & kFacesMask) | (code >> kMoreFacesShift & kFacesMask)
                                                   << base::kDirectionCount;
  const unsigned facet_count = code >> kFacetCountShift;
  if (facet_count > kTouchingFacetsMax) {
    return false;
  }
  const int states = static_cast<int>(vector[4]);
  node = {.cell = {static_cast<std::int32_t>(vector[0]), static_cast<std::int32_t>(vector[1]),
                   static_cast<std::int32_t>(vector[2])},
          .missing = Faces::from_mask(static_cast<FaceMask>(faces)),
          .is_fixed = (code & kFixedBit) != 0,
          .is_kept = (code & kKeptBit) != 0,
          .is_held = (code & kHeldBit) != 0,
          .was_released = (code & kReleasedBit) != 0,
          .is_doubtful = vector[5] > 0,
          .state = mechanics::ContactState::from_code(states % kCodeBase),
          .found = mechanics::ContactState::from_code(states / kCodeBase),
          .facet_count = static_cast<std::uint8_t>(facet_count)};
  return true;
}

std::uint16_t packed_state(const TouchingFacet& facet) {
  const unsigned known = (facet.is_held ? 1U : 0U) | (facet.was_released ? 2U : 0U) |
                         (facet.is_doubtful ? 4U : 0U) | (facet.is_given ? 8U : 0U);
  return static_cast<std::uint16_t>(static_cast<unsigned>(facet.state.code()) |
                                    static_cast<unsigned>(facet.found.code()) << kStateBitCount |
                                    known << 2 * kStateBitCount);
}

void unpack_state(std::uint16_t packed, TouchingFacet& facet) {
  constexpr unsigned kStateMask = (1U << kStateBitCount) - 1;
  const auto state_of = [](unsigned code) {
    return mechanics::ContactState::from_code(static_cast<int>(code) % kCodeBase);
  };
  const unsigned known = packed >> 2 * kStateBitCount;
  facet.state = state_of(packed & kStateMask);
  facet.found = state_of(packed >> kStateBitCount & kStateMask);
  facet.is_held = (known & 1U) != 0;
  facet.was_released = (known & 2U) != 0;
  facet.is_doubtful = (known & 4U) != 0;
  facet.is_given = (known & 8U) != 0;
}

int state_vectors(const FrontNode& node) {
  return node.is_kept ? (node.facet_count + kFacetsPerMessage - 1) / kFacetsPerMessage : 0;
}

base::Vec6<float> states_of(const FrontNode& node, int part) {
  base::Vec6<float> vector{};
  for (int i = 0; i < kFacetsPerMessage; ++i) {
    const std::size_t facet = at_facet(kFacetsPerMessage * part + i);
    const unsigned state = facet < node.facets.size() ? node.facets[facet] : 0U;
    vector[at_facet(i / 2)] += static_cast<float>(state << (i % 2 == 0 ? 0U : kFacetBitCount));
  }
  return vector;
}

void take_states(const base::Vec6<float>& vector, int part, FrontNode& node) {
  constexpr auto kMost = static_cast<float>(1U << 2 * kFacetBitCount);
  for (int i = 0; i < kFacetsPerMessage; ++i) {
    const std::size_t facet = at_facet(kFacetsPerMessage * part + i);
    const float real = vector[at_facet(i / 2)];
    const unsigned two = real >= 0 && real < kMost ? static_cast<unsigned>(real) : 0U;
    if (facet < node.facets.size()) {
      constexpr unsigned kMask = (1U << kFacetBitCount) - 1;
      node.facets[facet] =
          static_cast<std::uint16_t>((two >> (i % 2 == 0 ? 0U : kFacetBitCount)) & kMask);
    }
  }
}

base::Vec6<float> part_of(const base::Vec6<double>& u, bool is_low) {
  base::Vec6<float> part{};
  for (std::size_t i = 0; i < 6; ++i) {
    const double leading = leading_part(u[i]);
    part[i] = static_cast<float>(is_low ? u[i] - leading : leading);
  }
  return part;
}

}  // namespace holdfast::agent
