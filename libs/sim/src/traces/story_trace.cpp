// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <ostream>
#include <string>
#include <utility>

#include "holdfast/host/text.hpp"
#include "holdfast/sim/trace.hpp"

namespace holdfast::sim {
namespace {

constexpr std::array<const char*, base::kDirectionCount> kFaceNames = {"+x", "-x", "+y",
                                                                       "-y", "+z", "-z"};

std::string text(const base::Cell& cell) {
  return fmt::format("({},{},{})", cell.x, cell.y, cell.z);
}

/// Faces of cubes have names, others numbers.
std::string face_name(base::Direction face, const base::Lattice& lattice) {
  const auto i = static_cast<std::size_t>(base::index(face));
  return lattice == base::kCubic ? kFaceNames[i] : fmt::format("face {}", i);
}

std::string text(const Fault& fault, const base::Lattice& lattice) {
  switch (fault.kind) {
    case Fault::Kind::kKill:
      return "falls silent";
    case Fault::Kind::kCut:
      return fmt::format("loses its link at {}", face_name(fault.face, lattice));
    case Fault::Kind::kDetach:
      return "is taken off";
    case Fault::Kind::kReset:
      return "starts again";
    case Fault::Kind::kMend:
      return fmt::format("has its link at {} again", face_name(fault.face, lattice));
    case Fault::Kind::kUnplug:
      return fmt::format("is parted from its neighbour at {}", face_name(fault.face, lattice));
    case Fault::Kind::kPlug:
      return fmt::format("is connected at {} again", face_name(fault.face, lattice));
    case Fault::Kind::kAttach:
      break;
  }
  return "is put on";
}

}  // namespace

std::string describe(const agent::Answer& answer, const base::Lattice& lattice) {
  if (answer.verdict == agent::Verdict::kNone) {
    return "does not know the verdict any more";
  }
  std::string line = fmt::format("knows the verdict: {} ({})", agent::name(answer.verdict),
                                 agent::name(answer.reason));
  if (answer.verdict == agent::Verdict::kSafe || answer.verdict == agent::Verdict::kOverload) {
    line += fmt::format(", load ratio {} at {} {}", host::beside_one(answer.load_ratio_max, 4, 0),
                        text(answer.worst_cell), face_name(answer.worst_direction, lattice));
  }
  return line;
}

struct StoryTrace::Writer {
  std::ostream& out;
  StoryOptions options;
  const model::Robot* robot = nullptr;

  const base::Lattice& lattice() const {
    return robot == nullptr ? base::kCubic : robot->lattice();
  }

  LinkModel link = {};
  std::uint16_t epoch = 0;  ///< The newest that has been told.
  int phase = -1;           ///< The furthest in it.
  std::string line = {};

  template <class... Args>
  void write(fmt::format_string<Args...> format, Args&&... args) {
    line.clear();
    fmt::format_to(std::back_inserter(line), format, std::forward<Args>(args)...);
    out.write(line.data(), static_cast<std::streamsize>(line.size()));
  }

  std::string text_of(Time time) const {
    const auto in_seconds = seconds(link, time);
    return in_seconds ? fmt::format("{:.6f} s", *in_seconds) : fmt::format("{}", time);
  }

  void tell(Time time, std::int32_t module, std::string_view what) {
    write("{:>14}  {}  {}\n", text_of(time),
          text(robot->modules()[static_cast<std::size_t>(module)].cell), what);
  }
};

StoryTrace::StoryTrace(std::ostream& out, const StoryOptions& options)
    : writer_(new Writer{.out = out, .options = options}) {}

StoryTrace::~StoryTrace() = default;

void StoryTrace::begin(const model::Robot& robot, const LinkModel& link) {
  writer_->robot = &robot;
  writer_->link = link;
  writer_->write("{}, {} planned\n",
                 host::counted(robot.modules().size() - robot.planned_count(), "module"),
                 robot.planned_count());
}

void StoryTrace::joined(Time time, std::int32_t module, std::uint16_t epoch) {
  const bool is_first = epoch > writer_->epoch;
  if (is_first) {
    writer_->epoch = epoch;
    writer_->phase = -1;
    writer_->tell(time, module, fmt::format("starts the wave of epoch {}", epoch));
  } else if (writer_->options.tells_every_module) {
    writer_->tell(time, module, fmt::format("joined by the wave of epoch {}", epoch));
  }
}

void StoryTrace::phase_changed(Time time, std::int32_t module, agent::Phase phase) {
  const bool is_first = static_cast<int>(phase) > writer_->phase;
  if (is_first || writer_->options.tells_every_module) {
    writer_->tell(time, module, fmt::format("phase {}", name(phase)));
  }
  if (is_first) {
    writer_->phase = static_cast<int>(phase);
  }
}

void StoryTrace::verdict_known(Time time, std::int32_t module, const agent::Answer& answer) {
  writer_->tell(time, module, describe(answer, writer_->lattice()));
}

void StoryTrace::fault_happened(const Fault& fault) {
  writer_->tell(fault.at, fault.module, text(fault, writer_->lattice()));
}

void StoryTrace::announced(const Announcement& announcement) {
  const bool is_all = announcement.is_withdrawal && announcement.cell == agent::kEveryCell;
  writer_->tell(announcement.at, announcement.module,
                fmt::format("is told {} {}",
                            announcement.is_withdrawal ? "that a plan is withdrawn:"
                                                       : "of a planned module at",
                            is_all ? "all" : text(announcement.cell)));
}

void StoryTrace::end(const SimulationResult& result) {
  Writer& writer = *writer_;
  writer.write("{:<12} {:>14} {:>12} {:>14}\n", "phase", "time", "packets", "bytes");
  for (std::size_t i = 0; i < kPhaseCount; ++i) {
    const PhaseStatistics& phase = result.phases[i];
    if (phase.packets > 0 || phase.time > 0) {
      writer.write("{:<12} {:>14} {:>12} {:>14}\n", name(static_cast<agent::Phase>(i)),
                   writer.text_of(phase.time), phase.packets, phase.bytes);
    }
  }
  writer.write("{:<12} {:>14} {:>12} {:>14}\n", "all", writer.text_of(result.time), result.packets,
               result.bytes);
  writer.write("{} lost, {}\n", host::counted(result.lost_packets, "packet"),
               result.is_quiet ? "all is quiet" : "stopped at a limit");
  writer.out.flush();
}

}  // namespace holdfast::sim
