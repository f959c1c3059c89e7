// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "holdfast/agent/agent.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/sim/fault.hpp"
#include "holdfast/sim/link_model.hpp"
#include "holdfast/sim/simulation_result.hpp"
#include "holdfast/sim/trace.hpp"

/// A robot that computes its own verdict: an agent for every existing module, lines between them,
/// and time that jumps from event to event. The same inputs give the same events and the same
/// trace hash on every platform.
namespace holdfast::sim {

/// A function that changes what a module sends before it is on its line: `packet` holds `size`
/// bytes and has room for those of the largest packet. Returns the new size.
using Tamper = std::function<int(Time now, std::int32_t module, base::Direction face,
                                 std::span<std::uint8_t> packet, int size)>;

struct SimulationOptions {
  LinkModel link = unit();
  std::uint64_t seed = 1;  ///< Of noise, clocks and session numbers.
  /// The method of agent::Setup; if there is none, elimination on a level floor under weight alone,
  /// from which a robot goes on at its next change, and fronts elsewhere. A robot that is not of
  /// cubes on a floor is lent memory anyway, and then that for fronts, too.
  std::optional<agent::Method> method = {};
  bool only_one_sweep = false;  ///< See agent::Setup: modules with little flash.
  bool keeps_answers = true;    ///< See agent::Setup. False: every change starts from nothing.
  bool deflates = false;        ///< Modules have the memory to keep how they moved (deflation.hpp).
  bool judges_faces = false;    ///< Modules have the memory to judge free faces (free_faces.hpp).
  /// Modules have the memory for 30 planned ones, not 5 (more_planned.hpp). They have it anyway
  /// where the robot, the step and `announcements` have more than 5 together.
  bool plans_many = false;
  std::vector<Fault> faults = {};
  std::vector<std::int32_t> absent = {};         ///< Modules that are not there at the start.
  std::vector<Announcement> announcements = {};  ///< Besides the robot's planned modules.
  std::vector<Misplaced> misplaced = {};         ///< Modules that are put on wrongly.
  /// Anchors besides `anchor`; with that module here, it is told this cell.
  std::vector<ToldCell> told_cells = {};
  /// The words of a step; if there are any, modules have memory to judge its stages.
  std::vector<agent::StepWord> step = {};
  /// The robot as the step leaves it, where it is more than cubes on a floor; not owned. Without,
  /// modules know nothing of what a new one touches and weighs, and its stage is undecided.
  const model::Robot* step_end = nullptr;
  Time time_max = agent::kNever;  ///< Later events do not happen.
  std::uint64_t event_count_max = ~std::uint64_t{0};
  /// The time after the last verdict for which the modules' watching over it is simulated as well.
  Time watch_for = 0;
  std::int32_t anchor = 0;  ///< The module that knows its cell.
  /// The module that is told of the robot's planned modules, and of the step, before it starts.
  std::int32_t plan_module = 0;
  bool tells_planned = true;  ///< False: nobody is told of them but by `announcements`.
  int thread_count = 0;       ///< Of the simulation; 0: as many as the machine has cores.
  /// Modules handle events in groups, and threads share them, where so many are near; fewer are
  /// handled one by one. The result is the same.
  std::size_t window_events_min = 1000;
  TraceSink* trace = nullptr;  ///< Not owned; outlives the simulation.
  Tamper tamper = {};          ///< Called for every packet, if there is one: faulty modules.
};

/// Says why a simulation cannot be made (what, value found, values allowed), if it cannot.
std::optional<std::string> find_options_fault(const model::Robot& robot,
                                              const SimulationOptions& options);

/// Says why modules that are lent no memory, as all that run elsewhere than in Simulation, do not
/// know enough of a robot; none if it is cubes on a floor under their weight.
std::optional<std::string> find_floor_fault(const model::Robot& robot);

/// Makes the setup that the agents of a robot have in common.
agent::Setup make_setup(const model::Robot& robot, const SimulationOptions& options);

/// Whether the module is there at the start: not if it is put on before it is taken off.
bool starts_attached(const SimulationOptions& options, std::int32_t module);

class Engine;

class Simulation {
 public:
  /// Keeps a reference to the robot. Options with a fault are a bug of the caller.
  Simulation(const model::Robot& robot, SimulationOptions options);
  Simulation(model::Robot&&, SimulationOptions) = delete;
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  /// Runs until nothing can happen any more or a limit is reached. Modules watch over their verdict
  /// for ever; the run ends when that is all they do and there is nothing that it could find.
  void run();

  /// Hands about `event_count` events to modules. False: it is over. The first call also starts all
  /// modules, which counts.
  bool run_for(std::uint64_t event_count);

  /// Makes a fault happen now, in a simulation without faults and `watch_for` that has come to its
  /// end; it can be run again then.
  void happen(const Fault& fault);
  void happen(const Announcement& announcement);

  /// The result so far.
  SimulationResult result() const;

  /// The result so far without what modules say: answer, agreement, root, and the busiest one.
  SimulationResult counts() const;

  /// How often modules have handled events in groups (SimulationOptions::window_events_min).
  std::uint64_t window_count() const;

  /// The agent of an existing module.
  const agent::Agent& agent(std::int32_t module) const;

  /// Whether the module is attached and not silenced.
  bool is_alive(std::int32_t module) const;

  std::int32_t agent_count() const;

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace holdfast::sim
