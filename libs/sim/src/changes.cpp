// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <memory>

#include "engine.hpp"
#include "holdfast/base/check.hpp"

/// Starting a robot, and what is done to it later.
namespace holdfast::sim {
namespace {

/// Increments of the random number of link-ups: odd, so that 65,536 link-ups all differ.
constexpr unsigned kRandomStep = 0x9e37;

agent::Identity identity_of(const model::Robot& robot, std::size_t module, std::int32_t anchor) {
  const model::Module& description = robot.modules()[module];
  return {.id = static_cast<std::uint32_t>(module + 1),
          .is_fixed = description.support == model::Support::kFixed,
          .is_anchor = module == static_cast<std::size_t>(anchor),
          .cell = description.cell};
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

}  // namespace

bool starts_attached(const SimulationOptions& options, std::int32_t module) {
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
      pool_(options_.link.packet_bytes),
      recorder_(options_.trace) {
  for (std::size_t size = 0; size < line_times_.size(); ++size) {
    line_times_[size] = line_time(options_.link, static_cast<int>(size));
  }
  const std::size_t count = robot.modules().size() - robot.planned_count();
  static_assert(model::kModuleCountMax < (std::size_t{1} << kModuleBits));
  agents_.reserve(count);
  ports_.resize(count);
  // A seed of its own for each module: consecutive seeds of the whole do not overlap.
  const std::uint64_t base = base::Rng(options_.seed).next();
  for (std::size_t i = 0; i < count; ++i) {
    agents_.emplace_back(setup_, identity_of(robot, i, options_.anchor));
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
    start(module);
  }
}

/// A module starts and senses its neighbours.
void Engine::start(std::int32_t module) {
  hand_in(module, event_of(agent::EventKind::kStart));
  for (const base::Direction face : base::kDirections) {
    const std::int32_t other = neighbour(module, face);
    if (other >= 0 && ports_[at(other)].is_attached) {
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

void Engine::make_fault(const Fault& fault) {
  if (recorder_.trace() != nullptr) {
    recorder_.trace()->fault_happened(fault);
  }
  Port& port = ports_[at(fault.module)];
  const auto cut = [&](std::int32_t module, base::Direction face) {
    Port& end = ports_[at(module)];
    end.cut_faces = static_cast<std::uint8_t>(end.cut_faces | (1U << static_cast<unsigned>(face)));
  };
  switch (fault.kind) {
    case Fault::Kind::kKill:
      break_at_ = now_;
      port.is_silenced = true;
      silence(fault.module);
      break;
    case Fault::Kind::kCut:
      break_at_ = now_;
      cut(fault.module, fault.face);
      cut(neighbour(fault.module, fault.face), base::opposite(fault.face));
      break;
    case Fault::Kind::kDetach:
      detach(fault.module);
      break;
    case Fault::Kind::kAttach:
      attach(fault.module);
      break;
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
  for (const base::Direction face : base::kDirections) {
    const std::int32_t other = neighbour(module, face);
    if (other >= 0 && ports_[at(other)].takes_part()) {
      hand_in(other, event_of(agent::EventKind::kLinkDown, base::opposite(face)));
    }
  }
}

/// A new module comes to the place: everything begins anew but what concerns lines and the queue.
void Engine::attach(std::int32_t module) {
  Port& port = ports_[at(module)];
  if (port.is_attached) {
    return;
  }
  agent::Agent* place = &agents_[at(module)];
  std::destroy_at(place);
  std::construct_at(place, setup_, identity_of(robot_, at(module), options_.anchor));
  port.epoch = 0;
  port.phase = agent::Phase::kDiscovery;
  port.verdict = agent::Verdict::kNone;
  port.is_attached = true;
  port.is_silenced = false;
  start(module);
  for (const base::Direction face : base::kDirections) {
    const std::int32_t other = neighbour(module, face);
    if (other >= 0 && ports_[at(other)].takes_part()) {
      link_up(other, base::opposite(face));
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
