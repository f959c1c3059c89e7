// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/link_model.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace holdfast::sim {

LinkModel blinky_blocks_v1() {
  LinkModel model;
  model.packet_bytes = 17;
  model.bit_rate = 38'400;
  // A packet of 17 bytes takes about 6.1 ms on the hardware, which is 23.4 bytes of 10 bits: the
  // firmware frames and escapes. 6 bytes of overhead make it 5.99 ms.
  model.overhead_bytes = 6;
  model.retransmit_after = 50'000;
  model.retry_count = 4;
  return model;
}

LinkModel blinky_blocks_v2() {
  LinkModel model;
  model.packet_bytes = 228;
  model.bit_rate = 115'200;
  // '~', a header of 4 bytes, a checksum of 2, '.'. Escapes are not counted.
  model.overhead_bytes = 8;
  model.retransmit_after = 100'000;
  model.retry_count = 3;
  return model;
}

LinkModel catoms() {
  LinkModel model = blinky_blocks_v2();
  model.compute_time = 100;
  return model;
}

LinkModel unit() {
  LinkModel model;
  model.ticks_per_second = 0;
  model.packet_bytes = 228;
  model.packet_time = 1;
  model.is_unlimited = true;
  model.acknowledge_after = 3;
  model.retransmit_after = 16;
  model.ping_after = 4000;
  return model;
}

std::optional<LinkModel> find_link_model(std::string_view name) {
  if (name == "v1") {
    return blinky_blocks_v1();
  }
  if (name == "v2") {
    return blinky_blocks_v2();
  }
  if (name == "catoms") {
    return catoms();
  }
  if (name == "unit") {
    return unit();
  }
  return std::nullopt;
}

std::optional<std::string> find_link_fault(const LinkModel& model) {
  if (model.packet_bytes < agent::wire::kPacketBytesMin ||
      model.packet_bytes > agent::wire::kPacketBytesMax) {
    return fmt::format("packet_bytes is {}, expected {} to {}", model.packet_bytes,
                       agent::wire::kPacketBytesMin, agent::wire::kPacketBytesMax);
  }
  if (model.overhead_bytes < 0 || model.bits_per_byte < 1) {
    return fmt::format("overhead_bytes is {}, bits_per_byte {}; expected 0 and 1 or more",
                       model.overhead_bytes, model.bits_per_byte);
  }
  if (model.packet_time == 0 && (model.bit_rate == 0 || model.ticks_per_second == 0)) {
    return "a packet takes no time: packet_time, or bit_rate and ticks_per_second, must not be 0";
  }

  struct Named {
    const char* name;
    double value;
  };

  for (const Named& chance :
       {Named{"loss", model.loss}, Named{"duplication", model.duplication},
        Named{"reordering", model.reordering}, Named{"corruption", model.corruption}}) {
    if (!(chance.value >= 0 && chance.value <= 1)) {
      return fmt::format("{} is {}, expected 0 to 1", chance.name, chance.value);
    }
  }
  if (model.reordering > 0 && model.reordering_delay == 0) {
    return "reordering_delay is 0, but reordering is not";
  }
  if (!(model.clock_drift >= 0 && model.clock_drift <= 0.1)) {
    return fmt::format("clock_drift is {}, expected 0 to 0.1", model.clock_drift);
  }
  return std::nullopt;
}

Time line_time(const LinkModel& model, int packet_bytes) {
  if (model.bit_rate == 0) {
    return model.packet_time;
  }
  const auto bytes = static_cast<Time>(packet_bytes) + static_cast<Time>(model.overhead_bytes);
  const Time bits = bytes * static_cast<Time>(model.bits_per_byte);
  return model.packet_time + (bits * model.ticks_per_second + model.bit_rate - 1) / model.bit_rate;
}

/// Makes a module wait long enough before it sends a packet again. The longest wait, from the
/// moment a packet is handed to its line, is the packet and its delays; the other side's computing;
/// acknowledge_after; a packet for which the acknowledgement has to wait, the acknowledgement and
/// its delays; computing again. Computing waits for one event of every face and a timer. Clocks may
/// run fast by the drift.
agent::LinkTiming link_timing(const LinkModel& model, int face_count) {
  const Time events_ahead = static_cast<Time>(face_count) + 1;
  const Time line = line_time(model, model.packet_bytes);
  const Time held_back = model.reordering > 0 ? model.reordering_delay : 0;
  const Time way = line + model.latency + model.jitter + held_back;
  const Time computing = (events_ahead + 1) * model.compute_time;
  const Time wait = 2 * (way + computing) + line + model.acknowledge_after;
  const auto drift_ppm = static_cast<Time>(model.clock_drift * 1e6);
  // Both clocks count: one side's timeout, the other's acknowledge_after.
  const Time needed = wait + (wait * 3 * drift_ppm) / 1'000'000 + 1;
  agent::LinkTiming timing;
  timing.packet_bytes = model.packet_bytes;
  timing.acknowledge_after = model.acknowledge_after;
  timing.retransmit_after = std::max(model.retransmit_after, needed);
  timing.retry_count = model.retry_count;
  timing.lost_after_retries = model.lost_after_retries;
  timing.ping_after = std::max(model.ping_after, timing.retransmit_after);
  return timing;
}

std::optional<double> seconds(const LinkModel& model, Time time) {
  if (model.ticks_per_second == 0) {
    return std::nullopt;
  }
  return static_cast<double>(time) / static_cast<double>(model.ticks_per_second);
}

}  // namespace holdfast::sim
