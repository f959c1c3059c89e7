// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <iterator>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/sim/trace.hpp"

namespace holdfast::sim {

/// The format is that of Chrome's trace viewer: complete slices "X", arrows from "s" to "f",
/// instants "i", names "M". Slices are written when they end, so that none is ever left open.
struct PerfettoTrace::Writer {
  /// The state of a module's thread in the trace.
  struct Thread {
    agent::Phase phase = agent::Phase::kDiscovery;
    Time since = 0;
    bool is_named = false;
  };

  std::ostream& out;
  PerfettoOptions options;
  const model::Robot* robot = nullptr;
  std::vector<Thread> threads = {};
  std::uint64_t event_count = 0;
  bool is_truncated = false;
  bool is_closed = false;
  std::string line = {};

  /// Whether there is room for one more event; names do not count.
  bool takes_event() {
    if (is_closed || event_count >= options.event_count_max) {
      is_truncated = true;
      return false;
    }
    ++event_count;
    return true;
  }

  template <class... Args>
  void write(fmt::format_string<Args...> format, Args&&... args) {
    line.clear();
    fmt::format_to(std::back_inserter(line), format, std::forward<Args>(args)...);
    out.write(line.data(), static_cast<std::streamsize>(line.size()));
  }

  /// Names the module's thread before its first event.
  void name_thread(std::int32_t module) {
    Thread& thread = threads[static_cast<std::size_t>(module)];
    if (thread.is_named) {
      return;
    }
    thread.is_named = true;
    const base::Cell& cell = robot->modules()[static_cast<std::size_t>(module)].cell;
    write(
        ",\n{{\"ph\":\"M\",\"pid\":1,\"tid\":{},\"name\":\"thread_name\","
        "\"args\":{{\"name\":\"{} ({},{},{})\"}}}}",
        module + 1, module, cell.x, cell.y, cell.z);
  }

  void instant(Time time, std::int32_t module, std::string_view what) {
    if (takes_event()) {
      name_thread(module);
      write(",\n{{\"ph\":\"i\",\"s\":\"t\",\"pid\":1,\"tid\":{},\"ts\":{},\"name\":\"{}\"}}",
            module + 1, time, what);
    }
  }

  void end_slice(Time time, std::int32_t module) {
    const Thread& thread = threads[static_cast<std::size_t>(module)];
    if (time > thread.since && takes_event()) {
      name_thread(module);
      write(",\n{{\"ph\":\"X\",\"pid\":1,\"tid\":{},\"ts\":{},\"dur\":{},\"name\":\"{}\"}}",
            module + 1, thread.since, time - thread.since, name(thread.phase));
    }
  }

  /// One end of a packet's arrow.
  void arrow(const PacketTrace& packet, std::int32_t module, char end) {
    if (options.has_packets && takes_event()) {
      name_thread(module);
      write(
          ",\n{{\"ph\":\"{}\",\"bp\":\"e\",\"pid\":1,\"tid\":{},\"ts\":{},\"id\":{},"
          "\"cat\":\"packet\",\"name\":\"packet\"}}",
          end, module + 1, packet.time, packet.number);
    }
  }

  void close() {
    if (!is_closed) {
      is_closed = true;
      // Without begin() the array is empty: its opening is still to come.
      out << (robot == nullptr ? "{\"traceEvents\":[" : "")
          << "],\n\"otherData\":{\"truncated\":" << (is_truncated ? "true" : "false")
          << ",\"events\":" << event_count << "}}\n";
      out.flush();
    }
  }
};

PerfettoTrace::PerfettoTrace(std::ostream& out, const PerfettoOptions& options)
    : writer_(new Writer{.out = out, .options = options}) {}

PerfettoTrace::~PerfettoTrace() { writer_->close(); }

void PerfettoTrace::begin(const model::Robot& robot, const LinkModel& /*link*/) {
  writer_->robot = &robot;
  writer_->threads.resize(robot.modules().size());
  writer_->out
      << "{\"displayTimeUnit\":\"ms\",\"traceEvents\":[\n"
         "{\"ph\":\"M\",\"pid\":1,\"name\":\"process_name\",\"args\":{\"name\":\"robot\"}}";
}

void PerfettoTrace::packet_sent(const PacketTrace& packet, Time /*line_time*/) {
  writer_->arrow(packet, packet.from, 's');
}

void PerfettoTrace::packet_delivered(const PacketTrace& packet) {
  writer_->arrow(packet, packet.to, 'f');
}

void PerfettoTrace::packet_lost(const PacketTrace& packet) {
  if (writer_->options.has_packets) {
    writer_->instant(packet.time, packet.from, "packet lost");
  }
}

void PerfettoTrace::phase_changed(Time time, std::int32_t module, agent::Phase phase) {
  writer_->end_slice(time, module);
  Writer::Thread& thread = writer_->threads[static_cast<std::size_t>(module)];
  thread.phase = phase;
  thread.since = time;
}

void PerfettoTrace::verdict_known(Time time, std::int32_t module, const agent::Answer& answer) {
  writer_->instant(time, module, agent::name(answer.verdict));
}

void PerfettoTrace::fault_happened(const Fault& fault) {
  writer_->instant(fault.at, fault.module, name(fault.kind));
}

void PerfettoTrace::announced(const Announcement& announcement) {
  writer_->instant(
      announcement.at, announcement.module,
      announcement.is_withdrawal ? "told that a plan is withdrawn" : "told of a planned module");
}

void PerfettoTrace::end(const SimulationResult& result) {
  const auto count =
      static_cast<std::int32_t>(writer_->robot->modules().size() - writer_->robot->planned_count());
  for (std::int32_t module = 0; module < count; ++module) {
    writer_->end_slice(result.time, module);
  }
  writer_->close();
}

}  // namespace holdfast::sim
