// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/large_beam.hpp"
#include "holdfast/model/environment.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/linear_system.hpp"

/// Equilibrium in the deformed shape: all loads of a robot grow together, lambda times what they
/// are, and its stable equilibrium is followed from lambda = 0 (docs/second_order.md).
///
/// Beams are those of mechanics/large_beam.hpp, exact for any displacement; facets have the exact
/// contact law, Eqs. (6)-(8), in the same strains. An equilibrium is stable if the tangent
/// stiffness is positive definite there: all pivots of its factors are. Forces keep their direction
/// and act at the modules' centres; torques are constant in the global frame.
namespace holdfast::large {

/// How the search for equilibria ended.
enum class Outcome : std::uint8_t {
  kReached,        ///< The whole path is stable.
  kLost,           ///< Stability is lost at `critical`.
  kNotFound,       ///< No further equilibrium was found, though none is known to be lost.
  kNoStart,        ///< There is no stable equilibrium, or no settled contact, for small loads.
  kTooLarge,       ///< The factors of the tangent do not fit into the memory allowed.
  kCarriedMasses,  ///< Masses on levers, of modules on their way, are not followed.
};

/// The way in which stability is lost.
enum class Loss : std::uint8_t {
  kBifurcation,  ///< Other equilibria branch off: it buckles.
  kLimit,        ///< No equilibrium is near for larger loads: it collapses.
};

/// What may happen on the path.
enum class EventKind : std::uint8_t {
  kBreaks,         ///< The first load ratio reaches 1.
  kTouchesFloor,   ///< A module that was above the floor reaches it.
  kTouchesItself,  ///< Modules meet that are no neighbours, or a module meets an obstacle.
  kTooSoft,        ///< The strain at a facet's edge reaches kStrainMax: no linear law holds there.
};

inline constexpr int kEventKindCount = 4;

/// The strain at the edge of a facet beyond which a linear law says nothing.
inline constexpr double kStrainMax = 0.5;

/// Why a branch behind the loss of stability ends.
enum class End : std::uint8_t {
  kFactorMax,      ///< The loads have grown to Options::factor_max.
  kUnloaded,       ///< They have gone back to none.
  kTouchesFloor,   ///< As the event of this name: this model makes no contacts,
  kTouchesItself,  ///< nor these,
  kTooSoft,        ///< and knows linear laws only.
  kLetsGo,         ///< A facet opens and lets go sideways, and no stable equilibrium is near.
  kNotFound,       ///< No further equilibrium is found.
  kSteps,          ///< It has not ended after as many steps as are made.
};

/// Returns "up_to", "unloaded", "touches_floor", "touches_itself", "too_soft", "lets_go",
/// "not_found" or "steps".
const char* name(End end);

/// Returns "breaks", "touches_floor", "touches_itself" or "too_soft".
const char* name(EventKind kind);

/// Returns "bifurcation" or "limit".
const char* name(Loss loss);

/// The first time that something happens.
struct Event {
  EventKind kind = EventKind::kBreaks;
  double factor = 0;                      ///< lambda
  std::vector<std::size_t> modules = {};  ///< Indices: the two ends of a connection, or one.
};

/// The loss of stability, and how the robot begins to move then.
struct Critical {
  double factor = 0;  ///< lambda
  Loss loss = Loss::kBifurcation;
  std::size_t module = 0;          ///< The index of the module that moves most.
  std::array<double, 3> motion{};  ///< Its direction, of length 1, global frame.
  bool is_by_facets = false;       ///< Whether a facet tilts or is open then: it tips over.
};

/// One equilibrium on the path, in numbers.
struct PathPoint {
  double factor = 0;
  double load_ratio_max = 0;
  double displacement_max_mm = 0;
  bool is_stable = true;  ///< All are but those behind a loss of stability.
};

/// An equilibrium under lambda times the loads.
struct State {
  double factor = 0;
  std::vector<mechanics::Pose> poses = {};           ///< By module.
  std::vector<solver::FacetState> facets = {};       ///< In the robot's order.
  std::vector<base::Vec6<double>> facet_force = {};  ///< By facet: on its module, at the node.
  /// The force in the middle of each connection, local frame there.
  std::vector<base::Vec6<double>> middle_force = {};
  std::vector<double> load_ratio = {};  ///< By connection.
  std::vector<double> gap_mm = {};      ///< By connection: the opening at its facet's edge.
  double load_ratio_max = 0;            ///< 0 without connections.
  std::optional<std::size_t> worst = {};
  double displacement_max_mm = 0;
  double rotation_max_rad = 0;
  double edge_strain_max = 0;
};

/// Equilibria behind the loss of stability, stable or not, in their order along the branch.
struct Branch {
  End end = End::kNotFound;
  std::vector<std::size_t> modules = {};  ///< Of the event that ends it.
  std::vector<PathPoint> points = {};
  /// The first stable equilibrium under the loads as they are; under those of a limit point where
  /// that is beyond them, under Options::factor_max where a bifurcation is.
  std::optional<State> rest = {};
  State last = {};  ///< Without poses if there are no points.
};

/// What is wanted of a path.
struct Options {
  double factor_max = 2;  ///< Where the path ends; more than 0.
  /// What modules may meet as the robot bends; a robot itself knows the facets alone that touch at
  /// rest.
  std::span<const model::Obstacle> obstacles = {};
  bool is_bonded = false;  ///< Facets hold like a module below would.
  /// Goes on behind the first loss of stability: by arc length, or from a bifurcation along the
  /// mode to both sides.
  bool is_followed_behind = false;
  /// A function that is called with each equilibrium, whether it is stable, and the number of its
  /// branch: 0 before the loss.
  std::function<void(const State& state, bool is_stable, int branch)> on_state = {};
  std::size_t memory_bytes_max = solver::EquilibriumOptions{}.memory_bytes_max;
  int thread_count = 0;  ///< 0: as many as the machine has cores.
};

/// A path of stable equilibria.
struct Path {
  Outcome outcome = Outcome::kNoStart;
  std::optional<Critical> critical = {};
  std::vector<Event> events = {};  ///< By factor; one of each kind at most.
  std::vector<PathPoint> points = {};
  State last = {};                   ///< At lambda = 1, or the last one where that is not reached.
  std::optional<State> loaded = {};  ///< At lambda = 1.
  /// Behind the loss of stability, if that is wanted: two of a bifurcation, else one.
  std::vector<Branch> behind = {};
  int step_count = 0;   ///< Equilibria that were found.
  int solve_count = 0;  ///< Factorizations.
};

/// Follows a robot's stable equilibria.
Path follow(const model::Robot& robot, const Options& options = {});

}  // namespace holdfast::large
