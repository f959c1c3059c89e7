// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json_lines.hpp"

#include "holdfast/io/json_stream.hpp"
#include "words.hpp"

namespace holdfast::instrument {
namespace {

using module::LogEntry;
using module::StatusReport;

const char* event_of(LogEntry::What what) {
  switch (what) {
    case LogEntry::What::kStarted:
      return "started";
    case LogEntry::What::kJoined:
      return "joined";
    case LogEntry::What::kPhase:
      return "phase";
    case LogEntry::What::kVerdict:
      return "verdict";
    case LogEntry::What::kPlan:
      return "plan";
    case LogEntry::What::kWithdraw:
      return "withdraw";
    case LogEntry::What::kHeard:
      return "heard";
    case LogEntry::What::kUnheard:
      return "unheard";
    case LogEntry::What::kConfigured:
      return "configured";
    case LogEntry::What::kOtherVersion:
      return "other_version";
  }
  return "unknown";
}

/// What an entry is about, beside its text.
void write_details(io::JsonStream& json, const LogEntry& entry) {
  switch (entry.what) {
    case LogEntry::What::kStarted:
      json.member("reset_flags", entry.value);
      break;
    case LogEntry::What::kJoined:
      json.member("epoch", entry.number);
      break;
    case LogEntry::What::kPhase:
      json.member("phase", phase_name(entry.value));
      break;
    case LogEntry::What::kVerdict:
      json.member("verdict", agent::name(known_answer(entry.value, entry.number).verdict));
      json.member("reason", agent::name(known_answer(entry.value, entry.number).reason));
      break;
    case LogEntry::What::kPlan:
      json.member("of", entry.cell);
      break;
    case LogEntry::What::kWithdraw:
      json.key("of");
      entry.cell == agent::kEveryCell ? json.value("all") : json.value(entry.cell);
      break;
    case LogEntry::What::kHeard:
    case LogEntry::What::kUnheard:
      json.member("face", face_name(entry.value));
      break;
    case LogEntry::What::kConfigured:
      json.member("revision", entry.number);
      break;
    case LogEntry::What::kOtherVersion:
      json.member("face", face_name(entry.value));
      json.member("wire_version", entry.number);
      break;
  }
}

bool has_loads(const agent::Answer& answer) {
  return answer.verdict == agent::Verdict::kSafe || answer.verdict == agent::Verdict::kOverload;
}

void write_answer(io::JsonStream& json, const StatusReport& report) {
  const agent::Answer answer = answer_of(report);
  const bool is_loaded = has_loads(answer);
  json.member("verdict", agent::name(answer.verdict));
  json.member("reason", agent::name(answer.reason));
  json.member("load_ratio_max",
              is_loaded ? std::optional<double>(answer.load_ratio_max) : std::nullopt);
  json.member("worst_cell", is_loaded ? std::optional(answer.worst_cell) : std::nullopt);
  json.key("worst_face");
  is_loaded ? json.value(face_name(report.worst_direction)) : json.value(nullptr);
  json.member("own_load_ratio",
              is_loaded ? std::optional<double>(report.own_load_ratio) : std::nullopt);
}

void write_faces(io::JsonStream& json, std::uint8_t faces) {
  json.key("neighbours");
  json.begin_array();
  for (std::uint8_t face = 0; face < base::kDirectionCount; ++face) {
    if ((faces >> face & 1) != 0) {
      json.value(face_name(face));
    }
  }
  json.end_array();
}

}  // namespace

std::string json_line(const std::string& device, double seconds, const LogEntry& entry,
                      const StatusReport& report) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kLine);
  json.begin_object();
  json.member("device", device);
  json.member("event", event_of(entry.what));
  json.member("seconds", seconds);
  json.member("cell", cell_of(report));
  write_details(json, entry);
  json.member("text", describe(entry, report));
  json.end_object();
  return text;
}

std::string json_line(const std::string& device, const StatusReport& report) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kLine);
  json.begin_object();
  json.member("device", device);
  json.member("event", "status");
  json.member("seconds", report.time_us * 1e-6);
  json.member("cell", cell_of(report));
  json.member("id", report.id);
  json.member("anchor", report.has(StatusReport::kIsAnchor));
  json.member("fixed", report.has(StatusReport::kIsFixed));
  json.member("root", report.has(StatusReport::kIsRoot));
  json.member("configured", report.has(StatusReport::kHasConfiguration));
  write_answer(json, report);
  json.member("epoch", report.epoch);
  json.member("phase", phase_name(report.phase));
  json.member("plans", report.plan_count);
  json.member("revision", report.revision);
  json.member("numbers", report.setup_sum);
  write_faces(json, report.connected);
  json.member("refused", report.refused_count);
  json.member("reset_flags", report.reset_reason);
  json.member("stack_bytes", report.stack_bytes);
  json.end_object();
  return text;
}

std::string json_line(const std::string& device, const char* event, std::optional<int> count) {
  std::string text;
  io::JsonStream json(text, io::JsonStream::Layout::kLine);
  json.begin_object();
  json.member("device", device);
  json.member("event", event);
  if (count) {
    json.member("count", *count);
  }
  json.end_object();
  return text;
}

}  // namespace holdfast::instrument
