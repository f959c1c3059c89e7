// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/host/text.hpp"
#include "world/environment_map.hpp"

namespace holdfast::sim {
namespace {

std::optional<std::string> find_module_fault(const char* what, std::int32_t module,
                                             std::size_t count) {
  if (module >= 0 && static_cast<std::size_t>(module) < count) {
    return std::nullopt;
  }
  return fmt::format("{} is {}, expected existing modules: 0 to {}", what, module, count - 1);
}

/// Whether some support has a coefficient of friction.
bool has_friction(const model::Robot& robot) {
  return std::ranges::any_of(
      robot.facets(), [](const model::Facet& facet) { return facet.touch.friction.has_value(); });
}

std::optional<std::string> find_unknown_fault(const model::Robot& robot) {
  if (const auto unknown = find_unknown_to_modules(robot)) {
    return "the robot has " + *unknown + ", which the modules' program does not know";
  }
  return std::nullopt;
}

/// The modules' own program takes every neighbour for connected, unless it is told otherwise in the
/// words of a step, which know nothing of what else happens.
std::optional<std::string> find_robot_fault(const model::Robot& robot,
                                            const SimulationOptions& options) {
  if (auto unknown = find_unknown_fault(robot)) {
    return unknown;
  }
  const bool is_told = !options.step.empty() && robot.planned_count() == 0 &&
                       options.faults.empty() && options.announcements.empty();
  if (robot.released_count() == 0 || is_told) {
    return std::nullopt;
  }
  return fmt::format(
      "the robot has {} that {} not connected: modules are told of that by 'simulate' alone, and "
      "not with planned modules, changes or faults; try 'simulate --stages' of a file whose "
      "steps attach what is planned",
      host::counted(robot.released_count(), "pair") + " of neighbours",
      robot.released_count() == 1 ? "is" : "are");
}

/// The number of a lattice in greetings.
std::uint8_t wire_number(const base::Lattice& lattice) {
  return lattice == base::kCubic         ? agent::wire::kCubicLattice
         : lattice == base::kFaceCentred ? agent::wire::kFaceCentredLattice
         : lattice == base::kHexagonal   ? agent::wire::kHexagonalLattice
                                         : agent::wire::kHexagonalPrismLattice;
}

/// Finds a fault unless every face of the lattice is named once.
std::optional<std::string> find_faces_fault(const model::Robot& robot, const Misplaced& misplaced) {
  std::uint32_t seen = 0;
  const auto count = static_cast<std::size_t>(robot.lattice().direction_count);
  for (std::size_t i = 0; i < count; ++i) {
    seen |= 1U << static_cast<unsigned>(base::index(misplaced.faces[i]));
  }
  if (seen == (1U << count) - 1) {
    return std::nullopt;
  }
  return fmt::format("the faces of misplaced module {} are not {} different ones of its lattice",
                     misplaced.module, count);
}

/// Finds a fault in an announcement: what is in a cell where the robot has no module is known only
/// of a floor.
std::optional<std::string> find_place_fault(const model::Robot& robot,
                                            const Announcement& announcement) {
  const auto is_there = [&](const model::Module& module) {
    return module.cell == announcement.cell;
  };
  if (announcement.is_withdrawal || !needs_environment(robot) ||
      std::ranges::any_of(robot.modules(), is_there)) {
    return std::nullopt;
  }
  return fmt::format(
      "a module is planned at {}, expected cells of the robot's modules, as it has more than a "
      "floor",
      model::text(announcement.cell));
}

}  // namespace

std::optional<std::string> find_options_fault(const model::Robot& robot,
                                              const SimulationOptions& options) {
  const std::size_t count = robot.modules().size() - robot.planned_count();
  auto found = find_robot_fault(robot, options);
  if (!found && options.judges_faces) {
    found = find_floor_fault(robot);
  }
  if (!found && options.step_end != nullptr) {
    found = find_unknown_fault(*options.step_end);
  }
  if (!found && !options.step.empty() && options.judges_faces) {
    found = "the options ask for stages of a step and for free faces, expected one of them";
  }
  found = found ? found : find_link_fault(options.link);
  found = found ? found : find_module_fault("anchor", options.anchor, count);
  found = found ? found : find_module_fault("plan_module", options.plan_module, count);
  for (std::size_t i = 0; !found && i < options.misplaced.size(); ++i) {
    found = find_module_fault("misplaced module", options.misplaced[i].module, count);
    found = found ? found : find_faces_fault(robot, options.misplaced[i]);
  }
  for (std::size_t i = 0; !found && i < options.told_cells.size(); ++i) {
    found = find_module_fault("module that is told its cell", options.told_cells[i].module, count);
  }
  if (!found && options.step.size() > agent::kWordCountMax) {
    found = fmt::format("the step has {} words, expected at most {}: modules keep no more",
                        options.step.size(), agent::kWordCountMax);
  }
  for (std::size_t i = 0; !found && i < options.announcements.size(); ++i) {
    found = find_module_fault("module of an announcement", options.announcements[i].module, count);
    found = found ? found : find_place_fault(robot, options.announcements[i]);
  }
  for (std::size_t i = 0; !found && i < options.absent.size(); ++i) {
    found = find_module_fault("module that is absent", options.absent[i], count);
  }
  for (std::size_t i = 0; !found && i < options.faults.size(); ++i) {
    const Fault& fault = options.faults[i];
    found = find_module_fault("module of a fault", fault.module, count);
    if (!found && is_of_link(fault.kind)) {
      const auto& neighbours = robot.neighbours()[static_cast<std::size_t>(fault.module)];
      const std::int32_t other = neighbours[static_cast<std::size_t>(base::index(fault.face))];
      if (other < 0 || static_cast<std::size_t>(other) >= count) {
        found =
            fmt::format("the module {} has no neighbour at face {}, so there is no link to {}",
                        model::text(robot.modules()[static_cast<std::size_t>(fault.module)].cell),
                        base::index(fault.face), name(fault.kind));
      }
    }
  }
  if (!found && options.tells_planned && robot.planned_count() > 0 &&
      !starts_attached(options, options.plan_module)) {
    found = fmt::format("plan_module {} is not there at the start", options.plan_module);
  }
  return found;
}

std::optional<std::string> find_floor_fault(const model::Robot& robot) {
  if (const auto beyond = model::find_beyond_paper(robot)) {
    return "the robot has " + *beyond + ", and these modules know cubes on a floor only";
  }
  return std::nullopt;
}

agent::Setup make_setup(const model::Robot& robot, const SimulationOptions& options) {
  const model::Material& material = robot.material();
  const FootParts foot = foot_parts(robot, agent::kFacetPartMax);
  agent::Setup setup;
  setup.section = model::beam_section(material);
  setup.facet_mm = material.facet_mm;
  setup.weight_n = model::module_weight_n(material);
  setup.strength_vertical_n = material.strength_vertical_n;
  setup.strength_lateral_n = material.strength_lateral_n;
  setup.contact_gamma = material.contact_gamma;
  setup.facet_numerator = foot.numerator;
  setup.facet_denominator = foot.denominator;
  setup.support_z = robot.support_z();
  const bool is_level =
      stands_level(robot) && (options.step_end == nullptr || stands_level(*options.step_end));
  setup.method = options.method.value_or(
      options.only_one_sweep || is_level ? agent::Method::kElimination : agent::Method::kFronts);
  setup.only_one_sweep = options.only_one_sweep;
  const bool has_map = needs_environment(robot, options.step_end);
  setup.has_friction =
      has_friction(robot) || (options.step_end != nullptr && has_friction(*options.step_end));
  setup.keeps_answers = options.keeps_answers && !setup.has_friction && (!has_map || is_level);
  const RatioBounds bounds = ratio_bounds(robot, options.step_end);
  setup.ratio_per_n = bounds.per_n;
  setup.ratio_per_nmm = bounds.per_nmm;
  setup.ratio_per_energy_root = bounds.per_energy_root;
  setup.slack_bits = bounds.slack_bits;
  setup.judges_bending = robot.is_modulus_stated() && !options.only_one_sweep;
  setup.lattice = robot.lattice();
  const auto plane = has_map ? find_support_plane(robot, options.step_end) : std::nullopt;
  if (plane) {
    setup.has_plane = true;
    setup.plane_axes = {plane->axes[0], plane->axes[1]};
  }
  setup.timing = link_timing(options.link, robot.lattice().direction_count);
  setup.timing.lattice = wire_number(robot.lattice());
  agent::prepare(setup);
  return setup;
}

Simulation::Simulation(const model::Robot& robot, SimulationOptions options) {
  HOLDFAST_CHECK(!find_options_fault(robot, options));
  engine_ = std::make_unique<Engine>(robot, std::move(options));
}

Simulation::Simulation(Simulation&&) noexcept = default;

Simulation& Simulation::operator=(Simulation&&) noexcept = default;

Simulation::~Simulation() = default;

void Simulation::run() {
  while (engine_->run_for(~std::uint64_t{0})) {
  }
}

bool Simulation::run_for(std::uint64_t event_count) { return engine_->run_for(event_count); }

void Simulation::happen(const Fault& fault) { engine_->happen(fault); }

void Simulation::happen(const Announcement& announcement) { engine_->happen(announcement); }

SimulationResult Simulation::result() const { return engine_->result(); }

std::uint64_t Simulation::window_count() const { return engine_->window_count(); }

SimulationResult Simulation::counts() const { return engine_->counts(); }

const agent::Agent& Simulation::agent(std::int32_t module) const { return engine_->agent(module); }

bool Simulation::is_alive(std::int32_t module) const { return engine_->takes_part(module); }

std::int32_t Simulation::agent_count() const { return engine_->agent_count(); }

}  // namespace holdfast::sim
