// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// From one verdict to the next, where only plans have changed or a module has come: the tree
// stands, and displacements and contact states are a good guess.
#include "holdfast/agent/conductor.hpp"
#include "holdfast/agent/feet.hpp"
#include "resume_masks.hpp"
#include "scalar.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// How many beams planned modules have among each other and to the robot.
int planned_connections(const Planned& planned) {
  int ends = 0;
  for (int k = 0; k < planned.count(); ++k) {
    const Faces touching = planned.touching(k);
    for (const base::Direction direction : planned.directions()) {
      ends += touching.has(direction) ? 2 : 0;
      ends += planned.neighbour_of(k, direction) >= 0 ? 1 : 0;
    }
  }
  return ends / 2;
}

/// A tree that has grown deeper than this part of its depth is made anew. All steps but few go on
/// with the tree that there is, and no sweep is longer than a quarter more.
constexpr int kDeeperShare = 4;

/// What is known of a module that is, or will be, in a cell.
struct Place {
  std::int64_t mass = 1;  ///< Units.
  bool is_ground = false;
  bool is_known = true;
};

Place place_of(const Setup& setup, const Environment* environment, const base::Cell& cell) {
  if (!kHasSurroundings || environment == nullptr) {
    return {.is_ground = cell.z == setup.support_z};
  }
  Surroundings there;
  there.environment = environment;
  environment->describe(environment->map, cell, there);
  return {
      .mass = there.mass, .is_ground = there.facet_count > 0, .is_known = is_number(there.load[0])};
}

/// An order that is none.
Order no_order() { return {}; }

}  // namespace

/// The unilateral law and the older methods keep more than displacements, and clusters are found by
/// the order that begins them.
bool Conductor::can_renew(const Setup& setup) const {
  const bool has_method =
      setup.method == Method::kElimination || setup.method == Method::kPolynomial;
  const bool is_decided =
      answer_.verdict != Verdict::kNone && answer_.verdict != Verdict::kUndecided;
  return setup.keeps_answers && asked_ == Operation::kVerdict && is_decided && has_method &&
         !is_unilateral_ && !has_clusters_;
}

Order Conductor::renew(const Setup& setup, const News& news, const Planned& planned,
                       const Environment* environment) {
  is_resumed_ = true;
  is_same_shape_ = (news.flags & kIsFulfilled) != 0;
  has_judged_ = has_judged_ && (news.flags & (kIsFulfilled | kIsGrown)) == 0;
  if ((news.flags & kIsGrown) != 0) {
    ++census_;
    depth_ = depth_ < news.hops ? news.hops : depth_;
  }
  if (depth_ > wave_depth_ + wave_depth_ / kDeeperShare + 2) {
    return no_order();  // Another root would make shorter sweeps.
  }
  return renew_plan(setup, news.flags, news.cell, planned, environment);
}

/// One plan more or less. What every module knows of plans must fit: one more has place and is
/// new, one less is there.
/// Whatever hangs in the air adds no stiffness to the tree.
Order Conductor::renew_plan(const Setup& setup, std::uint8_t flags, const base::Cell& cell,
                            const Planned& planned, const Environment* environment) {
  const bool ends = (flags & kIsEnded) != 0;
  const int left = planned.count() - (ends ? 1 : 0);
  const bool is_known = planned.find(cell) >= 0;
  const bool is_new = !ends && (flags & kIsGrown) == 0;
  if (is_known != ends || (is_new && left >= kPlannedMax)) {
    return no_order();
  }
  const Place place = place_of(setup, environment, cell);
  if (!place.is_known) {
    return no_order();
  }
  has_factors_ = has_factors_ && !place.is_ground;
  Order renew = ask(Operation::kRenew);
  renew.flags = static_cast<std::uint8_t>(flags | (has_factors_ ? kKeepsFactors : 0U));
  renew.cell = cell;
  return renew;
}

Order Conductor::after_renew(const Setup& setup, const Report& report, const Planned& planned,
                             const Environment* environment) {
  if ((report.flags & kAtOdds) != 0 || report.count != census_) {
    return no_order();
  }
  if ((report.flags & kMoreAnnounced) != 0) {
    is_same_shape_ = false;
    return renew_plan(setup, 0, report.cell, planned, environment);
  }
  if ((report.flags & kNewLoop) != 0) {
    has_factors_ = false;
    Order again = ask(Operation::kRenew);
    again.flags = kIsUnchanged;
    return again;
  }
  const bool is_fixed = (report.flags & kAnyFixed) != 0;
  if (is_same_shape_ && is_fixed == is_fixed_ &&
      report.count + static_cast<std::uint32_t>(planned.count()) == effort_.module_count) {
    planned_count_ = static_cast<std::uint8_t>(planned.count());
    return finish(answer_.verdict, answer_.reason);
  }
  is_fixed_ = is_fixed;
  return weigh(setup, report, planned, environment) ? resume(setup, planned) : no_order();
}

