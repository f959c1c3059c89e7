// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "../block_kernels.hpp"

namespace holdfast::solver {
namespace {

using mechanics::ContactState;

constexpr int kIterationMax = 500;

/// Memory per module: measured 330 to 400 bytes on solids and on random growth, in double precision
/// 500 to 700 on slender robots.
constexpr std::size_t kBytesPerModule = 450;
constexpr std::size_t kBytesPerModuleDouble = 800;

/// A robot of n modules that is N long consists of N / sqrt(n / N) cubes in a row, at most, as if
/// its modules were in one bar. Rounding moves it by that number squared times what it moves a
/// cube, and where it so moves it by more than this share of the true motion, single precision is
/// not even tried: from N^3 / n = 2.5e6 on. By experiment it gives up in portals from 2.0e6 on,
/// needs dozens of iterations in bridges from 2.1e6 on, and does well in towers up to 9e6. A robot
/// that is sent on wrongly takes twice as long.
constexpr double kRoundingShare = 0.15;

/// So small a network is solved on its coarsest level, in double precision anyway.
constexpr std::size_t kTrivialCount = 48;

/// So many facets may stay out of all clusters, one of so many nodes: the coarsest level then has
/// them all, and is factorized anew after each change. A foot of a portal has 16.
constexpr std::size_t kAloneMax = 128;
constexpr std::size_t kAloneShare = 64;

/// What counts as thin: plates one module thick and solids have four neighbours a node and more,
/// but for their edges; full ladders have three.
constexpr std::size_t kThinCountMax = 2000;
constexpr double kThinDegree = 3.5;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

/// 0 for a facet that is stuck, else which of the twenty contact states it is in.
std::uint8_t code_of(const ContactState& state, bool is_held, mechanics::ContactLaw law) {
  const bool holds_sideways = law == mechanics::ContactLaw::kRegularised || is_held;
  if (state == ContactState{} && holds_sideways) {
    return 0;
  }
  const int shape = state.pressed ? 3 * (state.tilt_x + 1) + (state.tilt_y + 1) : 9;
  return static_cast<std::uint8_t>(1 + 2 * shape + (holds_sideways ? 1 : 0));
}

bool is_held(std::uint8_t code) { return (code - 1) % 2 == 1; }

ContactState state_of(std::uint8_t code) {
  const int shape = (code - 1) / 2;
  if (shape == 9) {
    return {.pressed = false};
  }
  return {.pressed = true,
          .tilt_x = static_cast<std::int8_t>(shape / 3 - 1),
          .tilt_y = static_cast<std::int8_t>(shape % 3 - 1)};
}

}  // namespace

Multigrid::Multigrid(const model::Robot& robot, MultigridOptions options)
    : robot_(robot),
      precision_(options.precision),
      team_(options.thread_count, robot.modules().size()),
      network_(make_reduced_network(robot, team_)),
      weight_({0, 0, -model::module_weight_n(robot.material()), 0, 0, 0}),
      facet_of_module_(robot.ground_count() > 0 ? robot.modules().size() : 0, -1),
      may_yield_(options.may_yield),
      progress_(std::move(options.progress)) {
  for (std::size_t node = 0; node < network_.node_count; ++node) {
    const std::int32_t module = network_.module[node];
    if (robot.modules()[at(module)].support == model::Support::kGround) {
      facet_of_module_[at(module)] = static_cast<std::int32_t>(facets_.size());
      facets_.push_back({.node = static_cast<std::int32_t>(node), .state = {}});
    }
  }
  alone_ = nodes_alone();
}

void Multigrid::set_precision(Precision precision) {
  precision_ = precision;
  iteration_.reset();
  reference_ = 0;
  is_stale_ = true;
}

/// Whether it is plain from the robot's shape that single precision will not do.
bool Multigrid::is_too_slender() const {
  const double length = network_.extent;
  const auto count = static_cast<double>(robot_.modules().size());
  const double slenderness_squared = length * length * length / count;
  return network_.node_count > kTrivialCount &&
         std::numeric_limits<float>::epsilon() / 2 * slenderness_squared > kRoundingShare;
}

std::size_t Multigrid::bytes_for(std::size_t module_count, Precision precision) {
  return module_count * (precision == Precision::kSingle ? kBytesPerModule : kBytesPerModuleDouble);
}

void Multigrid::set_law(const mechanics::GroundFacet<double>& facet) {
  ground_ = facet;
  for (std::size_t module = 0; module < facet_of_module_.size(); ++module) {
    if (facet_of_module_[module] >= 0) {
      set_facet(module, {}, true);
    }
  }
  is_law_new_ = true;
  is_stale_ = true;
}

void Multigrid::set_facet(std::size_t module, const ContactState& state, bool is_held) {
  Facet& facet = facets_[at(facet_of_module_[module])];
  facet.state = state;
  facet.is_held = is_held;
  const std::uint8_t code = code_of(state, is_held, ground_.law);
  if (code == facet.code) {
    return;
  }
  facet.code = code;
  Kind& kind = network_.kind[at(facet.node)];
  kind[base::index(base::Direction::kMinusZ)] = code == 0 ? 1 : 0;
  kind[kContactByte] = code;
  is_stale_ = true;
}

void Multigrid::set_load(std::vector<Vec> load) {
  carry(robot_, team_, std::move(load), network_);
  if (iteration_) {
    iteration_->x().assign(iteration_->x().size(), 0);
  }
  is_residual_known_ = false;
  reference_ = 0;
  is_stale_ = true;
}

/// If its coarsest level has all facets the hierarchy gets the tangent itself: the finest level as
/// it is, the others with its upper half on both sides, as springs are carried. Else a stand-in.
Mat Multigrid::tangent(std::uint8_t code) const {
  return alone_.empty() ? mechanics::symmetric_tangent(ground_, state_of(code), is_held(code))
                        : mechanics::contact_tangent(ground_, state_of(code), is_held(code));
}

/// On the ground, by the facet of a node.
Multigrid::Vec Multigrid::force(std::uint8_t code, std::size_t node) const {
  Vec u;
  std::copy_n(iteration_->x().begin() + static_cast<std::ptrdiff_t>(6 * node), 6, u.begin());
  return code == 0 ? mechanics::contact_force(ground_, {}, true, u)
                   : mechanics::contact_force(ground_, state_of(code), is_held(code), u);
}

/// Facets, where they are few: those of a few feet. Which part of a foot presses decides how it
/// tilts, and a cluster as large as the foot cannot know.
std::vector<std::int32_t> Multigrid::nodes_alone() const {
  std::vector<std::int32_t> nodes;
  if (may_yield_ && facets_.size() <= kAloneMax &&
      kAloneShare * facets_.size() <= network_.node_count) {
    for (const Facet& facet : facets_) {
      nodes.push_back(facet.node);
    }
  }
  return nodes;
}

std::unique_ptr<Iteration> Multigrid::make_iteration() {
  const auto ground = [this](std::uint8_t code) { return tangent(code); };
  if (precision_ == Precision::kDouble) {
    return std::make_unique<ConjugateGradients<double>>(network_, robot_.material(), team_, ground,
                                                        alone_);
  }
  return std::make_unique<ConjugateGradients<float>>(network_, robot_.material(), team_, ground,
                                                     alone_);
}

void Multigrid::update_iteration() {
  if (iteration_ && !is_law_new_) {
    iteration_->update_contact();
    return;
  }
  std::vector<double> x;
  if (iteration_) {
    x = std::move(iteration_->x());
  }
  iteration_.reset();
  iteration_ = make_iteration();
  is_law_new_ = false;
  is_residual_known_ = false;
  if (!x.empty()) {
    iteration_->x() = std::move(x);
  }
  if (progress_) {
    iteration_->progress = [this](int, double error) {
      progress_(++told_count_, std::sqrt(std::max(0.0, error) / reference_));
    };
  }
}

/// What the present displacements leave unbalanced, with the contact's own tangent.
void Multigrid::compute_residual() {
  std::vector<double>& r = iteration_->r();
  std::vector<double>& x = iteration_->x();
  team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const Vec& load = network_.load.empty() ? weight_ : network_.load[at(network_.module[node])];
      std::copy(load.begin(), load.end(), r.begin() + static_cast<std::ptrdiff_t>(6 * node));
    }
  });
  if (reference_ > 0) {
    iteration_->subtract_product();
  }
  for (const Facet& facet : facets_) {
    if (facet.code != 0) {
      const std::size_t i = 6 * at(facet.node);
      const Vec u = {x[i], x[i + 1], x[i + 2], x[i + 3], x[i + 4], x[i + 5]};
      const Vec known = base::multiply(tangent(facet.code), u);
      const Vec true_force = force(facet.code, at(facet.node));
      for (std::size_t k = 0; k < 6; ++k) {
        r[i + k] -= true_force[k] - known[k];
      }
    }
  }
}

