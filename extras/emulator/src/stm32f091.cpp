// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stm32f091.hpp"

#include <algorithm>

namespace holdfast::emulator {
namespace {

constexpr Cycles kNever = ~Cycles{0};

// RM0091, table 1.
constexpr std::uint32_t kTimer2 = 0x40000000;
constexpr std::uint32_t kTimer3 = 0x40000400;
constexpr std::uint32_t kWatchdog = 0x40003000;
constexpr std::uint32_t kSyscfg = 0x40010000;
constexpr std::uint32_t kAdc = 0x40012400;
constexpr std::uint32_t kDma = 0x40020000;  // DMA2 lies 0x400 behind DMA1.
constexpr std::uint32_t kRcc = 0x40021000;
constexpr std::uint32_t kFlash = 0x40022000;
constexpr std::uint32_t kGpio = 0x48000000;
constexpr std::array<std::uint32_t, kUsartCount> kUsarts = {0x40013800, 0x40004400, 0x40004800,
                                                            0x40004C00, 0x40005000, 0x40011400};

// Offsets of registers.
constexpr std::uint32_t kRccCr = kRcc + 0x00;
constexpr std::uint32_t kRccCfgr = kRcc + 0x04;
constexpr std::uint32_t kRccAhb = kRcc + 0x14;
constexpr std::uint32_t kRccApb2 = kRcc + 0x18;
constexpr std::uint32_t kRccApb1 = kRcc + 0x1C;
constexpr std::uint32_t kRccCsr = kRcc + 0x24;
constexpr std::uint32_t kRccCr2 = kRcc + 0x34;
constexpr std::uint32_t kWatchdogPr = kWatchdog + 0x04;
constexpr std::uint32_t kWatchdogRlr = kWatchdog + 0x08;
constexpr std::uint32_t kWatchdogSr = kWatchdog + 0x0C;
constexpr std::uint32_t kUsartCr1 = 0x00;
constexpr std::uint32_t kUsartCr3 = 0x08;
constexpr std::uint32_t kUsartBrr = 0x0C;
constexpr std::uint32_t kUsartRdr = 0x24;
constexpr std::uint32_t kUsartTdr = 0x28;
constexpr std::uint32_t kDmaFirstChannel = 0x08;
constexpr std::uint32_t kDmaChannelBytes = 0x14;
constexpr std::uint32_t kDmaChannelCount = 7;
constexpr std::uint32_t kDmaCselr = 0xA8;
constexpr std::uint32_t kCndtr = 0x04;  // Of a channel, behind its CCR.
constexpr std::uint32_t kCpar = 0x08;
constexpr std::uint32_t kCmar = 0x0C;
constexpr std::uint32_t kTimerCr1 = 0x00;
constexpr std::uint32_t kTimerSr = 0x10;
constexpr std::uint32_t kTimerCnt = 0x24;
constexpr std::uint32_t kTimerPsc = 0x28;
constexpr std::uint32_t kTimerCcr1 = 0x34;
constexpr std::uint32_t kAdcIsr = kAdc + 0x00;
constexpr std::uint32_t kAdcCr = kAdc + 0x08;
constexpr std::uint32_t kAdcDr = kAdc + 0x40;

// Bits.
constexpr std::uint32_t kEnable = 1;
constexpr std::uint32_t kFromMemory = 1U << 4U;
constexpr std::uint32_t kCircular = 1U << 5U;
constexpr std::uint32_t kMemoryIncrement = 1U << 7U;
constexpr std::uint32_t kReceives = 1U << 0U | 1U << 2U;  // USART: UE, RE ...
constexpr std::uint32_t kSends = 1U << 0U | 1U << 3U;     // ... or TE
constexpr std::uint32_t kDmaReceives = 1U << 6U;
constexpr std::uint32_t kDmaSends = 1U << 7U;
constexpr std::uint32_t kCompared = 1U << 1U;

// RCC's, each with "ready" one bit above "on"; and the PLL's source and factor for 48 MHz: 8 MHz of
// the crystal times 6. Others are not emulated: with them it never gets ready.
constexpr std::uint32_t kHsiOn = 1U << 0U;
constexpr std::uint32_t kHseOn = 1U << 16U;
constexpr std::uint32_t kPllOn = 1U << 24U;
constexpr std::uint32_t kHsi48On = 1U << 16U;
constexpr std::uint32_t kPllBits = 3U << 15U | 15U << 18U;
constexpr std::uint32_t kPllOf48Mhz = 2U << 15U | 4U << 18U;
constexpr std::uint32_t kPllOfBootloader = 10U << 18U;  // HSI / 2 times 12

// Channels that can serve a USART (RM0091, tables 33 and 34), by controller; bit: channel.
constexpr std::array<std::uint32_t, 2> kReceiveChannels = {0b01101010, 0b00001100};
constexpr std::array<std::uint32_t, 2> kSendChannels = {0b10010100, 0b00110010};

bool has(std::uint32_t value, std::uint32_t bits) { return (value & bits) == bits; }

}  // namespace

Stm32f091::Stm32f091(Hooks hooks, std::uint64_t seed) : hooks_(std::move(hooks)), noise_(seed) {
  reset(kResetByPower);
}

void Stm32f091::reset(std::uint32_t reason) {
  registers_.clear();
  reg(kRccCr) = kHsiOn | kHsiOn << 1U | kPllOn | kPllOn << 1U;
  reg(kRccCfgr) = kPllOfBootloader | 2U | 2U << 2U;
  reg(kRccCsr) = reason;
  flash_.reset();
  reg(kWatchdogRlr) = 0xfff;
  receiving_ = {};
  sending_ = {};
  line_free_at_ = {};
  sent_.clear();
  is_compare_armed_ = false;
  is_compared_ = false;
  watchdog_at_ = kNever;
  is_watchdog_open_ = false;
}

bool Stm32f091::has_vectors_in_ram() const { return (look(kSyscfg) & 3U) == 3U; }

/// 6.4.1, 6.4.2, 6.4.10 and 6.4.14: what is switched on gets ready at once if it can; the PLL's
/// bits stand while it runs; the system takes a source that is ready.
void Stm32f091::write_clocks(std::uint32_t address, std::uint32_t value) {
  const bool runs_pll = has(look(kRccCr), kPllOn);
  if (address == kRccCsr) {
    reg(kRccCsr) = has(value, 1U << 24U) ? 0 : look(kRccCsr);
    return;
  }
  if (address == kRccCfgr && runs_pll) {
    value = (value & ~kPllBits) | (look(kRccCfgr) & kPllBits);
  }
  const auto ready = [&](std::uint32_t bit, bool can) {
    value &= ~(bit << 1U);
    value |= can ? (value & bit) << 1U : 0;
  };
  if (address == kRccCr) {
    ready(kHsiOn, true);
    ready(kHseOn, has_crystal_);
    const bool has_input = has(value, kHseOn << 1U);
    const std::uint32_t source = look(kRccCfgr) & kPllBits;
    ready(kPllOn, (source == kPllOf48Mhz && has_input) || source == kPllOfBootloader);
  } else if (address == kRccCr2) {
    ready(kHsi48On, true);
  } else {
    const std::uint32_t wanted = value & 3U;
    const std::uint32_t control = look(kRccCr);
    const std::array<bool, 4> is_ready = {has(control, kHsiOn << 1U), has(control, kHseOn << 1U),
                                          has(control, kPllOn << 1U),
                                          has(look(kRccCr2), kHsi48On << 1U)};
    const std::uint32_t in_use = is_ready[wanted] ? wanted << 2U : look(kRccCfgr) & 0xcU;
    value = (value & ~0xcU) | in_use;
  }
  reg(address) = value;
}

/// 24.3 and 24.4, with an LSI of 40 kHz.
void Stm32f091::write_watchdog(std::uint32_t address, std::uint32_t value) {
  if (address != kWatchdog) {
    if (is_watchdog_open_ && address != kWatchdogSr) {
      reg(address) = value;
    }
    return;
  }
  is_watchdog_open_ = value == 0x5555;
  const bool runs = watchdog_at_ != kNever;
  if (value == 0xCCCC || (value == 0xAAAA && runs)) {
    constexpr Cycles kLsi = 48'000'000 / 40'000;
    const Cycles reload = look(kWatchdogRlr);
    watchdog_at_ = hooks_.now() + (reload + 1) * (Cycles{4} << (look(kWatchdogPr) & 7U)) * kLsi;
  }
}

std::uint32_t Stm32f091::look(std::uint32_t address) const {
  const auto found = registers_.find(address);
  return found == registers_.end() ? 0 : found->second;
}

/// RM0091, 6.4.6 to 6.4.8.
bool Stm32f091::is_clocked(std::uint32_t address) const {
  const std::uint32_t block = address & ~0x3ffU;
  const std::uint32_t ahb = look(kRccAhb);
  if (block >= kGpio) {
    return ((ahb >> (17 + (block - kGpio) / 0x400)) & 1U) != 0;
  }
  switch (block) {
    case kTimer2:
      return has(look(kRccApb1), 1U << 0U);
    case kTimer3:
      return has(look(kRccApb1), 1U << 1U);
    case kSyscfg:
      return has(look(kRccApb2), 1U << 0U);
    case kUsarts[0]:
      return has(look(kRccApb2), 1U << 14U);
    case kUsarts[1]:
      return has(look(kRccApb1), 1U << 17U);
    case kUsarts[2]:
      return has(look(kRccApb1), 1U << 18U);
    case kUsarts[3]:
      return has(look(kRccApb1), 1U << 19U);
    case kUsarts[4]:
      return has(look(kRccApb1), 1U << 20U);
    case kUsarts[5]:
      return has(look(kRccApb2), 1U << 5U);
    case kAdc:
      return has(look(kRccApb2), 1U << 9U);
    case kDma:
      return has(ahb, 1U << 0U);
    case kDma + 0x400:
      return has(ahb, 1U << 1U);
    default:
      return true;
  }
}

Cycles Stm32f091::byte_cycles(int usart) const {
  constexpr Cycles kBits = 10;  // 8N1
  return kBits * look(kUsarts[at(usart)] + kUsartBrr);
}

std::uint32_t Stm32f091::count() const {
  if (!has(look(kTimer2 + kTimerCr1), kEnable)) {
    return 0;
  }
  return static_cast<std::uint32_t>((hooks_.now() - timer_begin_) /
                                    (look(kTimer2 + kTimerPsc) + 1));
}

/// When the counter will equal CCR1 next.
Cycles Stm32f091::compare_time() const {
  const Cycles tick = look(kTimer2 + kTimerPsc) + 1;
  const Cycles now = (hooks_.now() - timer_begin_) / tick;
  const auto rest = look(kTimer2 + kTimerCcr1) - static_cast<std::uint32_t>(now);
  return timer_begin_ + (now + rest) * tick;
}

std::uint32_t Stm32f091::read(std::uint32_t address) {
  if (!is_clocked(address)) {
    return 0;
  }
  catch_up();
  switch (address) {
    case kTimer2 + kTimerCnt:
      return count();
    case kTimer2 + kTimerSr:
      if (!is_compared_ && ++idle_reads_ >= 3) {
        idle_reads_ = 0;
        hooks_.idle();
      }
      return is_compared_ ? kCompared : 0;
    case kAdcDr:
      return 1750 + static_cast<std::uint32_t>(noise_.below(16));  // About 30 degrees, with noise
    default:
      break;
  }
  if ((address & ~0x3ffU) == kFlash && address != kFlash) {  // ACR is as it was written.
    return flash_.read_register(address - kFlash);
  }
  for (const Transfer& transfer : sending_) {
    if (transfer.channel != 0 && address == transfer.channel + kCndtr) {
      return left_to_send(transfer, hooks_.now());
    }
  }
  return look(address);
}

void Stm32f091::write(std::uint32_t address, std::uint32_t value) {
  if (!is_clocked(address)) {
    return;
  }
  catch_up();
  idle_reads_ = 0;
  if (address == kTimer2 + kTimerSr) {
    is_compared_ = is_compared_ && has(value, kCompared);
    return;
  }
  if (address == kRccCr || address == kRccCfgr || address == kRccCr2 || address == kRccCsr) {
    write_clocks(address, value);
    return;
  }
  if ((address & ~0x3ffU) == kWatchdog) {
    write_watchdog(address, value);
    return;
  }
  if ((address & ~0x3ffU) == kFlash && address != kFlash) {
    hooks_.stall(flash_.write_register(address - kFlash, value));
    return;
  }
  reg(address) = value;
  const std::uint32_t place = address - kDma;
  const bool is_channel = place < 0x800 && place % 0x400 >= kDmaFirstChannel &&
                          place % 0x400 < kDmaFirstChannel + kDmaChannelBytes * kDmaChannelCount;
  if (is_channel && (place % 0x400 - kDmaFirstChannel) % kDmaChannelBytes == 0) {
    start_channel(address);
  }
  switch (address) {
    case kAdcCr:
      reg(kAdcIsr) = value & 5U;  // Ready, and every conversion done at once.
      break;
    case kTimer2 + kTimerCr1:
      timer_begin_ = hooks_.now();
      break;
    case kTimer2 + kTimerCcr1:
      is_compare_armed_ = true;
      compare_at_ = compare_time();
      break;
    default:
      break;
  }
}

/// A channel's CCR has been written: who does it serve now?
void Stm32f091::start_channel(std::uint32_t channel) {
  for (auto* transfers : {&receiving_, &sending_}) {
    for (Transfer& transfer : *transfers) {
      if (transfer.channel == channel) {
        transfer = {};
      }
    }
  }
  const std::uint32_t control = look(channel);
  if (!has(control, kEnable | kMemoryIncrement)) {
    return;
  }
  const std::uint32_t controller = (channel - kDma) / 0x400;
  const std::uint32_t number = ((channel - kDma) % 0x400 - kDmaFirstChannel) / kDmaChannelBytes + 1;
  const std::uint32_t request =
      look(kDma + 0x400 * controller + kDmaCselr) >> (4 * (number - 1)) & 15U;
  const bool sends = has(control, kFromMemory);
  const std::uint32_t allowed = (sends ? kSendChannels : kReceiveChannels)[controller];
  if (request < 8 || request >= 8 + kUsartCount || !has(allowed, 1U << number)) {
    return;
  }
  const auto usart = static_cast<int>(request - 8);
  const std::uint32_t base = kUsarts[at(usart)];
  if (look(channel + kCpar) != base + (sends ? kUsartTdr : kUsartRdr)) {
    return;
  }
  Transfer& transfer = (sends ? sending_ : receiving_)[at(usart)];
  transfer = {.channel = channel, .total = look(channel + kCndtr), .begin = hooks_.now()};
  if (sends) {
    start_sending(usart, transfer);
  }
}

/// Reads the whole message at once: a program must leave it alone until it has been sent.
void Stm32f091::start_sending(int usart, Transfer& transfer) {
  const std::uint32_t base = kUsarts[at(usart)];
  if (!is_clocked(base) || !has(look(base + kUsartCr1), kSends) ||
      !has(look(base + kUsartCr3), kDmaSends) || byte_cycles(usart) == 0 || transfer.total == 0) {
    return;
  }
  transfer.begin = std::max(transfer.begin, line_free_at_[at(usart)]);
  Sent sent{
      .usart = usart, .begin = transfer.begin, .byte_cycles = byte_cycles(usart), .bytes = {}};
  for (std::uint32_t i = 0; i < transfer.total; ++i) {
    sent.bytes.push_back(hooks_.load(look(transfer.channel + kCmar) + i));
  }
  line_free_at_[at(usart)] = transfer.begin + transfer.total * sent.byte_cycles;
  sent_.push_back(std::move(sent));
}

/// The data register holds one byte and the shift register another, so DMA is two bytes ahead.
std::uint32_t Stm32f091::left_to_send(const Transfer& transfer, Cycles time) const {
  const auto usart = static_cast<int>(&transfer - sending_.data());
  const Cycles byte = byte_cycles(usart);
  if (byte == 0 || time < transfer.begin) {
    return transfer.total;
  }
  const Cycles moved = (time - transfer.begin) / byte + 2;
  return moved >= transfer.total ? 0 : transfer.total - static_cast<std::uint32_t>(moved);
}

/// Everything that has happened up to now.
void Stm32f091::catch_up() {
  const Cycles now = hooks_.now();
  for (int usart = 0; usart < kUsartCount; ++usart) {
    std::deque<Arrival>& line = arrivals_[at(usart)];
    while (!line.empty() && line.front().time <= now) {
      lost_bytes_ += take_byte(usart, line.front()) ? 0 : 1;
      line.pop_front();
      idle_reads_ = 0;
    }
  }
  if (is_compare_armed_ && compare_at_ <= now) {
    is_compare_armed_ = false;
    is_compared_ = true;
  }
}

/// A USART tolerates 3.33 % between the two clocks (27.5.5, 8 bits, three samples); a byte beyond
/// is lost.
bool Stm32f091::take_byte(int usart, const Arrival& arrival) {
  const std::uint32_t base = kUsarts[at(usart)];
  const Transfer& transfer = receiving_[at(usart)];
  const Cycles own = byte_cycles(usart);
  const Cycles apart =
      own > arrival.byte_cycles ? own - arrival.byte_cycles : arrival.byte_cycles - own;
  const bool is_ready = has(look(base + kUsartCr1), kReceives) &&
                        has(look(base + kUsartCr3), kDmaReceives) && 30 * apart <= own;
  if (!is_ready || transfer.channel == 0) {
    return false;
  }
  std::uint32_t& left = reg(transfer.channel + kCndtr);
  if (left == 0) {
    return false;
  }
  hooks_.store(look(transfer.channel + kCmar) + transfer.total - left, arrival.byte);
  --left;
  if (left == 0 && has(look(transfer.channel), kCircular)) {
    left = transfer.total;
  }
  return true;
}

Cycles Stm32f091::next_event() {
  const Cycles now = hooks_.now();
  Cycles next = is_compare_armed_ ? compare_at_ : kNever;
  for (int usart = 0; usart < kUsartCount; ++usart) {
    if (!arrivals_[at(usart)].empty()) {
      next = std::min(next, arrivals_[at(usart)].front().time);
    }
    const Transfer& transfer = sending_[at(usart)];
    if (transfer.channel != 0 && left_to_send(transfer, now) > 0) {
      const Cycles byte = byte_cycles(usart);
      next = std::min(next, transfer.begin + (transfer.total > 2 ? transfer.total - 2 : 0) * byte);
    }
  }
  return next;
}

std::array<std::uint8_t, 3> Stm32f091::lamp() const {
  std::array<std::uint8_t, 3> colour{};
  for (std::uint32_t i = 0; i < 3; ++i) {
    colour[i] = static_cast<std::uint8_t>(look(kTimer3 + kTimerCcr1 + 4 * i));
  }
  return colour;
}

}  // namespace holdfast::emulator
