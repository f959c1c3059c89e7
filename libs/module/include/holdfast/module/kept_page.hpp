// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/module/configuration.hpp"

/// A page of configuration in flash that the module itself writes: whenever the power fails, it
/// finds the old page or the new one afterwards, never a mix. It lies in two places, each of which
/// can be erased by itself. A new page goes into the place that does not hold: erased first, the
/// magic number last. Then the old one's magic number is overwritten with zeros. A page that is the
/// same is not written, so a change costs one erasure, of each place in turn.
///
/// Behind a page lies a number that grows with each one, and its complement. A page without, erased
/// there, was written by a programmer, and holds whatever else there is.
namespace holdfast::module {

/// What a board's flash does: bits become ones by erasing a whole place, and zeros by programming
/// half-words, of erased ones or to zero. (RM0091, 3.2.2, of STM32F0; others allow more.)
class FlashPlaces {
 public:
  static constexpr int kCount = 2;
  /// A page, its number and the complement.
  static constexpr std::size_t kBytes = kConfigurationBytes + 4;

  /// What lies there, kBytes, aligned to 8.
  virtual const std::uint8_t* bytes(int place) = 0;
  virtual void erase(int place) = 0;
  virtual void program(int place, std::size_t offset, std::uint16_t value) = 0;

 protected:
  ~FlashPlaces() = default;
};

/// The place whose page holds; -1: there is none.
int find_kept_page(FlashPlaces& flash);

/// Keeps a page, kConfigurationBytes of a configuration that says at least who the module is.
void keep_page(FlashPlaces& flash, std::span<const std::uint8_t> page);

}  // namespace holdfast::module