/// The same if only facets have changed since: x and r have never parted.
void Multigrid::update_residual() {
  std::vector<double>& r = iteration_->r();
  for (const Facet& facet : facets_) {
    if (facet.code != facet.old_code) {
      const Vec before = force(facet.old_code, at(facet.node));
      const Vec now = force(facet.code, at(facet.node));
      for (std::size_t k = 0; k < 6; ++k) {
        r[6 * at(facet.node) + k] += before[k] - now[k];
      }
    }
  }
}

/// What the contact's tangent has beyond what the hierarchy knows of it.
std::vector<NodeTerm> Multigrid::unsymmetric_terms() const {
  std::vector<NodeTerm> terms;
  for (const Facet& facet : facets_) {
    if (ground_.law == mechanics::ContactLaw::kRegularised &&
        (facet.state.tilt_x != 0 || facet.state.tilt_y != 0)) {
      const Mat exact = mechanics::contact_tangent(ground_, facet.state, facet.is_held);
      const Mat minus_known = scaled(tangent(facet.code), -1);
      NodeTerm& term = terms.emplace_back();
      term = {.node = facet.node, .difference = exact, .transposed_difference = transpose(exact)};
      base::add_to(term.difference, minus_known);
      base::add_to(term.transposed_difference, minus_known);
    }
  }
  return terms;
}

