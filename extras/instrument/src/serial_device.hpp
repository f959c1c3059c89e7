// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "holdfast/base/result.hpp"

namespace holdfast::instrument {

/// A serial adapter, or a pseudo-terminal: 8 bits, no parity, raw.
class SerialDevice {
 public:
  /// Errors: there is no such terminal; a rate that terminals do not know.
  static base::Result<SerialDevice> open(const std::string& name, std::uint32_t baud);

  SerialDevice(SerialDevice&& other) noexcept;
  SerialDevice& operator=(SerialDevice&&) = delete;
  ~SerialDevice();

  /// Reads what has come in, waiting for it that long; 0: nothing, or the other end has gone.
  std::size_t read(std::span<std::uint8_t> bytes, int timeout_ms);

  /// Writes as much as the device takes within a second; the rest is lost.
  void write(std::span<const std::uint8_t> bytes);

  const std::string& name() const { return name_; }

 private:
  SerialDevice(std::string name, int descriptor);

  std::string name_;
  int descriptor_;
};

}  // namespace holdfast::instrument
