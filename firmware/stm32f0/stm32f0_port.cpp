// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stm32f0_port.hpp"

#include "holdfast/boards/stm32f0.hpp"
#include "registers.hpp"

namespace holdfast::stm32f0 {
namespace {

using boards::stm32f0::kClockHz;
using boards::stm32f0::kLines;
using boards::stm32f0::Line;
using module::Time;

constexpr std::uint32_t kEnable = 1U << 0U;  // Of DMA channels, timers, the ADC.

// DMA: CCR.
constexpr std::uint32_t kFromMemory = 1U << 4U;
constexpr std::uint32_t kCircular = 1U << 5U;
constexpr std::uint32_t kMemoryIncrement = 1U << 7U;

// Timers: SR.
constexpr std::uint32_t kCompared = 1U << 1U;

Usart& usart(int face) { return at<Usart>(kLines[static_cast<std::size_t>(face)].usart); }

Dma& controller(std::uint8_t code) { return dma(code >> 4U); }

DmaChannel& channel(std::uint8_t code) { return controller(code).channel[(code & 15U) - 1]; }

DmaChannel& sender(int face) { return channel(kLines[static_cast<std::size_t>(face)].dma_send); }

DmaChannel& receiver(int face) {
  return channel(kLines[static_cast<std::size_t>(face)].dma_receive);
}

std::uint32_t address(const volatile void* place) {
  return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(place));
}

/// 48 MHz from the internal oscillator, one wait state with prefetch; power for what is used.
void start_clocks() {
  constexpr std::uint32_t kHsi48On = 1U << 16U;
  constexpr std::uint32_t kHsi48Ready = 1U << 17U;
  constexpr std::uint32_t kUseHsi48 = 3;
  flash().ACR = 1U | 1U << 4U;
  rcc().CR2 = rcc().CR2 | kHsi48On;
  while ((rcc().CR2 & kHsi48Ready) == 0) {
  }
  rcc().CFGR = kUseHsi48;
  while ((rcc().CFGR >> 2U & 3U) != kUseHsi48) {
  }
  rcc().AHBENR = rcc().AHBENR | 3U | 7U << 17U;                     // DMA1, DMA2, ports A to C
  rcc().APB2ENR = rcc().APB2ENR | 1U << 5U | 1U << 9U | 1U << 14U;  // USART6, ADC, USART1
  rcc().APB1ENR = rcc().APB1ENR | 3U | 15U << 17U;                  // TIM2, TIM3, USART2 to 5
}

void start_pin(int port, std::uint32_t pin, std::uint32_t function) {
  constexpr std::uint32_t kAlternate = 2;
  Gpio& gpio_port = gpio(port);
  Register& select = pin < 8 ? gpio_port.AFRL : gpio_port.AFRH;
  const std::uint32_t nibble = pin % 8 * 4;
  select = (select & ~(15U << nibble)) | function << nibble;
  gpio_port.MODER = (gpio_port.MODER & ~(3U << 2 * pin)) | kAlternate << 2 * pin;
}

void select_request(std::uint8_t code, std::uint32_t request) {
  const std::uint32_t nibble = ((code & 15U) - 1U) * 4U;
  Register& select = controller(code).CSELR;
  select = (select & ~(15U << nibble)) | request << nibble;
}

/// TIM2 counts microseconds and never stops; TIM3 makes the lamp's three colours.
void start_timers() {
  constexpr std::uint32_t kUpdate = 1;
  timer2().PSC = kClockHz / 1'000'000 - 1;
  timer2().ARR = 0xffffffff;
  timer2().EGR = kUpdate;
  timer2().CR1 = kEnable;
  constexpr std::uint32_t kPwm = 0x68;  // PWM mode 1, preloaded; twice in CCMR1.
  timer3().ARR = 255;
  timer3().CCMR1 = kPwm | kPwm << 8U;
  timer3().CCMR2 = kPwm;
  timer3().CCER = 0x111;
  timer3().CR1 = kEnable;
}

void start_adc() {
  constexpr std::uint32_t kReady = 1;
  constexpr std::uint32_t kTemperatureOn = 1U << 23U;
  constexpr std::uint32_t kTemperatureChannel = 1U << 16U;
  adc().CCR = kTemperatureOn;
  adc().CHSELR = kTemperatureChannel;
  adc().CR = kEnable;
  while ((adc().ISR & kReady) == 0) {
  }
}

}  // namespace

