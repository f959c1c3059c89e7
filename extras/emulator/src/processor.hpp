// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "cycles.hpp"
#include "holdfast/emulator/image.hpp"

struct uc_struct;

namespace holdfast::emulator {

/// What a processor's loads and stores beyond memory reach.
class Peripherals {
 public:
  virtual ~Peripherals() = default;
  virtual std::uint32_t read(std::uint32_t address) = 0;
  virtual void write(std::uint32_t address, std::uint32_t value) = 0;
  /// Loads and stores of the flash that the program writes; offsets are from its beginning.
  virtual std::uint32_t read_flash(std::uint32_t offset, unsigned size) = 0;
  virtual void write_flash(std::uint32_t offset, std::uint32_t value, unsigned size) = 0;
};

/// Is called when the program enters a function, and when it returns from it.
class Watcher {
 public:
  virtual ~Watcher() = default;
  virtual void entered(std::span<const std::uint32_t, 4> arguments) = 0;
  virtual void left() = 0;
};

/// A Cortex-M0 with the memory of an STM32F091, run by Unicorn, with a count of its cycles.
class Processor {
 public:
  static constexpr std::uint32_t kFlashBegin = 0x08000000;
  static constexpr std::uint32_t kFlashBytes = 256 * 1024;  ///< Of the largest.
  static constexpr std::uint32_t kRamBegin = 0x20000000;
  static constexpr std::uint32_t kRamBytes = 32 * 1024;
  static constexpr std::uint32_t kUniqueNumber = 0x1FFFF7AC;  ///< 12 bytes; RM0091, 33.1.

  /// Keeps references to all but the image, and the address of the function to watch.
  Processor(const Image& image, CostTable& costs, Peripherals& peripherals, Watcher& watcher,
            std::uint32_t watched);
  Processor(const Processor&) = delete;
  Processor& operator=(const Processor&) = delete;
  ~Processor();

  /// Starts the program again as the reset pin does: memory stays as it is.
  void reset();

  /// Goes on elsewhere, as when an exception is taken.
  void jump(std::uint32_t address);

  /// Runs until the clock shows `limit` or later, or stop() is called. False: the program did what
  /// no program may, and the processor has locked up.
  bool run(Cycles limit);

  /// Ends run() after the instruction that called a peripheral.
  void stop();

  Cycles now() const { return cycles_; }

  /// Lets time pass while the program waits.
  void skip_to(Cycles time) { cycles_ = time; }

  void read(std::uint32_t address, std::span<std::uint8_t> bytes) const;
  void write(std::uint32_t address, std::span<const std::uint8_t> bytes);
  std::uint32_t word(std::uint32_t address) const;

 private:
  struct Callbacks;

  void enter_block(std::uint64_t address, std::uint32_t size);
  void learn(std::uint64_t address, std::uint32_t size, BlockCost& cost) const;

  CostTable& costs_;
  Peripherals& peripherals_;
  Watcher& watcher_;
  std::uint32_t watched_;
  std::uint32_t vectors_;
  uc_struct* engine_ = nullptr;
  Cycles cycles_ = 0;
  Cycles limit_ = 0;
  std::uint64_t next_ = 0;      ///< Where the last block goes on if its branch is not taken, ...
  std::uint32_t if_taken_ = 0;  ///< ... and what it costs if it is.
  std::uint32_t return_ = 0;    ///< The watched function will return to here.
  std::uint32_t program_counter_ = 0;
};

}  // namespace holdfast::emulator
