// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "system_choice.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace holdfast::solver {
namespace {

/// Up to here the direct solver is as fast, and exact.
constexpr std::size_t kDirectCountMax = 128;

/// The unilateral law takes dozens of steps that change a few facets each, and its weak springs
/// cost multigrid digits. So up to here the direct solver, which makes only some columns again, is
/// faster if no more blocks than this fill in per node.
constexpr std::size_t kUnilateralCountMax = 6000;
constexpr std::size_t kUnilateralFillMax = 16;

/// A factorization beside multigrid takes no longer than multigrid itself with so many blocks that
/// fill in and products of two blocks per node. Robots of many joints with so many connections
/// each are not tried, as even the order of elimination takes long and then fills in more. Joints
/// are modules with three connections or more: all others go first and leave a connection less.
constexpr std::size_t kBesideFillMax = 16;
constexpr std::size_t kBesideProductMax = 100;
constexpr std::size_t kBesideCountTried = 5'000;
constexpr double kBesideConnectionsMax = 2.0;

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// Whether a robot has many joints with many connections.
bool has_dense_joints(const model::Robot& robot) {
  std::size_t joints = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const auto beside = robot.connected()[i];
    joints += std::ranges::count_if(beside, [](auto other) { return other >= 0; }) > 2 ? 1U : 0U;
  }
  const std::size_t others = robot.modules().size() - joints;
  return joints > kBesideCountTried &&
         static_cast<double>(robot.connections().size()) >
             static_cast<double>(others) + kBesideConnectionsMax * static_cast<double>(joints);
}

}  // namespace

SystemChoice::SystemChoice(const model::Robot& robot, const EquilibriumOptions& options)
    : robot_(robot), options_(options), has_tried_double_(options.precision == Precision::kDouble) {
  const bool is_small =
      options.method == Method::kAutomatic && robot.free_count() <= kDirectCountMax;
  if (is_small || options.method == Method::kDirect) {
    make_direct(options.fill_max);
  } else {
    multigrid_ = Multigrid::make(robot, options_);
  }
}

LinearSystem* SystemChoice::system() {
  return direct_ ? static_cast<LinearSystem*>(direct_.get()) : multigrid_.get();
}

std::unique_ptr<LinearSystem> SystemChoice::take() {
  return direct_ ? std::unique_ptr<LinearSystem>(std::move(direct_)) : std::move(multigrid_);
}

/// Returns false, and keeps what there is, if it is too large.
bool SystemChoice::make_direct(std::size_t fill_max) {
  EquilibriumOptions options = options_;
  options.fill_max = fill_max;
  direct_ = DirectSystem::make(robot_, options);
  if (direct_) {
    multigrid_.reset();
  }
  return direct_ != nullptr;
}

void SystemChoice::prepare(mechanics::ContactLaw law) {
  if (multigrid_ && options_.method == Method::kAutomatic &&
      law == mechanics::ContactLaw::kUnilateral && robot_.free_count() <= kUnilateralCountMax) {
    make_direct(kUnilateralFillMax);
  }
}

std::unique_ptr<DirectSystem> SystemChoice::make_direct_beside() const {
  if (!multigrid_ || options_.method == Method::kMultigrid || has_dense_joints(robot_)) {
    return nullptr;
  }
  const std::size_t count = robot_.free_count();
  EquilibriumOptions options = options_;
  options.fill_max = std::min(options.fill_max, kBesideFillMax);
  return DirectSystem::make(robot_, options, kBesideProductMax * count);
}

bool SystemChoice::try_next() {
  if (options_.method == Method::kDirect) {
    return false;
  }
  has_tried_direct_ =
      has_tried_direct_ || direct_ != nullptr || options_.method == Method::kMultigrid;
  return robot_.free_count() <= kUnilateralCountMax ? try_direct() || try_double()
                                                    : try_double() || try_direct();
}

bool SystemChoice::try_direct() {
  return !std::exchange(has_tried_direct_, true) && make_direct(kUnlimited);
}

bool SystemChoice::try_double() {
  if (std::exchange(has_tried_double_, true)) {
    return false;
  }
  if (multigrid_) {
    if (!multigrid_->set_precision(Precision::kDouble)) {
      multigrid_.reset();
    }
    return multigrid_ != nullptr;
  }
  EquilibriumOptions options = options_;
  options.precision = Precision::kDouble;
  multigrid_ = Multigrid::make(robot_, options);
  if (multigrid_) {
    direct_.reset();
  }
  return multigrid_ != nullptr;
}

std::unique_ptr<LinearSystem> make_linear_system(const model::Robot& robot,
                                                 const EquilibriumOptions& options) {
  return SystemChoice(robot, options).take();
}

}  // namespace holdfast::solver
