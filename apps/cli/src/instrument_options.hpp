// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.hpp"
#include "holdfast/instrument.hpp"

namespace holdfast::cli {

/// The option --baud.
inline void add_baud(CLI::App& command, InstrumentOptions& options) {
  command.add_option("--baud", options.baud, "Bits in a second on the line")
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace holdfast::cli
