// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "holdfast/instrument.hpp"
#include "json_lines.hpp"
#include "probe.hpp"
#include "words.hpp"

namespace holdfast {
namespace {

using Clock = std::chrono::steady_clock;
using instrument::Probe;

constexpr auto kAskEvery = std::chrono::milliseconds(50);
/// The most that a module is at work without reading, and more.
constexpr auto kSilentAfter = std::chrono::seconds(2);

/// One device of several that are listened to.
struct Ear {
  Probe probe;
  Clock::time_point ask_at;
  Clock::time_point heard_at;
  bool is_heard = false;
  bool was_silent = false;
};

class Listening {
 public:
  Listening(std::vector<Probe> probes, const InstrumentOptions& options,
            const std::function<void(const HeardLine& line)>& tell)
      : options_(options), tell_(tell) {
    for (Probe& probe : probes) {
      ears_.push_back({.probe = std::move(probe),
                       .ask_at = Clock::now(),
                       .heard_at = Clock::now(),
                       .is_heard = false,
                       .was_silent = false});
    }
  }

  std::optional<base::Error> run(const std::function<bool()>& goes_on) {
    const auto end = Clock::now() + std::chrono::duration<double>(options_.time_max_s);
    while (goes_on() && (options_.time_max_s <= 0 || Clock::now() < end)) {
      for (Ear& ear : ears_) {
        if (auto fault = serve(ear)) {
          return fault;
        }
      }
      if (options_.is_once && is_over()) {
        break;
      }
    }
    return std::nullopt;
  }

  Heard heard() const {
    Heard heard;
    bool is_first = true;
    for (const Ear& ear : ears_) {
      if (!ear.is_heard || ear.was_silent) {
        ++heard.silent_count;
        continue;
      }
      const agent::Verdict verdict = instrument::answer_of(*ear.probe.status()).verdict;
      heard.verdict = is_first || heard.verdict == verdict ? verdict : agent::Verdict::kUndecided;
      is_first = false;
    }
    return heard;
  }

 private:
  bool is_over() const {
    return std::ranges::all_of(ears_,
                               [](const Ear& ear) { return ear.is_heard || ear.was_silent; });
  }

  std::optional<base::Error> serve(Ear& ear) {
    if (Clock::now() >= ear.ask_at) {
      ear.probe.ask();
      ear.ask_at = Clock::now() + kAskEvery;
    }
    const int patience_ms = ears_.size() > 1 ? 2 : 10;
    if (ear.probe.take(patience_ms)) {
      if (auto fault = find_version_fault(ear.probe)) {
        return fault;
      }
      welcome(ear);
    }
    if (!options_.is_once && ear.is_heard) {
      tell_log(ear);
    }
    if (Clock::now() > ear.heard_at + kSilentAfter && !ear.was_silent) {
      ear.was_silent = true;
      tell_({fmt::format("{}: no answer", ear.probe.name()),
             instrument::json_line(ear.probe.name(), "silent")});
    }
    return std::nullopt;
  }

  void welcome(Ear& ear) {
    const module::StatusReport& report = *ear.probe.status();
    if (options_.is_once && !ear.is_heard) {
      tell_({fmt::format("{}", fmt::join(instrument::describe(ear.probe.name(), report), "\n")),
             instrument::json_line(ear.probe.name(), report)});
    } else if (ear.was_silent) {
      tell_({fmt::format("{}: answers again", ear.probe.name()),
             instrument::json_line(ear.probe.name(), "answers")});
    }
    ear.is_heard = true;
    ear.was_silent = false;
    ear.heard_at = Clock::now();
  }

  void tell_log(Ear& ear) {
    int lost = 0;
    const std::vector<module::LogEntry> log = ear.probe.take_log(lost);
    const module::StatusReport& report = *ear.probe.status();
    if (lost > 0) {
      tell_({fmt::format("{:>14}  {}  {} it has forgotten", "", instrument::cell_text(report),
                         host::counted(lost, "thing")),
             instrument::json_line(ear.probe.name(), "forgotten", lost)});
    }
    for (const module::LogEntry& entry : log) {
      const double seconds = ear.probe.seconds(entry.time_us);
      tell_({fmt::format("{:>12.6f} s  {}  {}", seconds, instrument::cell_text(report),
                         instrument::describe(entry, report)),
             instrument::json_line(ear.probe.name(), seconds, entry, report)});
    }
  }

  InstrumentOptions options_;
  const std::function<void(const HeardLine& line)>& tell_;
  std::vector<Ear> ears_;
};

}  // namespace

base::Result<Heard> listen(std::span<const std::string> devices, const InstrumentOptions& options,
                           const std::function<void(const HeardLine& line)>& tell,
                           const std::function<bool()>& goes_on) {
  auto probes = instrument::open_probes(devices, options.baud);
  if (!probes) {
    return probes.error();
  }
  Listening listening(std::move(probes).value(), options, tell);
  if (auto fault = listening.run(goes_on)) {
    return *fault;
  }
  return listening.heard();
}

}  // namespace holdfast
