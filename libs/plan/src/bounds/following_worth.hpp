// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace holdfast::plan {

/// Whether it pays to follow a growing robot from a state that was solved: what that takes for each
/// state that it certifies, against what a solution from nothing takes for each that its bound
/// does. Where ways down to supports are long the displacements that follow are near, but soon no
/// bound of the load ratio is, and every one of them takes more than a solution from nothing.
///
/// Counts multigrid's iterations, not time, so that the same states are solved on every machine.
class FollowingWorth {
 public:
  /// A state was solved from nothing, in so many iterations. Returns whether to follow it: where
  /// that did not pay the last time it rests, longer each time.
  bool begin(int iteration_count) {
    solved_ = {.effort = kSetup + iteration_count, .state_count = 1};
    followed_ = {.effort = kSetup};
    is_following_ = false;
    if (rest_ == 0) {
      return true;
    }
    --rest_;
    return false;
  }

  /// Whether following, which has not begun yet, can pay: not where a bound has certified so many
  /// states that each took less than a solution that follows takes at least.
  bool can_pay() const {
    return is_following_ || solved_.effort >= kEffortMin * solved_.state_count;
  }

  /// One more state was certified, by following or by what is known of the last that was solved so.
  void certify(bool by_following) {
    is_following_ = is_following_ || by_following;
    ++(is_following_ ? followed_ : solved_).state_count;
  }

  /// Following certifies no more states, after so many iterations.
  void end(int iteration_count) {
    followed_.effort += iteration_count;
    const bool pays =
        followed_.effort * solved_.state_count <= solved_.effort * followed_.state_count;
    pause_ = pays ? 0 : std::min(8 * pause_ + 7, kPauseMax);
    rest_ = pause_;
  }

 private:
  struct Share {
    int effort = 0;  ///< In iterations.
    int state_count = 0;
  };

  /// The effort to make a robot, its equations and their hierarchy, in iterations.
  static constexpr int kSetup = 15;
  /// The least effort, for each certified state, of a solution that follows: it takes about three.
  static constexpr int kEffortMin = 1;
  /// The longest rest, in solved states.
  static constexpr int kPauseMax = 1000;

  Share solved_;
  Share followed_;
  bool is_following_ = false;
  int pause_ = 0;
  int rest_ = 0;
};

}  // namespace holdfast::plan
