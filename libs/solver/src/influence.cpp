// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/influence.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "block_kernels.hpp"
#include "direct_system.hpp"

namespace holdfast::solver {
namespace {

/// What a selected inverse takes, in factorizations.
constexpr std::size_t kSelectedPerFactor = 2;

}  // namespace

InverseStiffness::InverseStiffness(std::unique_ptr<const BlockLu> factors,
                                   const DirectSystem& system, const InfluenceQuestions& questions)
    : own_(std::move(factors)), system_(system) {
  std::vector<std::size_t> nodes;
  for (const std::size_t module : questions.modules) {
    const std::int32_t node = system.node_of(static_cast<std::int32_t>(module));
    if (node >= 0) {
      nodes.push_back(base::at(node));
    }
  }
  const BlockLu& lu = own_ ? *own_ : system.factors();
  std::vector<Edge> pairs;
  for (const Edge& pair : questions.pairs) {
    const Edge edge{system.node_of(pair.a), system.node_of(pair.b)};
    if (edge.a >= 0 && edge.b >= 0) {
      pairs.push_back(edge);
    }
  }
  // A selected inverse takes twice as much as the factors, and more for pairs.
  if (questions.is_any_connected ||
      lu.way_product_count(nodes) > kSelectedPerFactor * lu.factor_product_count()) {
    inverse_ = std::make_unique<SelectedInverse>(
        lu.selected_inverse(nodes, pairs, questions.thread_count));
    return;
  }
  for (const std::size_t node : nodes) {
    pairs.push_back({static_cast<std::int32_t>(node), static_cast<std::int32_t>(node)});
  }
  const std::vector<base::Mat6<double>> blocks = lu.inverse_blocks(pairs, questions.thread_count);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    pairs_.emplace(std::pair(pairs[i].a, pairs[i].b), blocks[i]);
  }
}

InverseStiffness::~InverseStiffness() = default;

base::Mat6<double> InverseStiffness::between(std::size_t first, std::size_t second) const {
  const std::int32_t a = system_.node_of(static_cast<std::int32_t>(first));
  const std::int32_t b = system_.node_of(static_cast<std::int32_t>(second));
  if (a < 0 || b < 0) {
    return {};
  }
  if (const auto found = pairs_.find({a, b}); found != pairs_.end()) {
    return found->second;
  }
  if (const auto found = pairs_.find({b, a}); found != pairs_.end()) {
    return transpose(found->second);
  }
  return inverse_->block(base::at(a), base::at(b));
}

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

std::size_t Influence::factor_product_count() const {
  return system_->factors().factor_product_count();
}

/// A block times a vector is a sixth of a product, and there are two for each block.
double Influence::solution_product_count() const {
  return static_cast<double>(system_->factors().lower_block_count()) / 3;
}

void Influence::find_inverse(const InfluenceQuestions& questions) {
  inverse_ = std::make_unique<InverseStiffness>(nullptr, *system_, questions);
}

std::span<const FacetState> Influence::facets() const { return system_->facets(); }

const FacetLaw<double>& Influence::law() const { return system_->law(); }

const model::LatticeBeam<double>& Influence::beam() const { return system_->beam(); }

std::size_t Influence::slot_count() const { return system_->factors().node_count() + 1; }

std::unique_ptr<const InverseStiffness> Influence::inverse_of(
    std::span<const double> connection_factors, const InfluenceQuestions& questions) const {
  auto lu = std::make_unique<BlockLu>(system_->factors_of(connection_factors));
  if (!lu->factor(questions.thread_count)) {
    return nullptr;
  }
  return std::make_unique<InverseStiffness>(std::move(lu), *system_, questions);
}

void Influence::solve(std::span<LaneBlock> by_slot) const {
  system_->factors().solve_lanes(by_slot.first(by_slot.size() - 1));
  by_slot.back() = {};
}

LaneNumbers Influence::begin_solution(std::span<LaneBlock> by_slot) const {
  by_slot.back() = {};
  return system_->factors().begin_lanes(by_slot.first(by_slot.size() - 1));
}

void Influence::find_solution(std::span<LaneBlock> by_slot, std::span<const std::size_t> slots,
                              std::vector<std::uint8_t>& is_found) const {
  std::vector<std::size_t> places;
  std::ranges::copy_if(slots, std::back_inserter(places),
                       [&](std::size_t slot) { return slot + 1 != by_slot.size(); });
  system_->factors().find_lanes(by_slot.first(by_slot.size() - 1), places, is_found);
}

void Influence::end_solution(std::span<LaneBlock> by_slot,
                             std::vector<std::uint8_t>& is_found) const {
  system_->factors().end_lanes(by_slot.first(by_slot.size() - 1), is_found);
}

}  // namespace holdfast::solver
