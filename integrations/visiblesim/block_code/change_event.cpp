// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "change_event.hpp"

#include <iostream>
#include <utility>

#include "holdfast_code.hpp"
#include "robots/blinkyBlocks/blinkyBlocksWorld.h"

namespace holdfast::visiblesim {
namespace {

BaseSimulator::BuildingBlock* find_block(std::uint32_t id) {
  BaseSimulator::BuildingBlock* block =
      BlinkyBlocks::getWorld()->getBlockById(static_cast<int>(id));
  const bool is_there =
      block != nullptr && block->getState() >= BaseSimulator::BuildingBlock::ALIVE;
  return is_there ? block : nullptr;
}

void attach(const base::Cell& cell) {
  auto* world = BlinkyBlocks::getWorld();
  const Cell3DPosition position(static_cast<short>(cell.x), static_cast<short>(cell.y),
                                static_cast<short>(cell.z));
  if (!world->lattice->isInGrid(position) || !world->lattice->isFree(position)) {
    std::cerr << "holdfast: no module can come to " << position
              << ": it is taken or out of the grid" << std::endl;
    return;
  }
  world->addBlock(0, HoldfastCode::build, position, Color());
  world->linkBlock(position);
  world->linkNeighbors(position);
}

class ChangeEvent final : public Event {
 public:
  explicit ChangeEvent(const Change& change) : Event(change.at), change_(change) {
    Session::instance().ensemble().pending_changed(1);
  }

  ~ChangeEvent() override { Session::instance().ensemble().pending_changed(-1); }

  const std::string getEventName() override { return "holdfast change"; }

  void consume() override {
    Session& session = Session::instance();
    if (change_.kind == Change::Kind::kAttach) {
      attach(change_.cell);
      return;
    }
    if (change_.kind == Change::Kind::kPlan) {
      plan(session);
      return;
    }
    BaseSimulator::BuildingBlock* block = find_block(change_.id);
    if (block == nullptr) {
      std::cerr << "holdfast: there is no module " << change_.id << std::endl;
    } else if (change_.kind == Change::Kind::kKill) {
      static_cast<HoldfastCode*>(block->blockCode)->block()->fall_silent();
    } else if (change_.kind == Change::Kind::kDetach) {
      BlinkyBlocks::getWorld()->deleteBlock(block);
    } else {
      BlinkyBlocks::getWorld()->tapBlock(change_.at, block->blockId, -1);
    }
  }

 private:
  void plan(Session& session) const {
    const base::Cell first = session.visiblesim_cell(session.ensemble().first_cell());
    const Cell3DPosition position(static_cast<short>(first.x), static_cast<short>(first.y),
                                  static_cast<short>(first.z));
    auto* block = BlinkyBlocks::getWorld()->lattice->getBlock(position);
    if (block == nullptr) {
      std::cerr << "holdfast: the robot's first module, which is told of plans, is gone"
                << std::endl;
      return;
    }
    const base::Cell cell = session.own_cell(change_.cell);
    session.ensemble().add_plan(cell);
    static_cast<HoldfastCode*>(block->blockCode)->block()->plan(cell);
  }

  Change change_;
};

}  // namespace

void schedule_changes(Session& session, BaseSimulator::Scheduler* scheduler) {
  for (const Change& change : std::exchange(session.settings.changes, {})) {
    scheduler->schedule(new ChangeEvent(change));
  }
}

}  // namespace holdfast::visiblesim
