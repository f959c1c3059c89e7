// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/stuck_core.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "holdfast/plan/part_of.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

std::unique_ptr<StuckCore> StuckCore::make(const model::RobotSpec& spec, const ElementSet& modules,
                                           solver::Precision precision) {
  auto robot = model::Robot::create(part_of(spec, modules), 1);
  if (!robot) {
    return nullptr;
  }
  std::unique_ptr<StuckCore> core(new StuckCore(std::move(robot).value()));
  core->system_ =
      solver::make_linear_system(core->robot_, {.precision = precision, .thread_count = 1});
  if (!core->system_) {
    return nullptr;
  }
  core->system_->set_law({});
  return core;
}

std::optional<StuckCore::Answer> StuckCore::answer(const Vecs& loads, double tolerance) {
  system_->set_loads(model::Loads(loads));
  if (system_->solve(tolerance) != solver::LinearOutcome::kSolved) {
    return std::nullopt;
  }
  Answer answer{.displacement = system_->displacement()};
  if (!system_->is_exact()) {
    const double norm = std::sqrt(std::max(0.0, work_of(loads, answer.displacement)));
    answer.error = verdict::kEnergyFactor * tolerance * norm;
  }
  return answer;
}

double work_of(const StuckCore::Vecs& loads, const StuckCore::Vecs& displacement) {
  double work = 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    work += base::dot(loads[i], displacement[i]);
  }
  return work;
}

}  // namespace holdfast::plan
