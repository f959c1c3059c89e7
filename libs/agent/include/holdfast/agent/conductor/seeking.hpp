// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/conductor/iterations.hpp"
#include "holdfast/agent/conductor/law.hpp"
#include "holdfast/agent/conductor/whole.hpp"

namespace holdfast::agent {

/// Further solutions of the regularised law, as the exact solver seeks them
/// (solver/other_solutions.cpp): a facet that does not press all over, and is pulled sideways by
/// more than it presses, may be held where it is open, or let go where it presses. So each is put
/// into that state, one at a time, and Newton's method goes on from there. Most go back at once. No
/// robot is safe of which another solution breaks a connection or falls.
///
/// Where Newton's method settles nowhere, and contact states say whether the robot falls, it is
/// those that fall that are sought: who falls hangs by one foot, so each foot is tried as all that
/// presses, all over and by each edge and corner. The exact law decides whether what is not found
/// to fall is safe. Of few feet all states are gone through in which the feet that press have all
/// their corners on one line: a state that the law prescribes for what it leads to falls. Where
/// others press the robot stands, and nobody has to solve for it.
///
/// In a program that does not seek it is never active.
class Seeking {
 public:
  /// What comes next.
  enum class Then : std::uint8_t {
    kOrder,       ///< The order that comes with it.
    kSolve,       ///< Iterations, from the states that facets have now.
    kExactLaw,    ///< Nothing falls: the unilateral law from rest, by the safest method.
    kMoreSafely,  ///< All of it once more, by the safest method.
    kAnew,        ///< What was found first, from rest.
    kFoundAgain,  ///< What was found first is found again.
  };

  struct Move {
    Then then = Then::kOrder;
    Order order = {};
  };

  /// Changes of contact states in one trial.
  static constexpr std::uint32_t kChangesOfTrial = 20;

  /// An equilibrium begins.
  void reset();

  /// The equilibrium begins from rest, and nothing more is sought.
  void end(bool other_fails);

  bool is_active() const;

  /// Another solution breaks a connection or falls, or may.
  bool other_fails() const { return other_fails_; }

  bool is_by_one_foot() const;
  bool tries_each_state() const;

  /// May there be another solution, and has nobody sought it?
  bool is_doubted(const Whole& whole, const Law& law, double ratio) const;

  /// Clusters of modules keep what would have to be forgotten: robots with them are not safe where
  /// they are doubted.
  bool may_begin(const Whole& whole, const Law& law, const Iterations& iterations) const;

  /// States go round in circles. May there be a solution that falls?
  bool may_hang_by_foot(const Whole& whole) const;

  /// Are the states those that were found first, and want to be? Or not those that were tried?
  bool is_back(const Law& law) const;

  Order begin(const Whole& whole, const Law& law, Newton& newton);
  Order begin_one_foot(const Whole& whole, const Law& law, Newton& newton);

  /// The move after kSeek. The first report, of what was found, only names the first facet. Where
  /// there are fronts it is the first that leads elsewhere, and if there is none nobody has to go
  /// back.
  Move after_seek(const Whole& whole, const Report& report, Newton& newton);

  /// Iterations begin from the states that facets have now. With fronts: are facets tried that the
  /// root does not keep yet?
  bool begin_solve(const Whole& whole);

  /// The next facet; behind the last one all go back to what was found.
  Move next_trial();

  /// A solution: another one, or, in the end, the first one again.
  Move after_trial(const Whole& whole, const Law& law, Iterations& iterations);

  Move after_corners(bool is_standing);

  /// A trial whose states go round in circles has no solution. Of one that is lost, as the method
  /// did not converge, nobody knows: a safer method tries all again, and behind the safest one the
  /// robot is not safe. What was found first is found again from rest. Given states are tried once
  /// more from where that has led, as feet that tilt are not solved for by a method that is certain
  /// to converge.
  Move leave_trial(const Whole& whole, bool is_lost, Newton& newton);

 private:
  enum class Stage : std::uint8_t { kNotYet, kTrying, kReturning, kDone };

  /// All states of so many facets are tried, as by the exact solver, in a robot of so few modules:
  /// a hundred solves, which take larger ones five times as long as trials of one foot.
  static constexpr std::uint8_t kFewFeet = 3;

  Order seek(std::uint32_t key, std::uint8_t flags = 0);
  Move after_given_state(const Report& report);
  Move next_state();
  bool seeks_again(const Whole& whole) const;

  Stage stage_;
  bool other_fails_;
  bool is_by_one_foot_;    ///< Those are sought that fall, hanging by one foot.
  bool tries_each_state_;  ///< All states of few feet are gone through.
  bool was_tried_;         ///< The states that are tried were tried before, which did not converge.
  bool is_front_stale_;    ///< Facets are tried that the root does not keep yet.
  bool is_trial_lost_;     ///< A trial did not converge by the present method.
  bool was_newton_;        ///< Newton::is_used before.
  std::uint8_t trial_count_;
  std::uint8_t foot_count_;
  std::uint8_t foot_;         ///< The next state is another one of this foot, or of one behind it.
  std::uint32_t found_hash_;  ///< Of the states that were found first.
  std::uint32_t next_key_;    ///< Of the facet that is tried next; 0: all have been.
  std::array<std::uint32_t, kFewFeet> keys_;  ///< Of few feet, ...
  std::array<std::uint8_t, kFewFeet> codes_;  ///< ... and the states that are tried.
};

}  // namespace holdfast::agent
