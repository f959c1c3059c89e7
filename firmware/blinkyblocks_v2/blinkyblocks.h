// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/* The published functions of Blinky Blocks 2's library that the adapter calls, and those that the
   library calls: declared by us, by their names, so that the adapter compiles without it. Its owners
   put their own header in place of this one. */

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What the library hands to the packet handler. Only these two members are used. */
typedef struct {
  uint8_t io_port;
  uint8_t packet_content[228];
} L3_packet;

/* Called by the application. */
uint8_t send_message(uint8_t port, uint8_t *data, uint16_t size, uint8_t ack);
uint8_t is_connected(uint8_t port);
uint32_t get_id(void);
void setColor(uint8_t color);
uint32_t HAL_GetTick(void); /* Milliseconds; of ST's library, on which this one is built. */

/* Defined by the application. */
void BBinit(void);
void BBloop(void);
uint8_t process_standard_packet(L3_packet *packet);

#ifdef __cplusplus
}
#endif
