// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stm32f4_port.hpp"

namespace holdfast::stm32f4 {
namespace {

using module::Time;
using Register = volatile std::uint32_t;

/// ST's reference manual RM0090, 30.6.
struct Usart {
  Register SR, DR, BRR, CR1, CR2, CR3;
};

/// ARMv7-M, B3.3.
struct SysTick {
  Register CSR, RVR, CVR;
};

template <class Block>
Block& at(std::uintptr_t address) {
  return *reinterpret_cast<Block*>(address);
}

constexpr std::uint32_t kClockHz = 168'000'000;
constexpr std::uint32_t kTicks = kClockHz / 1000;

SysTick& systick() { return at<SysTick>(0xE000E010); }

/// Interrupt enables, 32 in each (ARMv7-M, B3.4).
Register& interrupt_enable(std::uint32_t number) {
  return at<Register>(0xE000E100 + number / 32 * 4);
}

struct Line {
  std::uintptr_t usart;
  std::uint32_t interrupt;
};

/// USART1 to 3, UART4 and 5, USART6; face by face.
constexpr std::array<Line, 6> kLines = {{{0x40011000, 37},
                                         {0x40004400, 38},
                                         {0x40004800, 39},
                                         {0x40004C00, 52},
                                         {0x40005000, 53},
                                         {0x40011400, 71}}};

Usart& usart(int face) { return at<Usart>(kLines[static_cast<std::size_t>(face)].usart); }

Stm32f4Port* port = nullptr;
volatile std::uint32_t milliseconds = 0;

template <int Face>
void on_byte() {
  port->take_byte(Face);
}

void on_tick() { milliseconds = milliseconds + 1; }

}  // namespace

Stm32f4Port::Stm32f4Port() {
  constexpr std::uint32_t kEnabled = 1U << 13U | 1U << 5U | 1U << 3U | 1U << 2U;  // UE RXNEIE TE RE
  port = this;
  systick().RVR = kTicks - 1;
  systick().CVR = 0;
  systick().CSR = 7;
  for (std::size_t face = 0; face < kLines.size(); ++face) {
    Usart& uart = usart(static_cast<int>(face));
    uart.BRR = 42'000'000 / 115'200;
    uart.CR1 = kEnabled;
    const std::uint32_t number = kLines[face].interrupt;
    interrupt_enable(number) = 1U << number % 32;
  }
  asm volatile("cpsie i");  // Start-up has disabled them.
}

Time Stm32f4Port::now() {
  std::uint32_t before = 0;
  std::uint32_t left = 0;
  do {
    before = milliseconds;
    left = systick().CVR;
  } while (before != milliseconds);
  const std::uint32_t part = (kTicks - 1 - left) / (kClockHz / 1'000'000);
  return Time{before} * 1000 + part;
}

/// Mixes the time, which QEMU takes from the host's, and a count of the calls.
std::uint16_t Stm32f4Port::random() {
  const std::uint32_t mixed = (++calls_ + systick().CVR) * 0x9e3779b1U;
  return static_cast<std::uint16_t>(mixed >> 16U);
}

void Stm32f4Port::take_byte(int face) {
  Ring& ring = rings_[static_cast<std::size_t>(face)];
  const auto byte = static_cast<std::uint8_t>(usart(face).DR);
  if (ring.written - ring.read < kRingBytes) {
    ring.bytes[ring.written % kRingBytes] = byte;
    ring.written = ring.written + 1;
  }
}

bool Stm32f4Port::read(int face, std::uint8_t& byte) {
  Ring& ring = rings_[static_cast<std::size_t>(face)];
  if (ring.read == ring.written) {
    return false;
  }
  byte = ring.bytes[ring.read % kRingBytes];
  ring.read = ring.read + 1;
  return true;
}

bool Stm32f4Port::is_line_free(int) { return true; }

std::span<std::uint8_t, module::kFrameBytesMax> Stm32f4Port::buffer(int) { return frame_; }

void Stm32f4Port::transmit(int face, int size) {
  constexpr std::uint32_t kEmpty = 1U << 7U;  // TXE
  for (int i = 0; i < size; ++i) {
    while ((usart(face).SR & kEmpty) == 0) {
    }
    usart(face).DR = frame_[static_cast<std::size_t>(i)];
  }
}

void Stm32f4Port::show(const agent::Colour&) {}

/// SysTick ends every wait within a millisecond.
void Stm32f4Port::sleep(Time until) {
  for (const Ring& ring : rings_) {
    if (ring.read != ring.written) {
      return;
    }
  }
  if (now() < until) {
    asm volatile("wfi");
  }
}

}  // namespace holdfast::stm32f4

using Handler = void (*)();

/// The vectors of the chip's interrupts come behind the first 16 (RM0090, table 61), the last of
/// which is SysTick.
extern "C" {
extern const Handler holdfast_tick;
extern const std::array<Handler, 72> holdfast_interrupts;
[[gnu::section(".vectors.tick"), gnu::used]] const Handler holdfast_tick =
    holdfast::stm32f4::on_tick;
[[gnu::section(".vectors.interrupts"), gnu::used]] const std::array<Handler, 72>
    holdfast_interrupts = [] {
      std::array<Handler, 72> handlers{};
      handlers[37] = holdfast::stm32f4::on_byte<0>;
      handlers[38] = holdfast::stm32f4::on_byte<1>;
      handlers[39] = holdfast::stm32f4::on_byte<2>;
      handlers[52] = holdfast::stm32f4::on_byte<3>;
      handlers[53] = holdfast::stm32f4::on_byte<4>;
      handlers[71] = holdfast::stm32f4::on_byte<5>;
      return handlers;
    }();
}