/// Takes up changed facets. What has not changed since the last solution goes on from there. False
/// if the robot is too slender.
bool Multigrid::begin() {
  if (!is_new()) {
    return true;
  }
  if (precision_ == Precision::kSingle && is_too_slender()) {
    return false;
  }
  update_iteration();
  if (precision_ == Precision::kSingle && iteration_->is_too_slender()) {
    return false;
  }
  if (is_residual_known_) {
    update_residual();
  } else {
    compute_residual();
  }
  is_residual_known_ = true;
  for (Facet& facet : facets_) {
    facet.old_code = facet.code;
  }
  const double error = iteration_->begin();
  if (reference_ == 0) {
    reference_ = error;
  }
  is_stale_ = false;
  return true;
}

bool Multigrid::is_thin() const {
  if (network_.node_count > kThinCountMax) {
    return false;
  }
  std::size_t ends = 0;
  for (std::size_t node = 0; node < network_.node_count; ++node) {
    ends += static_cast<std::size_t>(std::count_if(
        network_.kind[node].begin(), network_.kind[node].begin() + base::kDirectionCount,
        [](auto length) { return length > 0; }));
  }
  return static_cast<double>(ends) <= kThinDegree * static_cast<double>(network_.node_count);
}

bool Multigrid::solve(double tolerance, int iteration_count_min, double energy_error_max) {
  if (network_.node_count == 0) {
    return true;
  }
  if (!begin()) {
    return false;
  }
  const int before = iteration_->iteration_count();
  energy_error_ = std::min(tolerance * std::sqrt(reference_), energy_error_max);
  const Iteration::Goal goal = {.error = energy_error_ * energy_error_,
                                .iteration_count_min = iteration_count_min,
                                .iteration_count_max = kIterationMax};
  const std::vector<NodeTerm> terms = unsymmetric_terms();
  const auto end = terms.empty() ? iteration_->run(goal) : iteration_->run_unsymmetric(goal, terms);
  last_count_ = iteration_->iteration_count() - before;
  iteration_count_ += last_count_;
  if (end == Iteration::End::kConverged) {
    return true;
  }
  iteration_->x().assign(iteration_->x().size(), 0);  // Nothing to go on from.
  is_residual_known_ = false;
  is_stale_ = true;
  return false;
}

base::Vec6<double> Multigrid::facet_correction(std::size_t module) const {
  const Facet& facet = facets_[at(facet_of_module_[module])];
  return iteration_ ? iteration_->correction(at(facet.node)) : Vec{};
}

std::vector<base::Vec6<double>> Multigrid::displacement() {
  std::vector<Vec> by_module(robot_.modules().size());
  if (iteration_) {
    const std::vector<double>& x = iteration_->x();
    team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(6 * node), 6,
                    by_module[at(network_.module[node])].begin());
      }
    });
  }
  recover(robot_, network_, team_, by_module);
  return by_module;
}

}  // namespace holdfast::solver
