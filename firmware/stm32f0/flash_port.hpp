// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/module/kept_page.hpp"
#include "holdfast/module/relayed_port.hpp"

namespace holdfast::stm32f0 {

/// Adds to a board what a module that is told its configuration needs: the last two pages of the
/// flash to keep it in.
class FlashPort final : public module::RelayedPort, private module::FlashPlaces {
 public:
  explicit FlashPort(module::Port& port) : RelayedPort(port) {}

  /// Reads the page that was kept or flashed; without one it is left alone.
  void recall(module::Configuration& page);

  /// Takes 40 ms at most, in which the processor stands still and lines go on by DMA.
  void keep(std::span<const std::uint8_t> page) override { module::keep_page(*this, page); }

  module::Health health() override;

 private:
  const std::uint8_t* bytes(int place) override;
  void erase(int place) override;
  void program(int place, std::size_t offset, std::uint16_t value) override;
};

}  // namespace holdfast::stm32f0
