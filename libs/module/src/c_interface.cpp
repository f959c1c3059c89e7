// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// holdfast.h on a Module. Two ports: lines of bytes, and lines of packets.
#include <cstddef>
#include <new>

#include "holdfast.h"
#include "holdfast/module/program.hpp"
#include "holdfast/module/serial_port.hpp"

namespace holdfast::module {
namespace {

/// hf_poll() is called at least as often, so that a clock of 32 bits is never lost track of.
constexpr Time kLongestPause = 1'000'000;

/// What the board's functions give, as both ports need it.
class Board {
 public:
  explicit Board(const hf_port& port) : port_(port), time_(port.now(port.context)) {}

  /// A clock that goes back a little, as one does whose counter has counted over before its
  /// interrupt was taken, stands still instead.
  Time now() {
    const std::uint32_t since = port_.now(port_.context) - static_cast<std::uint32_t>(time_);
    time_ += since < 0x80000000U ? since : 0;
    return time_;
  }

  std::uint16_t random() { return port_.random(port_.context); }

  bool is_line_free(int face) { return port_.is_line_free(port_.context, face); }

  bool is_connected(int face) { return port_.is_connected(port_.context, face); }

  void send(int face, const std::uint8_t* bytes, std::size_t size) {
    port_.send(port_.context, face, bytes, size);
  }

  Health health() {
    const std::size_t stack = port_.stack_bytes == nullptr ? 0 : port_.stack_bytes(port_.context);
    constexpr std::size_t kMost = 0xffff;
    return {.reset_reason = port_.reset_reason,
            .stack_bytes = static_cast<std::uint16_t>(stack < kMost ? stack : kMost)};
  }

  void keep(std::span<const std::uint8_t> page) {
    if (port_.keep_page != nullptr) {
      port_.keep_page(port_.context, page.data());
    }
  }

  void show(const agent::Colour& colour) {
    if (port_.show != nullptr && !(was_shown_ && colour == shown_)) {
      port_.show(port_.context, {colour.red, colour.green, colour.blue, colour.blinks});
    }
    was_shown_ = true;
    shown_ = colour;
  }

 private:
  hf_port port_;
  Time time_;
  bool was_shown_ = false;
  agent::Colour shown_;
};

/// Bytes from an interrupt, or from anywhere, to the program: one writes, one reads.
class Ring {
 public:
  std::size_t room() const { return kBytes - used(); }

  bool is_empty() const { return used() == 0; }

  void put(std::uint8_t byte) {
    const std::uint16_t at = written_;
    bytes_[at % kBytes] = byte;
    written_ = static_cast<std::uint16_t>(at + 1);
  }

  std::uint8_t take() {
    const std::uint16_t at = read_;
    const std::uint8_t byte = bytes_[at % kBytes];
    read_ = static_cast<std::uint16_t>(at + 1);
    return byte;
  }

  /// Takes bytes that were put one by one at once: the reader sees all of them or none.
  void put(std::uint8_t first, std::span<const std::uint8_t> rest) {
    std::uint16_t at = written_;
    bytes_[at % kBytes] = first;
    for (const std::uint8_t byte : rest) {
      bytes_[++at % kBytes] = byte;
    }
    written_ = static_cast<std::uint16_t>(at + 1);
  }

 private:
  /// 44 ms of 115,200 baud, or two of the largest packets. A power of two.
  static constexpr std::size_t kBytes = 512;

  std::size_t used() const { return static_cast<std::uint16_t>(written_ - read_); }

  volatile std::uint16_t written_ = 0;
  volatile std::uint16_t read_ = 0;
  std::array<volatile std::uint8_t, kBytes> bytes_;
};

using Rings = std::array<Ring, base::kDirectionCount>;

class ByteLines final : public SerialPort {
 public:
  explicit ByteLines(const hf_port& port) : board_(port) {}

  Time now() override { return board_.now(); }

  std::uint16_t random() override { return board_.random(); }

  bool is_line_free(int face) override { return board_.is_line_free(face); }

  void show(const agent::Colour& colour) override { board_.show(colour); }

  Health health() override { return board_.health(); }

  void keep(std::span<const std::uint8_t> page) override { board_.keep(page); }

  std::size_t take(int face, std::span<const std::uint8_t> bytes) {
    Ring& ring = rings_[static_cast<std::size_t>(face)];
    std::size_t taken = 0;
    while (taken < bytes.size() && ring.room() > 0) {
      ring.put(bytes[taken++]);
    }
    return taken;
  }

  Time until() const { return until_; }

 private:
  bool read(int face, std::uint8_t& byte) override {
    Ring& ring = rings_[static_cast<std::size_t>(face)];
    if (ring.is_empty()) {
      return false;
    }
    byte = ring.take();
    return true;
  }

