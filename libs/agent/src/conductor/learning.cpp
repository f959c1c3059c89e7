// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/learning.hpp"

#include "conductor/orders.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/world/stages.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

/// Plans that end in one round, at most; more end as `undecided`.
constexpr std::uint8_t kForgottenMax = 200;

/// The masks of many planned modules go down in parts. `planned` has those of the later ones.
Order ask_hosts(const Whole& whole, const Planned& planned) {
  Order hosts = order_of(Operation::kHosts);
  hosts.masks = whole.totals;
  if (kIsGeneral && whole.planned_count > kMasksOfPart) {
    const int first = planned.parts_here() * kMasksOfPart;
    hosts.index = static_cast<std::uint8_t>(planned.parts_here());
    for (std::size_t i = 0; i < hosts.masks.size(); ++i) {
      const int k = first + static_cast<int>(i);
      hosts.masks[i] = k < planned.count() ? planned.touching(k).mask() : FaceMask{0};
    }
  }
  return hosts;
}

/// Does somebody emulate every planned module? Reports have room for few; of many the root knows
/// it.
bool is_all_hosted(const Whole& whole, const Report& report, const Planned& planned) {
  if (kIsGeneral && whole.planned_count > kPlannedMax) {
    return !planned.is_any_detached();
  }
  return is_each_hosted(whole, report);
}

/// Do loads pull a robot away from the plane of all its supports? But for rounding to units.
bool is_pulled_away(const Setup& setup, const Report& report) {
  const auto pressure = static_cast<std::int32_t>(report.mass());
  return setup.has_plane && (report.flags & kSumOverflow) == 0 &&
         pressure < -static_cast<std::int64_t>(report.count);
}

/// Does the check in a plane of supports fit? What does not fit there is left to the equilibrium.
bool fits_plane_check(const Setup& setup, const Report& report, std::uint16_t extent) {
  constexpr std::int64_t kMost = 0x7fffffff;
  const auto fits = [](std::int64_t moment) { return -kMost <= moment && moment <= kMost; };
  return (report.flags & kSumOverflow) == 0 && fits(report.moment[0]) && fits(report.moment[1]) &&
         fits_plane_check(setup, static_cast<std::int32_t>(report.mass()), report.count, extent);
}

/// `found`: the word of this index.
Order ask_word(std::uint8_t index, const Report& found) {
  Order order = order_of(Operation::kWord);
  order.index = index;
  order.count = found.extent;
  order.cell = found.cell;
  order.mass = static_cast<std::int32_t>(found.number);
  return order;
}

}  // namespace

Order Learning::begin() {
  Order first = order_of(Operation::kPlan);
  first.index = kNoPlanned;
  return first;
}

Order Learning::after_plan(Whole& whole, const Report& report, const Planned& planned) {
  if ((report.flags & kEnded) != 0) {
    return forget(whole, report);
  }
  if (whole.planned_count > planned.capacity()) {
    return undecided(Reason::kPlannedTooMany);
  }
  if (whole.planned_count > 0 && (!kIsGeneral || whole.planned_count <= kMasksOfPart)) {
    whole.totals[whole.planned_count - 1U] = report.mask;
  }
  if ((report.flags & kFound) != 0) {
    // One too many is asked for, too: it may be one that has ended.
    Order plan = order_of(Operation::kPlan);
    plan.index = whole.planned_count++;
    plan.cell = report.cell;
    return plan;
  }
  if ((report.flags & (kTooManyAnnounced | kDisputed)) != 0) {
    return undecided((report.flags & kDisputed) != 0 ? Reason::kPlanDisputed
                                                     : Reason::kPlannedTooMany);
  }
  return kKeepsAnswers && (report.flags & kStepTold) != 0 ? first_word()
                                                          : ask_hosts(whole, planned);
}

Order Learning::forget(Whole& whole, const Report& report) {
  if (forgotten_count_++ == kForgottenMax) {
    return undecided(Reason::kNotConverged);
  }
  whole.planned_count = 0;
  whole.totals = {};
  Order forget = order_of(Operation::kForget);
  forget.cell = report.cell;
  forget.flags = (report.flags & kFulfilled) != 0 ? kIsFulfilled : std::uint8_t{0};
  return forget;
}

Order Learning::after_hosts(Whole& whole, const Report& report, const Planned& planned) {
  if (!planned.has_all_parts()) {
    return ask_hosts(whole, planned);
  }
  whole.is_any_remote = (report.mask & kAnyRemote) != 0;
  if (!is_all_hosted(whole, report, planned)) {
    return undecided(Reason::kPlannedDetached);
  }
  Order mass = order_of(Operation::kMass);
  mass.cell = whole.root;
  return mass;
}

Order Learning::after_mass(Whole& whole, const Setup& setup, const Report& report) {
  if (report.count != whole.census + whole.planned_count) {
    return undecided(Reason::kNeighbourSilent);
  }
  whole.effort.module_count = report.count;
  whole.is_fixed = (report.flags & kAnyFixed) != 0;
  whole.has_uneven_supports = (report.flags & kUneven) != 0;
  whole.extent = report.extent;
  whole.has_many_loops = (report.flags & kManyLoops) != 0;
  if (whole.extent > kExtentMax || whole.depth > kExtentMax) {
    return undecided(Reason::kTooLarge);
  }
  if (whole.may_fall() && is_pulled_away(setup, report)) {
    return verdict_order(Verdict::kUnstable, Reason::kTopples);
  }
  if (whole.is_fixed || (whole.is_uneven() && !fits_plane_check(setup, report, whole.extent))) {
    return {};
  }
  constexpr std::int64_t kMost = 0x7fffffff;
  const auto is_large = [](std::int64_t moment) { return moment < -kMost || moment > kMost; };
  const auto [x, y, z] = report.moment;
  if ((report.flags & kSumOverflow) != 0 || is_large(x) || is_large(y) ||
      !fits_exact_check(setup, report.mass())) {
    return undecided(Reason::kTooLarge);
  }
  Order angles = order_of(Operation::kAngles);
  angles.cell = whole.root;
  angles.mass = static_cast<std::int32_t>(report.mass());
  angles.moment = {static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
  return angles;
}

Order first_word() {
  return ask_word(kNoWord, {.number = bits_of({.kind = StepWord::Kind::kAttach})});
}

Order after_word(const Report& report, const Stages& stages) {
  const std::uint8_t learned = stages.learned_count();
  const std::uint16_t total = learned == 0 ? report.extent : stages.total();
  const bool is_last = learned > 0 && learned == total;
  const bool is_found = (report.flags & kFound) != 0 && report.extent == total &&
                        total <= kWordCountMax &&
                        stages.is_possible(word_of(report.number, report.cell));
  const bool is_clear = (report.flags & (kDisputed | kDenied)) == 0 &&
                        (is_last ? stages.is_whole(report.count) : is_found);
  if (!is_clear) {
    return undecided(Reason::kStepUnclear);
  }
  if (!is_last) {
    return ask_word(learned, report);
  }
  Order stage = order_of(Operation::kStage);
  stage.answer = {.verdict = Verdict::kUndecided, .reason = Reason::kInPieces};
  const bool is_split = (report.flags & kSplit) != 0;
  stage.flags = static_cast<std::uint8_t>(is_split ? report.mask : 0);
  stage.index = static_cast<std::uint8_t>(is_split ? Stage::kNone : Stage::kRelease);
  return stage;
}

}  // namespace holdfast::agent