/// Adds the planned modules to what the others have reported. False: too large to be counted, or
/// some touch nothing.
bool Conductor::weigh(const Setup& setup, const Report& report, const Planned& planned,
                      const Environment* environment) {
  if (planned.count() > resumed_planned_max(face_count(setup))) {
    return false;  // Their masks have no room in one order.
  }
  planned_count_ = static_cast<std::uint8_t>(planned.count());
  effort_ = {.module_count = census_ + planned_count_, .method = setup.method};
  std::array<std::int64_t, 2> moment = {report.moment[0], report.moment[1]};
  std::int64_t extent = report.extent;
  std::int64_t mass = report.mass();
  bool is_known = true;
  totals_ = {};
  for (int k = 0; k < planned.count(); ++k) {
    const base::Cell& cell = planned.cell(k);
    const std::int64_t x = cell.x - root_.x;
    const std::int64_t y = cell.y - root_.y;
    const std::int64_t z = cell.z - root_.z;
    const base::Cell away = floor_place(setup, cell, root_);
    const Place place = place_of(setup, environment, cell);
    moment[0] += place.mass * away.x;
    moment[1] += place.mass * away.y;
    mass += place.mass;
    is_known = is_known && place.is_known;
    const std::int64_t reach =
        (x < 0 ? -x : x) + (y < 0 ? -y : y) + (z < 0 ? -z : z) + (setup.is_cubic() ? 0 : 1);
    extent = extent < reach ? reach : extent;
    totals_[static_cast<std::size_t>(k)] = planned.touching(k).mask();
  }
  constexpr std::int64_t kMost = 0x7fffffff;
  for (const std::int64_t value : moment) {
    if (value < -kMost || value > kMost) {
      return false;
    }
  }
  if (!is_known || planned.is_any_detached()) {
    return false;  // It has a beam less than it would hang by, which hides one that closes a loop.
  }
  const bool is_bent = planned_connections(planned) != planned.count();
  is_any_remote_ = is_bent;
  has_many_loops_ = is_bent || (report.flags & kManyLoops) != 0;
  extent_ = static_cast<std::uint16_t>(extent);
  mass_ = static_cast<std::int32_t>(mass);
  moment_ = {static_cast<std::int32_t>(moment[0]), static_cast<std::int32_t>(moment[1])};
  return (report.flags & kSumOverflow) == 0 && extent <= kExtentMax && depth_ <= kExtentMax &&
         fits_exact_check(setup, mass);
}

/// As the order that begins an equilibrium, with all that went before it.
Order Conductor::resume(const Setup& setup, const Planned& /*planned*/) {
  const Order begin = begin_law(setup, false);
  const bool has_method =
      effort_.method == Method::kElimination || effort_.method == Method::kPolynomial;
  if (begin.operation != Operation::kBegin || !has_method) {
    return no_order();
  }
  Order resume = begin;
  const bool deflates = deflation_ != nullptr && deflation_->is_used() && !is_exact();
  resume.operation = deflates ? Operation::kResumeDeflated : Operation::kResume;
  asked_ = resume.operation;
  // A planned module between others closes a loop.
  has_factors_ = has_factors_ && effort_.method == Method::kElimination;
  resume.flags =
      static_cast<std::uint8_t>(begin.flags | (has_factors_ ? kKeepsFactors : 0U) |
                                (has_motion_ ? kKeepsMotion : 0U) | (is_fixed_ ? 0U : kRests));
  resume.count = is_exact() ? std::uint16_t{0} : iteration_degree();
  resume.index = deflation_ != nullptr ? deflation_->place() : std::uint8_t{wire::kKeptMax};
  resume.mass = mass_;
  resume.moment = moment_;
  resume.masks = resume_masks(totals_, face_count(setup));
  open_held_count_ = 0;
  is_comparing_ = false;
  return resume;
}

Order Conductor::after_resume(const Report& report) {
  const unsigned all = (1U << planned_count_) - 1;
  if ((report.mask & 0x7fU) != all) {
    return finish(Verdict::kUndecided, Reason::kPlannedDetached);
  }
  if (!is_fixed_ && report.feet.range != mechanics::SafeRange::kFull) {
    return finish(Verdict::kUnstable, Reason::kTopples);
  }
  if (!is_exact()) {
#ifndef HOLDFAST_AGENT_STARTS_AFRESH
    if (asked_ == Operation::kResumeDeflated) {
      deflation_->begin(report.along, report.energies);
    }
#endif
    return first_iteration();
  }
  ++effort_.solves;
  predicted_ = kUnbounded;
  return tree_iteration();
}

Order Conductor::after_close(const Setup& setup, const Report& report) {
  if (!report.corners.stable) {
    return after_corners(setup, report);
  }
  note_worst(report);
  if (may_slip(report)) {
    return finish(Verdict::kUndecided, Reason::kMaySlip);
  }
  return conclude(setup);
}

}  // namespace holdfast::agent
