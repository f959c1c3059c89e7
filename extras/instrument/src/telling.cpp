// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "holdfast/emulated.hpp"
#include "holdfast/instrument.hpp"
#include "holdfast/module/configuration.hpp"
#include "pages.hpp"
#include "probe.hpp"
#include "words.hpp"

namespace holdfast {
namespace {

using Clock = std::chrono::steady_clock;
using instrument::Probe;
using module::FrameKind;
using module::LogEntry;
using module::StatusReport;

constexpr auto kPatience = std::chrono::seconds(10);
constexpr auto kAnswerTime = std::chrono::milliseconds(1'000);

std::string text(const base::Cell& cell) {
  return cell == agent::kEveryCell ? "all" : fmt::format("({},{},{})", cell.x, cell.y, cell.z);
}

/// Says something again and again until the module's own words show that it has been understood.
template <class Say, class IsDone>
bool insist(Probe& probe, const Say& say, const IsDone& is_done) {
  const auto end = Clock::now() + kPatience;
  while (Clock::now() < end) {
    say();
    const auto again = Clock::now() + kAnswerTime;
    while (Clock::now() < again) {
      if (probe.ask_for(std::chrono::milliseconds(100)) && is_done()) {
        return true;
      }
    }
  }
  return false;
}

base::Error not_done(const Probe& probe) {
  return {.code = base::ErrorCode::kUnwritable,
          .message = "the module answers, but has not done what it was told within 10 s",
          .where = probe.name()};
}

/// A plan, or its withdrawal: told again does no harm, and the log shows that it has come.
base::Result<std::string> tell_plan(Probe& probe, const Telling& telling) {
  const bool is_withdrawal = telling.kind == Telling::Kind::kWithdraw;
  if (!probe.status()->has(StatusReport::kHasConfiguration)) {
    return base::Error{.code = base::ErrorCode::kUnwritable,
                       .message =
                           "the module has no configuration and would forget a plan; first tell it "
                           "the robot's numbers: holdfast tell DEVICE configure FILE",
                       .where = probe.name()};
  }
  std::array<std::uint8_t, 13> payload{};
  module::PayloadWriter out(payload);
  out.cell(telling.cell);
  if (is_withdrawal) {
    out.u8(1);
  }
  int lost = 0;
  probe.take_log(lost);  // What was before.
  const auto what = is_withdrawal ? LogEntry::What::kWithdraw : LogEntry::What::kPlan;
  const bool is_done = insist(
      probe, [&] { probe.send(FrameKind::kPlan, out.written()); },
      [&] {
        return std::ranges::any_of(probe.take_log(lost), [&](const LogEntry& entry) {
          return entry.what == what && entry.cell == telling.cell;
        });
      });
  if (!is_done) {
    return not_done(probe);
  }
  return fmt::format("{}: {} {}", probe.name(),
                     is_withdrawal ? "the plan is withdrawn:" : "a module is planned at",
                     text(telling.cell));
}

base::Result<std::string> tell_who(Probe& probe, const Telling& telling) {
  using What = module::Who::What;
  const auto kind = telling.kind;
  const What what = kind == Telling::Kind::kAnchor     ? What::kAnchor
                    : kind == Telling::Kind::kNoAnchor ? What::kNoAnchor
                    : kind == Telling::Kind::kFixed    ? What::kFixed
                                                       : What::kFree;
  const bool is_about_anchor = what == What::kAnchor || what == What::kNoAnchor;
  const std::uint8_t flag = is_about_anchor ? StatusReport::kIsAnchor : StatusReport::kIsFixed;
  const bool wanted = what == What::kAnchor || what == What::kFixed;
  const bool is_done = insist(
      probe,
      [&] {
        probe.send_fields(FrameKind::kWho, module::Who{what, telling.cell});
      },
      [&] {
        const StatusReport& now = *probe.status();
        // Without a configuration there is no cell yet.
        const bool is_there = what != What::kAnchor || now.cell == telling.cell ||
                              !now.has(StatusReport::kHasConfiguration);
        return now.has(flag) == wanted && is_there;
      });
  if (!is_done) {
    return not_done(probe);
  }
  return fmt::format("{}: module {} {}", probe.name(), probe.status()->id,
                     what == What::kAnchor     ? "is the anchor, at " + text(telling.cell)
                     : what == What::kNoAnchor ? std::string("is not the anchor")
                     : what == What::kFixed    ? std::string("is held from outside")
                                               : std::string("is not held from outside"));
}

void send_parts(Probe& probe, std::span<const std::uint8_t> setup, std::uint16_t revision) {
  std::array<std::uint8_t, module::kPayloadBytesMax> payload{};
  std::uint8_t index = 0;
  while (const std::size_t size = module::write_part(setup, revision, index++, payload)) {
    probe.send(FrameKind::kConfigure, std::span<const std::uint8_t>(payload).first(size));
  }
}

base::Result<std::string> configure(Probe& probe, const Structure& structure) {
  const auto setup = instrument::setup_of(structure);
  if (!setup) {
    return setup.error();
  }
  const StatusReport before = *probe.status();
  const std::uint16_t sum = module::sum_of_setup(setup.value());
  if (before.has(StatusReport::kHasConfiguration) && before.setup_sum == sum) {
    return fmt::format("{}: module {} has these numbers already", probe.name(), before.id);
  }
  auto revision = static_cast<std::uint16_t>(before.revision + 1);
  revision = revision == 0 ? std::uint16_t{1} : revision;
  const bool is_done = insist(
      probe, [&] { send_parts(probe, setup.value(), revision); },
      [&] { return probe.status()->revision == revision && probe.status()->setup_sum == sum; });
  if (!is_done) {
    return not_done(probe);
  }
  return fmt::format(
      "{}: module {} has revision {} of the robot's numbers, and tells its neighbours",
      probe.name(), before.id, revision);
}

}  // namespace

base::Result<std::string> tell(const std::string& device, const Telling& telling,
                               const InstrumentOptions& options) {
  auto probes = instrument::open_probes({&device, 1}, options.baud);
  if (!probes) {
    return probes.error();
  }
  Probe probe = std::move(std::move(probes).value().front());
  if (!probe.ask_for(std::chrono::seconds(2))) {
    return instrument::silence(device);
  }
  if (auto fault = find_version_fault(probe)) {
    return *fault;
  }
  switch (telling.kind) {
    case Telling::Kind::kPlan:
    case Telling::Kind::kWithdraw:
      return tell_plan(probe, telling);
    case Telling::Kind::kConfigure:
      return configure(probe, *telling.structure);
    default:
      return tell_who(probe, telling);
  }
}

}  // namespace holdfast