  std::span<std::uint8_t, kFrameBytesMax> buffer(int face) override {
    return frames_[static_cast<std::size_t>(face)];
  }

  void transmit(int face, int size) override {
    board_.send(face, buffer(face).data(), static_cast<std::size_t>(size));
  }

  void sleep(Time until) override { until_ = until; }

  Board board_;
  Time until_ = 0;
  Rings rings_;
  std::array<std::array<std::uint8_t, kFrameBytesMax>, base::kDirectionCount> frames_;
};

class PacketLines final : public Port {
 public:
  explicit PacketLines(const hf_port& port) : board_(port) {}

  Time now() override { return board_.now(); }

  std::uint16_t random() override { return board_.random(); }

  bool is_line_free(int face) override { return board_.is_line_free(face); }

  bool is_connected(int face) override { return board_.is_connected(face); }

  void show(const agent::Colour& colour) override { board_.show(colour); }

  Health health() override { return board_.health(); }

  void keep(std::span<const std::uint8_t> page) override { board_.keep(page); }

  bool receive(Incoming& incoming) override {
    for (int i = 0; i < base::kDirectionCount; ++i) {
      const int face = next_;
      next_ = next_ + 1 == base::kDirectionCount ? 0 : next_ + 1;
      Ring& ring = rings_[static_cast<std::size_t>(face)];
      if (ring.is_empty()) {
        continue;
      }
      const std::size_t size = ring.take();
      for (std::size_t k = 0; k < size; ++k) {
        in_[k] = ring.take();
      }
      incoming = {.face = face,
                  .kind = FrameKind::kPacket,
                  .payload = std::span<const std::uint8_t>(in_).first(size)};
      return true;
    }
    return false;
  }

  void send(int face, std::span<const std::uint8_t> packet) override {
    std::array<std::uint8_t, kPayloadBytesMax>& out = out_[static_cast<std::size_t>(face)];
    for (std::size_t i = 0; i < packet.size(); ++i) {
      out[i] = packet[i];
    }
    board_.send(face, out.data(), packet.size());
  }

  void wait(Time until) override { until_ = until; }

  std::size_t take(int face, std::span<const std::uint8_t> packet) {
    Ring& ring = rings_[static_cast<std::size_t>(face)];
    if (packet.empty() || packet.size() > in_.size() || ring.room() < packet.size() + 1) {
      return 0;
    }
    ring.put(static_cast<std::uint8_t>(packet.size()), packet);
    return packet.size();
  }

  Time until() const { return until_; }

 private:
  Board board_;
  Time until_ = 0;
  int next_ = 0;  ///< The face to look at first, so that all have their turn.
  Rings rings_;
  std::array<std::uint8_t, kPayloadBytesMax> in_;
  std::array<std::array<std::uint8_t, kPayloadBytesMax>, base::kDirectionCount> out_;
};

constexpr std::size_t larger(std::size_t a, std::size_t b) { return a > b ? a : b; }

/// Who the module is and what it knows; false: it neither has a page nor may wait for one.
bool take_page(const hf_config& config, Configuration& configuration) {
  auto* const to = reinterpret_cast<std::uint8_t*>(&configuration);
  for (std::size_t i = 0; config.page != nullptr && i < kConfigurationBytes; ++i) {
    to[i] = static_cast<const std::uint8_t*>(config.page)[i];
  }
  if (!is_valid(configuration)) {
    return config.id != 0;
  }
  agent::prepare(configuration.setup);  // What the page has no room for.
  if (config.identity != nullptr) {
    const hf_identity& own = *config.identity;
    configuration.identity = {.id = own.id,
                              .is_fixed = own.is_fixed,
                              .is_anchor = own.is_anchor,
                              .cell = {own.x, own.y, own.z}};
    configuration.checksum = checksum_of(configuration);
  }
  return true;
}

}  // namespace
}  // namespace holdfast::module

namespace hfm = holdfast::module;

/// All that one module is; the port and the program in memory of their own, as they are made last.
struct hf_module {
  hfm::Configuration configuration;
  hfm::PlanMemory plans;
  hfm::ByteLines* bytes = nullptr;  ///< One of these two.
  hfm::PacketLines* packets = nullptr;
  hfm::Program* program = nullptr;
  alignas(8) std::byte port[hfm::larger(sizeof(hfm::ByteLines), sizeof(hfm::PacketLines))];
  alignas(8) std::byte module[sizeof(hfm::Program)];
};

