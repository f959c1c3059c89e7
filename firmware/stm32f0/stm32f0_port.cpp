// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "stm32f0_port.hpp"

#include "holdfast/boards/stm32f0.hpp"
#include "registers.hpp"

extern "C" {
using Handler = void (*)();
extern const Handler holdfast_vectors[15];
}

namespace holdfast::stm32f0 {
namespace {

using boards::stm32f0::kClockHz;
using boards::stm32f0::kLines;
using boards::stm32f0::Line;
using module::Time;

constexpr std::uint32_t kHsiOn = 1U | 16U << 3U;  // RCC_CR's, and the factory's trimming.
constexpr std::uint32_t kEnable = 1U << 0U;       // Of DMA channels, timers, the ADC.

// DMA: CCR.
constexpr std::uint32_t kFromMemory = 1U << 4U;
constexpr std::uint32_t kCircular = 1U << 5U;
constexpr std::uint32_t kMemoryIncrement = 1U << 7U;

// Timers: SR.
constexpr std::uint32_t kCompared = 1U << 1U;

/// 44 ms of bytes, or 67 of version 1's. A line on which more comes in during one step loses some,
/// and the links repeat them.
constexpr std::size_t kRingBytes = boards::stm32f0::kBaud < 115'200 ? 256 : 512;

struct Buffers {
  std::array<std::uint8_t, kRingBytes> ring;
  std::array<std::uint8_t, module::kFrameBytesMax> frame;
  std::uint16_t read_at;
};

// There is one board. Its memory is zero from the start, which takes no code here.
std::array<Buffers, 6> faces;
std::uint32_t time_high;
std::uint32_t time_low;

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

/// What a bootloader may have left (SysTick stays masked by PRIMASK): interrupts, DMA, peripherals,
/// clocks, and its own vectors where the processor looks for them, as a Cortex-M0 has no VTOR: ours
/// go to the start of the RAM, which is put there instead (RM0091, 9.1.1).
void start_anew() {
  constexpr std::uint32_t kMapRam = 3;
  interrupt_disable() = ~0U;
  rcc().CR = rcc().CR | kHsiOn;  // Its own clock may be another.
  rcc().CFGR = 0;
  while ((rcc().CFGR >> 2U & 3U) != 0) {
  }
  rcc().CR = kHsiOn;
  rcc().APB1RSTR = ~0U;
  rcc().APB2RSTR = ~0U;
  rcc().AHBRSTR = ~0U;
  rcc().APB1RSTR = 0;
  rcc().APB2RSTR = 0;
  rcc().AHBRSTR = 0;
  rcc().AHBENR = 1U << 2U | 1U << 4U | 3U | 7U << 17U;   // SRAM, flash; DMA1, DMA2, ports A to C
  rcc().APB2ENR = 1U | 1U << 5U | 1U << 9U | 1U << 14U;  // SYSCFG, USART6, ADC, USART1
  rcc().APB1ENR = 3U | 15U << 17U;                       // TIM2, TIM3, USART2 to 5
  for (std::size_t i = 0; i < 7; ++i) {
    dma(1).channel[i].CCR = 0;
    dma(2).channel[i].CCR = 0;
  }
  __builtin_memcpy(&at<std::uint32_t>(0x20000000), holdfast_vectors, sizeof(holdfast_vectors));
  syscfg().CFGR1 = kMapRam;
}

/// A program that does not feed it for 1.6 to 2.7 s (the LSI is 30 to 50 kHz) starts again.
void start_watchdog() {
  watchdog().KR = 0xCCCC;
  watchdog().KR = 0x5555;
  watchdog().PR = 4;  // LSI / 64
  watchdog().RLR = 1249;
  while (watchdog().SR != 0) {
  }
}

void feed_watchdog() { watchdog().KR = 0xAAAA; }

/// 48 MHz from the crystal, one wait state with prefetch. Where there is none, or where it fails
/// (the clock security system's NMI ends the program, and it starts again), from the HSI48, which
/// is 3 % off: neighbours may then not understand each other.
void start_clocks() {
  constexpr std::uint32_t kHseOn = 1U << 16U;
  constexpr std::uint32_t kHseReady = 1U << 17U;
  constexpr std::uint32_t kSecurity = 1U << 19U;
  constexpr std::uint32_t kPllOn = 1U << 24U;
  constexpr std::uint32_t kPllReady = 1U << 25U;
  constexpr std::uint32_t kHsi48On = 1U << 16U;
  constexpr std::uint32_t kHsi48Ready = 1U << 17U;
  constexpr std::uint32_t kPllOfHse = 2U << 15U | (kClockHz / boards::stm32f0::kCrystalHz - 2)
                                                      << 18U;
  constexpr int kLooksMax = 100'000;  // At 8 MHz, more than 50 ms.
  flash().ACR = 1U | 1U << 4U;
  rcc().CR = kHsiOn | kHseOn;
  std::uint32_t source = 3;  // HSI48
  for (int i = 0; i < kLooksMax && source == 3; ++i) {
    source = (rcc().CR & kHseReady) != 0 ? 2 : 3;
  }
  if (source == 2) {
    rcc().CFGR = kPllOfHse;
    rcc().CR = kHsiOn | kHseOn | kSecurity | kPllOn;
    while ((rcc().CR & kPllReady) == 0) {
    }
  } else {
    rcc().CR2 = kHsi48On;
    while ((rcc().CR2 & kHsi48Ready) == 0) {
    }
  }
  rcc().CFGR = kPllOfHse | source;
  while ((rcc().CFGR >> 2U & 3U) != source) {
  }
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
  start_watchdog();
  start_anew();
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
    channel(line.dma_send).CMAR = address(faces[face].frame.data());
    DmaChannel& in = channel(line.dma_receive);
    in.CPAR = address(&uart.RDR);
    in.CMAR = address(faces[face].ring.data());
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
  time_high += low < time_low ? 1U : 0U;
  time_low = low;
  return Time{time_high} << 32U | low;
}

/// Mixes the noise of 16 measurements of the temperature.
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
  Buffers& here = faces[static_cast<std::size_t>(face)];
  if (here.read_at == kRingBytes - receiver(face).CNDTR) {
    return false;
  }
  byte = static_cast<const volatile std::uint8_t&>(here.ring[here.read_at]);
  here.read_at = static_cast<std::uint16_t>((here.read_at + 1U) % kRingBytes);
  return true;
}

bool Stm32f0Port::is_line_free(int face) { return sender(face).CNDTR == 0; }

std::span<std::uint8_t, module::kFrameBytesMax> Stm32f0Port::buffer(int face) {
  return faces[static_cast<std::size_t>(face)].frame;
}

void Stm32f0Port::transmit(int face, int size) {
  DmaChannel& out = sender(face);
  out.CCR = 0;
  out.CNDTR = static_cast<std::uint32_t>(size);
  asm volatile("" ::: "memory");  // The frame is in memory.
  out.CCR = kMemoryIncrement | kFromMemory | kEnable;
}

std::uint32_t Stm32f0Port::take_reset_reason() {
  const std::uint32_t flags = rcc().CSR >> 24U;
  rcc().CSR = 1U << 24U;
  return flags;
}

std::span<const std::uint8_t> Stm32f0Port::unique_number() {
  constexpr std::size_t kBytes = 12;
  return {&at<const std::uint8_t>(0x1FFFF7AC), kBytes};
}

void Stm32f0Port::signal(std::uint32_t count, bool is_for_ever) {
  constexpr std::uint32_t kFlash = 250'000;
  timer3().CCR2 = 0;
  timer3().CCR3 = 0;
  for (std::uint32_t i = 2 * count + 4; i > 0; --i) {
    if (is_for_ever) {
      feed_watchdog();
    }
    timer3().CCR1 = i > 4 && i % 2 == 0 ? 255 : 0;
    const std::uint32_t begin = timer2().CNT;
    while (timer2().CNT - begin < kFlash) {
    }
  }
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
    if (faces[face].read_at != kRingBytes - receiver(static_cast<int>(face)).CNDTR) {
      return true;
    }
  }
  return false;
}

/// Looks at the lines until something has happened or TIM2 has reached `until`; it looks at the
/// clock itself once in a turn, so that hardware need not signal anything.
void Stm32f0Port::sleep(Time until) {
  feed_watchdog();
  const std::uint8_t busy = busy_lines();
  const Time time = now();
  if (until <= time) {
    return;
  }
  constexpr Time kLongest = 0x40000000;
  const Time rest = until - time < kLongest ? until - time : kLongest;
  timer2().CCR1 = time_low + static_cast<std::uint32_t>(rest);
  timer2().SR = ~kCompared;
  while (!is_anything_here() && busy_lines() == busy && (timer2().SR & kCompared) == 0) {
    // The compare is for equality: it may have been missed between the last two lines.
    if (now() >= until) {
      break;
    }
  }
}

}  // namespace holdfast::stm32f0
