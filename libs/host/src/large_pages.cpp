// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/host/large_pages.hpp"

#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

// A sanitizer brings an allocator of its own, which would write to all that it is asked for.
#if defined(__SANITIZE_ADDRESS__)
#define HOLDFAST_HAS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define HOLDFAST_HAS_SANITIZER
#endif
#endif

namespace holdfast::host {

// The heap is stretched over half of the machine's memory at once, marked, and given back to the
// allocator, which is told never to give it back to the system: addresses, not memory.
void use_large_pages() {
#if defined(__GLIBC__) && !defined(HOLDFAST_HAS_SANITIZER)
  constexpr std::size_t kPage = std::size_t{2} << 20U;
  const auto memory = static_cast<std::size_t>(sysconf(_SC_PHYS_PAGES)) *
                      static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, -1);
  void* const heap = std::malloc(memory / 2);
  if (heap != nullptr) {
    const auto address = reinterpret_cast<std::uintptr_t>(heap);
    char* const begin = static_cast<char*>(heap) + (kPage - address % kPage);
    madvise(begin, (memory / 2 & ~(kPage - 1)) - kPage, MADV_HUGEPAGE);
    std::free(heap);
  }
#endif
}

}  // namespace holdfast::host
