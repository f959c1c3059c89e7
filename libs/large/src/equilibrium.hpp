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

/// Whether an iteration is done with a residual, given that before it, as forces: it is at most
/// `share` of the loads, or rounding leaves more.
bool is_done(double size, double last_size, double loads, double share);

/// Finds stability and direction of an equilibrium, for which residual() is asked once more.
Found examined(System& system, Configuration here);

/// Whether facets in other states have the same forces at an equilibrium.
bool is_about_to_change(System& system, const Configuration& here, const FacetStates& states);

/// The states, of those that were tried, which facets are about to go into, forces being the same,
/// and in which the equilibrium is not stable: then there is none beyond, and the robot tips over
/// these facets. None if there are no such.
std::optional<FacetStates> find_tipping(System& system, const Configuration& here,
                                        const std::vector<FacetStates>& tried);

/// Whether facets are open, but still held sideways.
bool has_open_held_facets(const Configuration& here);

/// Releases them for good: their sideways forces go to none in steps. Returns whether equilibria
/// are stable all the way; `here` is the last.
bool release_open(System& system, Configuration& here);

/// The equilibrium for another lambda, near that of `from`, open facets released for good: their
/// sideways forces go to none in steps, over stable equilibria.
Search advance(System& system, const Found& from, double factor);

}  // namespace holdfast::large
