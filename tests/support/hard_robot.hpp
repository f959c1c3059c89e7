// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "general_robot.hpp"

/// General robots made hard to answer.
namespace holdfast::test {

/// The kinds of robots that are hard to answer.
enum class Hardness : std::uint8_t {
  kPoints,      ///< Feet are points.
  kOneContact,  ///< One facet alone touches something.
  kSlots,       ///< Obstacles on two opposite sides of one to three modules.
  kCeiling,     ///< Loads turned round: what it stood on is above it.
  kNoFriction,  ///< All that it touches is perfectly smooth.
  kFriction,    ///< Coefficients from 0.05 to 1.
  kMassRatio,   ///< Masses from 1e-4 to 1e4 kg.
  kTie,         ///< One facet, pressed at or within 1e-12 to 1e-6 of its edge.
  kFloor,       ///< On a floor, wherever down is in the lattice.
};

inline constexpr std::uint64_t kHardnessCount = 9;

/// Returns "points", "one contact", "slots" and so on.
const char* name(Hardness hardness);

/// The seeds take turns.
inline Hardness hardness_of(std::uint64_t seed) {
  return static_cast<Hardness>(seed % kHardnessCount);
}

/// general_robot(), made hard in the way hardness_of(seed). Only those on a floor have one.
model::RobotSpec hard_robot(const base::Lattice& lattice, std::uint64_t seed);

}  // namespace holdfast::test
