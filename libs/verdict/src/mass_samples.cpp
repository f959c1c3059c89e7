// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/verdict/mass_samples.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "holdfast/base/rng.hpp"
#include "holdfast/verdict/connection_law.hpp"
#include "holdfast/verdict/reliability.hpp"

namespace holdfast::verdict {
namespace {

using mechanics::ContactLaw;
using Vec = base::Vec6<double>;

/// Samples whose load ratios together are more numbers than this are fewer, but never fewer than
/// the least count.
constexpr std::size_t kNumbersMax = 20'000'000;
constexpr std::size_t kSamplesMin = 64;

/// Samples that are solved at once.
constexpr std::size_t kAtOnce = 16;

/// The error of a sample's displacements, as a share of what masses change; load ratios are linear
/// in them.
constexpr double kTolerance = 1e-6;

/// Standard normal numbers, by Box and Muller.
class Normal {
 public:
  explicit Normal(std::uint64_t seed) : rng_(seed) {}

  double next() {
    constexpr double kFullTurn = 6.28318530717958647693;
    const double size = std::sqrt(-2 * std::log(1 - uniform()));
    return size * std::cos(kFullTurn * uniform());
  }

 private:
  double uniform() { return static_cast<double>(rng_.next() >> 11U) * 0x1p-53; }

  base::Rng rng_;
};

/// The linear system of a robot in the states of its equilibrium.
class KeptStates {
 public:
  KeptStates(const model::Robot& robot, const Assessment& assessment,
             const solver::EquilibriumOptions& options)
      : robot_(robot) {
    const solver::Equilibrium& known = assessment.equilibrium;
    is_bonded_ = assessment.contact_model == ContactModel::kBonded;
    if (known.open_but_held_count > 0 || !known.displacement_low.empty()) {
      return;
    }
    system_ = solver::make_linear_system(robot, options);
    if (!system_) {
      return;
    }
    if (!known.slip.empty()) {  // Other masses, other slips.
      system_.reset();
      return;
    }
    const bool is_exact_law = known.law == ContactLaw::kUnilateral;
    system_->set_law(
        {.law = known.law, .gamma = is_exact_law ? known.gamma : robot.material().contact_gamma});
    for (std::size_t i = 0; i < known.contact.size(); ++i) {
      system_->set_facet(i, known.contact[i], !is_exact_law || known.contact[i].pressed);
    }
    if (!keeps(known.displacement)) {
      system_.reset();
    }
  }

  bool can_be_followed() const { return system_ != nullptr; }

  /// What changes of masses do to displacements; none if it fails.
  std::optional<std::vector<std::vector<Vec>>> changes(
      std::span<const std::vector<double>> masses_kg) const {
    std::vector<model::Loads> loads;
    for (const std::vector<double>& some : masses_kg) {
      std::vector<Vec> forces(some.size());
      for (std::size_t i = 0; i < some.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          forces[i][k] = some[i] * robot_.gravity()[k];
        }
      }
      loads.emplace_back(std::move(forces));
    }
    return system_->solve_each(loads, kTolerance);
  }

  /// Whether all facets are in these states when modules are displaced so.
  bool keeps(std::span<const Vec> displacement) const {
    return is_bonded_ || std::ranges::all_of(system_->facets(), [&](const solver::FacetState& one) {
             return one.is_bonded ||
                    system_->law().state_at(one, displacement[one.module]) == one.state;
           });
  }

 private:
  const model::Robot& robot_;
  bool is_bonded_ = false;
  std::unique_ptr<solver::LinearSystem> system_;
};

/// Makes one case after the other.
class Sampler {
 public:
  Sampler(const model::Robot& robot, const Assessment& assessment, const MassSampling& sampling)
      : robot_(robot),
        assessment_(assessment),
        sampling_(sampling),
        laws_(robot),
        kept_(robot, assessment, sampling.equilibrium) {}

  /// Adds both samples with masses that differ by these, and by their opposites.
  void add_pairs(std::span<const std::vector<double>> masses_kg) {
    const auto changes =
        kept_.can_be_followed() ? kept_.changes(masses_kg) : decltype(kept_.changes(masses_kg))();
    for (std::size_t i = 0; i < masses_kg.size(); ++i) {
      for (const double sign : {1.0, -1.0}) {
        add(masses_kg[i], changes ? &(*changes)[i] : nullptr, sign);
      }
    }
  }

  SampledMasses take() && { return std::move(sampled_); }

 private:
  void add(const std::vector<double>& masses_kg, const std::vector<Vec>* change, double sign) {
    if (change != nullptr) {
      std::vector<Vec> moved = assessment_.equilibrium.displacement;
      for (std::size_t i = 0; i < moved.size(); ++i) {
        for (std::size_t k = 0; k < 6; ++k) {
          moved[i][k] += sign * (*change)[i][k];
        }
      }
      if (kept_.keeps(moved)) {
        sampled_.cases.push_back({.ratios = ratios(moved)});
        return;
      }
    }
    ++sampled_.changed_count;
    sampled_.cases.push_back(checked(masses_kg, sign));
  }

  std::vector<double> ratios(const std::vector<Vec>& displacement) const {
    std::vector<double> list;
    for (const model::Connection& pair : robot_.connections()) {
      list.push_back(
          laws_.load_ratio(pair, displacement[base::at(pair.a)], displacement[base::at(pair.b)]));
    }
    return list;
  }

  LoadCase checked(const std::vector<double>& masses_kg, double sign) {
    if (!sampling_.check || check_count_ == sampling_.check_count_max) {
      return {.state = CaseState::kUnknown};
    }
    ++check_count_;
    std::vector<double> masses(masses_kg.size());
    for (std::size_t i = 0; i < masses.size(); ++i) {
      masses[i] = robot_.mass(i) + sign * masses_kg[i];
    }
    const auto found = sampling_.check(masses);
    auto ratios = found ? known_ratios(*found) : std::nullopt;
    if (ratios) {
      return {.ratios = *std::move(ratios)};
    }
    const bool is_fallen = found && known_stability(*found) == std::optional(false);
    return {.state = is_fallen ? CaseState::kFallen : CaseState::kUnknown};
  }

  const model::Robot& robot_;
  const Assessment& assessment_;
  const MassSampling& sampling_;
  ConnectionLaws laws_;
  KeptStates kept_;
  SampledMasses sampled_;
  std::size_t check_count_ = 0;
};

}  // namespace

SampledMasses sample_masses(const model::Robot& robot, const Assessment& assessment,
                            std::span<const double> mass_cv, const MassSampling& sampling) {
  if (std::ranges::all_of(mass_cv, [](double cv) { return cv == 0; }) ||
      !known_ratios(assessment)) {
    return {};
  }
  const std::size_t fitting = kNumbersMax / std::max<std::size_t>(1, robot.connections().size());
  const std::size_t count = std::min(sampling.sample_count, std::max(kSamplesMin, fitting)) / 2;
  Sampler sampler(robot, assessment, sampling);
  Normal normal(sampling.seed);
  std::vector<std::vector<double>> some;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double>& masses = some.emplace_back(robot.modules().size());
    for (std::size_t module = 0; module < masses.size(); ++module) {
      // No mass is below zero, either way.
      const double share = std::clamp(mass_cv[module] * normal.next(), -1.0, 1.0);
      masses[module] = robot.mass(module) * share;
    }
    if (some.size() == kAtOnce || i + 1 == count) {
      sampler.add_pairs(some);
      some.clear();
    }
  }
  return std::move(sampler).take();
}

}  // namespace holdfast::verdict
