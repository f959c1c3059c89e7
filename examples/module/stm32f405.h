/* SPDX-FileCopyrightText: The holdfast authors
   SPDX-License-Identifier: Apache-2.0

   What on_cortex_m4.c needs of the chip: ST's reference manual RM0090, 30.6; ARMv7-M, B3.3. */
#ifndef STM32F405_H
#define STM32F405_H

#include <stdint.h>

typedef struct {
  volatile uint32_t SR, DR, BRR, CR1, CR2, CR3;
} usart;

typedef struct {
  volatile uint32_t CSR, RVR, CVR;
} systick;

#define USART_EMPTY (1u << 7)
#define SYSTICK ((systick*)0xE000E010u)
#define TICKS_PER_MS 168000u
#define CONFIGURATION ((const void*)0x080E0000u) /* The last sector of the flash. */

extern usart* const usarts[6]; /* By face. */
void start_board(void);

/* From interrupts; main program. */
void take_tick(void);
void take_byte(int face);

#endif
