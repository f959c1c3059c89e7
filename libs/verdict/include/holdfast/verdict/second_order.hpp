// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "holdfast/base/cell.hpp"
#include "holdfast/solver/second_order.hpp"

/// Whether linear theory suffices for a robot: what its bending would change, to second order
/// (docs/second_order.md).
namespace holdfast::verdict {

/// The buckling factor from which on linear theory may be trusted [Eurocode 3, 5.2.1(3)].
inline constexpr double kTrustedFactor = 10;

/// The largest motion of the mode in which a robot would buckle.
struct BucklingMode {
  base::Cell cell;                       ///< Of the module that moves most,
  std::array<double, 3> direction = {};  ///< and where to, or the opposite way; of length 1.
};

enum class Trust : std::uint8_t {
  kTrusted,
  kNotTrusted,
  kNotCertain,  ///< Nothing speaks against it, but no factorization proves the buckling factor.
};

struct SecondOrder {
  Trust trust = Trust::kNotTrusted;
  solver::BucklingAnswer answer = solver::BucklingAnswer::kNoStiffness;
  double factor = 0;  ///< As solver::Buckling has it.
  std::optional<BucklingMode> mode = {};
  /// The largest load ratio to second order, what is added made larger as a column's bending is
  /// near its buckling load; none without connections or stiffness.
  std::optional<double> load_ratio_max = {};
  // Of the linear solution:
  double displacement_max_mm = 0;
  double rotation_max_rad = 0;
  double edge_strain_max = 0;  ///< Of any connection, at the edge of its facet.
  /// The largest moment of a pressed facet as a share of that by which it would tilt, to second
  /// order; 0 where no facet is pressed all over.
  double facet_reserve_max = 0;
  /// Whether bending takes the centre of mass over an edge of the support polygon.
  bool leans_out = false;
  /// Whether somebody said what the elastic modulus is. The default is nobody's measurement.
  bool is_modulus_stated = false;
  double elastic_modulus_mpa = 0;

  /// The buckling factor, where it is known, or known to be no more.
  std::optional<double> buckling_factor() const {
    const bool is_known = answer == solver::BucklingAnswer::kFactor ||
                          (answer == solver::BucklingAnswer::kAtMost && factor < kTrustedFactor);
    return is_known ? std::optional(factor) : std::nullopt;
  }

  /// The elastic modulus at which the buckling factor would be 1: it is proportional to that, as
  /// forces do not depend on it.
  std::optional<double> elastic_modulus_needed_mpa() const {
    const auto known = buckling_factor();
    return known ? std::optional(elastic_modulus_mpa / *known) : std::nullopt;
  }
};

/// Returns "trusted", "not trusted" or "not certain".
const char* name(Trust trust);

}  // namespace holdfast::verdict
