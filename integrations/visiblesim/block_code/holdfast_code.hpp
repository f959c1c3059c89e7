// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <string>

#include "block.hpp"
#include "robots/blinkyBlocks/blinkyBlocksBlockCode.h"
#include "session.hpp"

/// The robot's program as VisibleSim's program of one Blinky Block. This folder is all that knows
/// VisibleSim; what a module does is in ../src and in the room agent.
namespace holdfast::visiblesim {

class HoldfastCode final : public BlinkyBlocks::BlinkyBlocksBlockCode, private BlockHost {
 public:
  /// `host` is null where VisibleSim only reads its command line.
  explicit HoldfastCode(BlinkyBlocks::BlinkyBlocksBlock* host);

  static BaseSimulator::BlockCode* build(BaseSimulator::BuildingBlock* host);

  void startup() override;
  void processLocalEvent(EventPtr event) override;
  void onNeighborChanged(std::uint64_t face, int action) override;
  void onInterruptionEvent(EventPtr event) override;
  void onTap(int connector) override;
  void onEndOfSimulation() override;
  std::string onInterfaceDraw() override;
  void parseUserElements(TiXmlDocument* configuration) override;
  bool parseUserCommandLineArgument(int& argc, char** argv[]) override;

  /// The module's program; null before the module has started.
  Block* block() { return block_.get(); }

 private:
  agent::Time now() override;
  std::uint64_t neighbour(base::Direction face) override;
  void send(base::Direction face, const Packet& packet) override;
  void call_at(agent::Time at) override;
  void show(const Block& block) override;

  void interrupt_at(agent::Time at, int what);
  void watch_line(base::Direction face);
  bool is_there() const;
  void take_off_if_removed();

  BlinkyBlocks::BlinkyBlocksBlock* module_;
  std::unique_ptr<Block> block_;
  std::array<P2PNetworkInterface*, base::kDirectionCount> interfaces_{};  ///< By face.
  agent::Verdict told_ = agent::Verdict::kNone;
};

}  // namespace holdfast::visiblesim
