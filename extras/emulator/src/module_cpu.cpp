// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "module_cpu.hpp"

#include <algorithm>
#include <cstring>

#include "holdfast/base/check.hpp"
#include "holdfast/module/program.hpp"

namespace holdfast::emulator {
namespace {

constexpr const char* kStep = "_ZN8holdfast5agent5Agent9step_partERKNS0_5EventERNS0_7ActionsE";

/// agent::Event and agent::Actions as they lie in the module's memory.
struct EventLayout {
  std::uint8_t kind;
  std::uint8_t told;
  std::uint64_t now;
  std::uint8_t face;
  std::uint16_t random;
  std::int32_t cell[3];
  std::uint32_t bytes;
  std::uint32_t byte_count;
};

struct ActionsLayout {
  std::uint8_t send_faces;
  std::uint8_t is_unfinished;
  std::uint64_t wake_at;
  std::int32_t packet_bytes;
  std::uint8_t packet[agent::wire::kPacketBytesMax];
};

static_assert(sizeof(EventLayout) == 40 && sizeof(ActionsLayout) == 248);

constexpr std::size_t kUniqueBytes = 12;

/// Chips of one wafer: its coordinates differ, lot and number of the wafer do not (RM0091, 33.1).
std::array<std::uint8_t, kUniqueBytes> unique_number(std::uint32_t number) {
  const auto x = static_cast<std::uint8_t>(number & 0xffU);
  const auto y = static_cast<std::uint8_t>(number >> 8U & 0xffU);
  return {x, 0, y, 0, 7, '4', '2', 'Q', '0', '6', 'A', 'X'};
}

template <class Value>
Value read_value(const Processor& processor, std::uint32_t address) {
  Value value{};
  processor.read(address, {reinterpret_cast<std::uint8_t*>(&value), sizeof(Value)});
  return value;
}

}  // namespace

Stm32f091::Hooks ModuleCpu::hooks() {
  return {
      .now = [this] { return processor_.now(); },
      .store =
          [this](std::uint32_t address, std::uint8_t byte) {
            processor_.write(address, {&byte, 1});
          },
      .load =
          [this](std::uint32_t address) { return read_value<std::uint8_t>(processor_, address); },
      .idle =
          [this] {
            is_waiting_ = true;
            wake_at_ = stm_.next_event();
            processor_.stop();
          },
      .stall = [this](Cycles cycles) { processor_.skip_to(processor_.now() + cycles); }};
}

ModuleCpu::ModuleCpu(const Image& image, CostTable& costs,
                     const module::Configuration& configuration, std::uint64_t seed, Cycles start,
                     const BoardOptions& board)
    : image_(image),
      configuration_(configuration),
      shadow_(std::make_unique<agent::Agent>(configuration_.setup, configuration_.identity)),
      stm_(hooks(), seed),
      processor_(image, costs, stm_, *this, image.at(kStep)),
      clock_off_ppm_(board.clock_off_ppm),
      wake_at_(own(start)) {
  if (!board.has_crystal) {
    stm_.take_crystal_off();
  }
  processor_.write(Processor::kUniqueNumber, unique_number(board.number));
  if (image.writes_flash()) {
    stm_.flash().place_at(image.flash_end() - FlashMemory::kBytes);
  }
  if (board.has_page) {
    std::array<std::uint8_t, module::kConfigurationBytes> page{};
    std::memcpy(page.data(), &configuration_, page.size());
    const std::uint32_t place = image.at("holdfast_configuration");
    if (image.writes_flash()) {
      stm_.flash().load(place, page);
    } else {
      processor_.write(place, page);
    }
  }
}

/// The program has begun anew, with what it knows by now.
void ModuleCpu::begin_shadow() {
  const std::uint32_t place =
      image_.at(image_.writes_flash() ? "holdfast_configuration_in_use" : "holdfast_configuration");
  std::array<std::uint8_t, module::kConfigurationBytes> page{};
  processor_.read(place, page);
  std::memcpy(static_cast<void*>(&configuration_), page.data(), page.size());
  if (configuration_.identity.id == 0) {
    std::array<std::uint8_t, kUniqueBytes> number{};
    processor_.read(Processor::kUniqueNumber, number);
    configuration_.identity.id = module::id_of(number);
  }
  shadow_ = std::make_unique<agent::Agent>(configuration_.setup, configuration_.identity);
  verdict_ = agent::Verdict::kNone;
}

Cycles ModuleCpu::own(Cycles time) const {
  const auto off = static_cast<std::int64_t>(time) * clock_off_ppm_ / 1'000'000;
  return time + static_cast<Cycles>(off);
}

Cycles ModuleCpu::outside(Cycles time) const {
  return clock_off_ppm_ == 0 || time == ~Cycles{0}
             ? time
             : time * 1'000'000 / static_cast<Cycles>(1'000'000 + clock_off_ppm_);
}

Cycles ModuleCpu::own_next_time() const {
  return is_waiting_ ? std::min(wake_at_, stm_.watchdog_at()) : processor_.now();
}

void ModuleCpu::run(Cycles limit) {
  const Cycles end = own(limit);
  while (is_alive_ && own_next_time() < end) {
    if (own_next_time() >= stm_.watchdog_at()) {
      processor_.skip_to(own_next_time());
      ++reset_count_;
      reset(kResetByWatchdog);
    }
    if (is_waiting_) {
      processor_.skip_to(std::max(wake_at_, processor_.now()));
      is_waiting_ = false;
    }
    if (processor_.run(std::min(end, stm_.watchdog_at()))) {
      continue;
    }
    // A HardFault. Without vectors of its own the program does not learn of it.
    constexpr std::uint32_t kHardFault = 0x2000000C;
    if (!stm_.has_vectors_in_ram()) {
      kill();
    }
    is_inside_ = false;
    processor_.jump(processor_.word(kHardFault));
  }
}

void ModuleCpu::arrive(int usart, const Arrival& arrival) {
  const Arrival here{
      .time = own(arrival.time), .byte_cycles = own(arrival.byte_cycles), .byte = arrival.byte};
  stm_.arrive(usart, here);
  wake_at_ = std::min(wake_at_, here.time);
}

std::vector<Sent> ModuleCpu::take_sent() {
  std::vector<Sent> all = stm_.take_sent();
  for (Sent& sent : all) {
    sent.begin = outside(sent.begin);
    sent.byte_cycles = outside(sent.byte_cycles);
  }
  return all;
}

void ModuleCpu::reset(std::uint32_t reason) {
  stm_.reset(reason);
  processor_.reset();
  event_ = {};
  is_inside_ = false;
  is_waiting_ = false;
}

void ModuleCpu::crash() {
  constexpr std::uint32_t kNoProgram = 0x10000000;
  processor_.jump(kNoProgram);
  is_inside_ = false;
  is_waiting_ = false;
}

module::Status ModuleCpu::status() const {
  const std::uint32_t address = processor_.word(image_.at("holdfast_status"));
  return address == 0 ? module::Status{} : read_value<module::Status>(processor_, address);
}

std::uint32_t ModuleCpu::stack_bytes() const {
  constexpr std::uint32_t kPaint = 0xc5c5c5c5;
  const std::uint32_t end = image_.at("holdfast_stack_end");
  std::uint32_t address = image_.at("holdfast_stack_begin");
  while (address < end && processor_.word(address) == kPaint) {
    address += 4;
  }
  return end - address;
}

void ModuleCpu::entered(std::span<const std::uint32_t, 4> arguments) {
  using agent::EventKind;
  const bool was_recall = event_.kind == EventKind::kRecall;
  read_event(arguments[1]);
  // What is recalled comes first of all, then the start.
  if (!was_recall && (event_.kind == EventKind::kRecall || event_.kind == EventKind::kStart)) {
    begin_shadow();
  }
  actions_address_ = arguments[2];
  entered_at_ = processor_.now();
  is_inside_ = true;
}

void ModuleCpu::read_event(std::uint32_t address) {
  const auto event = read_value<EventLayout>(processor_, address);
  event_ = {.kind = static_cast<agent::EventKind>(event.kind),
            .told = static_cast<agent::Told>(event.told),
            .now = event.now,
            .face = static_cast<base::Direction>(event.face),
            .random = event.random,
            .cell = {event.cell[0], event.cell[1], event.cell[2]},
            .bytes = {}};
  if (event_.kind == agent::EventKind::kReceive && event.byte_count <= event_bytes_.size()) {
    const auto bytes = std::span(event_bytes_).first(event.byte_count);
    processor_.read(event.bytes, bytes);
    event_.bytes = bytes;
  }
}

void ModuleCpu::left() {
  if (!is_inside_) {
    return;
  }
  is_inside_ = false;
  const Cycles cycles = processor_.now() - entered_at_;
  const agent::Phase phase = shadow_->phase();
  shadow_->step_part(event_, actions_);
  compare_actions();
  ++steps_.count;
  steps_.cycles += cycles;
  if (cycles > steps_.cycles_max) {
    steps_.cycles_max = cycles;
    steps_.longest = phase;
  }
  const agent::Verdict verdict = shadow_->answer().verdict;
  if (verdict != verdict_ && verdict != agent::Verdict::kNone) {
    steps_.verdict_time = outside(processor_.now());
  }
  verdict_ = verdict;
}

void ModuleCpu::compare_actions() {
  const auto actions = read_value<ActionsLayout>(processor_, actions_address_);
  const auto size = static_cast<std::size_t>(std::clamp(actions_.packet_bytes, 0, 228));
  const bool is_same = actions.send_faces == actions_.send_faces &&
                       (actions.is_unfinished != 0) == actions_.is_unfinished &&
                       actions.wake_at == actions_.wake_at &&
                       actions.packet_bytes == actions_.packet_bytes &&
                       std::equal(actions.packet, actions.packet + size, actions_.packet.begin());
  steps_.mismatch_count += is_same ? 0 : 1;
  if (size > 0) {
    take_packet({actions.packet, size});
  }
}

void ModuleCpu::take_packet(std::span<const std::uint8_t> packet) {
  constexpr std::size_t kOverhead = agent::wire::kHeaderBytes + agent::wire::kChecksumBytes;
  sim::PhaseStatistics& phase = steps_.phases[static_cast<std::size_t>(shadow_->phase())];
  ++steps_.packets;
  ++phase.packets;
  steps_.bytes += packet.size();
  phase.bytes += packet.size();
  if (agent::wire::header_of(packet).kind == agent::wire::PacketKind::kData) {
    ++steps_.data_packets;
    steps_.payload_bytes += packet.size() - kOverhead;
  }
}

}  // namespace holdfast::emulator