Stm32f0Port::Stm32f0Port() {
  start_clocks();
  start_timers();
  start_adc();
  for (std::size_t face = 0; face < kLines.size(); ++face) {
    const Line& line = kLines[face];
    start_pin(line.gpio, line.pin_send, line.function);
    start_pin(line.gpio, line.pin_receive, line.function);
    select_request(line.dma_send, line.code);
    select_request(line.dma_receive, line.code);
    Usart& uart = usart(static_cast<int>(face));
    channel(line.dma_send).CPAR = address(&uart.TDR);
    channel(line.dma_send).CMAR = address(faces_[face].frame.data());
    DmaChannel& in = channel(line.dma_receive);
    in.CPAR = address(&uart.RDR);
    in.CMAR = address(faces_[face].ring.data());
    in.CNDTR = kRingBytes;
    in.CCR = kMemoryIncrement | kCircular | kEnable;
    uart.BRR = boards::stm32f0::baud_divisor(boards::stm32f0::kBaud);
    uart.CR3 = 1U << 6U | 1U << 7U | 1U << 12U;  // DMA both ways, no stop at an overrun
    uart.CR1 = 1U << 0U | 1U << 2U | 1U << 3U;   // Enable, receive, send
  }
}

/// The counter has 32 bits; this must be called once in 71 minutes, and hellos see to that.
Time Stm32f0Port::now() {
  const std::uint32_t low = timer2().CNT;
  time_high_ += low < time_low_ ? 1U : 0U;
  time_low_ = low;
  return Time{time_high_} << 32U | low;
}

/// From the noise of 16 measurements of the temperature.
std::uint16_t Stm32f0Port::random() {
  constexpr std::uint32_t kStart = 1U << 2U;
  constexpr std::uint32_t kDone = 1U << 2U;
  std::uint32_t value = timer2().CNT;
  for (int i = 0; i < 16; ++i) {
    adc().CR = adc().CR | kStart;
    while ((adc().ISR & kDone) == 0) {
    }
    value = (value << 7U | value >> 25U) ^ adc().DR;
  }
  return static_cast<std::uint16_t>(value ^ value >> 16U);
}

bool Stm32f0Port::read(int face, std::uint8_t& byte) {
  Face& here = faces_[static_cast<std::size_t>(face)];
  if (here.read_at == kRingBytes - receiver(face).CNDTR) {
    return false;
  }
  byte = static_cast<const volatile std::uint8_t&>(here.ring[here.read_at]);
  here.read_at = static_cast<std::uint16_t>((here.read_at + 1U) % kRingBytes);
  return true;
}

bool Stm32f0Port::is_line_free(int face) { return sender(face).CNDTR == 0; }

std::span<std::uint8_t, module::kFrameBytesMax> Stm32f0Port::buffer(int face) {
  return faces_[static_cast<std::size_t>(face)].frame;
}

void Stm32f0Port::transmit(int face, int size) {
  DmaChannel& out = sender(face);
  out.CCR = 0;
  out.CNDTR = static_cast<std::uint32_t>(size);
  asm volatile("" ::: "memory");  // The frame is in memory.
  out.CCR = kMemoryIncrement | kFromMemory | kEnable;
}

void Stm32f0Port::show(const agent::Colour& colour) {
  timer3().CCR1 = colour.red;
  timer3().CCR2 = colour.green;
  timer3().CCR3 = colour.blue;
}

std::uint8_t Stm32f0Port::busy_lines() {
  std::uint8_t busy = 0;
  for (int face = 0; face < static_cast<int>(kLines.size()); ++face) {
    busy = static_cast<std::uint8_t>(busy << 1U | (is_line_free(face) ? 0U : 1U));
  }
  return busy;
}

bool Stm32f0Port::is_anything_here() {
  for (std::size_t face = 0; face < kLines.size(); ++face) {
    if (faces_[face].read_at != kRingBytes - receiver(static_cast<int>(face)).CNDTR) {
      return true;
    }
  }
  return false;
}

/// Looks at the lines until something has happened or TIM2 has reached `until`; it looks at the
/// clock itself once in a turn, so that hardware need not signal anything.
void Stm32f0Port::sleep(Time until) {
  const std::uint8_t busy = busy_lines();
  const Time time = now();
  if (until <= time) {
    return;
  }
  constexpr Time kLongest = 0x40000000;
  const Time rest = until - time < kLongest ? until - time : kLongest;
  timer2().CCR1 = time_low_ + static_cast<std::uint32_t>(rest);
  timer2().SR = ~kCompared;
  while (!is_anything_here() && busy_lines() == busy && (timer2().SR & kCompared) == 0) {
    // The compare is for equality: it may have been missed between the last two lines.
    if (now() >= until) {
      break;
    }
  }
}

}  // namespace holdfast::stm32f0
