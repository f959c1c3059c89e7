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
  constexpr std::size_t kModulesMin = 64;
  const std::size_t count = modules_.agents.size();
  region_modules_ = std::max(kModulesMin, (count + Region::kCountMax - 1) / Region::kCountMax);
  const std::size_t region_count = (count + region_modules_ - 1) / region_modules_;
  regions_.resize(region_count);
  for (std::size_t i = 0; i < region_count; ++i) {
    region_store_.push_back(
        std::make_unique<Region>(modules_, ledger_, regions_, static_cast<std::uint32_t>(i)));
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
      options.link.compute_time > 0 || ledger_.agenda().end() - 1 > options.time_max ||
      ledger_.agenda().window().empty()) {
    return false;
  }
  const std::uint64_t done = ledger_.recorder.event_count();
  return (options.event_count_max - done) / kStepsMax > count;
}

void Engine::run_ahead() {
  constexpr std::size_t kPrefetch = 8;
  if (team_ == nullptr) {
    team_ = std::make_unique<host::Team>(modules_.options.thread_count, modules_.agents.size());
  }
  const std::span<QueuedEvent> events = ledger_.take_window();
  first_.assign(modules_.agents.size(), Region::Window::kNone);
  next_.resize(events.size());
  for (std::size_t i = events.size(); i-- > 0;) {
    const std::size_t module = at(Happening::module_of(events[i].content));
    next_[i] = first_[module];
    first_[module] = static_cast<std::uint32_t>(i);
  }
  const Region::Window window{
      .events = events, .first = first_, .next = next_, .end = ledger_.agenda().end()};
  team_->each(regions_.size(), [&](std::size_t i) {
    const std::size_t begin = i * region_modules_;
    const std::size_t end = std::min(begin + region_modules_, modules_.agents.size());
    regions_[i]->run_ahead(window, static_cast<std::int32_t>(begin),
                           static_cast<std::int32_t>(end));
  });
  while (ledger_.agenda().has_window()) {
    if (const QueuedEvent* ahead = ledger_.agenda().peek(kPrefetch); ahead != nullptr) {
      Region::prefetch_turn(regions_, ahead->content);
    }
    const QueuedEvent event = ledger_.pop_taken();
    now_ = event.time;
    Region::tell(regions_, event);
  }
  for (Region* region : regions_) {
    region->end_window();
  }
}

}  // namespace holdfast::sim
