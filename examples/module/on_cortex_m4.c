/* SPDX-FileCopyrightText: The holdfast authors
   SPDX-License-Identifier: Apache-2.0

   A module on an STM32F405 as QEMU's machine netduinoplus2 has it (on a board the clock tree and
   pins come first): a byte that comes in raises an interrupt, SysTick counts milliseconds. */
#include <holdfast.h>

#include "stm32f405.h"

static volatile uint32_t milliseconds;
static hf_module* module;
const hf_status* volatile holdfast_status; /* For who looks into the memory. */

void take_tick(void) { milliseconds = milliseconds + 1; }

void take_byte(int face) {
  const uint8_t byte = (uint8_t)usarts[face]->DR;
  if (module != NULL) {
    hf_receive(module, face, &byte, 1);
  }
}

static uint32_t now(void* context) {
  (void)context;
  uint32_t before, left;
  do {
    before = milliseconds;
    left = SYSTICK->CVR;
  } while (before != milliseconds);
  return before * 1000 + (TICKS_PER_MS - 1 - left) / (TICKS_PER_MS / 1000);
}

static uint16_t draw(void* context) {
  static uint32_t calls;
  return (uint16_t)((++calls + now(context) + SYSTICK->CVR) * 2654435761u >> 16);
}

static bool is_line_free(void* context, int face) {
  (void)context;
  (void)face;
  return true; /* send_bytes() waits. */
}

static void send_bytes(void* context, int face, const uint8_t* bytes, size_t size) {
  (void)context;
  while (size-- > 0) {
    while ((usarts[face]->SR & USART_EMPTY) == 0) {
    }
    usarts[face]->DR = *bytes++;
  }
}

void hf_panic(const char* condition, const char* file, int line) {
  (void)condition, (void)file, (void)line;
  for (;;) {
  }
}

int main(void) {
  static uint64_t memory[HF_BYTES / 8];
  const hf_config config = {
      .port = {.now = now, .random = draw, .is_line_free = is_line_free, .send = send_bytes},
      .page = CONFIGURATION};
  start_board();
  module = hf_init(memory, sizeof memory, &config);
  if (module == NULL) {
    hf_panic("no configuration", __FILE__, __LINE__);
  }
  holdfast_status = hf_get_status(module);
  for (;;) {
    if (hf_poll(module) > 0) {
      __asm__ volatile("wfi"); /* SysTick ends it within a millisecond. */
    }
  }
}
