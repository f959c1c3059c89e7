// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "processor.hpp"

#include <dlfcn.h>
#include <unicorn/unicorn.h>

#include <array>
#include <type_traits>

#include "flash_memory.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/emulator/emulation.hpp"

namespace holdfast::emulator {
namespace {

/// Peripherals of the buses APB and AHB1, ports of AHB2 (RM0091, 2.2.2), and the processor's own
/// (ARMv6-M, B3.2), which do nothing, as no program here has interrupts.
struct Window {
  std::uint32_t begin;
  std::uint32_t size;
};

constexpr std::array<Window, 3> kWindows = {
    {{0x40000000, 0x24000}, {0x48000000, 0x2000}, {0xE000E000, 0x1000}}};

/// What is called of Unicorn, by its own names. To load its library takes 4 ms, longer than most
/// checks, so that is left until somebody emulates.
struct Library {
  decltype(&::uc_open) uc_open = nullptr;
  decltype(&::uc_close) uc_close = nullptr;
  decltype(&::uc_ctl) uc_ctl = nullptr;
  decltype(&::uc_emu_start) uc_emu_start = nullptr;
  decltype(&::uc_emu_stop) uc_emu_stop = nullptr;
  decltype(&::uc_hook_add) uc_hook_add = nullptr;
  decltype(&::uc_mem_map) uc_mem_map = nullptr;
  decltype(&::uc_mem_read) uc_mem_read = nullptr;
  decltype(&::uc_mem_write) uc_mem_write = nullptr;
  decltype(&::uc_mmio_map) uc_mmio_map = nullptr;
  decltype(&::uc_reg_read) uc_reg_read = nullptr;
  decltype(&::uc_reg_write) uc_reg_write = nullptr;
  bool is_there = false;
};

Library load() {
  Library library;
  void* const handle = dlopen("libunicorn.so.2", RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    return library;
  }
  const auto take = [handle](const char* name, auto& function) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(dlsym(handle, name));
    return function != nullptr;
  };
  library.is_there =
      take("uc_open", library.uc_open) && take("uc_close", library.uc_close) &&
      take("uc_ctl", library.uc_ctl) && take("uc_emu_start", library.uc_emu_start) &&
      take("uc_emu_stop", library.uc_emu_stop) && take("uc_hook_add", library.uc_hook_add) &&
      take("uc_mem_map", library.uc_mem_map) && take("uc_mem_read", library.uc_mem_read) &&
      take("uc_mem_write", library.uc_mem_write) && take("uc_mmio_map", library.uc_mmio_map) &&
      take("uc_reg_read", library.uc_reg_read) && take("uc_reg_write", library.uc_reg_write);
  return library;
}

const Library& unicorn() {
  static const Library kLibrary = load();
  return kLibrary;
}

void check(uc_err error) { HOLDFAST_CHECK(error == UC_ERR_OK); }

std::uint32_t register_of(uc_engine* engine, int name) {
  std::uint32_t value = 0;
  check(unicorn().uc_reg_read(engine, name, &value));
  return value;
}

}  // namespace

bool is_available() { return unicorn().is_there; }

/// Unicorn's callbacks are C functions.
struct Processor::Callbacks {
  static void block(uc_engine*, std::uint64_t address, std::uint32_t size, void* self) {
    static_cast<Processor*>(self)->enter_block(address, size);
  }

  template <std::size_t Index>
  static std::uint64_t read(uc_engine*, std::uint64_t offset, unsigned, void* self) {
    return static_cast<Processor*>(self)->peripherals_.read(kWindows[Index].begin +
                                                            static_cast<std::uint32_t>(offset));
  }

  template <std::size_t Index>
  static void write(uc_engine*, std::uint64_t offset, unsigned, std::uint64_t value, void* self) {
    static_cast<Processor*>(self)->peripherals_.write(
        kWindows[Index].begin + static_cast<std::uint32_t>(offset),
        static_cast<std::uint32_t>(value));
  }

  static std::uint64_t read_flash(uc_engine*, std::uint64_t offset, unsigned size, void* self) {
    return static_cast<Processor*>(self)->peripherals_.read_flash(
        static_cast<std::uint32_t>(offset), size);
  }

  static void write_flash(uc_engine*, std::uint64_t offset, unsigned size, std::uint64_t value,
                          void* self) {
    static_cast<Processor*>(self)->peripherals_.write_flash(
        static_cast<std::uint32_t>(offset), static_cast<std::uint32_t>(value), size);
  }

  /// The flash, as far as the program does not write it.
  static void map_flash(uc_engine* engine, const Image& image, Processor* self) {
    std::uint32_t bytes = image.flash_end() - kFlashBegin;
    if (image.writes_flash()) {
      bytes -= FlashMemory::kBytes;
      check(unicorn().uc_mmio_map(engine, kFlashBegin + bytes, FlashMemory::kBytes, &read_flash,
                                  self, &write_flash, self));
    }
    check(unicorn().uc_mem_map(engine, kFlashBegin, bytes, UC_PROT_READ | UC_PROT_EXEC));
  }

