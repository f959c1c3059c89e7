// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/core_answers.hpp"

#include <utility>

#include "holdfast/plan/part_of.hpp"

namespace holdfast::plan {
namespace {

/// Where more blocks than this fill in per module the factors take longer than they are worth.
constexpr std::size_t kAnswersFillMax = 100;

}  // namespace

std::unique_ptr<CoreAnswers> CoreAnswers::make(const model::RobotSpec& spec,
                                               const ElementSet& core) {
  auto robot = model::Robot::create(part_of(spec, core), 1);
  if (!robot) {
    return nullptr;
  }
  std::unique_ptr<CoreAnswers> made(new CoreAnswers(std::move(robot).value()));
  solver::EquilibriumOptions direct;
  direct.method = solver::Method::kDirect;
  direct.fill_max = kAnswersFillMax;
  direct.thread_count = 1;
  made->influence_ = solver::Influence::make(made->robot_, direct);
  const bool is_exact =
      made->influence_ && rounding_share(made->robot_, *made->influence_) <= kRoundingShareMax;
  return is_exact ? std::move(made) : nullptr;
}

void CoreAnswers::find_inverse(std::span<const std::size_t> modules,
                               std::span<const solver::Edge> pairs) {
  influence_->find_inverse(modules, pairs, 1);
}

base::Mat6<double> CoreAnswers::between(std::size_t first, std::size_t second) const {
  return influence_->between(first, second);
}

std::vector<CoreAnswers::Vecs> CoreAnswers::answers(
    std::span<const std::vector<PointLoad>> loads) const {
  std::vector<Vecs> found(loads.size(), Vecs(robot_.modules().size()));
  for (std::size_t first = 0; first < loads.size(); first += solver::kLaneCount) {
    const std::size_t count = std::min(solver::kLaneCount, loads.size() - first);
    std::vector<solver::LaneBlock> lanes(influence_->slot_count());
    for (std::size_t lane = 0; lane < count; ++lane) {
      for (const PointLoad& point : loads[first + lane]) {
        for (std::size_t k = 0; k < 6; ++k) {
          lanes[influence_->slot(point.module)].values[k][lane] += point.load[k];
        }
      }
    }
    influence_->solve(lanes);
    for (std::size_t module = 0; module < robot_.modules().size(); ++module) {
      const solver::LaneBlock& block = lanes[influence_->slot(module)];
      const bool is_fixed = robot_.modules()[module].support == model::Support::kFixed;
      for (std::size_t lane = 0; !is_fixed && lane < count; ++lane) {
        for (std::size_t k = 0; k < 6; ++k) {
          found[first + lane][module][k] = block.values[k][lane];
        }
      }
    }
  }
  return found;
}

}  // namespace holdfast::plan
