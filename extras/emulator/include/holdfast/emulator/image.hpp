// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "holdfast/base/result.hpp"

namespace holdfast::emulator {

/// A program for a 32-bit Arm, as the linker left it: the parts of an ELF file that matter.
struct Image {
  struct Segment {
    std::uint32_t address = 0;  ///< Where it is stored.
    std::vector<std::uint8_t> bytes;
  };

  std::vector<Segment> segments;
  std::map<std::string, std::uint32_t> symbols;
  std::uint32_t flash_bytes = 0;  ///< Of all segments.
  std::uint32_t ram_bytes = 0;    ///< Data and zeros, without the stack.

  /// A symbol's value; it must be there.
  std::uint32_t at(const std::string& symbol) const;

  /// Takes the program its configuration by message, and keep it in the last 4 KB of its flash?
  bool writes_flash() const { return symbols.contains("holdfast_configuration_in_use"); }

  /// The first address behind the flash of the part that it is for.
  std::uint32_t flash_end() const;

  /// The number that is stored at a symbol in flash.
  std::uint32_t word(const std::string& symbol) const;
};

/// Errors: the file cannot be read, or is no image of this firmware.
base::Result<Image> load_image(const std::string& path);

}  // namespace holdfast::emulator