  template <std::size_t Index>
  static void map(uc_engine* engine, Processor* self) {
    check(unicorn().uc_mmio_map(engine, kWindows[Index].begin, kWindows[Index].size, &read<Index>,
                                self, &write<Index>, self));
  }
};

Processor::Processor(const Image& image, CostTable& costs, Peripherals& peripherals,
                     Watcher& watcher, std::uint32_t watched)
    : costs_(costs),
      peripherals_(peripherals),
      watcher_(watcher),
      watched_(watched),
      vectors_(image.at("holdfast_vectors")) {
  check(unicorn().uc_open(UC_ARCH_ARM, static_cast<uc_mode>(UC_MODE_THUMB | UC_MODE_MCLASS),
                          &engine_));
  check(unicorn().uc_ctl_set_cpu_model(engine_, UC_CPU_ARM_CORTEX_M0));
  constexpr std::uint32_t kPageBytes = 4096;
  Callbacks::map_flash(engine_, image, this);
  check(unicorn().uc_mem_map(engine_, kUniqueNumber & ~(kPageBytes - 1), kPageBytes, UC_PROT_READ));
  check(unicorn().uc_mem_map(engine_, kRamBegin, kRamBytes, UC_PROT_READ | UC_PROT_WRITE));
  Callbacks::map<0>(engine_, this);
  Callbacks::map<1>(engine_, this);
  Callbacks::map<2>(engine_, this);
  for (const Image::Segment& segment : image.segments) {
    write(segment.address, segment.bytes);
  }
  uc_hook hook = 0;
  check(unicorn().uc_hook_add(engine_, &hook, UC_HOOK_BLOCK,
                              reinterpret_cast<void*>(&Callbacks::block), static_cast<void*>(this),
                              std::uint64_t{1}, std::uint64_t{0}));
  reset();
}

Processor::~Processor() { unicorn().uc_close(engine_); }

void Processor::reset() {
  const std::uint32_t stack = word(vectors_);
  check(unicorn().uc_reg_write(engine_, UC_ARM_REG_SP, &stack));
  jump(word(vectors_ + 4));
}

void Processor::jump(std::uint32_t address) {
  program_counter_ = address;
  next_ = 0;
  if_taken_ = 0;
  return_ = 0;
}

bool Processor::run(Cycles limit) {
  // No block of this program is here.
  constexpr std::uint64_t kNowhere = 0xfffffffe;
  limit_ = limit;
  const uc_err error = unicorn().uc_emu_start(engine_, program_counter_ | 1U, kNowhere, 0, 0);
  program_counter_ = register_of(engine_, UC_ARM_REG_PC);
  return error == UC_ERR_OK;
}

void Processor::stop() {
  if_taken_ = 0;
  unicorn().uc_emu_stop(engine_);
}

void Processor::enter_block(std::uint64_t address, std::uint32_t size) {
  cycles_ += address == next_ ? 0 : if_taken_;
  if_taken_ = 0;
  if (cycles_ >= limit_) {
    unicorn().uc_emu_stop(engine_);  // Before the block is run; it comes here again.
    return;
  }
  BlockCost fresh;
  BlockCost* known = costs_.find(address);
  BlockCost& cost = known != nullptr ? *known : fresh;
  if (cost.size != size) {
    learn(address, size, cost);
  }
  cycles_ += cost.cycles;
  next_ = address + size;
  if_taken_ = cost.if_taken;
  if (address == return_) {
    return_ = 0;
    watcher_.left();
  } else if (address == watched_) {
    return_ = register_of(engine_, UC_ARM_REG_LR) & ~1U;
    const std::array<std::uint32_t, 4> arguments = {
        register_of(engine_, UC_ARM_REG_R0), register_of(engine_, UC_ARM_REG_R1),
        register_of(engine_, UC_ARM_REG_R2), register_of(engine_, UC_ARM_REG_R3)};
    watcher_.entered(arguments);
  }
}

void Processor::learn(std::uint64_t address, std::uint32_t size, BlockCost& cost) const {
  std::vector<std::uint8_t> code(size);
  read(static_cast<std::uint32_t>(address), code);
  cost = cost_of(code);
}

void Processor::read(std::uint32_t address, std::span<std::uint8_t> bytes) const {
  check(unicorn().uc_mem_read(engine_, address, bytes.data(), bytes.size()));
}

void Processor::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  check(unicorn().uc_mem_write(engine_, address, bytes.data(), bytes.size()));
}

std::uint32_t Processor::word(std::uint32_t address) const {
  std::array<std::uint8_t, 4> bytes{};
  read(address, bytes);
  return static_cast<std::uint32_t>(bytes[0] | bytes[1] << 8 | bytes[2] << 16) |
         static_cast<std::uint32_t>(bytes[3]) << 24;
}

}  // namespace holdfast::emulator
