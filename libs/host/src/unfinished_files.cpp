// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "unfinished_files.hpp"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>

namespace holdfast::host::unfinished_files {
namespace {

constexpr std::size_t kSlotCount = 16;
constexpr std::size_t kNameBytesMax = 4096;

/// Storage that is never freed: a handler may look at it at any time.
struct Slot {
  std::atomic<bool> is_taken{false};
  std::atomic<bool> has_name{false};
  std::array<char, kNameBytesMax> name{};
};

// Zeroed storage of the program; a handler cannot wait for a function's first call.
std::array<Slot, kSlotCount> slots;

static_assert(std::atomic<bool>::is_always_lock_free, "read in a signal handler");

/// Does only what POSIX allows in a handler. The signal's default action follows: it was restored
/// when the handler was called, and the signal raised here waits for its end.
extern "C" void remove_files(int signal) {
  for (Slot& slot : slots) {
    if (slot.has_name.load(std::memory_order_acquire)) {
      ::unlink(slot.name.data());
    }
  }
  ::raise(signal);
}

}  // namespace

int add(std::string_view name) {
  for (std::size_t i = 0; i < kSlotCount && name.size() < kNameBytesMax; ++i) {
    Slot& slot = slots[i];
    if (!slot.is_taken.exchange(true)) {
      name.copy(slot.name.data(), name.size());
      slot.name[name.size()] = '\0';
      slot.has_name.store(true, std::memory_order_release);
      return static_cast<int>(i);
    }
  }
  return -1;
}

void remove(int slot) {
  if (slot >= 0) {
    slots[static_cast<std::size_t>(slot)].has_name.store(false, std::memory_order_release);
    slots[static_cast<std::size_t>(slot)].is_taken.store(false);
  }
}

void watch_signals() {
  for (const int signal : {SIGHUP, SIGINT, SIGPIPE, SIGQUIT, SIGTERM, SIGXCPU, SIGXFSZ}) {
    struct sigaction old {};

    if (::sigaction(signal, nullptr, &old) == 0 && old.sa_handler == SIG_DFL) {
      struct sigaction action {};

      action.sa_handler = remove_files;
      action.sa_flags = static_cast<int>(SA_RESETHAND);
      ::sigaction(signal, &action, nullptr);
    }
  }
}

}  // namespace holdfast::host::unfinished_files
