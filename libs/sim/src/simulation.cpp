// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/sim/simulation.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numeric>

#include "engine.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::sim {
namespace {

std::optional<std::string> find_module_fault(const char* what, std::int32_t module,
                                             std::size_t count) {
  if (module >= 0 && static_cast<std::size_t>(module) < count) {
    return std::nullopt;
  }
  return fmt::format("{} is {}, allowed are existing modules: 0 to {}", what, module, count - 1);
}

/// The modules' own program knows cubes on a floor, and takes every neighbour for connected.
std::optional<std::string> find_robot_fault(const model::Robot& robot) {
  if (const auto beyond = model::find_beyond_paper(robot)) {
    return "the robot has " + *beyond + ", and the modules' program knows cubes on a floor only";
  }
  if (robot.released_count() == 0) {
    return std::nullopt;
  }
  return fmt::format(
      "the robot has {} pairs of neighbours that are not connected, allowed are none: the modules' "
      "program connects all neighbours",
      robot.released_count());
}

}  // namespace

std::optional<std::string> find_options_fault(const model::Robot& robot,
                                              const SimulationOptions& options) {
  const std::size_t count = robot.modules().size() - robot.planned_count();
  auto found = find_robot_fault(robot);
  found = found ? found : find_link_fault(options.link);
  found = found ? found : find_module_fault("anchor", options.anchor, count);
  found = found ? found : find_module_fault("plan_module", options.plan_module, count);
  for (std::size_t i = 0; !found && i < options.announcements.size(); ++i) {
    found = find_module_fault("module of an announcement", options.announcements[i].module, count);
  }
  for (std::size_t i = 0; !found && i < options.faults.size(); ++i) {
    const Fault& fault = options.faults[i];
    found = find_module_fault("module of a fault", fault.module, count);
    if (!found && fault.kind == Fault::Kind::kCut) {
      const auto& neighbours = robot.neighbours()[static_cast<std::size_t>(fault.module)];
      const std::int32_t other = neighbours[static_cast<std::size_t>(base::index(fault.face))];
      if (other < 0 || static_cast<std::size_t>(other) >= count) {
        found = fmt::format("module {} has no link to cut at face {}", fault.module,
                            base::index(fault.face));
      }
    }
  }
  if (!found && options.tells_planned && robot.planned_count() > 0 &&
      !starts_attached(options, options.plan_module)) {
    found = fmt::format("plan_module {} is not there at the start", options.plan_module);
  }
  return found;
}

agent::Setup make_setup(const model::Robot& robot, const SimulationOptions& options) {
  // Facet and pitch as a ratio of whole numbers: rounded to this part, then reduced.
  constexpr std::int32_t kParts = 4096;
  const model::Material& material = robot.material();
  const double parts = std::round(material.facet_mm / material.pitch_mm * kParts);
  const auto numerator = static_cast<std::int32_t>(parts < 1 ? 1 : parts);
  const std::int32_t divisor = std::gcd(numerator, kParts);
  agent::Setup setup;
  setup.section = model::beam_section(material);
  setup.facet_mm = material.facet_mm;
  setup.weight_n = model::module_weight_n(material);
  setup.strength_vertical_n = material.strength_vertical_n;
  setup.strength_lateral_n = material.strength_lateral_n;
  setup.contact_gamma = material.contact_gamma;
  setup.facet_numerator = numerator / divisor;
  setup.facet_denominator = kParts / divisor;
  setup.support_z = robot.support_z();
  setup.method = options.method;
  setup.degree_max = options.degree_max;
  setup.timing = link_timing(options.link);
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

SimulationResult Simulation::result() const { return engine_->result(); }

const agent::Agent& Simulation::agent(std::int32_t module) const { return engine_->agent(module); }

bool Simulation::is_alive(std::int32_t module) const { return engine_->port(module).takes_part(); }

std::int32_t Simulation::agent_count() const { return engine_->agent_count(); }

}  // namespace holdfast::sim
