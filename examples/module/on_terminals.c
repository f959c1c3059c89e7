/* SPDX-FileCopyrightText: The holdfast authors
   SPDX-License-Identifier: Apache-2.0

   on_terminals PAGE [FACE=TERMINAL]... [plan=X,Y,Z] [id=N]   one module of a robot as a process: its
   lines are pseudo-terminals, or serial adapters. FACE is 0 to 5 for +x, -x, +y, -y, +z, -z; PAGE is
   what `holdfast emulate FILE --pages FOLDER` writes. With an id the page may be missing: the module
   waits for what `holdfast tell` tells it, and keeps that in PAGE. Prints each verdict that it comes
   to. */
#define _DEFAULT_SOURCE
#include <fcntl.h>
#include <holdfast.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <termios.h>
#include <time.h>
#include <unistd.h>

static const char* page_name;
static struct pollfd lines[HF_FACES]; /* A line that is not there has the number -1. */

static uint32_t now(void* context) {
  (void)context;
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (uint32_t)time.tv_sec * 1000000u + (uint32_t)(time.tv_nsec / 1000);
}

static uint16_t draw(void* context) { return (uint16_t)(now(context) * 2654435761u >> 16); }

static bool is_line_free(void* context, int face) {
  (void)context;
  struct pollfd line = {lines[face].fd, POLLOUT, 0};
  return line.fd >= 0 && poll(&line, 1, 0) == 1 && (line.revents & POLLOUT) != 0;
}

static void send_bytes(void* context, int face, const uint8_t* bytes, size_t size) {
  (void)context;
  if (write(lines[face].fd, bytes, size) != (ssize_t)size) {
    fprintf(stderr, "face %d: not all was sent; the links repeat it\n", face);
  }
}

static void keep_page(void* context, const void* page) {
  (void)context;
  FILE* const file = fopen(page_name, "wb");
  if (file == NULL || fwrite(page, 1, HF_PAGE_BYTES, file) != HF_PAGE_BYTES || fclose(file) != 0) {
    perror(page_name);
  }
}

void hf_panic(const char* condition, const char* file, int line) {
  fprintf(stderr, "%s:%d: %s\n", file, line, condition);
  abort();
}

static int open_line(const char* name) {
  const int line = open(name, O_RDWR | O_NOCTTY);
  struct termios raw;
  if (line < 0 || tcgetattr(line, &raw) != 0) {
    perror(name);
    exit(1);
  }
  cfmakeraw(&raw);
  cfsetspeed(&raw, B115200);
  tcsetattr(line, TCSANOW, &raw);
  return line;
}

int main(int argc, char** argv) {
  static uint64_t memory[HF_BYTES / 8];
  static uint8_t page[HF_PAGE_BYTES];
  unsigned id = 0;
  for (int i = 2; i < argc; ++i) {
    sscanf(argv[i], "id=%u", &id);
  }
  page_name = argc > 1 ? argv[1] : "";
  FILE* const file = fopen(page_name, "rb");
  if ((file == NULL || fread(page, 1, sizeof page, file) != sizeof page) && id == 0) {
    fprintf(stderr, "usage: on_terminals PAGE [FACE=TERMINAL]... [plan=X,Y,Z] [id=N]\n");
    return 64;
  }
  if (file != NULL) {
    fclose(file);
  }
  for (int face = 0; face < HF_FACES; ++face) {
    lines[face] = (struct pollfd){-1, POLLIN, 0};
  }
  const hf_config config = {.port = {.now = now,
                                     .random = draw,
                                     .is_line_free = is_line_free,
                                     .send = send_bytes,
                                     .keep_page = keep_page},
                            .page = page,
                            .id = id};
  hf_module* const module = hf_init(memory, sizeof memory, &config);
  if (module == NULL) {
    fprintf(stderr, "%s: no configuration of this version\n", page_name);
    return 65;
  }
  for (int i = 2; i < argc; ++i) {
    int x, y, z;
    if (sscanf(argv[i], "plan=%d,%d,%d", &x, &y, &z) == 3) {
      hf_plan(module, x, y, z);
    } else if (argv[i][0] >= '0' && argv[i][0] < '0' + HF_FACES && argv[i][1] == '=') {
      lines[argv[i][0] - '0'].fd = open_line(argv[i] + 2);
    }
  }
  uint8_t shown = HF_NONE;
  for (;;) {
    const uint32_t pause_us = hf_poll(module);
    const hf_status* const status = hf_get_status(module);
    if (status->verdict != shown) {
      shown = status->verdict;
      printf("%s %.4f, %s\n", hf_verdict_name(shown), (double)status->load_ratio_max,
             hf_reason_name(status->reason));
      fflush(stdout);
    }
    poll(lines, HF_FACES, (int)((pause_us + 999) / 1000));
    for (int face = 0; face < HF_FACES; ++face) {
      uint8_t bytes[256];
      const ssize_t size =
          (lines[face].revents & POLLIN) == 0 ? 0 : read(lines[face].fd, bytes, sizeof bytes);
      hf_receive(module, face, bytes, size > 0 ? (size_t)size : 0);
    }
  }
}
