// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What large robots take of memory, counted where it is allocated: the same on every machine. The
// limits are those of docs/evidence/solver.md, where they are measured on larger robots.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>
#include <ostream>
#include <string>

#include "holdfast/holdfast.hpp"

namespace {

std::atomic<std::size_t> live = 0;
std::atomic<std::size_t> most = 0;

void* counted(void* memory) {
  if (memory == nullptr) {
    throw std::bad_alloc();
  }
  const std::size_t now = live += malloc_usable_size(memory);
  std::size_t before = most;
  while (now > before && !most.compare_exchange_weak(before, now)) {
  }
  return memory;
}

void give_back(void* memory) {
  live -= memory == nullptr ? 0 : malloc_usable_size(memory);
  std::free(memory);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }

// The library's own calls the one above, but a sanitizer's does not.
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  try {
    return operator new(size);
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto unit = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(unit, (size + unit - 1) / unit * unit));
}

void operator delete(void* memory) noexcept { give_back(memory); }

void operator delete(void* memory, std::size_t /*size*/) noexcept { give_back(memory); }

void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { give_back(memory); }

void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  give_back(memory);
}

namespace holdfast {
namespace {

/// The most bytes a module that `work` takes at a time, beyond what there is already.
template <class Work>
std::size_t bytes_per_module(std::size_t module_count, const Work& work) {
  const std::size_t before = live;
  most = before;
  work();
  return (most - before) / module_count;
}

struct Budget {
  const char* family;
  std::size_t size;
  std::size_t read;  ///< Bytes a module, from the file's text to the robot.
  /// Bytes a module from the robot to the verdict, without the robot itself. Of slender robots most
  /// is for the motions in which they might buckle.
  std::size_t assess;
};

std::ostream& operator<<(std::ostream& out, const Budget& budget) {
  return out << budget.family << ' ' << budget.size;
}

class Memory : public testing::TestWithParam<Budget> {};

TEST_P(Memory, of_a_check_stays_within_its_budget) {
  const Budget& budget = GetParam();
  const auto family = generate(budget.family, budget.size).value();
  const std::string text = io::write_json(family);
  const std::size_t count = family.modules.size();
  std::optional<Structure> structure;
  const auto read = [&] { structure.emplace(load_text(text, budget.family, 1).value()); };
  const auto assess = [&] { check(structure->robot, {.thread_count = 1}); };
  EXPECT_LE(bytes_per_module(count, read), budget.read);
  EXPECT_LE(bytes_per_module(count, assess), budget.assess);
}

INSTANTIATE_TEST_SUITE_P(
    Families, Memory,
    testing::Values(Budget{"cube", 37, 216, 222}, Budget{"scaffold", 61, 195, 168},
                    Budget{"ball", 46, 198, 383}, Budget{"tower", 6000, 212, 1100},
                    Budget{"portal", 2002, 212, 1070}, Budget{"portal", 5002, 212, 1090},
                    Budget{"growth", 50000, 215, 349}),
    [](const auto& one) { return one.param.family + std::to_string(one.param.size); });

}  // namespace
}  // namespace holdfast
