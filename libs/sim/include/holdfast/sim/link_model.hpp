// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/agent/wire/link.hpp"

/// Describes what the lines between modules do to packets, and how modules wait for them.
///
/// A link is two lines, one for each direction. A packet of B bytes occupies its line for
///   packet_time + ceil((B + overhead_bytes) bits_per_byte ticks_per_second / bit_rate)
/// and arrives `latency` after that, plus what jitter and reordering add. Times are in ticks:
/// microseconds for real hardware, rounds for the model `unit`.
namespace holdfast::sim {

using agent::Time;

struct LinkModel {
  Time ticks_per_second = 1'000'000;  ///< 0: ticks have no length in seconds.

  int packet_bytes = agent::wire::kPacketBytesMin;  ///< The largest packet.
  Time packet_time = 0;                             ///< Of every packet, whatever its size.
  std::uint64_t bit_rate = 0;                       ///< Bits per second; 0: bytes take no time.
  int overhead_bytes = 0;                           ///< Framing around each packet.
  int bits_per_byte = 10;                           ///< 8N1: a start bit, 8 bits, a stop bit.
  bool is_unlimited = false;                        ///< A line takes any number of packets at once.
  Time latency = 0;

  // Noise. Probabilities are per packet, in [0, 1].
  Time jitter = 0;  ///< Adds 0 to `jitter` to each delivery; packets of a line stay in order.
  double loss = 0;
  double duplication = 0;
  double reordering = 0;      ///< A packet is held back by up to `reordering_delay`; others pass.
  Time reordering_delay = 0;  ///< Not 0 if `reordering` is not.
  double corruption = 0;      ///< 1 to 3 bits of the packet flip.

  // Modules.
  Time compute_time = 0;   ///< A module is busy for so long with each event; what it sends waits.
  double clock_drift = 0;  ///< Clocks run fast or slow by a random factor, at most this; <= 0.1.

  // The agents' waiting times; see agent::LinkTiming. link_timing() stretches them where needed.
  Time acknowledge_after = 8'000;
  Time retransmit_after = 50'000;
  int retry_count = 4;
  int lost_after_retries = 20;
  Time ping_after = 2'000'000;
};

/// Blinky Blocks, first version, the robot of [Piranda 2021]: 38,400 baud, packets of 17 bytes that
/// take about 6.1 ms each, 4 retries after 50 ms.
LinkModel blinky_blocks_v1();

/// Blinky Blocks, second version: 115,200 baud, payloads of 228 bytes, 3 retries after 100 ms.
LinkModel blinky_blocks_v2();

/// ASSUMED: nobody has published what a link of 3D catoms, or of any modules with more than six
/// faces, carries. Each face has lines as those of Blinky Blocks 2, all of them at once, and a
/// module takes 0.1 ms for each event. It says how times compare, not how long catoms will take.
LinkModel catoms();

/// Every packet takes one tick and lines are unlimited, so that the simulated time is the number
/// of rounds of a synchronous network. Packets of 228 bytes, version 2's, hold any message.
LinkModel unit();

/// The model that is called "v1", "v2", "catoms" or "unit".
std::optional<LinkModel> find_link_model(std::string_view name);

/// Says why a model cannot be simulated (name, value found, values allowed), if it cannot.
std::optional<std::string> find_link_fault(const LinkModel& model);

/// The time for which a packet occupies its line.
Time line_time(const LinkModel& model, int packet_bytes);

/// The waiting times of the agents: as the model says, but long enough for an acknowledgement to
/// come back with all delays that the model can add, on the slowest and fastest clock.
agent::LinkTiming link_timing(const LinkModel& model, int face_count = base::kDirectionCount);

/// A time in seconds; none if ticks have no length.
std::optional<double> seconds(const LinkModel& model, Time time);

}  // namespace holdfast::sim
