// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/agent.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::sim {

/// An item of the queue, packed into 64 bits: item, module, face, kind.
struct Happening {
  enum class Kind : std::uint8_t {
    kDeliver,   ///< A packet arrives; item: its slot.
    kLine,      ///< A line is free again.
    kTimer,     ///< An agent may want to wake.
    kReady,     ///< A module has finished computing.
    kFault,     ///< item: index in the options.
    kAnnounce,  ///< item: index in the options.
  };

  Kind kind{};
  base::Direction face{};
  std::int32_t module = 0;
  std::uint32_t item = 0;

  std::uint64_t packed() const {
    return static_cast<std::uint64_t>(item) << 32U | static_cast<std::uint64_t>(module) << 7U |
           static_cast<std::uint64_t>(face) << 3U | static_cast<std::uint64_t>(kind);
  }

  static Happening of(std::uint64_t content) {
    return {.kind = kind_of(content),
            .face = static_cast<base::Direction>((content >> 3U) & 15U),
            .module = module_of(content),
            .item = static_cast<std::uint32_t>(content >> 32U)};
  }

  static Kind kind_of(std::uint64_t content) { return static_cast<Kind>(content & 7U); }

  static std::int32_t module_of(std::uint64_t content) {
    return static_cast<std::int32_t>((content >> 7U) & ((1U << kModuleBits) - 1));
  }

 private:
  static constexpr int kModuleBits = 25;
  static_assert(model::kModuleCountMax < (std::size_t{1} << kModuleBits));
};

}  // namespace holdfast::sim
