// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// The registers of the STM32F091 that the port uses, by the names of ST's reference manual RM0091.
/// Addresses: RM0091, table 1.
namespace holdfast::stm32f0 {

using Register = volatile std::uint32_t;

struct Rcc {  // RM0091, 6.4
  Register CR, CFGR, CIR, APB2RSTR, APB1RSTR, AHBENR, APB2ENR, APB1ENR, BDCR, CSR, AHBRSTR, CFGR2,
      CFGR3, CR2;
};

struct Watchdog {  // 24.4, the independent one
  Register KR, PR, RLR, SR;
};

struct Syscfg {  // 9.1
  Register CFGR1;
};

struct Flash {  // 3.5
  Register ACR, KEYR, OPTKEYR, SR, CR, AR;
};

struct Gpio {  // 8.4
  Register MODER, OTYPER, OSPEEDR, PUPDR, IDR, ODR, BSRR, LCKR, AFRL, AFRH;
};

struct Usart {  // 27.8
  Register CR1, CR2, CR3, BRR, GTPR, RTOR, RQR, ISR, ICR, RDR, TDR;
};

struct DmaChannel {  // 10.4
  Register CCR, CNDTR, CPAR, CMAR, reserved;
};

struct Dma {
  Register ISR, IFCR;
  DmaChannel channel[7];
  Register reserved[5];
  Register CSELR;
};

struct Timer {  // 17.4
  Register CR1, CR2, SMCR, DIER, SR, EGR, CCMR1, CCMR2, CCER, CNT, PSC, ARR, reserved, CCR1, CCR2,
      CCR3, CCR4;
};

struct Adc {  // 13.12
  Register ISR, IER, CR, CFGR1, CFGR2, SMPR, reserved1[2], TR, reserved2, CHSELR, reserved3[5], DR,
      reserved4[177], CCR;
};

template <class Block>
Block& at(std::uintptr_t address) {
  return *reinterpret_cast<Block*>(address);
}

inline Rcc& rcc() { return at<Rcc>(0x40021000); }

inline Flash& flash() { return at<Flash>(0x40022000); }

inline Gpio& gpio(int port) {
  return at<Gpio>(0x48000000 + static_cast<std::uintptr_t>(port) * 0x400);
}

inline Timer& timer2() { return at<Timer>(0x40000000); }

inline Timer& timer3() { return at<Timer>(0x40000400); }

inline Adc& adc() { return at<Adc>(0x40012400); }

inline Watchdog& watchdog() { return at<Watchdog>(0x40003000); }

inline Syscfg& syscfg() { return at<Syscfg>(0x40010000); }

/// Interrupts of the chip that are enabled (ARMv6-M, B3.4): ones written here disable them.
inline Register& interrupt_disable() { return at<Register>(0xE000E180); }

/// DMA1 or DMA2.
inline Dma& dma(std::uint32_t number) { return at<Dma>(0x40020000 + (number - 1) * 0x400); }

}  // namespace holdfast::stm32f0
