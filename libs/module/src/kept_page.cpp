// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/kept_page.hpp"

namespace holdfast::module {
namespace {

constexpr std::uint16_t kErased = 0xffff;

std::uint16_t half_word(const std::uint8_t* bytes, std::size_t offset) {
  return static_cast<std::uint16_t>(bytes[offset] | bytes[offset + 1] << 8);
}

std::uint16_t number_in(FlashPlaces& flash, int place) {
  return half_word(flash.bytes(place), kConfigurationBytes);
}

/// Is a whole page there, with a whole number or none?
bool holds_page(FlashPlaces& flash, int place) {
  const std::uint16_t number = number_in(flash, place);
  const std::uint16_t complement = half_word(flash.bytes(place), kConfigurationBytes + 2);
  const bool is_number_whole = (number ^ complement) == kErased || (number & complement) == kErased;
  return is_number_whole &&
         has_identity(*reinterpret_cast<const Configuration*>(flash.bytes(place)));
}

/// Makes a page invalid. Half of it suffices.
void overwrite_magic(FlashPlaces& flash, int place) {
  flash.program(place, 0, 0);
  flash.program(place, 2, 0);
}

}  // namespace

int find_kept_page(FlashPlaces& flash) {
  const bool is_first = holds_page(flash, 0);
  if (!holds_page(flash, 1)) {
    return is_first ? 0 : -1;
  }
  const std::uint16_t first = number_in(flash, 0);
  const std::uint16_t second = number_in(flash, 1);
  // A programmer's; else the later one, as numbers count over.
  const bool is_first_later =
      first == kErased || (second != kErased && static_cast<std::int16_t>(first - second) > 0);
  return is_first && is_first_later ? 0 : 1;
}

void keep_page(FlashPlaces& flash, std::span<const std::uint8_t> page) {
  const int before = find_kept_page(flash);
  const std::uint8_t* const old = before < 0 ? nullptr : flash.bytes(before);
  bool is_same = before >= 0;
  for (std::size_t i = 0; is_same && i < kConfigurationBytes; ++i) {
    is_same = old[i] == page[i];
  }
  if (is_same) {
    return;
  }
  const int place = before == 0 ? 1 : 0;
  auto number = static_cast<std::uint16_t>(before < 0 ? 0 : number_in(flash, before) + 1);
  number = number == kErased ? std::uint16_t{0} : number;
  // An erasure that is broken off may leave anything, but for this.
  overwrite_magic(flash, place);
  flash.erase(place);
  flash.program(place, kConfigurationBytes, number);
  flash.program(place, kConfigurationBytes + 2, static_cast<std::uint16_t>(~number));
  for (std::size_t offset = kConfigurationBytes; offset > 0; offset -= 2) {
    flash.program(place, offset - 2, half_word(page.data(), offset - 2));
  }
  if (before >= 0) {
    overwrite_magic(flash, before);
  }
}

}  // namespace holdfast::module
