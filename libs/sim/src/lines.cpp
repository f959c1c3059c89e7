// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "engine.hpp"
#include "holdfast/base/check.hpp"

/// Carries packets: from the agent that has one to the line, and from the line to the agent at its
/// end.
namespace holdfast::sim {

/// Offers every free line to the agent that wants it.
void Engine::flush(std::int32_t module) {
  const std::uint16_t faces = ports_[at(module)].wanted;
  for (unsigned left = faces; left != 0; left &= left - 1) {
    offer_line(module, std::countr_zero(left));
  }
}

void Engine::offer_line(std::int32_t module, int face) {
  Port& port = ports_[at(module)];
  const auto bit = static_cast<std::uint16_t>(1U << static_cast<unsigned>(face));
  const Time& free_at = lines(module, face).free_at[line_of(face)];
  bool is_sending = true;
  for (int i = 0; is_sending && i < kBurstMax && (port.wanted & bit) != 0; ++i) {
    if (!options_.link.is_unlimited && now_ < free_at) {
      break;
    }
    is_sending = send_one(module, face);
  }
  if (is_sending && (port.wanted & bit) != 0 && (port.line_events & bit) == 0) {
    port.line_events = static_cast<std::uint16_t>(port.line_events | bit);
    push(std::max(free_at, now_ + 1),
         {.kind = Kind::kLine, .face = static_cast<base::Direction>(face), .module = module});
  }
}

/// Sends a packet; returns false if there was nothing to send after all.
bool Engine::send_one(std::int32_t module, int face) {
  step_event_ = event_of(agent::EventKind::kLineFree, static_cast<base::Direction>(face));
  step(module);
  int size = actions_.packet_bytes;
  if (size > 0 && options_.tamper) {
    const auto room = static_cast<std::size_t>(options_.link.packet_bytes);
    size = options_.tamper(now_, module, static_cast<base::Direction>(face),
                           std::span(actions_.packet).first(room), size);
  }
  HOLDFAST_CHECK(size >= 0 && size <= options_.link.packet_bytes);
  if (size == 0) {
    return false;
  }
  transmit(module, face, {actions_.packet.data(), static_cast<std::size_t>(size)});
  return true;
}

void Engine::transmit(std::int32_t module, int face, std::span<const std::uint8_t> packet) {
  Port& port = ports_[at(module)];
  const auto direction = static_cast<base::Direction>(face);
  const Time duration = line_times_[packet.size()];
  lines(module, face).free_at[line_of(face)] = now_ + duration;
  port.bytes_sent += packet.size();
  ++port.packets_sent;
  const PacketTag tag{.number = packet_count_++,
                      .rounds = port.rounds + (is_data(packet) ? 1 : 0),
                      .size = static_cast<std::uint16_t>(packet.size())};
  const PacketTrace trace{.time = now_,
                          .number = tag.number,
                          .from = module,
                          .to = neighbour(module, direction),
                          .face = direction,
                          .bytes = packet};
  recorder_.sent(trace, port.seen.phase, duration);
  HOLDFAST_CHECK(trace.to >= 0);
  if (is_noisy_ && noise_.is_lost(port.rng)) {
    recorder_.lost(trace);
    return;
  }
  const Time earliest = now_ + duration + options_.link.latency;
  launch(module, face, tag, packet, earliest);
  if (is_noisy_ && noise_.is_doubled(port.rng)) {
    launch(module, face, tag, packet, earliest);
  }
}

/// Puts a packet on its way. Those that are not held back arrive in the order they left.
void Engine::launch(std::int32_t module, int face, const PacketTag& tag,
                    std::span<const std::uint8_t> packet, Time earliest) {
  Port& port = ports_[at(module)];
  const auto direction = static_cast<base::Direction>(face);
  const std::uint32_t slot = pool_.put(tag, packet);
  Time arrival = earliest;
  if (is_noisy_) {
    if (noise_.is_corrupted(port.rng)) {
      flip_bits(pool_.bytes(slot), port.rng);
    }
    arrival += noise_.jitter(port.rng);
    Time& last = lines(module, face).arrival_last[line_of(face)];
    if (noise_.is_held_back(port.rng)) {
      arrival += noise_.delay(port.rng);
    } else {
      last = std::max(last, arrival);
      arrival = last;
    }
  }
  push(arrival, {.kind = Kind::kDeliver,
                 .face = base::opposite(direction),
                 .module = neighbour(module, direction),
                 .item = slot});
}

void Engine::arrive(const Happening& what) {
  const Port& port = ports_[at(what.module)];
  const bool is_cut = (port.cut_faces | port.open_faces).has(what.face);
  if (is_cut || !port.takes_part()) {
    drop(what);
  } else {
    attend(what);
  }
}

/// A packet that reaches nobody.
void Engine::drop(const Happening& what) {
  recorder_.lost(trace_of(what));
  pool_.release(what.item);
}

PacketTrace Engine::trace_of(const Happening& what) const {
  return {.time = now_,
          .number = pool_.tag(what.item).number,
          .from = neighbour(what.module, what.face),
          .to = what.module,
          .face = base::opposite(what.face),
          .bytes = pool_.bytes(what.item)};
}

}  // namespace holdfast::sim
