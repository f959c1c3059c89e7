// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/sim/simulation.hpp"
#include "ledger.hpp"
#include "modules.hpp"
#include "region.hpp"

namespace holdfast::sim {

/// The simulation behind its interface: takes events from the queue and gives them to the regions
/// of their modules, one at a time, or all of a window at once where that makes no difference.
class Engine {
 public:
  Engine(const model::Robot& robot, SimulationOptions options);

  /// Hands about `event_count` events to modules; returns false if the simulation is over.
  bool run_for(std::uint64_t event_count);

  void happen(const Fault& fault);
  void happen(const Announcement& announcement);

  SimulationResult result() const;
  SimulationResult counts() const;

  const agent::Agent& agent(std::int32_t module) const { return modules_.agents[at(module)]; }

  bool takes_part(std::int32_t module) const { return modules_.ports[at(module)].takes_part(); }

  std::uint64_t window_count() const { return window_count_; }

  std::int32_t agent_count() const { return modules_.count(); }

 private:
  using Kind = Happening::Kind;

  static constexpr std::uint32_t kPrefetchAhead = 2;

  static std::size_t at(std::int32_t module) { return Modules::at(module); }

  Port& port(std::int32_t module) { return modules_.ports[at(module)]; }

  Region& region(std::int32_t module) { return *regions_[at(module) >> region_bits_]; }

  // engine.cpp: the loop.
  bool is_at_rest(Time next) const;
  void handle(const QueuedEvent& event);

  // windows.cpp
  void make_regions();
  bool can_run_ahead();
  void run_ahead();

  // changes.cpp: starting, faults.
  void boot();
  void tell_step();
  void start(std::int32_t module);
  void link_up(std::int32_t module, base::Direction face);

  void hand_in(std::int32_t module, const agent::Event& event) {
    region(module).hand_in(now_, module, event);
  }

  void make_fault(const Fault& fault);
  void make_link_fault(const Fault& fault);
  void tell_neighbours(std::int32_t module, agent::EventKind kind);
  void detach(std::int32_t module);
  void attach(std::int32_t module);
  void begin_anew(std::int32_t module);
  void announce(const Announcement& announcement);

  // outcome.cpp
  void finish();

  Modules modules_;
  Ledger ledger_;
  unsigned region_bits_ = 0;  ///< A region has two to this power modules, but the last one.
  std::vector<std::unique_ptr<Region>> region_store_;
  std::vector<Region*> regions_;
  std::unique_ptr<host::Team> team_;  ///< Not before a window is run ahead.
  std::uint64_t window_count_ = 0;    ///< Those that were run ahead.
  Time now_ = 0;
  Time break_at_ = agent::kNever;  ///< Of the last thing that nobody was told of.
  bool is_booted_ = false;
  bool is_quiet_ = false;
  bool is_over_ = false;
};

}  // namespace holdfast::sim
