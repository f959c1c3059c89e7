// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// From reset to holdfast_main() on a Cortex-M: vectors, memory, a painted stack.
#include <cstdint>

#include "firmware.hpp"

extern "C" {

// From the linker script.
extern std::uint32_t holdfast_data_load, holdfast_data_begin, holdfast_data_end;
extern std::uint32_t holdfast_zero_begin, holdfast_zero_end;
extern std::uint32_t holdfast_stack_begin, holdfast_stack_end;

[[noreturn]] void holdfast_main();

/// The stack is filled with this, so that one can see how deep it has been.
constexpr std::uint32_t kPaint = 0xc5c5c5c5;

[[noreturn]] void holdfast_reset() {
  asm volatile("cpsid i");  // A bootloader may have left some enabled.
  // Leave alone what this function itself has on the stack.
  const auto here = reinterpret_cast<std::uint32_t*>(__builtin_frame_address(0)) - 16;
  for (std::uint32_t* word = &holdfast_stack_begin; word < here; ++word) {
    *static_cast<volatile std::uint32_t*>(word) = kPaint;
  }
  const std::uint32_t* from = &holdfast_data_load;
  for (std::uint32_t* to = &holdfast_data_begin; to < &holdfast_data_end; ++to) {
    *static_cast<volatile std::uint32_t*>(to) = *from++;
  }
  for (std::uint32_t* word = &holdfast_zero_begin; word < &holdfast_zero_end; ++word) {
    *static_cast<volatile std::uint32_t*>(word) = 0;
  }
  holdfast_main();
}

[[noreturn]] void holdfast_fault() { holdfast::firmware::stop(holdfast::firmware::Stop::kFault); }

using Handler = void (*)();

/// ARMv6-M, B1.5.2: the first stack pointer, then 14 handlers of the processor. A port that has
/// interrupts puts SysTick's and the chip's behind them (.vectors.tick, .vectors.interrupts).
extern const Handler holdfast_vectors[15];
[[gnu::section(".vectors"), gnu::used]] const Handler holdfast_vectors[15] = {
    reinterpret_cast<Handler>(&holdfast_stack_end),
    holdfast_reset,
    holdfast_fault,
    holdfast_fault,
};
}
