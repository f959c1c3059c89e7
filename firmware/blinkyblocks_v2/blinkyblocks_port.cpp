// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The module's program as an application of Blinky Blocks 2's own library, which keeps lines,
// frames and hellos. It compiles against blinkyblocks.h here; it has never been on a block.
//
// A message is two bytes, kind and size, then the payload. send_message() does not bound the size
// and drops silently what finds no buffer: so packets are 226 bytes at most (Setup::timing), one
// goes out on a line only when the last one must be through, and what is dropped the links repeat.
#include <array>
#include <new>

#include "blinkyblocks.h"
#include "holdfast/base/check.hpp"
#include "holdfast/module/module.hpp"

extern "C" const holdfast::module::Configuration holdfast_configuration;

namespace holdfast::blinkyblocks {
namespace {

using module::Time;

constexpr int kHeaderBytes = 2;
constexpr int kMessageBytesMax = 228;

/// The library's port by face, +x right, -x left, +y back, -y front, +z top, -z bottom.
constexpr std::array<std::uint8_t, base::kDirectionCount> kPorts = {2, 3, 4, 0, 5, 1};

int face_of(std::uint8_t port) {
  int face = 0;
  while (face < base::kDirectionCount && kPorts[static_cast<std::size_t>(face)] != port) {
    ++face;
  }
  return face;
}

// The library's palette, by number.
constexpr std::uint8_t kRed = 0;
constexpr std::uint8_t kOrange = 1;
constexpr std::uint8_t kGreen = 3;
constexpr std::uint8_t kBlue = 5;
constexpr std::uint8_t kPurple = 6;
constexpr std::uint8_t kWhite = 8;
constexpr std::uint8_t kDark = 9;

std::uint8_t palette(const agent::Colour& colour) {
  const bool has_red = colour.red > 127;
  const bool has_green = colour.green > 127;
  if (colour.blue > 127) {
    return has_red ? (has_green ? kWhite : kPurple) : kBlue;
  }
  return has_red ? (colour.green > 63 ? kOrange : kRed) : has_green ? kGreen : kDark;
}

class BlinkyBlocksPort final : public module::Port {
 public:
  Time now() override {
    const std::uint32_t low = HAL_GetTick();
    high_ += low < low_ ? 1U : 0U;
    low_ = low;
    return (Time{high_} << 32U | low) * 1000;
  }

  /// Differs by block, time and call.
  std::uint16_t random() override {
    seed_ = (seed_ + get_id() + HAL_GetTick()) * 0x9e3779b1U + 1;
    return static_cast<std::uint16_t>(seed_ >> 16U);
  }

  bool receive(module::Incoming& incoming) override {
    if (read_ == written_) {
      return false;
    }
    const Message& message = messages_[read_ % kMessageCount];
    read_ = read_ + 1;
    incoming = {.face = message.face,
                .kind = static_cast<module::FrameKind>(message.bytes[0]),
                .payload = std::span(message.bytes).subspan(kHeaderBytes, message.bytes[1])};
    return true;
  }

  bool is_connected(int face) override {
    return ::is_connected(kPorts[static_cast<std::size_t>(face)]) != 0;
  }

  bool is_line_free(int face) override { return now() >= free_at_[static_cast<std::size_t>(face)]; }

  void send(int face, std::span<const std::uint8_t> packet) override {
    HOLDFAST_CHECK(packet.size() <= kMessageBytesMax - kHeaderBytes);
    out_[0] = static_cast<std::uint8_t>(module::FrameKind::kPacket);
    out_[1] = static_cast<std::uint8_t>(packet.size());
    for (std::size_t i = 0; i < packet.size(); ++i) {
      out_[kHeaderBytes + i] = packet[i];
    }
    const auto size = static_cast<std::uint16_t>(kHeaderBytes + packet.size());
    send_message(kPorts[static_cast<std::size_t>(face)], out_.data(), size, 0);
    constexpr Time kByte = 87;  // Microseconds, at 115,200 baud
    free_at_[static_cast<std::size_t>(face)] = now() + (size + 8U) * kByte;
  }

  void show(const agent::Colour& colour) override {
    const std::uint8_t shown = palette(colour);
    if (shown != shown_) {
      shown_ = shown;
      setColor(shown);
    }
  }

  /// BBloop() is called again and again.
  void wait(Time) override {}

  /// Takes a message from the library's handler. When all places are taken it is dropped; links
  /// repeat it.
  void take(const L3_packet& packet) {
    const int face = face_of(packet.io_port);
    const int size = packet.packet_content[1];
    if (face == base::kDirectionCount || size > kMessageBytesMax - kHeaderBytes ||
        written_ - read_ == kMessageCount) {
      return;
    }
    Message& message = messages_[written_ % kMessageCount];
    message.face = static_cast<std::uint8_t>(face);
    for (int i = 0; i < kHeaderBytes + size; ++i) {
      message.bytes[static_cast<std::size_t>(i)] = packet.packet_content[i];
    }
    written_ = written_ + 1;
  }

 private:
  static constexpr unsigned kMessageCount = 8;

  struct Message {
    std::uint8_t face;
    std::array<std::uint8_t, kMessageBytesMax> bytes;
  };

  std::array<Message, kMessageCount> messages_;
  volatile unsigned read_ = 0;
  volatile unsigned written_ = 0;
  std::array<std::uint8_t, kMessageBytesMax> out_;
  std::array<Time, base::kDirectionCount> free_at_{};
  std::uint32_t high_ = 0;
  std::uint32_t low_ = 0;
  std::uint32_t seed_ = 0;
  std::uint8_t shown_ = 0xff;
};

// Storage without constructors that would run before BBinit().
alignas(BlinkyBlocksPort) std::byte port_storage[sizeof(BlinkyBlocksPort)];
alignas(module::Module) std::byte module_storage[sizeof(module::Module)];
[[gnu::section(".keep")]] module::PlanMemory plans;
BlinkyBlocksPort* port = nullptr;
module::Module* program = nullptr;

}  // namespace
}  // namespace holdfast::blinkyblocks

void holdfast::base::panic(const char*, const char*, int) {
  for (;;) {
  }
}

void BBinit() {
  using namespace holdfast;
  blinkyblocks::port = new (blinkyblocks::port_storage) blinkyblocks::BlinkyBlocksPort();
  if (module::is_valid(holdfast_configuration)) {
    blinkyblocks::program = new (blinkyblocks::module_storage)
        module::Module(holdfast_configuration.setup, holdfast_configuration.identity,
                       blinkyblocks::plans, *blinkyblocks::port);
  }
}

void BBloop() {
  if (holdfast::blinkyblocks::program != nullptr) {
    holdfast::blinkyblocks::program->run_once();
  }
}

uint8_t process_standard_packet(L3_packet* packet) {
  if (packet != nullptr && holdfast::blinkyblocks::port != nullptr) {
    holdfast::blinkyblocks::port->take(*packet);
  }
  return 0;
}
