// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast_code.hpp"

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <vector>

#include "change_event.hpp"
#include "faces.hpp"
#include "packet_message.hpp"
#include "robots/blinkyBlocks/blinkyBlocksWorld.h"

namespace holdfast::visiblesim {
namespace {

/// The purpose of an interruption: the agent's call, or with a face added the line of that face.
constexpr int kCall = 0;
constexpr int kLine = 1;

constexpr int kExitUsage = 64;

}  // namespace

HoldfastCode::HoldfastCode(BlinkyBlocks::BlinkyBlocksBlock* host)
    : BlinkyBlocksBlockCode(host), module_(host) {
  if (host == nullptr) {
    return;
  }
  addMessageEventFunc2(kPacketType, [this](MessagePtr message, P2PNetworkInterface* interface) {
    const auto found = std::ranges::find(interfaces_, interface);
    if (block_ != nullptr && found != interfaces_.end()) {
      block_->receive(static_cast<base::Direction>(found - interfaces_.begin()),
                      static_cast<const PacketMessage&>(*message).packet());
    }
  });
}

BaseSimulator::BlockCode* HoldfastCode::build(BaseSimulator::BuildingBlock* host) {
  return new HoldfastCode(static_cast<BlinkyBlocks::BlinkyBlocksBlock*>(host));
}

void HoldfastCode::parseUserElements(TiXmlDocument* configuration) {
  Session::instance().open(configuration->Value());
}

bool HoldfastCode::parseUserCommandLineArgument(int& argc, char** argv[]) {
  const char letter = (*argv)[0][1];
  if (kOptionLetters.find(letter) == std::string_view::npos) {
    std::cerr << option_help();
    return false;
  }
  const char* value = argc > 1 ? (*argv)[1] : "";
  if (const auto error = Session::instance().settings.take(letter, value)) {
    std::cerr << "holdfast: " << *error << std::endl;
    std::exit(kExitUsage);
  }
  --argc;
  ++*argv;
  return true;
}

void HoldfastCode::startup() {
  Session& session = Session::instance();
  for (int i = 0; i < module_->getNbInterfaces(); ++i) {
    const Cell3DPosition step = module_->getRelativePosition(static_cast<short>(i));
    if (const auto face = face_towards({step[0], step[1], step[2]})) {
      interfaces_[static_cast<std::size_t>(base::index(*face))] = module_->getInterface(i);
    }
  }
  session.start(scheduler->getSchedulerLength() == SCHEDULER_LENGTH_INFINITE);
  schedule_changes(session, scheduler);
  const Cell3DPosition& at = module_->position;
  block_ = std::make_unique<Block>(session.ensemble(), static_cast<BlockHost&>(*this), getId(),
                                   session.own_cell({at[0], at[1], at[2]}),
                                   static_cast<std::uint16_t>(module_->getRandomUint()));
  block_->start();
  show(*block_);
  availabilityDate = std::max(availabilityDate, block_->busy_until());
}

bool HoldfastCode::is_there() const {
  return module_->getState() >= BaseSimulator::BuildingBlock::ALIVE;
}

void HoldfastCode::take_off_if_removed() {
  if (block_ != nullptr && !is_there()) {
    block_->take_off();
  }
}

/// A module that computes lets VisibleSim's events wait.
void HoldfastCode::processLocalEvent(EventPtr event) {
  BlinkyBlocksBlockCode::processLocalEvent(event);
  if (block_ != nullptr) {
    availabilityDate = std::max(availabilityDate, block_->busy_until());
  }
}

/// VisibleSim hands no event to a block that is removed, so its neighbours say so.
void HoldfastCode::onNeighborChanged(std::uint64_t, int action) {
  if (action == EVENT_REMOVE_NEIGHBOR) {
    for (const auto& [id, block] : BaseSimulator::getWorld()->getMap()) {
      static_cast<HoldfastCode*>(block->blockCode)->take_off_if_removed();
    }
  }
  if (block_ != nullptr) {
    block_->look_around();
  }
}

void HoldfastCode::onInterruptionEvent(EventPtr event) {
  const int what = static_cast<const InterruptionEvent<int>&>(*event).data;
  if (what == kCall) {
    block_->called(event->date);
  } else {
    watch_line(static_cast<base::Direction>(what - kLine));
  }
}

void HoldfastCode::onTap(int) {
  if (block_ != nullptr) {
    const std::string text = block_->describe();
    console << text << "\n";
    std::cout << static_cast<double>(now()) * 1e-6 << " s  module " << getId()
              << " is tapped: " << text << std::endl;
  }
}

void HoldfastCode::onEndOfSimulation() { Session::instance().finish(); }

std::string HoldfastCode::onInterfaceDraw() {
  return BlinkyBlocksBlockCode::onInterfaceDraw() + "\n" + Session::instance().status();
}

agent::Time HoldfastCode::now() { return scheduler->now(); }

std::uint64_t HoldfastCode::neighbour(base::Direction face) {
  const P2PNetworkInterface* interface = interfaces_[static_cast<std::size_t>(base::index(face))];
  return interface != nullptr && interface->isConnected()
             ? interface->connectedInterface->globalId + 1
             : 0;
}

void HoldfastCode::send(base::Direction face, const Packet& packet) {
  P2PNetworkInterface* interface = interfaces_[static_cast<std::size_t>(base::index(face))];
  if (interface->isConnected()) {
    sendMessage(new PacketMessage(Session::instance().ensemble(), packet), interface, 0, 0);
  }
  interrupt_at(now(), kLine + base::index(face));
}

/// VisibleSim draws how long a packet takes when it sets out, so its line is asked then, and when
/// the packet is through.
void HoldfastCode::watch_line(base::Direction face) {
  const P2PNetworkInterface* interface = interfaces_[static_cast<std::size_t>(base::index(face))];
  const bool is_free =
      interface->messageBeingTransmitted == nullptr && interface->outgoingQueue.empty();
  if (is_free) {
    block_->line_free(face);
  } else {
    interrupt_at(std::max(now(), interface->availabilityDate), kLine + base::index(face));
  }
}

void HoldfastCode::call_at(agent::Time at) { interrupt_at(at, kCall); }

void HoldfastCode::interrupt_at(agent::Time at, int what) {
  scheduler->schedule(new InterruptionEvent<int>(at, module_, what));
}

void HoldfastCode::show(const Block& block) {
  if (!is_there()) {
    return;
  }
  const agent::Colour colour = block.agent().colour();
  setColor(Color(int{colour.red}, int{colour.green}, int{colour.blue}));
  module_->setBlinkMode(colour.blinks);
  const agent::Answer& answer = block.agent().answer();
  if (answer.verdict != told_) {
    told_ = answer.verdict;
    console << sim::describe(answer) << "\n";
  }
}

}  // namespace holdfast::visiblesim
