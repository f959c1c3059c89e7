// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/distributed.hpp"

/// The options that the block code adds to VisibleSim's own, one letter and one value each.
namespace holdfast::visiblesim {

/// Something done to the robot while it runs.
struct Change {
  enum class Kind : std::uint8_t {
    kKill,    ///< The module falls silent for ever.
    kDetach,  ///< The module is taken off.
    kAttach,  ///< A module comes to the cell.
    kPlan,    ///< The robot's first module is told of a module planned in the cell.
    kTap,     ///< The module is tapped.
  };

  Kind kind = Kind::kKill;
  agent::Time at = 0;    ///< Microseconds.
  std::uint32_t id = 0;  ///< VisibleSim's number of the module.
  base::Cell cell = {};  ///< As VisibleSim counts.
};

struct Settings {
  sim::SimulationOptions simulation = {.link = sim::blinky_blocks_v1()};
  std::vector<Change> changes = {};
  std::string json = {};  ///< File for the report; empty: none.

  /// Takes an option. Error: there is no such letter, or the value is none for it.
  std::optional<std::string> take(char letter, std::string_view value);
};

/// The letters of the options.
inline constexpr std::string_view kOptionLetters = "KDAPTCMJ";

/// A line for each option.
std::string_view option_help();

}  // namespace holdfast::visiblesim
