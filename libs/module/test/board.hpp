// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <deque>
#include <vector>

#include "holdfast.h"
#include "holdfast/module/configuration.hpp"

/// A module as somebody's firmware sees it, for tests.
namespace holdfast::module {

using Bytes = std::vector<std::uint8_t>;

/// One cube of 0.6 N on another one that is held, by a connector of 10 N: it is compressed, not
/// pulled, so the robot holds.
inline Bytes page_of(std::uint32_t id, bool is_held) {
  Configuration configuration;
  configuration.identity = {.id = id, .is_fixed = is_held, .is_anchor = is_held, .cell = {0, 0, 0}};
  configuration.setup.section = {.elastic_modulus = 100,
                                 .length = 40,
                                 .area = 1600,
                                 .moment_x = 2e5,
                                 .moment_y = 2e5,
                                 .torsion = 2e5};
  configuration.setup.weight_n = 0.6;
  configuration.setup.strength_vertical_n = 10;
  configuration.setup.strength_lateral_n = 10;
  configuration.setup.timing.packet_bytes = agent::wire::kPacketBytesMax;
  configuration.setup.only_one_sweep = true;
  agent::prepare(configuration.setup);
  configuration.checksum = checksum_of(configuration);
  Bytes page(kConfigurationBytes);
  std::memcpy(page.data(), &configuration, page.size());
  return page;
}

/// A module of which nothing but holdfast.h is known.
struct Board {
  explicit Board(bool has_packets) {
    config.port = {.context = this,
                   .now = [](void* self) { return board(self).now_us; },
                   .random = [](void* self) { return ++board(self).draws; },
                   .is_line_free = [](void*, int) { return true; },
                   .send =
                       [](void* self, int face, const std::uint8_t* bytes, std::size_t size) {
                         board(self).sent.push_back({face, Bytes(bytes, bytes + size)});
                       },
                   .show = [](void* self, hf_colour colour) { board(self).lamp = colour; },
                   .is_connected = nullptr,
                   .keep_page =
                       [](void* self, const void* page) {
                         const auto* const bytes = static_cast<const std::uint8_t*>(page);
                         board(self).kept = Bytes(bytes, bytes + HF_PAGE_BYTES);
                       },
                   .stack_bytes = [](void*) { return std::size_t{1'234}; },
                   .reset_reason = 0x20};
    if (has_packets) {
      config.port.is_connected = [](void* self, int face) {
        return (board(self).neighbours >> face & 1) != 0;
      };
    }
  }

  static Board& board(void* self) { return *static_cast<Board*>(self); }

  void start(const Bytes& page) {
    config.page = page.data();
    module = hf_init(memory.data(), sizeof(memory), &config);
    ASSERT_NE(module, nullptr);
  }

  std::uint8_t verdict() const { return hf_get_status(module)->verdict; }

  struct Message {
    int face;
    Bytes bytes;
  };

  hf_config config{};
  hf_module* module = nullptr;
  std::uint32_t now_us = 0;
  std::uint16_t draws = 0;
  int neighbours = 0;
  hf_colour lamp{};
  std::deque<Message> sent;
  Bytes kept;  ///< The page that was kept last.
  std::array<std::uint64_t, HF_BYTES / 8> memory{};
};

/// Lets time pass as hf_poll() asks for.
inline void run(Board& board, std::uint32_t duration_us) {
  const std::uint32_t end = board.now_us + duration_us;
  while (end - board.now_us < 0x80000000U && board.now_us != end) {
    const std::uint32_t pause = hf_poll(board.module);
    board.now_us += std::min({pause > 0 ? pause : 1'000U, end - board.now_us});
  }
}

}  // namespace holdfast::module
