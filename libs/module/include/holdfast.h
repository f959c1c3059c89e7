/* SPDX-FileCopyrightText: The holdfast authors
   SPDX-License-Identifier: Apache-2.0

   The program of a module for firmware in C (C99): every module of a robot runs it, they talk face
   to face, and each learns whether the robot will hold when the planned modules are attached.

     static uint64_t memory[HF_BYTES / 8];
     hf_module *module = hf_init(memory, sizeof memory, &config);
     for (;;) {
       hf_receive(module, face, bytes, size);     what has come in, also from an interrupt
       uint32_t pause_us = hf_poll(module);       does what there is to do, 5 ms at most (Cortex-M0)
       ... sleep until something comes in, a line becomes free, or so long ...
     }

   No heap, no exceptions, no threads. All functions of one module are called from one place, but
   hf_receive(), which an interrupt of the same core may call. docs/porting.md is the tutorial. */
#ifndef HOLDFAST_H
#define HOLDFAST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Faces, by index: +x, -x, +y, -y, +z, -z. All modules have the same orientation. */
#define HF_FACES 6

/* Enough memory for a module on any processor, and what it may keep over a reset; hf_size() says
   how much of the first is used. Both are aligned to 8 bytes. */
#define HF_BYTES ((size_t)(sizeof(void*) == 4 ? 18432 : 20480))
#define HF_KEEP_BYTES ((size_t)256)

/* A configuration page: each file that `holdfast emulate FILE --pages FOLDER` writes. */
#define HF_PAGE_BYTES ((size_t)280)

/* The longest packet where the program does not make frames itself. */
#define HF_PACKET_BYTES 228

typedef struct hf_module hf_module;

typedef struct {
  uint8_t red, green, blue;
  bool blinks; /* Its rhythm is the program's: `show` is called as it goes on and off. */
} hf_colour;

/* What the board does for the program. `context` is handed to each function. */
typedef struct {
  void* context;
  /* Microseconds; counts on over 2^32, and is read at least once in a second by hf_poll(). */
  uint32_t (*now)(void* context);
  /* Differs from one call to the next and from one start to the next. */
  uint16_t (*random)(void* context);
  /* Can a line take the next bytes? */
  bool (*is_line_free)(void* context, int face);
  /* Sends bytes, which stay where they are until is_line_free() says yes again. */
  void (*send)(void* context, int face, const uint8_t* bytes, size_t size);
  /* Shows a colour; called when it changes. Null: there is no lamp. */
  void (*show)(void* context, hf_colour colour);
  /* Null: lines carry bytes, and the program makes frames, tells its neighbours that it is there
     and listens to them. Else lines carry whole packets, for boards with frames of their own: is
     there a neighbour at this face now? */
  bool (*is_connected)(void* context, int face);
  /* Keeps HF_PAGE_BYTES over a loss of power, and hands them in again as hf_config.page: what the
     module has been told of its robot and of itself. Null: it forgets. May take a while. */
  void (*keep_page)(void* context, const void* page);
  /* How deep the stack has been, for instruments. Null, or 0: not known. */
  size_t (*stack_bytes)(void* context);
  uint8_t reset_reason; /* The board's own flags, for instruments; 0: not known. */
} hf_port;

/* Who a module is. */
typedef struct {
  uint32_t id;    /* Different for every module. */
  bool is_fixed;  /* Held from outside. */
  bool is_anchor; /* Knows its cell, the next three; exactly one module of a robot. */
  int32_t x, y, z;
} hf_identity;

typedef struct {
  hf_port port;                /* Copied. */
  const void* page;            /* HF_PAGE_BYTES; copied. Null, or one that is damaged: see id. */
  const hf_identity* identity; /* Null: as the page says. */
  uint32_t id; /* hf_id(), instead of the page's, and a module without a page waits until it is told
                  its robot's numbers at a face (holdfast tell); 0: the page is needed. */
  void* keep; /* HF_KEEP_BYTES that a reset leaves alone, for plans; null: a reset forgets them. */
} hf_config;

typedef enum { HF_NONE, HF_SAFE, HF_OVERLOAD, HF_UNSTABLE, HF_UNDECIDED } hf_verdict;

/* What the module has come to. */
typedef struct {
  uint32_t step_count;
  uint32_t plan_count;     /* Told to this module and not ended. */
  uint8_t verdict;         /* hf_verdict; HF_NONE while it is being worked out. */
  uint8_t reason;          /* hf_reason_name() */
  uint8_t phase;           /* Of the computation. */
  uint8_t worst_direction; /* The worst connection: from worst_cell through this face. */
  float load_ratio_max;    /* Not meaningful if unstable or undecided. */
  int32_t worst_cell[3];
  float own_load_ratio; /* The largest of this module's own connections. */
  hf_colour colour;
  uint32_t epoch; /* Of the round. */
} hf_status;

/* How much memory a module takes. */
size_t hf_size(void);

/* Makes a module in memory of `size` bytes and starts it. Null: the memory is too small or not
   aligned to 8, or the page is damaged or of another version. */
hf_module* hf_init(void* memory, size_t size, const hf_config* config);

/* Takes what has come in on a face: bytes, or with `is_connected` one whole packet. Returns how
   many bytes were taken; those that find no room are lost, and the neighbour repeats them. */
size_t hf_receive(hf_module* module, int face, const uint8_t* bytes, size_t size);

/* Does what there is to do. Returns the microseconds after which to call it again, if nothing comes
   in and no line becomes free before; 0: at once, as work is left. */
uint32_t hf_poll(hf_module* module);

/* Tells the robot, through this module, that one is planned at a cell, or no more, or none at all.
   Any module will do. */
void hf_plan(hf_module* module, int32_t x, int32_t y, int32_t z);
void hf_withdraw(hf_module* module, int32_t x, int32_t y, int32_t z);
void hf_withdraw_all(hf_module* module);

/* Tells the module itself that it sits in a cell and is the anchor, or whether it is held from
   outside. It keeps that with its page, and starts anew at the next hf_poll(). */
void hf_set_anchor(hf_module* module, int32_t x, int32_t y, int32_t z);
void hf_set_fixed(hf_module* module, bool is_fixed);

/* An id from the chip's unique number, never 0. */
uint32_t hf_id(const void* unique_number, size_t size);

/* Up to date after each hf_poll(). */
const hf_status* hf_get_status(const hf_module* module);

const char* hf_verdict_name(uint8_t verdict);
const char* hf_reason_name(uint8_t reason);

/* Defined by the firmware: a check of the program's has failed, which is a bug. Must not return:
   show it, and let the watchdog start the module again. Who links libholdfast, on a host, has no
   need of it: that prints what it is and aborts. */
void hf_panic(const char* condition, const char* file, int line);

#ifdef __cplusplus
}
#endif

#endif
