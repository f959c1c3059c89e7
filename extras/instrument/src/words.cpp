// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "words.hpp"

#include <fmt/format.h>

#include <array>

#include "holdfast/sim/trace.hpp"

namespace holdfast::instrument {
namespace {

using module::LogEntry;
using module::StatusReport;

std::string text(const base::Cell& cell) {
  return fmt::format("({},{},{})", cell.x, cell.y, cell.z);
}

std::string describe_verdict(const LogEntry& entry, const StatusReport& report) {
  const agent::Answer now = answer_of(report);
  const agent::Answer then = known_answer(entry.value, entry.number);
  if (then.verdict == now.verdict && then.reason == now.reason) {
    return sim::describe(now);
  }
  // The load ratio has gone with it.
  return then.verdict == agent::Verdict::kNone
             ? sim::describe(then)
             : fmt::format("knew the verdict: {} ({})", agent::name(then.verdict),
                           agent::name(then.reason));
}

}  // namespace

std::string phase_name(std::uint8_t phase) {
  return phase < sim::kPhaseCount ? std::string(sim::name(static_cast<agent::Phase>(phase)))
                                  : fmt::format("{}", phase);
}

agent::Answer known_answer(std::uint8_t verdict, std::uint16_t reason) {
  const bool is_known = verdict <= static_cast<std::uint8_t>(agent::Verdict::kUndecided) &&
                        reason < agent::kReasonCount;
  return {.verdict = is_known ? static_cast<agent::Verdict>(verdict) : agent::Verdict::kUndecided,
          .reason = is_known ? static_cast<agent::Reason>(reason) : agent::Reason::kNone};
}

const char* face_name(std::uint8_t face) {
  constexpr std::array<const char*, base::kDirectionCount + 1> kNames = {"+x", "-x", "+y", "-y",
                                                                         "+z", "-z", "?"};
  return kNames[face < base::kDirectionCount ? face : kNames.size() - 1];
}

std::string face_names(std::uint8_t faces) {
  std::string names;
  for (std::uint8_t face = 0; face < base::kDirectionCount; ++face) {
    if ((faces >> face & 1) != 0) {
      names += (names.empty() ? "" : ", ") + std::string(face_name(face));
    }
  }
  return names.empty() ? "none" : names;
}

std::optional<base::Cell> cell_of(const StatusReport& report) {
  return report.has(StatusReport::kHasCell) ? std::optional(report.cell) : std::nullopt;
}

std::string cell_text(const StatusReport& report) {
  return report.has(StatusReport::kHasCell) ? text(report.cell) : "(?)";
}

agent::Answer answer_of(const StatusReport& report) {
  agent::Answer answer = known_answer(report.verdict, report.reason);
  answer.load_ratio_max = report.load_ratio_max;
  answer.worst_cell = report.worst_cell;
  answer.worst_direction = report.worst_direction < base::kDirectionCount
                               ? static_cast<base::Direction>(report.worst_direction)
                               : base::Direction::kPlusX;
  return answer;
}

std::string describe(const LogEntry& entry, const StatusReport& report) {
  switch (entry.what) {
    case LogEntry::What::kStarted:
      return entry.value == 0 ? "starts" : fmt::format("starts, reset flags 0x{:02x}", entry.value);
    case LogEntry::What::kJoined:
      return fmt::format("joined by the wave of epoch {}", entry.number);
    case LogEntry::What::kPhase:
      return fmt::format("phase {}", phase_name(entry.value));
    case LogEntry::What::kVerdict:
      return describe_verdict(entry, report);
    case LogEntry::What::kPlan:
      return fmt::format("is told of a planned module at {}", text(entry.cell));
    case LogEntry::What::kWithdraw:
      return fmt::format("is told that a plan is withdrawn: {}",
                         entry.cell == agent::kEveryCell ? "all" : text(entry.cell));
    case LogEntry::What::kHeard:
      return fmt::format("hears a neighbour at {}", face_name(entry.value));
    case LogEntry::What::kUnheard:
      return fmt::format("hears its neighbour at {} no more", face_name(entry.value));
    case LogEntry::What::kConfigured:
      return fmt::format("starts with revision {} of the robot's numbers", entry.number);
    case LogEntry::What::kOtherVersion:
      return fmt::format(
          "hears packets of other version {} at {}: the program there is another one", entry.number,
          face_name(entry.value));
  }
  return fmt::format("logs what this program does not know ({})", static_cast<int>(entry.what));
}

std::vector<std::string> describe(const std::string& device, const StatusReport& report) {
  const auto flag = [&](std::uint8_t bit, const char* word) {
    return report.has(bit) ? fmt::format(", {}", word) : std::string();
  };
  std::vector<std::string> lines = {
      fmt::format("{}: module {} at {}{}{}{}", device, report.id, cell_text(report),
                  flag(StatusReport::kIsAnchor, "anchor"), flag(StatusReport::kIsFixed, "fixed"),
                  flag(StatusReport::kIsRoot, "root"))};
  if (!report.has(StatusReport::kHasConfiguration)) {
    lines.emplace_back("  verdict     none; it waits for the robot's numbers (holdfast tell)");
  } else {
    constexpr std::string_view kKnows = "knows the verdict: ";
    const std::string verdict = sim::describe(answer_of(report));
    lines.push_back("  verdict     " +
                    (verdict.starts_with(kKnows) ? verdict.substr(kKnows.size()) : "none yet"));
    lines.push_back(fmt::format("  own loads   {:.4f}, the largest ratio of its own connections",
                                report.own_load_ratio));
    lines.push_back(fmt::format("  round       epoch {}, phase {}; {} told here and not ended",
                                report.epoch, phase_name(report.phase),
                                host::counted(report.plan_count, "plan")));
    lines.push_back(fmt::format("  numbers     {:04x}, {}", report.setup_sum,
                                report.revision == 0
                                    ? std::string("of a page that was flashed")
                                    : fmt::format("revision {}", report.revision)));
  }
  lines.push_back("  neighbours  " + face_names(report.connected));
  lines.push_back("  refused     " + host::counted(report.refused_count, "message"));
  lines.push_back(fmt::format(
      "  board       {:.1f} s since its start, {}, {}", report.time_us * 1e-6,
      report.reset_reason == 0 ? std::string("reset flags not known")
                               : fmt::format("reset flags 0x{:02x}", report.reset_reason),
      report.stack_bytes == 0 ? std::string("stack not known")
                              : host::counted(report.stack_bytes, "byte") + " of stack"));
  return lines;
}

}  // namespace holdfast::instrument
