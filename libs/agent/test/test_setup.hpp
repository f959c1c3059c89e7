// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/agent/setup.hpp"

namespace holdfast::agent::test {

/// Weight of one module, Table I of [Piranda 2021].
inline constexpr double kWeight = 0.06106 * 9.81;

/// Bends more easily about one axis than about the other, so that no axes can be mixed up.
inline mechanics::BeamStiffness<double> lopsided_beam() {
  return mechanics::beam_stiffness<double>({.elastic_modulus = 100,
                                            .length = 40,
                                            .area = 1500,
                                            .moment_x = 200'000,
                                            .moment_y = 310'000,
                                            .torsion = 130'000});
}

/// Blinky Blocks, Table I of [Piranda 2021]; times in ticks of the test network.
inline Setup table_setup() {
  Setup setup;
  setup.section = {.elastic_modulus = 100,
                   .length = 40,
                   .area = 40.0 * 40.0,
                   .moment_x = 40.0 * 40.0 * 40.0 * 40.0 / 12,
                   .moment_y = 40.0 * 40.0 * 40.0 * 40.0 / 12,
                   .torsion = 2.25 * 20.0 * 20.0 * 20.0 * 20.0 / 2.6};
  setup.weight_n = kWeight;
  setup.strength_vertical_n = 11.98;
  setup.strength_lateral_n = 14.97;
  setup.timing = {.acknowledge_after = 2, .retransmit_after = 8, .ping_after = 100};
  prepare(setup);
  return setup;
}

/// "01 2c" -> {0x01, 0x2c}.
inline std::vector<std::uint8_t> from_hex(std::string_view text) {
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 2 <= text.size(); i += 3) {
    bytes.push_back(
        static_cast<std::uint8_t>(std::stoi(std::string(text.substr(i, 2)), nullptr, 16)));
  }
  return bytes;
}

template <class Bytes>
std::string to_hex(const Bytes& bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += text.empty() ? "" : " ";
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

}  // namespace holdfast::agent::test
