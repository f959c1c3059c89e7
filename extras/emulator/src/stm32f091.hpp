// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <unordered_map>
#include <vector>

#include "flash_memory.hpp"
#include "holdfast/base/rng.hpp"
#include "processor.hpp"

/// The peripherals of an STM32F091 as far as a module uses them, after the reference manual RM0091:
/// flash (3), reset and clock control (6), SYSCFG's memory map (9), DMA (10), the ADC's temperature
/// sensor (13), TIM2 and TIM3 (17, 18), the independent watchdog (24) and USART1 to 6 (27). A
/// peripheral whose clock is off reads as zero and takes nothing; a transfer needs the right
/// channel, request, direction and address; a byte matching baud rates.
namespace holdfast::emulator {

inline constexpr int kUsartCount = 6;

/// What a USART has begun to send: bytes, one behind the other.
struct Sent {
  int usart = 0;
  Cycles begin = 0;
  Cycles byte_cycles = 0;
  std::vector<std::uint8_t> bytes;
};

/// A byte that is complete at a time.
struct Arrival {
  Cycles time = 0;
  Cycles byte_cycles = 0;  ///< Of the sender.
  std::uint8_t byte = 0;
};

/// Flags of RCC_CSR that say why the chip has started (6.4.10).
inline constexpr std::uint32_t kResetByPower = 0x0C000000;
inline constexpr std::uint32_t kResetByPin = 0x04000000;
inline constexpr std::uint32_t kResetByWatchdog = 0x24000000;

class Stm32f091 final : public Peripherals {
 public:
  /// What it asks of the processor; `now` is its clock.
  struct Hooks {
    std::function<Cycles()> now;
    std::function<void(std::uint32_t, std::uint8_t)> store;
    std::function<std::uint8_t(std::uint32_t)> load;
    std::function<void()> idle;  ///< The program only waits; see next_event().
    std::function<void(Cycles)> stall = [](Cycles) {};  ///< The program stands still so long.
  };

  Stm32f091(Hooks hooks, std::uint64_t seed);

  std::uint32_t read(std::uint32_t address) override;
  void write(std::uint32_t address, std::uint32_t value) override;

  std::uint32_t read_flash(std::uint32_t offset, unsigned size) override {
    return flash_.read(offset, size);
  }

  void write_flash(std::uint32_t offset, std::uint32_t value, unsigned size) override {
    hooks_.stall(flash_.write(offset, value, size));
  }

  FlashMemory& flash() { return flash_; }

  /// All registers as a bootloader leaves them after a reset: it runs by the PLL, on the internal
  /// oscillator, and has not put it back. What was being sent breaks off.
  void reset(std::uint32_t reason = kResetByPin);

  /// A board without: HSE never gets ready.
  void take_crystal_off() { has_crystal_ = false; }

  /// When the watchdog bites unless it is fed; never: ~0.
  Cycles watchdog_at() const { return watchdog_at_; }

  /// Is the RAM where the processor looks for its vectors?
  bool has_vectors_in_ram() const;

  /// A byte that will come in; times never go back.
  void arrive(int usart, const Arrival& arrival) { arrivals_[at(usart)].push_back(arrival); }

  /// What it has begun to send since the last call.
  std::vector<Sent> take_sent() { return std::move(sent_); }

  /// When something happens next without the program's doing; never: ~0.
  Cycles next_event();

  /// Red, green and blue of the lamp.
  std::array<std::uint8_t, 3> lamp() const;

  std::uint64_t lost_bytes() const { return lost_bytes_; }

 private:
  struct Transfer {
    std::uint32_t channel = 0;  ///< Address of its CCR; 0: none.
    std::uint32_t total = 0;    ///< CNDTR at its start.
    Cycles begin = 0;           ///< Sending only.
  };

  static std::size_t at(int usart) { return static_cast<std::size_t>(usart); }

  std::uint32_t& reg(std::uint32_t address) { return registers_[address]; }

  std::uint32_t look(std::uint32_t address) const;
  bool is_clocked(std::uint32_t address) const;
  Cycles byte_cycles(int usart) const;
  void write_clocks(std::uint32_t address, std::uint32_t value);
  void write_watchdog(std::uint32_t address, std::uint32_t value);
  void start_channel(std::uint32_t channel);
  void start_sending(int usart, Transfer& transfer);
  void catch_up();
  bool take_byte(int usart, const Arrival& arrival);
  std::uint32_t left_to_send(const Transfer& transfer, Cycles time) const;
  std::uint32_t count() const;
  Cycles compare_time() const;

  Hooks hooks_;
  base::Rng noise_;
  FlashMemory flash_;
  std::unordered_map<std::uint32_t, std::uint32_t> registers_;
  std::array<std::deque<Arrival>, kUsartCount> arrivals_;
  std::array<Transfer, kUsartCount> receiving_;
  std::array<Transfer, kUsartCount> sending_;
  std::array<Cycles, kUsartCount> line_free_at_{};
  std::vector<Sent> sent_;
  bool has_crystal_ = true;
  Cycles watchdog_at_ = ~Cycles{0};
  bool is_watchdog_open_ = false;  ///< Its registers may be written.
  Cycles timer_begin_ = 0;
  bool is_compare_armed_ = false;
  bool is_compared_ = false;
  Cycles compare_at_ = 0;
  std::uint64_t lost_bytes_ = 0;
  int idle_reads_ = 0;  ///< Looks at TIM2's flags since anything has happened.
};

}  // namespace holdfast::emulator
