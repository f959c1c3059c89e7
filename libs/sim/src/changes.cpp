// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "engine.hpp"
#include "holdfast/base/check.hpp"

/// Starting a robot, and what is done to it later.
namespace holdfast::sim {
namespace {

/// Increments of the random number of link-ups: odd, so that 65,536 link-ups all differ.
constexpr unsigned kRandomStep = 0x9e37;

/// The shortest time in which something that a module does reaches another one.
Time shortest_flight(const LinkModel& link) {
  constexpr int kBytesMin = agent::wire::kHeaderBytes + agent::wire::kChecksumBytes;
  return line_time(link, kBytesMin) + link.latency;
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
    : modules_(robot, std::move(options)),
      ledger_(modules_.options.trace, shortest_flight(modules_.options.link)) {
  make_regions();
  const std::vector<Fault>& faults = modules_.options.faults;
  const std::vector<Announcement>& announcements = modules_.options.announcements;
  for (std::size_t i = 0; i < faults.size(); ++i) {
    ledger_.push(faults[i].at,
                 Happening{.kind = Kind::kFault, .item = static_cast<std::uint32_t>(i)});
  }
  for (std::size_t i = 0; i < announcements.size(); ++i) {
    ledger_.push(announcements[i].at,
                 Happening{.kind = Kind::kAnnounce, .item = static_cast<std::uint32_t>(i)});
  }
}

/// All modules start at time 0, in the order of their indices.
void Engine::boot() {
  is_booted_ = true;
  if (ledger_.recorder.trace() != nullptr) {
    ledger_.recorder.trace()->begin(modules_.robot, modules_.options.link);
  }
  for (std::int32_t module = 0; module < agent_count(); ++module) {
    if (!port(module).is_attached) {
      continue;
    }
    if (modules_.options.tells_planned && module == modules_.options.plan_module) {
      for (std::size_t i = at(agent_count()); i < modules_.robot.modules().size(); ++i) {
        announce({.at = 0, .module = module, .cell = modules_.robot.modules()[i].cell});
      }
    }
    if (module == modules_.options.plan_module) {
      tell_step();
    }
    start(module);
  }
}

void Engine::tell_step() {
  for (std::size_t i = 0; i < modules_.options.step.size(); ++i) {
    agent::Event event = event_of(agent::EventKind::kStep);
    event.word = modules_.options.step[i];
    event.index = static_cast<std::uint8_t>(i);
    event.total = static_cast<std::uint8_t>(modules_.options.step.size());
    hand_in(modules_.options.plan_module, event);
  }
}

/// A module starts and senses its neighbours.
void Engine::start(std::int32_t module) {
  hand_in(module, event_of(agent::EventKind::kStart));
  for (const base::Direction face : base::directions(modules_.robot.lattice())) {
    const std::int32_t other = modules_.neighbour(module, face);
    if (other >= 0 && port(other).is_attached && !port(module).open_faces.has(face)) {
      link_up(module, face);
    }
  }
}

void Engine::link_up(std::int32_t module, base::Direction face) {
  Port& here = port(module);
  do {
    here.random = static_cast<std::uint16_t>(here.random + kRandomStep);
  } while (here.random == 0);
  agent::Event event = event_of(agent::EventKind::kLinkUp, face);
  event.random = here.random;
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
  if (ledger_.recorder.trace() != nullptr) {
    ledger_.recorder.trace()->fault_happened(fault);
  }
  Port& here = port(fault.module);
  switch (fault.kind) {
    case Fault::Kind::kKill:
      break_at_ = now_;
      here.is_silenced = true;
      region(fault.module).silence(now_, fault.module);
      break;
    case Fault::Kind::kCut:
    case Fault::Kind::kMend:
    case Fault::Kind::kUnplug:
    case Fault::Kind::kPlug:
      make_link_fault(fault);
      break;
    case Fault::Kind::kReset:
      break_at_ = now_;
      if (here.is_attached) {
        region(fault.module).silence(now_, fault.module);
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
  const std::int32_t other = modules_.neighbour(fault.module, fault.face);
  const bool is_silent = fault.kind == Fault::Kind::kCut || fault.kind == Fault::Kind::kMend;
  break_at_ = is_silent ? now_ : break_at_;
  const bool was_open = port(fault.module).open_faces.has(fault.face);
  for (const auto& [module, face] :
       {std::pair{fault.module, fault.face}, std::pair{other, base::opposite(fault.face)}}) {
    Port& end = port(module);
    if (is_silent) {
      end.cut_faces.set(face, fault.kind == Fault::Kind::kCut);
    } else {
      end.open_faces.set(face, fault.kind == Fault::Kind::kUnplug);
    }
  }
  const bool is_open = port(fault.module).open_faces.has(fault.face);
  if (was_open == is_open || !port(fault.module).is_attached || !port(other).is_attached) {
    return;
  }
  for (const auto& [module, face] :
       {std::pair{fault.module, fault.face}, std::pair{other, base::opposite(fault.face)}}) {
    if (!port(module).takes_part()) {
      continue;
    }
    if (is_open) {
      hand_in(module, event_of(agent::EventKind::kLinkDown, face));
    } else {
      link_up(module, face);
    }
  }
}

void Engine::detach(std::int32_t module) {
  Port& here = port(module);
  if (!here.is_attached) {
    return;
  }
  here.is_attached = false;
  region(module).silence(now_, module);
  std::erase_if(modules_.options.misplaced,
                [module](const Misplaced& wrong) { return wrong.module == module; });
  tell_neighbours(module, agent::EventKind::kLinkDown);
}

void Engine::attach(std::int32_t module) {
  if (!port(module).is_attached) {
    begin_anew(module);
    tell_neighbours(module, agent::EventKind::kLinkUp);
  }
}

/// A new agent starts at the place: everything begins anew but what concerns lines and the queue.
void Engine::begin_anew(std::int32_t module) {
  modules_.begin_anew(module);
  Port& here = port(module);
  here.seen = {};
  here.is_attached = true;
  here.is_silenced = false;
  start(module);
}

/// Tells the neighbours at all faces of a module what has happened to it.
void Engine::tell_neighbours(std::int32_t module, agent::EventKind kind) {
  for (const base::Direction face : base::directions(modules_.robot.lattice())) {
    const std::int32_t other = modules_.neighbour(module, face);
    if (other < 0 || !port(other).takes_part() || port(module).open_faces.has(face)) {
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
  if (ledger_.recorder.trace() != nullptr) {
    ledger_.recorder.trace()->announced(announcement);
  }
  if (port(announcement.module).takes_part()) {
    agent::Event event = event_of(announcement.is_withdrawal ? agent::EventKind::kWithdraw
                                                             : agent::EventKind::kPlan);
    event.cell = announcement.cell;
    hand_in(announcement.module, event);
  }
}

}  // namespace holdfast::sim
