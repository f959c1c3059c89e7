// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "modules.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace holdfast::sim {
namespace {

agent::Identity identity_of(const model::Robot& robot, std::size_t module,
                            const SimulationOptions& options) {
  const model::Module& description = robot.modules()[module];
  const auto index = static_cast<std::int32_t>(module);
  const auto told = std::ranges::find(options.told_cells, index, &ToldCell::module);
  const bool is_told = told != options.told_cells.end();
  return {.id = static_cast<std::uint32_t>(module + 1),
          .is_fixed = description.support == model::Support::kFixed,
          .is_anchor = is_told || index == options.anchor,
          .cell = is_told ? told->cell : description.cell};
}

Clock draw_clock(const LinkModel& link, base::Rng& rng) {
  const auto rate_max = static_cast<std::uint64_t>(link.clock_drift * 4294967296.0);
  if (rate_max == 0) {
    return {};
  }
  const bool is_slow = rng.below(2) == 0;
  return {static_cast<std::uint32_t>(rng.below(rate_max + 1)), is_slow};
}

bool has_noise(const LinkModel& link) {
  return link.jitter > 0 || link.loss > 0 || link.duplication > 0 || link.reordering > 0 ||
         link.corruption > 0;
}

/// Whether modules have memory for fronts, as those have that know more than a floor.
bool lends_fronts(const model::Robot& robot, const SimulationOptions& options) {
  return options.method == agent::Method::kFronts ||
         (!options.only_one_sweep && needs_environment(robot, options.step_end));
}

/// Whether modules must keep more planned modules than they have room for themselves, those of a
/// step's end included.
bool plans_many(const model::Robot& robot, const SimulationOptions& options) {
  std::set<base::Cell> cells;
  for (std::size_t i = robot.modules().size() - robot.planned_count(); i < robot.modules().size();
       ++i) {
    cells.insert(robot.modules()[i].cell);
  }
  for (const Announcement& announcement : options.announcements) {
    if (!announcement.is_withdrawal) {
      cells.insert(announcement.cell);
    }
  }
  for (const agent::StepWord& word : options.step) {
    if (word.kind == agent::StepWord::Kind::kAttach) {
      cells.insert(word.cell);
    }
  }
  return options.plans_many || cells.size() > static_cast<std::size_t>(agent::kPlannedMax);
}

}  // namespace

Modules::Modules(const model::Robot& the_robot, SimulationOptions the_options)
    : robot(the_robot),
      options(std::move(the_options)),
      setup(make_setup(robot, options)),
      noise(options.link),
      is_noisy(has_noise(options.link)),
      lent(robot, robot.modules().size() - robot.planned_count(),
           {.has_fronts = lends_fronts(robot, options),
            .has_stages = !options.step.empty(),
            .judges_faces = options.judges_faces,
            .keeps_changes = options.deflates && setup.keeps_answers,
            .plans_many = plans_many(robot, options),
            .step_end = options.step_end}) {
  for (std::size_t size = 0; size < line_times.size(); ++size) {
    line_times[size] = line_time(options.link, static_cast<int>(size));
  }
  const std::size_t count = robot.modules().size() - robot.planned_count();
  agents.reserve(count);
  ports.resize(count);
  more_lines.resize(robot.lattice().direction_count > base::kDirectionCount ? count : 0);
  // A seed of its own for each module: consecutive seeds of the whole do not overlap.
  const std::uint64_t base = base::Rng(options.seed).next();
  for (std::size_t i = 0; i < count; ++i) {
    agents.emplace_back(setup, identity_of(robot, i, options), lent.memory_of(i));
    Port& port = ports[i];
    port.rng = base::Rng(base::Rng(base + i).next());
    port.random = static_cast<std::uint16_t>(port.rng.next());
    port.clock = draw_clock(options.link, port.rng);
  }
  for (const Fault& fault : options.faults) {
    if (fault.kind == Fault::Kind::kAttach) {
      ports[at(fault.module)].is_attached = starts_attached(options, fault.module);
    }
  }
  for (const std::int32_t module : options.absent) {
    ports[at(module)].is_attached = false;
  }
}

void Modules::begin_anew(std::int32_t module) {
  agent::Agent* place = &agents[at(module)];
  std::destroy_at(place);
  std::construct_at(place, setup, identity_of(robot, at(module), options),
                    lent.memory_of(at(module)));
}

}  // namespace holdfast::sim
