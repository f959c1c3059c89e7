// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/conductor/energy_bound.hpp"
#include "holdfast/agent/conductor/law.hpp"
#include "holdfast/agent/conductor/whole.hpp"
#include "holdfast/agent/equilibrium/deflation.hpp"

/// The iterations of an equilibrium as the root sees them: from the sums of one iteration to the
/// coefficients of the next (minimal_residuals.hpp), and when to stop.
namespace holdfast::agent {

/// How good the last judgement was, and is to be.
struct Accuracy {
  double ratio;       ///< The largest load ratio.
  double error;       ///< Bound on the error of load ratios.
  double error_best;  ///< Since contact states have changed.
  double target;      ///< The error that is good enough.
  std::uint8_t stagnation_count;
  [[no_unique_address]] PresentIf<kIsGeneral, std::uint8_t> slack_bits;  ///< Setup::slack_bits

  /// An equilibrium begins.
  void begin(const Whole& whole);

  /// Contact states have changed.
  void restart();

  /// What load ratios must be good to before contact states are told; a single module has none.
  double uneven_target(const Whole& whole) const;

  /// Where that is not reached any more.
  double halting_target(const Whole& whole) const;
};

/// Newton's method by the polynomial: contact states are kept until their forces are in balance.
struct Newton {
  bool is_used;
  bool stands_in;  ///< The next iteration is one of a linear problem, ...
  bool stood_in;   ///< ... as the last one was.
  bool is_solved;  ///< The facets' own forces are in balance, as far as states need it.
  double enough;   ///< The linear problem is solved when its error is below.

  /// States are sought anew: none has been seen.
  void begin(const Whole& whole);

  /// Decides after an iteration: is the next one another of the same linear problem, or are the
  /// facets' own forces looked up, and, where they are in balance, their states?
  void steer(const Whole& whole, const Accuracy& accuracy, bool kept_states);
};

/// Rigid clusters between two polynomials (rigid_clusters.hpp).
struct ClusterChoice {
  /// Iterations are taken with clusters, ...
  [[no_unique_address]] PresentIf<kHasAllMethods, bool> has;
  /// ... as the last one was.
  [[no_unique_address]] PresentIf<kHasAllMethods, bool> had;
  bool has_left;  ///< They brought nothing: never again.

  /// Does the order that begins find them?
  bool may_begin(const Whole& whole) const;

  /// The report of kClusters: beams between clusters, and those that do not go to the parent.
  void choose(const Whole& whole, const Report& report);
};

class Iterations {
 public:
  /// What an iteration's report means.
  enum class Outcome : std::uint8_t {
    kGoesOn,
    kSettled,
    kJumped,         ///< Some facets want other states than those in use.
    kStuck,          ///< No number, or too many iterations.
    kStagnant,       ///< No progress.
    kOutOfRoom,      ///< A front found no room.
    kWithoutState,   ///< The root found no contact state.
    kClustersStuck,  ///< Clusters bring nothing.
  };

  Accuracy accuracy;
  Newton newton;
  ClusterChoice clusters;

  /// A round begins.
  void enter(const Setup& setup, Deflation* deflation);

  /// An equilibrium begins, with displacements that are kept or from rest.
  void begin(const Whole& whole, bool keeps_motion);

  /// The degree of the polynomial that begins at once.
  std::uint16_t degree(const Whole& whole) const;

  /// The first iteration from states as they are; `begun_by` the last order.
  Order first(Whole& whole, const Law& law, wire::Operation begun_by);

  /// Contact states of few facets are put on trial.
  void begin_trial(const Whole& whole);

  /// Facets have let go.
  void begin_again(const Whole& whole);

  /// What an iteration has reported.
  Outcome judge(const Setup& setup, const Whole& whole, const Report& report,
                bool tries_each_state);

  /// The next iteration; the last one's states are still in use.
  Order next(const Whole& whole, const Law& law, const Report& report);

  /// Have iterations with clusters changed states for too long?
  bool is_beyond_clusters(const Whole& whole) const;

  /// The next iteration, with other states.
  Order jumped(const Whole& whole, const Law& law, const Report& report);

  /// Was the last iteration expected to be accurate enough for states to be told?
  bool was_accurate() const { return was_accurate_; }

  /// Displacements have been exchanged, and nothing is known of the next ones.
  void expect_nothing();

  // ---- What is kept of how the robot has moved before (deflation.hpp).

  bool deflates(const Whole& whole) const;

  /// The place at which a change is kept.
  std::uint8_t place_of_change();

  void begin_deflation(const Report& report);

  /// What this solve has changed is of use if it was one of the same stiffness all along.
  void end_deflation(const Whole& whole);

  /// What an iteration has reported, with the products of what it went along of the changes.
  Report completed(const Whole& whole, const Report& report);

 private:
  /// The next iteration of a one-sweep method: u + a (p - c p_older) + b p_older.
  struct Minimum {
    double a = 0;
    double b = 0;
    double c = 0;
    double square = 0;  ///< (p, q) of p - c p_older, or |q|^2
  };

  Order make(const Whole& whole, std::uint8_t flags, const std::array<float, 3>& coefficients);
  Order restarted(const Whole& whole, const Law& law, std::uint8_t flags = 0);
  Order minimised(const Whole& whole, const Law& law, const Report& report);
  Minimum minimum(const Report& report) const;
  double bound(const Setup& setup, const Report& report, double sum);
  wire::Operation operation(const Whole& whole) const;
  void set_along(const Whole& whole, Order& iteration);
  int stagnation_max(const Whole& whole) const;

  bool has_older_;       ///< There is an older direction.
  bool least_residual_;  ///< A facet tilts: no energy to minimise.
  bool has_changed_;     ///< M^-1 is another one than in the iteration before.
  bool holds_planned_;   ///< Planned modules stand still in M, ...
  bool held_planned_;    ///< ... as they did in the last iteration.
  bool kept_states_;     ///< The last iteration did not look contact states up.
  bool was_accurate_;
  bool is_spoiled_;      ///< The stiffness has changed while this solve went on.
  double predicted_;     ///< Error expected after the last iteration.
  double older_square_;  ///< (p, q) of the older direction, or |q|^2.
  EnergyBound energy_bound_;
  Deflation* deflation_;  ///< Lent; null: iterations are not deflated.
};

/// The error of any load ratio for an error e of the displacements with e K e = 1, a bound that
/// holds for any robot.
double ratio_per_energy_root(const Setup& setup);

/// Are not only load ratios asked for, but the forces of facets?
bool needs_forces(const Setup& setup, const Whole& whole);

}  // namespace holdfast::agent
