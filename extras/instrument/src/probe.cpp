// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "probe.hpp"

#include <fmt/format.h>

namespace holdfast::instrument {

using module::FrameKind;

void Probe::ask() {
  send_fields(FrameKind::kAsk, module::Ask{.format = module::kReportFormat,
                                           .what = module::Ask::kStatus | module::Ask::kLog,
                                           .log_from = log_next_});
}

bool Probe::take(int timeout_ms) {
  std::array<std::uint8_t, 512> bytes{};
  bool is_answered = false;
  const std::size_t size = device_.read(bytes, timeout_ms);
  for (const std::uint8_t byte : std::span(bytes).first(size)) {
    if (reader_.take(byte) != module::FrameReader::Found::kFrame) {
      continue;
    }
    module::StatusReport report;
    if (reader_.kind() == FrameKind::kStatus && module::read_fields(reader_.payload(), report)) {
      // It has started again: nothing of its log is known.
      const bool is_new = static_cast<std::int16_t>(report.log_next - log_next_) < 0;
      log_next_ = is_new ? std::uint16_t{0} : log_next_;
      time_us_ = is_new ? 0 : time_us_;
      status_ = report;
      is_answered = true;
    } else if (reader_.kind() == FrameKind::kLog) {
      take_log_frame(reader_.payload());
    }
  }
  return is_answered;
}

void Probe::take_log_frame(std::span<const std::uint8_t> payload) {
  module::PayloadReader in(payload);
  std::uint16_t number = 0;
  in.u16(number);
  if (!status_ || static_cast<std::int16_t>(number - log_next_) < 0) {
    return;  // The answer to an earlier question.
  }
  lost_ += static_cast<std::uint16_t>(number - log_next_);
  log_next_ = number;
  while (in.rest().size() >= static_cast<std::size_t>(module::kLogEntryBytes)) {
    module::each_field(log_.emplace_back(), in);
    ++log_next_;
  }
}

bool Probe::ask_for(std::chrono::milliseconds time) {
  constexpr int kAnswerMs = 250;
  const auto end = std::chrono::steady_clock::now() + time;
  do {
    ask();
    const auto again = std::chrono::steady_clock::now() + std::chrono::milliseconds(kAnswerMs);
    while (std::chrono::steady_clock::now() < again) {
      if (take(20)) {
        return true;
      }
    }
  } while (std::chrono::steady_clock::now() < end);
  return false;
}

std::vector<module::LogEntry> Probe::take_log(int& lost) {
  lost = std::exchange(lost_, 0);
  return std::exchange(log_, {});
}

double Probe::seconds(std::uint32_t time_us) {
  const auto ahead = static_cast<std::int32_t>(time_us - static_cast<std::uint32_t>(time_us_));
  time_us_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(ahead));
  return static_cast<double>(time_us_) * 1e-6;
}

void Probe::send(FrameKind kind, std::span<const std::uint8_t> payload) {
  std::array<std::uint8_t, module::kFrameBytesMax> frame{};
  const int size = module::write_frame(kind, payload, frame);
  device_.write(std::span<const std::uint8_t>(frame).first(static_cast<std::size_t>(size)));
}

base::Result<std::vector<Probe>> open_probes(std::span<const std::string> devices,
                                             std::uint32_t baud) {
  std::vector<Probe> probes;
  for (const std::string& name : devices) {
    auto device = SerialDevice::open(name, baud);
    if (!device) {
      return device.error();
    }
    probes.emplace_back(std::move(device).value());
  }
  return probes;
}

std::optional<base::Error> find_version_fault(const Probe& probe) {
  const auto& status = probe.status();
  if (!status ||
      (status->format == module::kReportFormat && status->wire_version == agent::wire::kVersion)) {
    return std::nullopt;
  }
  return base::Error{
      .code = base::ErrorCode::kUnsupported,
      .message = fmt::format("other version: the module reports in format {} and talks to others "
                             "in wire format {}, this program knows {} and {}; flash the robot's "
                             "modules with one program",
                             status->format, status->wire_version, module::kReportFormat,
                             agent::wire::kVersion),
      .where = probe.name()};
}

base::Error silence(const std::string& device) {
  return {.code = base::ErrorCode::kUnreadable,
          .message =
              "no answer; is a free face of a module at this device, at this rate, and does its "
              "program answer instruments (the 60 KB image does not)?",
          .where = device};
}

}  // namespace holdfast::instrument
