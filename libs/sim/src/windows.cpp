// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "engine.hpp"

/// Windows of the future in which modules do not reach each other.
namespace holdfast::sim {
namespace {

/// The most events that one event hands to a module: itself, and a full line at every face.
constexpr std::uint64_t kStepsMax = 1000;

}  // namespace

/// Regions are made of modules that follow each other in the robot, which mostly lie near each
/// other, too.
void Engine::make_regions() {
  constexpr unsigned kBitsMin = 3;
  const std::size_t count = modules_.agents.size();
  region_bits_ = kBitsMin;
  while (Region::kCountMax << region_bits_ < count) {
    ++region_bits_;
  }
  const std::size_t size = std::size_t{1} << region_bits_;
  regions_.resize((count + size - 1) / size);
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    region_store_.push_back(std::make_unique<Region>(modules_, ledger_, regions_,
                                                     static_cast<std::uint32_t>(i), i * size,
                                                     std::min(size, count - i * size)));
    regions_[i] = region_store_[i].get();
  }
}

/// Whether modules can handle all that is left of the window, each for itself: nobody watches or
/// changes anything, and the run cannot end within the window.
bool Engine::can_run_ahead() {
  const SimulationOptions& options = modules_.options;
  const std::size_t count = ledger_.agenda().window().size();
  if (count == 0 || count < options.window_events_min || !ledger_.has_later_work() ||
      !ledger_.is_of_modules() || options.trace != nullptr || options.tamper ||
      options.link.compute_time > 0 || ledger_.agenda().end() - 1 > options.time_max) {
    return false;
  }
  const std::uint64_t done = ledger_.recorder.event_count();
  return (options.event_count_max - done) / kStepsMax > count;
}

void Engine::run_ahead() {
  constexpr std::size_t kLater = 16;
  constexpr std::size_t kSoon = 8;
  if (team_ == nullptr) {
    const int wanted = modules_.options.thread_count;
    team_ = wanted == 0 ? std::make_unique<host::Team>(0, modules_.agents.size())
                        : std::make_unique<host::Team>(wanted);
  }
  ++window_count_;
  Agenda& agenda = ledger_.agenda();
  for (QueuedEvent& event : ledger_.take_window()) {
    event.content = region(Happening::module_of(event.content)).give(event);
  }
  team_->each(regions_.size(), [&](std::size_t i) { regions_[i]->run_ahead(agenda.end()); });
  while (agenda.has_window()) {
    Region::prefetch_turn(regions_, agenda.peek(kLater), agenda.peek(kSoon));
    const QueuedEvent event = ledger_.pop_taken();
    now_ = event.time;
    Region::tell(regions_, event);
  }
  for (Region* region : regions_) {
    region->end_window();
  }
}

}  // namespace holdfast::sim
