// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "holdfast/agent/agent.hpp"

/// What a module knows before it starts, as it lies in its flash: the robot's common setup, already
/// prepared, and who the module is. docs/firmware.md lists the bytes. A whole page of flash is kept
/// for it, so that it can be written without touching the program; the program uses the setup
/// where it lies. Little-endian, IEEE 754, natural alignment: the same on the module and on hosts.
namespace holdfast::module {

inline constexpr std::uint32_t kConfigurationMagic = 0x46434648;  ///< "HFCF"
/// "HFID": the module was told who it is, and not yet the robot's numbers.
inline constexpr std::uint32_t kIdentityMagic = 0x44494648;
inline constexpr std::uint16_t kConfigurationVersion = 1;

struct Configuration {
  std::uint32_t magic = kConfigurationMagic;
  std::uint16_t version = kConfigurationVersion;
  /// 0: the page was flashed. Else the module was told of it, and a later one holds.
  std::uint16_t revision = 0;
  agent::Identity identity;
  std::uint32_t checksum = 0;  ///< checksum_of()
  agent::Setup setup;
};

/// The part of the setup that is there: real modules know cubes alone.
inline constexpr std::size_t kSetupBytes = sizeof(agent::CubeSetup);
inline constexpr std::size_t kConfigurationBytes =
    sizeof(Configuration) - sizeof(agent::Setup) + kSetupBytes;

// An AVR aligns nothing and has no binary64: its pages are its own.
#ifndef __AVR__
static_assert(sizeof(agent::Identity) == 20 && offsetof(agent::Identity, is_anchor) == 5 &&
              offsetof(agent::Identity, cell) == 8);
static_assert(offsetof(agent::CubeSetup, facet_mm) == 48 &&
              offsetof(agent::CubeSetup, facet_numerator) == 88 &&
              offsetof(agent::CubeSetup, method) == 100 &&
              offsetof(agent::CubeSetup, iteration_count_max) == 104 &&
              offsetof(agent::CubeSetup, timing) == 112 &&
              offsetof(agent::CubeSetup, beam) == 152 &&
              offsetof(agent::CubeSetup, beam_float) == 216 && kSetupBytes == 248);
static_assert(kConfigurationBytes == 280);
#endif

/// The bytes of the setup as they lie in a page.
std::span<const std::uint8_t> setup_bytes(const Configuration& configuration);

/// A sum of the setup's fields alone: the same for all modules of a robot, whoever they are, and
/// for all copies of the setup, whatever lies between its fields.
std::uint16_t sum_of_setup(std::span<const std::uint8_t> setup_bytes);

inline std::uint16_t setup_sum(const Configuration& configuration) {
  return sum_of_setup(setup_bytes(configuration));
}

/// The checksum of everything but the magic number, the version and the sum itself.
std::uint32_t checksum_of(const Configuration& configuration);

/// Is this a configuration that the program can use?
bool is_valid(const Configuration& configuration);

/// Does it say at least who the module is?
bool has_identity(const Configuration& configuration);

}  // namespace holdfast::module
