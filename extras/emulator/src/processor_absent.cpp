// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// In place of processor.cpp where Unicorn is not installed: emulation says so and is never begun.
#include "holdfast/base/check.hpp"
#include "holdfast/emulator/emulation.hpp"
#include "processor.hpp"

namespace holdfast::emulator {

bool is_available() { return false; }

Processor::Processor(const Image&, CostTable& costs, Peripherals& peripherals, Watcher& watcher,
                     std::uint32_t watched)
    : costs_(costs), peripherals_(peripherals), watcher_(watcher), watched_(watched), vectors_(0) {
  base::panic("is_available()", __FILE__, __LINE__);
}

Processor::~Processor() = default;

void Processor::reset() {}

void Processor::jump(std::uint32_t) {}

bool Processor::run(Cycles) { return false; }

void Processor::stop() {}

void Processor::read(std::uint32_t, std::span<std::uint8_t>) const {}

void Processor::write(std::uint32_t, std::span<const std::uint8_t>) {}

std::uint32_t Processor::word(std::uint32_t) const { return 0; }

}  // namespace holdfast::emulator
