// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serial_device.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "holdfast/instrument.hpp"

namespace holdfast::instrument {
namespace {

constexpr std::pair<std::uint32_t, speed_t> kSpeeds[] = {
    {9'600, B9600},     {19'200, B19200},   {38'400, B38400},   {57'600, B57600},
    {115'200, B115200}, {230'400, B230400}, {460'800, B460800}, {921'600, B921600}};

const speed_t* find_speed(std::uint32_t baud) {
  for (const auto& [rate, speed] : kSpeeds) {
    if (rate == baud) {
      return &speed;
    }
  }
  return nullptr;
}

base::Error error_of(const std::string& name, std::string message) {
  return {.code = base::ErrorCode::kUnreadable, .message = std::move(message), .where = name};
}

}  // namespace

base::Result<SerialDevice> SerialDevice::open(const std::string& name, std::uint32_t baud) {
  const speed_t* const speed = find_speed(baud);
  if (speed == nullptr) {
    return base::bad_input(
        fmt::format("unknown rate {}; expected 9600, 19200, 38400, 57600, 115200, 230400, 460800 "
                    "or 921600",
                    baud),
        name);
  }
  SerialDevice device(name, ::open(name.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (device.descriptor_ < 0) {
    return error_of(name, fmt::format("the device cannot be opened: {}", std::strerror(errno)));
  }
  termios raw{};
  if (::tcgetattr(device.descriptor_, &raw) != 0) {
    return error_of(name, "this is no serial device");
  }
  ::cfmakeraw(&raw);
  raw.c_cflag |= CLOCAL | CREAD;
  if (::cfsetspeed(&raw, *speed) != 0 || ::tcsetattr(device.descriptor_, TCSANOW, &raw) != 0) {
    return error_of(name, fmt::format("the device does not take {} baud", baud));
  }
  return device;
}

SerialDevice::SerialDevice(std::string name, int descriptor)
    : name_(std::move(name)), descriptor_(descriptor) {}

SerialDevice::SerialDevice(SerialDevice&& other) noexcept
    : name_(std::move(other.name_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

SerialDevice::~SerialDevice() {
  if (descriptor_ >= 0) {
    ::close(descriptor_);
  }
}

std::size_t SerialDevice::read(std::span<std::uint8_t> bytes, int timeout_ms) {
  pollfd line{.fd = descriptor_, .events = POLLIN, .revents = 0};
  if (::poll(&line, 1, timeout_ms) <= 0) {
    return 0;
  }
  const ssize_t size = ::read(descriptor_, bytes.data(), bytes.size());
  if (size <= 0) {
    // Where the other end has gone, poll() does not wait.
    std::this_thread::sleep_for(std::chrono::milliseconds(timeout_ms));
    return 0;
  }
  return static_cast<std::size_t>(size);
}

void SerialDevice::write(std::span<const std::uint8_t> bytes) {
  pollfd line{.fd = descriptor_, .events = POLLOUT, .revents = 0};
  while (!bytes.empty() && ::poll(&line, 1, 1'000) == 1) {
    const ssize_t size = ::write(descriptor_, bytes.data(), bytes.size());
    if (size <= 0) {
      return;
    }
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
}

}  // namespace holdfast::instrument

namespace holdfast {
namespace {

class SerialChannel final : public emulator::Channel {
 public:
  explicit SerialChannel(instrument::SerialDevice device) : device_(std::move(device)) {}

  std::size_t read(std::span<std::uint8_t> bytes) override { return device_.read(bytes, 0); }

  void write(std::span<const std::uint8_t> bytes) override { device_.write(bytes); }

 private:
  instrument::SerialDevice device_;
};

}  // namespace

base::Result<std::unique_ptr<emulator::Channel>> open_channel(const std::string& device,
                                                              std::uint32_t baud) {
  auto opened = instrument::SerialDevice::open(device, baud);
  if (!opened) {
    return opened.error();
  }
  return std::unique_ptr<emulator::Channel>(
      std::make_unique<SerialChannel>(std::move(opened).value()));
}

}  // namespace holdfast
