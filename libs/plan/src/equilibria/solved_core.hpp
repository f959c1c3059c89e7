// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

#include "holdfast/solver/linear_system.hpp"

namespace holdfast::plan {

/// A load on one module.
struct PointLoad {
  std::size_t module = 0;
  base::Vec6<double> load{};
};

/// A robot that was solved, each of its facets in some contact state, and how it answers to more
/// loads as long as its facets stay in these states.
class SolvedCore {
 public:
  using Vec = base::Vec6<double>;

  virtual ~SolvedCore() = default;

  /// The facets, in the states that the robot was solved with.
  virtual std::span<const solver::FacetState> facets() const = 0;

  virtual const solver::FacetLaw<double>& law() const = 0;
  virtual const model::LatticeBeam<double>& beam() const = 0;

  /// How far a module is displaced by the robot's own loads.
  virtual const Vec& displacement(std::size_t module) const = 0;

  /// Whether answer() may be asked for loads on these modules.
  virtual bool knows(std::span<const std::size_t> modules) const = 0;

  /// How far a module moves by one more load.
  virtual Vec answer(std::size_t module, const PointLoad& load) const = 0;
};

}  // namespace holdfast::plan
