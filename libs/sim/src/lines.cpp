// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>

#include "holdfast/base/check.hpp"
#include "region.hpp"

/// Carries packets: from the agent that has one to the line, and from the line to the agent at its
/// end.
namespace holdfast::sim {

/// Offers every free line to the agent that wants it.
void Region::flush(std::int32_t module) {
  const std::uint16_t faces = port(module).wanted;
  for (unsigned left = faces; left != 0; left &= left - 1) {
    offer_line(module, std::countr_zero(left));
  }
}

void Region::offer_line(std::int32_t module, int face) {
  Port& here = port(module);
  const auto bit = static_cast<std::uint16_t>(1U << static_cast<unsigned>(face));
  const Time& free_at = modules_.lines(module, face).free_at[line_of(face)];
  bool is_sending = true;
  for (int i = 0; is_sending && i < kBurstMax && (here.wanted & bit) != 0; ++i) {
    if (!modules_.options.link.is_unlimited && now_ < free_at) {
      break;
    }
    is_sending = send_one(module, face);
  }
  if (is_sending && (here.wanted & bit) != 0 && (here.line_events & bit) == 0) {
    here.line_events = static_cast<std::uint16_t>(here.line_events | bit);
    push(std::max(free_at, now_ + 1),
         {.kind = Kind::kLine, .face = static_cast<base::Direction>(face), .module = module});
  }
}

/// Sends a packet; returns false if there was nothing to send after all.
bool Region::send_one(std::int32_t module, int face) {
  step_event_.kind = agent::EventKind::kLineFree;  // Nobody reads the rest of it.
  step_event_.face = static_cast<base::Direction>(face);
  step(module);
  int size = actions_.packet_bytes;
  if (size > 0 && modules_.options.tamper) {
    const auto room = static_cast<std::size_t>(modules_.options.link.packet_bytes);
    size = modules_.options.tamper(now_, module, static_cast<base::Direction>(face),
                                   std::span(actions_.packet).first(room), size);
  }
  HOLDFAST_CHECK(size >= 0 && size <= modules_.options.link.packet_bytes);
  if (size == 0) {
    return false;
  }
  transmit(module, face, {actions_.packet.data(), static_cast<std::size_t>(size)});
  return true;
}

void Region::transmit(std::int32_t module, int face, std::span<const std::uint8_t> packet) {
  Port& here = port(module);
  const auto direction = static_cast<base::Direction>(face);
  const Time duration = modules_.line_times[packet.size()];
  modules_.lines(module, face).free_at[line_of(face)] = now_ + duration;
  here.bytes_sent += packet.size();
  ++here.packets_sent;
  const PacketTag tag{.number = is_ahead_ ? 0 : ledger_.packet_count++,
                      .rounds = here.rounds + (is_data(packet) ? 1 : 0),
                      .size = static_cast<std::uint16_t>(packet.size())};
  const PacketTrace trace{.time = now_,
                          .number = tag.number,
                          .from = module,
                          .to = modules_.neighbour(module, direction),
                          .face = direction,
                          .bytes = packet};
  recorder().sent(trace, here.seen.phase, duration);
  HOLDFAST_CHECK(trace.to >= 0);
  if (modules_.is_noisy && modules_.noise.is_lost(here.rng)) {
    recorder().lost(trace);
    return;
  }
  const Time earliest = now_ + duration + modules_.options.link.latency;
  launch(module, face, tag, packet, earliest);
  if (modules_.is_noisy && modules_.noise.is_doubled(here.rng)) {
    launch(module, face, tag, packet, earliest);
  }
}

/// Puts a packet on its way. Those that are not held back arrive in the order they left.
void Region::launch(std::int32_t module, int face, const PacketTag& tag,
                    std::span<const std::uint8_t> packet, Time earliest) {
  Port& here = port(module);
  const auto direction = static_cast<base::Direction>(face);
  const std::uint32_t slot = pool_.put(tag, packet);
  Time arrival = earliest;
  if (modules_.is_noisy) {
    if (modules_.noise.is_corrupted(here.rng)) {
      flip_bits(pool_.bytes(slot), here.rng);
    }
    arrival += modules_.noise.jitter(here.rng);
    Time& last = modules_.lines(module, face).arrival_last[line_of(face)];
    if (modules_.noise.is_held_back(here.rng)) {
      arrival += modules_.noise.delay(here.rng);
    } else {
      last = std::max(last, arrival);
      arrival = last;
    }
  }
  push(arrival, {.kind = Kind::kDeliver,
                 .face = base::opposite(direction),
                 .module = modules_.neighbour(module, direction),
                 .item = number_ << kSlotBits | slot});
}

void Region::arrive(const Happening& what) {
  const Port& here = port(what.module);
  const bool is_cut = (here.cut_faces | here.open_faces).has(what.face);
  if (is_cut || !here.takes_part()) {
    drop(what);
  } else {
    attend(what);
  }
}

/// A packet that reaches nobody.
void Region::drop(const Happening& what) {
  if (is_ahead_) {
    effects_[effect_].is_lost = true;
    return;
  }
  ledger_.recorder.lost(trace_of(what));
  pool_of(all_, what.item).release(slot_of(what.item));
}

PacketTrace Region::trace_of(const Happening& what) const {
  const PacketPool& pool = pool_of(all_, what.item);
  const std::uint32_t slot = slot_of(what.item);
  return {.time = now_,
          .number = pool.tag(slot).number,
          .from = modules_.neighbour(what.module, what.face),
          .to = what.module,
          .face = base::opposite(what.face),
          .bytes = pool.bytes(slot)};
}

}  // namespace holdfast::sim