// holdfast.h says the same as the program.
static_assert(sizeof(hf_module) <= HF_BYTES && alignof(hf_module) <= 8);
static_assert(sizeof(hfm::PlanMemory) <= HF_KEEP_BYTES && alignof(hfm::PlanMemory) <= 8);
static_assert(holdfast::agent::wire::kPacketBytesMax == HF_PACKET_BYTES);
static_assert(holdfast::base::kDirectionCount == HF_FACES);
static_assert(HF_SAFE == static_cast<int>(holdfast::agent::Verdict::kSafe) &&
              HF_UNDECIDED == static_cast<int>(holdfast::agent::Verdict::kUndecided));
#ifndef __AVR__
static_assert(hfm::kConfigurationBytes == HF_PAGE_BYTES);
static_assert(sizeof(hf_status) == sizeof(hfm::Status) &&
              offsetof(hf_status, verdict) == offsetof(hfm::Status, verdict) &&
              offsetof(hf_status, reason) == offsetof(hfm::Status, reason) &&
              offsetof(hf_status, worst_direction) == offsetof(hfm::Status, worst_direction) &&
              offsetof(hf_status, load_ratio_max) == offsetof(hfm::Status, load_ratio_max) &&
              offsetof(hf_status, worst_cell) == offsetof(hfm::Status, worst_cell) &&
              offsetof(hf_status, own_load_ratio) == offsetof(hfm::Status, own_load_ratio) &&
              offsetof(hf_status, colour) == offsetof(hfm::Status, colour) &&
              offsetof(hf_status, epoch) == offsetof(hfm::Status, epoch));
#endif

extern "C" {

size_t hf_size(void) { return sizeof(hf_module); }

hf_module* hf_init(void* memory, size_t size, const hf_config* config) {
  if (memory == nullptr || size < sizeof(hf_module) ||
      reinterpret_cast<std::uintptr_t>(memory) % 8 != 0) {
    return nullptr;
  }
  auto* const self = new (memory) hf_module;
  if (!hfm::take_page(*config, self->configuration)) {
    return nullptr;
  }
  hfm::Port* port = nullptr;
  if (config->port.is_connected == nullptr) {
    port = self->bytes = new (self->port) hfm::ByteLines(config->port);
  } else {
    port = self->packets = new (self->port) hfm::PacketLines(config->port);
  }
  auto& plans =
      config->keep == nullptr ? self->plans : *static_cast<hfm::PlanMemory*>(config->keep);
  self->program = new (self->module) hfm::Program(self->configuration, config->id, plans, *port);
  return self;
}

size_t hf_receive(hf_module* module, int face, const uint8_t* bytes, size_t size) {
  if (face < 0 || face >= HF_FACES) {
    return 0;
  }
  const std::span<const std::uint8_t> in(bytes, size);
  return module->bytes != nullptr ? module->bytes->take(face, in) : module->packets->take(face, in);
}

uint32_t hf_poll(hf_module* module) {
  module->program->run_once();
  const bool is_serial = module->bytes != nullptr;
  const hfm::Time until = is_serial ? module->bytes->until() : module->packets->until();
  const hfm::Time now = is_serial ? module->bytes->now() : module->packets->now();
  const hfm::Time rest = until > now ? until - now : 0;
  return static_cast<uint32_t>(rest < hfm::kLongestPause ? rest : hfm::kLongestPause);
}

void hf_plan(hf_module* module, int32_t x, int32_t y, int32_t z) {
  module->program->plan({x, y, z});
}

void hf_withdraw(hf_module* module, int32_t x, int32_t y, int32_t z) {
  module->program->withdraw({x, y, z});
}

void hf_withdraw_all(hf_module* module) { module->program->withdraw(holdfast::agent::kEveryCell); }

void hf_set_anchor(hf_module* module, int32_t x, int32_t y, int32_t z) {
  module->program->tell_who({.what = hfm::Who::What::kAnchor, .cell = {x, y, z}});
}

void hf_set_fixed(hf_module* module, bool is_fixed) {
  module->program->tell_who(
      {.what = is_fixed ? hfm::Who::What::kFixed : hfm::Who::What::kFree, .cell = {}});
}

uint32_t hf_id(const void* unique_number, size_t size) {
  return hfm::id_of({static_cast<const std::uint8_t*>(unique_number), size});
}

const hf_status* hf_get_status(const hf_module* module) {
  return reinterpret_cast<const hf_status*>(&module->program->status());
}

const char* hf_verdict_name(uint8_t verdict) {
  return holdfast::agent::name(static_cast<holdfast::agent::Verdict>(verdict));
}

const char* hf_reason_name(uint8_t reason) {
  return reason < holdfast::agent::kReasonCount
             ? holdfast::agent::name(static_cast<holdfast::agent::Reason>(reason))
             : "not known to this program";
}
}
