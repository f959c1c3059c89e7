// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/influence.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "factorization/block_kernels.hpp"
#include "factorization/direct_system.hpp"

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
  influence->rough_ = system.displacement();
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

void Influence::find_inverse(std::span<const std::size_t> modules, std::span<const Edge> pairs,
                             int thread_count) {
  std::vector<std::size_t> nodes;
  for (const std::size_t module : modules) {
    const std::int32_t node = system_->node_of(static_cast<std::int32_t>(module));
    if (node >= 0) {
      nodes.push_back(base::at(node));
    }
  }
  std::vector<Edge> edges;
  for (const Edge& pair : pairs) {
    const Edge edge{system_->node_of(pair.a), system_->node_of(pair.b)};
    if (edge.a >= 0 && edge.b >= 0) {
      edges.push_back(edge);
    }
  }
  inverse_ = std::make_unique<SelectedInverse>(
      system_->factors().selected_inverse(nodes, edges, thread_count));
}

base::Mat6<double> Influence::between(std::size_t first, std::size_t second) const {
  const std::int32_t a = system_->node_of(static_cast<std::int32_t>(first));
  const std::int32_t b = system_->node_of(static_cast<std::int32_t>(second));
  return a < 0 || b < 0 ? base::Mat6<double>{} : inverse_->block(base::at(a), base::at(b));
}

std::span<const FacetState> Influence::facets() const { return system_->facets(); }

const FacetLaw<double>& Influence::law() const { return system_->law(); }

const model::LatticeBeam<double>& Influence::beam() const { return system_->beam(); }

std::size_t Influence::slot_count() const { return system_->factors().node_count() + 1; }

void Influence::solve(std::span<LaneBlock> by_slot) const {
  system_->factors().solve_lanes(by_slot.first(by_slot.size() - 1));
  by_slot.back() = {};
}

}  // namespace holdfast::solver
