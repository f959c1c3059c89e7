// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/plan/growing_network.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// The equilibrium of a robot that grows module by module, with all facets stuck, by a
/// factorization that grows with it.
///
/// Springs are the target's connections, and its facets, each a beam to an immobile node. If the
/// solution presses every facet all over, it is the equilibrium of the paper's law, and as exact as
/// the residual says. Everything else is left to verdict::assess(): other contact states, friction,
/// toppling, load ratios near 1.
class GrowingRobot {
 public:
  /// Keeps a reference to the whole robot.
  explicit GrowingRobot(const model::Robot& target);

  /// Whether that is faster than solving every state from nothing: in solid robots the factors
  /// fill. If not, nothing else may be called.
  bool is_thin() const { return growing_.has_value(); }

  /// What verdict::assess() says of a connected, supported state that does not topple: verdict,
  /// load ratio and displacements, those of its modules in ascending order. None where the state is
  /// not safe beyond doubt. Says nothing of stability.
  std::optional<verdict::Assessment> assess_safe(const ElementSet& state);

 private:
  struct Joint {
    model::Connection pair;
    const model::ConnectorLaw* law = nullptr;  ///< The target's.
  };

  void make_springs();
  std::int32_t node_of(std::size_t module) const;
  bool add(Element module);
  bool remove(Element module);
  void put_load(std::size_t module, double factor);
  bool go_to(const ElementSet& state);
  bool assign(const ElementSet& state);
  bool presses(const model::Facet& facet, const base::Vec6<double>& u) const;

  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  std::vector<Joint> joints_;                    ///< By spring, of the first ones.
  SpringNetwork network_;                        ///< Connections, then facets.
  std::vector<std::vector<std::size_t>> touch_;  ///< By module: its springs, facets first.
  std::optional<GrowingNetwork> growing_;
  ElementSet state_;       ///< What is in growing_.
  bool is_valid_ = false;  ///< Whether growing_ stands in state_.
};

}  // namespace holdfast::plan
