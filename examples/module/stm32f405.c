/* SPDX-FileCopyrightText: The holdfast authors
   SPDX-License-Identifier: Apache-2.0

   From reset to main(), and six USARTs with interrupts. */
#include "stm32f405.h"

/* USART1 to 3, UART4 and 5, USART6, and the numbers of their interrupts (RM0090, table 61). */
usart* const usarts[6] = {(usart*)0x40011000u, (usart*)0x40004400u, (usart*)0x40004800u,
                          (usart*)0x40004C00u, (usart*)0x40005000u, (usart*)0x40011400u};
static const uint8_t interrupts[6] = {37, 38, 39, 52, 53, 71};

void start_board(void) {
  SYSTICK->RVR = TICKS_PER_MS - 1;
  SYSTICK->CVR = 0;
  SYSTICK->CSR = 7;
  for (int face = 0; face < 6; ++face) {
    usarts[face]->BRR = 42000000u / 115200u;
    usarts[face]->CR1 = 1u << 13 | 1u << 5 | 1u << 3 | 1u << 2; /* UE RXNEIE TE RE */
    const uint32_t number = interrupts[face];
    ((volatile uint32_t*)0xE000E100u)[number / 32] = 1u << number % 32;
  }
}

/* stm32f405.ld. The last is an address like a handler's, the first of the vectors. */
extern uint32_t data_load, data_begin, data_end, zero_begin, zero_end;
void stack_end(void);
int main(void);

void on_reset(void);

/* The first of the vectors below, behind the stack. */
void on_reset(void) {
  const uint32_t* from = &data_load;
  for (uint32_t* to = &data_begin; to < &data_end; ++to) {
    *(volatile uint32_t*)to = *from++;
  }
  for (uint32_t* to = &zero_begin; to < &zero_end; ++to) {
    *(volatile uint32_t*)to = 0;
  }
  *(volatile uint32_t*)0xE000ED88u |= 15u << 20; /* CPACR: floating point on (ARMv7-M, B3.2.20). */
  main();
}

static void on_fault(void) {
  for (;;) {
  }
}

static void on_face_0(void) { take_byte(0); }

static void on_face_1(void) { take_byte(1); }

static void on_face_2(void) { take_byte(2); }

static void on_face_3(void) { take_byte(3); }

static void on_face_4(void) { take_byte(4); }

static void on_face_5(void) { take_byte(5); }

typedef void (*handler)(void);

/* The chip's interrupts stand behind the processor's 16 vectors. */
__attribute__((section(".vectors"), used)) static const handler vectors[16 + 72] = {
    stack_end,
    on_reset,
    on_fault,
    on_fault,
    [15] = take_tick,
    [16 + 37] = on_face_0,
    [16 + 38] = on_face_1,
    [16 + 39] = on_face_2,
    [16 + 52] = on_face_3,
    [16 + 53] = on_face_4,
    [16 + 71] = on_face_5,
};
