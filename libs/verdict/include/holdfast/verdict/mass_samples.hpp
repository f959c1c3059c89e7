// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/verdict/assessment.hpp"
#include "holdfast/verdict/scatter.hpp"

/// Loads of a robot whose masses scatter. As long as facets keep their states all forces are linear
/// in the masses, so that a sample is one more solution with the factorization that is there, and
/// its opposite, all masses as far off the other way, is free.
namespace holdfast::verdict {

enum class CaseState : std::uint8_t {
  kKnown,
  kFallen,   ///< The robot does not stay.
  kUnknown,  ///< Nothing is known.
};

/// Load ratios of a robot in one case.
struct LoadCase {
  CaseState state = CaseState::kKnown;
  std::vector<double> ratios = {};  ///< By connection; void unless known.
};

struct SampledMasses {
  std::vector<LoadCase> cases = {};  ///< Pairs of opposite samples.
  /// The samples in which facets are in other states, which took a check each.
  std::size_t changed_count = 0;
};

struct MassSampling {
  std::size_t sample_count = 1024;  ///< Fewer for robots with very many connections.
  std::uint64_t seed = 1;
  /// Checks the robot with other masses, by module, in kg; none if it cannot. Without it, and after
  /// `check_count_max`, samples in which facets are in other states are not known.
  std::function<std::optional<Assessment>(std::span<const double> masses_kg)> check = {};
  std::size_t check_count_max = 256;
  solver::EquilibriumOptions equilibrium = {};
};

/// Samples the masses of a robot of which this is the assessment; no cases where nothing scatters,
/// or known_ratios() are none. Where the equilibrium cannot be followed (facets that are open but
/// held, solutions that have no digits left) each sample is checked.
SampledMasses sample_masses(const model::Robot& robot, const Assessment& assessment,
                            std::span<const double> mass_cv, const MassSampling& sampling);

}  // namespace holdfast::verdict
