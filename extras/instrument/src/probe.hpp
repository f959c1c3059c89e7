// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "holdfast/module/status_report.hpp"
#include "serial_device.hpp"

namespace holdfast::instrument {

/// One module, seen from a free face of it.
class Probe {
 public:
  explicit Probe(SerialDevice device) : device_(std::move(device)) {}

  /// Asks for the status, and for what has been logged that is not known yet.
  void ask();

  /// Takes what comes in, for that long at most. True: something was answered.
  bool take(int timeout_ms);

  /// Asks until there is an answer; false: there is none within the time.
  bool ask_for(std::chrono::milliseconds time);

  /// The last status that was heard.
  const std::optional<module::StatusReport>& status() const { return status_; }

  /// What has been logged since the last call, and before it how many entries were lost.
  std::vector<module::LogEntry> take_log(int& lost);

  /// When the module started, seconds are counted from; `time_us` is one of its times.
  double seconds(std::uint32_t time_us);

  /// Sends a frame.
  void send(module::FrameKind kind, std::span<const std::uint8_t> payload);

  template <class Fields>
  void send_fields(module::FrameKind kind, const Fields& fields) {
    std::array<std::uint8_t, module::kPayloadBytesMax> payload{};
    module::PayloadWriter out(payload);
    module::each_field(fields, out);
    send(kind, out.written());
  }

  const std::string& name() const { return device_.name(); }

 private:
  void take_log_frame(std::span<const std::uint8_t> payload);

  SerialDevice device_;
  module::FrameReader reader_;
  std::optional<module::StatusReport> status_;
  std::vector<module::LogEntry> log_;
  std::uint16_t log_next_ = 0;
  int lost_ = 0;
  std::uint64_t time_us_ = 0;
};

/// Opens a probe at every device.
base::Result<std::vector<Probe>> open_probes(std::span<const std::string> devices,
                                             std::uint32_t baud);

/// What of a module's status this program does not know; none if it knows all.
std::optional<base::Error> find_version_fault(const Probe& probe);

/// The error of a device at which nobody answers.
base::Error silence(const std::string& device);

}  // namespace holdfast::instrument
