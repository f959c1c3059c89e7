// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/influence.hpp"

#include "direct_system.hpp"

namespace holdfast::solver {

Influence::Influence() = default;
Influence::~Influence() = default;

std::unique_ptr<Influence> Influence::make(const model::Robot& robot,
                                           const EquilibriumOptions& options) {
  std::unique_ptr<Influence> influence(new Influence());
  influence->system_ = DirectSystem::make(robot, options);
  if (!influence->system_) {
    return nullptr;
  }
  DirectSystem& system = *influence->system_;
  system.set_law(
      {.law = mechanics::ContactLaw::kRegularised, .gamma = robot.material().contact_gamma});
  if (system.solve(0) != LinearOutcome::kSolved) {
    return nullptr;
  }
  Solution solution;
  solution.displacement = system.displacement();
  influence->rough_ = solution.displacement;
  if (!system.refine(solution) || !solution.displacement_low.empty()) {
    return nullptr;
  }
  influence->displacement_ = std::move(solution.displacement);
  influence->slots_.resize(robot.modules().size());
  for (std::size_t i = 0; i < influence->slots_.size(); ++i) {
    const std::int32_t node = system.node_of(static_cast<std::int32_t>(i));
    influence->slots_[i] =
        node < 0 ? influence->slot_count() - 1 : system.factors().place(base::at(node));
  }
  return influence;
}

std::span<const FacetState> Influence::facets() const { return system_->facets(); }

const FacetLaw<double>& Influence::law() const { return system_->law(); }

const model::LatticeBeam<double>& Influence::beam() const { return system_->beam(); }

std::size_t Influence::slot_count() const { return system_->factors().node_count() + 1; }

Influence::Reach Influence::reach(std::size_t module) const {
  const std::int32_t node = system_->node_of(static_cast<std::int32_t>(module));
  Reach reach;
  if (node >= 0) {
    system_->factors().forward(base::at(node), reach.places, reach.blocks);
  }
  return reach;
}

base::Mat6<double> Influence::between(const Reach& first, const Reach& second) const {
  return system_->factors().symmetric_product(first.places, first.blocks, second.places,
                                              second.blocks);
}

void Influence::solve(std::span<LaneBlock> by_slot) const {
  system_->factors().solve_lanes(by_slot.first(by_slot.size() - 1));
  by_slot.back() = {};
}

}  // namespace holdfast::solver
