// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::firmware {

/// Why a module has stopped; a debugger finds it in `holdfast_stop`.
enum class Stop : std::uint32_t {
  kRunning,
  kFault,            ///< Of the processor.
  kBrokenCheck,      ///< A bug; base::panic().
  kNoConfiguration,  ///< The page in flash is empty or damaged.
};

/// Stays here for ever, silent: the neighbours take the module for dead.
[[noreturn]] void stop(Stop reason);

}  // namespace holdfast::firmware
