// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "system.hpp"

/// One equilibrium from another that is near: Newton's method with the exact tangent.
namespace holdfast::large {

/// An equilibrium and what follows from its tangent.
struct Found {
  Configuration here;
  bool is_stable = false;  ///< The tangent, facets held in their states, is positive definite.
  std::vector<Vec> direction =
      {};  ///< The displacements by lambda, by node; empty if it is singular.
};

/// Why there is none.
enum class Failure : std::uint8_t {
  kNone,
  kNotFound,     ///< Newton's method does not get there.
  kJump,         ///< It gets to an equilibrium that is far, so perhaps of another branch.
  kReleaseLost,  ///< Facets that open and let go sideways have no stable equilibrium near.
};

/// The states of all facets in an iteration.
using FacetStates = std::vector<solver::FacetState>;

struct Search {
  std::optional<Found> found = {};
  Failure failure = Failure::kNone;
  std::vector<FacetStates> tried = {};  ///< In the last iterations, where nothing was found.
};

/// Makes an equilibrium, with facets held or released as they are, from a configuration near it.
/// Facets take the states that they need. Where it finds none it tells the states of the last
/// iterations.
std::optional<Configuration> converge(System& system, Configuration start,
                                      std::vector<FacetStates>* tried = nullptr);

/// Finds stability and direction of an equilibrium, for which residual() is asked once more.
Found examined(System& system, Configuration here);

/// Whether an equilibrium is where facets are about to go into one of the states that were tried,
/// forces being the same, and is not stable in that: then there is none beyond, and the robot tips
/// over these facets.
bool is_lost_at_facets(System& system, const Configuration& here,
                       const std::vector<FacetStates>& tried);

/// The equilibrium for another lambda, near that of `from`, open facets released for good: their
/// sideways forces go to none in steps, over stable equilibria.
Search advance(System& system, const Found& from, double factor);

}  // namespace holdfast::large
