// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/law.hpp"

#include "algebra/scalar.hpp"
#include "algebra/tolerances.hpp"
#include "conductor/orders.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::agent {

void Law::begin(bool is_unilateral, std::uint32_t changes) {
  if (kIsGeneral && !is_unilateral) {
    has_given_up_ = false;
    is_second_ = false;
    springs_ = WeakSprings::kWeakest;
  }
  is_tilting_ = false;
  may_differ_ = false;
  changes_max_ = changes + kContactIterationsMax;
}

double Law::gamma() const {
  switch (kIsGeneral ? springs_ : WeakSprings::kWeakest) {
    case WeakSprings::kStiffer:
      return kStifferGamma;
    case WeakSprings::kToppling:
      return kTopplingGamma;
    default:
      return kUnilateralGamma;
  }
}

bool Law::stiffens_springs(const Whole& whole) {
  const bool is_weakest = springs_ == WeakSprings::kWeakest;
  const bool may_topple = springs_ == WeakSprings::kStiffer && !whole.is_fixed && !is_second_;
  if (!whole.is_uneven() || !(is_weakest || may_topple)) {
    return false;
  }
  springs_ = is_weakest ? WeakSprings::kStiffer : WeakSprings::kToppling;
  is_comparing_ = false;
  return true;
}

void Law::note(const Report& report) {
  is_tilting_ = (report.flags & kAnyTilting) != 0;
  may_pull_ = (report.flags & kMayPull) != 0;
  may_differ_ = (report.flags & kMayDiffer) != 0;
  if constexpr (kHasAllMethods) {
    states_hash_ = report.states_hash();
  }
}

bool Law::was_seen(std::uint32_t hash, bool forgets) {
  std::uint8_t place = 0;
  while (place < seen_count_ && seen_[place] != hash) {
    ++place;
  }
  const bool is_new = place == seen_count_;
  if (is_new && seen_count_ == kSeenMax) {
    if (!forgets) {
      return true;
    }
    place = 0;
  } else if (is_new) {
    ++seen_count_;
  }
  for (; place + 1U < seen_count_; ++place) {
    seen_[place] = seen_[place + 1U];
  }
  seen_[place] = hash;
  return !is_new;
}

Order Law::free_open_feet() {
  is_comparing_ = true;
  Order hold = order_of(wire::Operation::kHold);
  hold.flags = kFreeOpen;
  return hold;
}

void Law::forget_comparison() {
  open_held_count_ = 0;
  is_comparing_ = false;
}

Answer Law::verdict(const Whole& whole, double first, double ratio, double error,
                    bool other_fails) const {
  const auto undecided_by = [](Reason reason) {
    return Answer{.verdict = Verdict::kUndecided, .reason = reason};
  };
  const bool breaks = mechanics::breaks(first);
  const double springs = whole.effort.is_unilateral ? kRatioPerGamma * gamma() : 0;
  const double least = springs * (1 + absolute(ratio));
  const double doubt = (error > kErrorLeast ? error : kErrorLeast) + least;
  // Away from a level floor the robot may fall by the law that was given up.
  if (!is_number(first) || !is_number(ratio) || (whole.is_uneven() && has_given_up_)) {
    return undecided_by(Reason::kNotConverged);
  }
  if (absolute(ratio - 1) <= doubt) {
    return undecided_by(Reason::kTooClose);
  }
  const bool falls = kIsGeneral && (other_fails || (is_second_ && !is_standing_));
  if (mechanics::breaks(ratio) != breaks || (falls && !breaks)) {
    return undecided_by(Reason::kAmbiguousFeet);
  }
  return {.verdict = breaks ? Verdict::kOverload : Verdict::kSafe,
          .reason = breaks ? Reason::kBreaks : Reason::kHolds};
}

}  // namespace holdfast::agent
