// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "pages.hpp"

#include "holdfast/emulator/emulation.hpp"
#include "holdfast/module/configuration.hpp"

namespace holdfast::instrument {

base::Result<std::vector<std::uint8_t>> setup_of(const Structure& structure) {
  const emulator::EmulationOptions options;
  if (const auto fault = emulator::find_options_fault(structure.robot, options)) {
    return base::bad_input(*fault);
  }
  const std::vector<std::uint8_t> page =
      emulator::configuration_pages(structure.robot, options).front();
  return std::vector<std::uint8_t>(page.end() - static_cast<std::ptrdiff_t>(module::kSetupBytes),
                                   page.end());
}

}  // namespace holdfast::instrument
