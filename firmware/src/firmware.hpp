// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::firmware {

/// Why a module has stopped; its lamp shows as many red flashes. The last one stands in
/// `holdfast_last_stop` after the next start.
enum class Stop : std::uint32_t {
  kRunning,
  kFault,            ///< Of the processor, or of its crystal.
  kBrokenCheck,      ///< A bug; base::panic().
  kNoConfiguration,  ///< The page in flash is empty or damaged.
};

/// Shows why. Without a configuration for ever; else until the watchdog starts the program again,
/// after some 2 s. The neighbours take the module for dead meanwhile.
[[noreturn]] void stop(Stop reason);

}  // namespace holdfast::firmware
