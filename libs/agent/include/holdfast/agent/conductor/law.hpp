// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/conductor/whole.hpp"

namespace holdfast::agent {

/// The contact law in force, and what reports have said of contact under it. As in the exact
/// solver: first the paper's law (9)-(12), then the unilateral one, whose weak springs are
/// stiffened where it does not settle.
class Law {
 public:
  /// Begins anew; `changes`: of contact states so far.
  void begin(bool is_unilateral, std::uint32_t changes);

  /// Share of weak springs.
  double gamma() const;

  /// The next stiffer weak springs of the unilateral law; false: there are none.
  bool stiffens_springs(const Whole& whole);

  // ---- Contact states.

  /// What a residual's report says.
  void note(const Report& report);

  /// No states have been seen.
  void forget_seen() { seen_count_ = 0; }

  /// Have all facets been in these states? Those seen last are last. Where it is full they count as
  /// seen, or, if it `forgets`, what was not seen for the longest time is forgotten.
  bool was_seen(std::uint32_t hash, bool forgets);

  std::uint32_t states_hash() const { return states_hash_; }

  void limit_changes(std::uint32_t last) { changes_max_ = last; }

  bool is_beyond(std::uint32_t changes) const { return changes > changes_max_; }

  bool is_tilting() const { return is_tilting_; }

  /// May weak springs away from a level floor carry?
  bool may_pull() const { return kIsGeneral && may_pull_; }

  /// May a facet have a second state?
  bool may_differ() const { return may_differ_; }

  // ---- What the law has said.

  /// The regularised law may have a state: no method came to it.
  void give_up() { has_given_up_ = true; }

  /// The unilateral law is asked as well, as weak springs may pull.
  void ask_second() { is_second_ = true; }

  bool is_second() const { return kIsGeneral && is_second_; }

  /// Open feet are freed, to see whether the verdict stays.
  Order free_open_feet();

  bool is_comparing() const { return is_comparing_; }

  /// Forgets it for a verdict that is begun anew.
  void forget_comparison();

  void note_standing(bool is_standing) { is_standing_ = is_standing; }

  /// Does the robot stand, by the corners that press?
  bool is_standing() const { return is_standing_; }

  void note_held(std::uint32_t open_count) { open_held_count_ = open_count; }

  bool is_any_held_open() const { return open_held_count_ > 0; }

  bool is_toppling() const { return kIsGeneral && springs_ == WeakSprings::kToppling; }

  /// The verdict by the largest load ratio, `first` as it was told and `ratio` at the last
  /// judgement, whose error is bounded. `other_fails`: another solution does.
  Answer verdict(const Whole& whole, double first, double ratio, double error,
                 bool other_fails) const;

 private:
  /// The weakest, then some that single precision can tell, then those that only answer whether the
  /// robot hangs on them.
  enum class WeakSprings : std::uint8_t { kWeakest, kStiffer, kToppling };

  static constexpr int kSeenMax = 24;

  WeakSprings springs_;
  bool has_given_up_;
  bool is_second_;
  bool is_comparing_;
  bool is_standing_;
  bool is_tilting_;
  bool may_pull_;
  bool may_differ_;
  std::uint32_t states_hash_;  ///< Of the contact states wanted at the last judgement.
  std::uint32_t open_held_count_;
  std::uint32_t changes_max_;  ///< Effort::contact_iterations, under this law.
  std::array<std::uint32_t, kSeenMax> seen_;
  std::uint8_t seen_count_;
};

}  // namespace holdfast::agent
