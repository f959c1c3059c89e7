// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The functions on memory that every compiler may call (GCC manual, "Standards"), small: by words
// where all is aligned, else by bytes. So the firmware needs no C library.
#include <cstddef>
#include <cstdint>

namespace {

/// Words that may stand for anything.
using Word [[gnu::may_alias]] = std::uint32_t;

bool is_aligned(std::uintptr_t bits) { return bits % sizeof(Word) == 0; }

}  // namespace

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size) {
  const auto begin = reinterpret_cast<std::uintptr_t>(to);
  std::size_t done = 0;
  if (is_aligned(begin | reinterpret_cast<std::uintptr_t>(from))) {
    for (; done + sizeof(Word) <= size; done += sizeof(Word)) {
      *reinterpret_cast<Word*>(static_cast<char*>(to) + done) =
          *reinterpret_cast<const Word*>(static_cast<const char*>(from) + done);
    }
  }
  for (; done < size; ++done) {
    static_cast<char*>(to)[done] = static_cast<const char*>(from)[done];
  }
  return to;
}

void* memset(void* to, int value, std::size_t size) {
  const auto byte = static_cast<unsigned char>(value);
  std::size_t done = 0;
  if (is_aligned(reinterpret_cast<std::uintptr_t>(to))) {
    const std::uint32_t word = byte * 0x01010101U;
    for (; done + sizeof(Word) <= size; done += sizeof(Word)) {
      *reinterpret_cast<Word*>(static_cast<char*>(to) + done) = word;
    }
  }
  for (; done < size; ++done) {
    static_cast<unsigned char*>(to)[done] = byte;
  }
  return to;
}

void* memmove(void* to, const void* from, std::size_t size) {
  if (to <= from) {
    return memcpy(to, from, size);
  }
  while (size-- > 0) {
    static_cast<char*>(to)[size] = static_cast<const char*>(from)[size];
  }
  return to;
}

int memcmp(const void* a, const void* b, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) {
    const int difference =
        static_cast<const unsigned char*>(a)[i] - static_cast<const unsigned char*>(b)[i];
    if (difference != 0) {
      return difference;
    }
  }
  return 0;
}
}
