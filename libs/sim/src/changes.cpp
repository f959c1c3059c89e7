// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "engine.hpp"
#include "holdfast/base/check.hpp"

/// Starting a robot, and what is done to it later.
namespace holdfast::sim {
namespace {

/// Increments of the random number of link-ups: odd, so that 65,536 link-ups all differ.
constexpr unsigned kRandomStep = 0x9e37;

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

bool starts_attached(const SimulationOptions& options, std::int32_t module) {
  if (std::ranges::find(options.absent, module) != options.absent.end()) {
    return false;
  }
  const Fault* first = nullptr;
  for (const Fault& fault : options.faults) {
    const bool is_change = fault.kind == Fault::Kind::kAttach || fault.kind == Fault::Kind::kDetach;
    if (is_change && fault.module == module && (first == nullptr || fault.at < first->at)) {
      first = &fault;
    }
  }
  return first == nullptr || first->kind == Fault::Kind::kDetach;
}

Engine::Engine(const model::Robot& robot, SimulationOptions options)
    : robot_(robot),
      options_(std::move(options)),
      setup_(make_setup(robot, options_)),
      noise_(options_.link),
      is_noisy_(has_noise(options_.link)),
      lent_(robot, robot.modules().size() - robot.planned_count(),
            {.has_fronts = lends_fronts(robot, options_),
             .has_stages = !options_.step.empty(),
             .judges_faces = options_.judges_faces,
             .keeps_changes = options_.deflates && setup_.keeps_answers,
             .plans_many = plans_many(robot, options_),
             .step_end = options_.step_end}),
      pool_(options_.link.packet_bytes),
      recorder_(options_.trace) {
  for (std::size_t size = 0; size < line_times_.size(); ++size) {
    line_times_[size] = line_time(options_.link, static_cast<int>(size));
  }
  const std::size_t count = robot.modules().size() - robot.planned_count();
  static_assert(model::kModuleCountMax < (std::size_t{1} << kModuleBits));
  agents_.reserve(count);
  ports_.resize(count);
  more_lines_.resize(robot.lattice().direction_count > base::kDirectionCount ? count : 0);
  // A seed of its own for each module: consecutive seeds of the whole do not overlap.
  const std::uint64_t base = base::Rng(options_.seed).next();
  for (std::size_t i = 0; i < count; ++i) {
    agents_.emplace_back(setup_, identity_of(robot, i, options_), lent_.memory_of(i));
    Port& port = ports_[i];
    port.rng = base::Rng(base::Rng(base + i).next());
    port.random = static_cast<std::uint16_t>(port.rng.next());
    port.clock = draw_clock(options_.link, port.rng);
  }
  for (const Fault& fault : options_.faults) {
    if (fault.kind == Fault::Kind::kAttach) {
      ports_[at(fault.module)].is_attached = starts_attached(options_, fault.module);
    }
  }
  for (const std::int32_t module : options_.absent) {
    ports_[at(module)].is_attached = false;
  }
  for (std::size_t i = 0; i < options_.faults.size(); ++i) {
    push(options_.faults[i].at, {.kind = Kind::kFault, .item = static_cast<std::uint32_t>(i)});
  }
  for (std::size_t i = 0; i < options_.announcements.size(); ++i) {
    push(options_.announcements[i].at,
         {.kind = Kind::kAnnounce, .item = static_cast<std::uint32_t>(i)});
  }
}

/// The neighbour's index, or -1 if there is none or it is only planned.
std::int32_t Engine::neighbour(std::int32_t module, base::Direction face) const {
  const std::int32_t other =
      robot_.neighbours()[at(module)][static_cast<std::size_t>(base::index(face))];
  return other < agent_count() ? other : model::Robot::kNoNeighbour;
}

/// All modules start at time 0, in the order of their indices.
void Engine::boot() {
  is_booted_ = true;
  if (recorder_.trace() != nullptr) {
    recorder_.trace()->begin(robot_, options_.link);
  }
  for (std::int32_t module = 0; module < agent_count(); ++module) {
    if (!ports_[at(module)].is_attached) {
      continue;
    }
    if (options_.tells_planned && module == options_.plan_module) {
      for (std::size_t i = at(agent_count()); i < robot_.modules().size(); ++i) {
        announce({.at = 0, .module = module, .cell = robot_.modules()[i].cell});
      }
    }
    if (module == options_.plan_module) {
      tell_step();
    }
    start(module);
  }
}

void Engine::tell_step() {
  for (std::size_t i = 0; i < options_.step.size(); ++i) {
    agent::Event event = event_of(agent::EventKind::kStep);
    event.word = options_.step[i];
    event.index = static_cast<std::uint8_t>(i);
    event.total = static_cast<std::uint8_t>(options_.step.size());
    hand_in(options_.plan_module, event);
  }
}

/// A module starts and senses its neighbours.
void Engine::start(std::int32_t module) {
  hand_in(module, event_of(agent::EventKind::kStart));
  for (const base::Direction face : base::directions(robot_.lattice())) {
    const std::int32_t other = neighbour(module, face);
    if (other >= 0 && ports_[at(other)].is_attached && !ports_[at(module)].open_faces.has(face)) {
      link_up(module, face);
    }
  }
}

void Engine::link_up(std::int32_t module, base::Direction face) {
  Port& port = ports_[at(module)];
  do {
    port.random = static_cast<std::uint16_t>(port.random + kRandomStep);
  } while (port.random == 0);
  agent::Event event = event_of(agent::EventKind::kLinkUp, face);
  event.random = port.random;
  hand_in(module, event);
}

void Engine::happen(const Fault& fault) {
  is_over_ = false;
  make_fault(fault);
}

void Engine::happen(const Announcement& announcement) {
  is_over_ = false;
  announce(announcement);
}

void Engine::make_fault(const Fault& fault) {
  if (recorder_.trace() != nullptr) {
    recorder_.trace()->fault_happened(fault);
  }
  Port& port = ports_[at(fault.module)];
  switch (fault.kind) {
    case Fault::Kind::kKill:
      break_at_ = now_;
      port.is_silenced = true;
      silence(fault.module);
      break;
    case Fault::Kind::kCut:
    case Fault::Kind::kMend:
    case Fault::Kind::kUnplug:
    case Fault::Kind::kPlug:
      make_link_fault(fault);
      break;
    case Fault::Kind::kReset:
      break_at_ = now_;
      if (port.is_attached) {
        silence(fault.module);
        begin_anew(fault.module);
      }
      break;
    case Fault::Kind::kDetach:
      detach(fault.module);
      break;
    case Fault::Kind::kAttach:
      attach(fault.module);
      break;
  }
}

/// Changes both ends of a link.
void Engine::make_link_fault(const Fault& fault) {
  const std::int32_t other = neighbour(fault.module, fault.face);
  const bool is_silent = fault.kind == Fault::Kind::kCut || fault.kind == Fault::Kind::kMend;
  break_at_ = is_silent ? now_ : break_at_;
  const bool was_open = ports_[at(fault.module)].open_faces.has(fault.face);
  for (const auto& [module, face] :
       {std::pair{fault.module, fault.face}, std::pair{other, base::opposite(fault.face)}}) {
    Port& end = ports_[at(module)];
    if (is_silent) {
      end.cut_faces.set(face, fault.kind == Fault::Kind::kCut);
    } else {
      end.open_faces.set(face, fault.kind == Fault::Kind::kUnplug);
    }
  }
  const bool is_open = ports_[at(fault.module)].open_faces.has(fault.face);
  if (was_open == is_open || !ports_[at(fault.module)].is_attached ||
      !ports_[at(other)].is_attached) {
    return;
  }
  for (const auto& [module, face] :
       {std::pair{fault.module, fault.face}, std::pair{other, base::opposite(fault.face)}}) {
    if (!ports_[at(module)].takes_part()) {
      continue;
    }
    if (is_open) {
      hand_in(module, event_of(agent::EventKind::kLinkDown, face));
    } else {
      link_up(module, face);
    }
  }
}

/// The agent gets no more events; those that wait for it are void.
void Engine::silence(std::int32_t module) {
  Port& port = ports_[at(module)];
  set_wake(port, agent::kNever, false);
  port.wanted = 0;
  while (port.waiting_first != Port::kNoEvent) {
    const Happening what = take_waiting(module);
    if (what.kind == Kind::kDeliver) {
      drop(what);
    }
  }
}

void Engine::detach(std::int32_t module) {
  Port& port = ports_[at(module)];
  if (!port.is_attached) {
    return;
  }
  port.is_attached = false;
  silence(module);
  std::erase_if(options_.misplaced,
                [module](const Misplaced& wrong) { return wrong.module == module; });
  tell_neighbours(module, agent::EventKind::kLinkDown);
}

void Engine::attach(std::int32_t module) {
  if (!ports_[at(module)].is_attached) {
    begin_anew(module);
    tell_neighbours(module, agent::EventKind::kLinkUp);
  }
}

/// A new agent starts at the place: everything begins anew but what concerns lines and the queue.
void Engine::begin_anew(std::int32_t module) {
  agent::Agent* place = &agents_[at(module)];
  std::destroy_at(place);
  std::construct_at(place, setup_, identity_of(robot_, at(module), options_),
                    lent_.memory_of(at(module)));
  Port& port = ports_[at(module)];
  port.seen = {};
  port.is_attached = true;
  port.is_silenced = false;
  start(module);
}

/// Tells the neighbours at all faces of a module what has happened to it.
void Engine::tell_neighbours(std::int32_t module, agent::EventKind kind) {
  for (const base::Direction face : base::directions(robot_.lattice())) {
    const std::int32_t other = neighbour(module, face);
    if (other < 0 || !ports_[at(other)].takes_part() || ports_[at(module)].open_faces.has(face)) {
      continue;
    }
    if (kind == agent::EventKind::kLinkUp) {
      link_up(other, base::opposite(face));
    } else {
      hand_in(other, event_of(kind, base::opposite(face)));
    }
  }
}

void Engine::announce(const Announcement& announcement) {
  if (recorder_.trace() != nullptr) {
    recorder_.trace()->announced(announcement);
  }
  if (ports_[at(announcement.module)].takes_part()) {
    agent::Event event = event_of(announcement.is_withdrawal ? agent::EventKind::kWithdraw
                                                             : agent::EventKind::kPlan);
    event.cell = announcement.cell;
    hand_in(announcement.module, event);
  }
}

}  // namespace holdfast::sim
