// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/renewal.hpp"

#include "algebra/scalar.hpp"
#include "conductor/orders.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "messages/resume_masks.hpp"

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
  if (!kIsGeneral || environment == nullptr) {
    return {.is_ground = cell.z == setup.support_z};
  }
  Surroundings there;
  there.environment = environment;
  environment->describe(environment->map, cell, there);
  return {
      .mass = there.mass, .is_ground = there.facet_count > 0, .is_known = is_number(there.load[0])};
}

}  // namespace

Order Renewal::begin(Whole& whole, const Setup& setup, const News& news, const Planned& planned,
                     const Environment* environment) {
  whole.is_resumed = true;
  is_same_shape_ = (news.flags & kIsFulfilled) != 0;
  if ((news.flags & kIsGrown) != 0) {
    ++whole.census;
    whole.depth = whole.depth < news.hops ? news.hops : whole.depth;
  }
  if (whole.depth > whole.wave_depth + whole.wave_depth / kDeeperShare + 2) {
    return {};  // Another root would make shorter sweeps.
  }
  return renew_plan(setup, news.flags, news.cell, planned, environment);
}

/// One plan more or less. What every module knows of plans must fit: one more has place and is
/// new, one less is there.
/// Whatever hangs in the air adds no stiffness to the tree.
Order Renewal::renew_plan(const Setup& setup, std::uint8_t flags, const base::Cell& cell,
                          const Planned& planned, const Environment* environment) {
  const bool ends = (flags & kIsEnded) != 0;
  const int left = planned.count() - (ends ? 1 : 0);
  const bool is_known = planned.find(cell) >= 0;
  const bool is_new = !ends && (flags & kIsGrown) == 0;
  if (is_known != ends || (is_new && left >= kPlannedMax)) {
    return {};
  }
  const Place place = place_of(setup, environment, cell);
  if (!place.is_known) {
    return {};
  }
  has_factors = has_factors && !place.is_ground;
  Order renew = order_of(Operation::kRenew);
  renew.flags = static_cast<std::uint8_t>(flags | (has_factors ? kKeepsFactors : 0U));
  renew.cell = cell;
  return renew;
}

Order Renewal::after_renew(Whole& whole, const Setup& setup, const Report& report,
                           const Planned& planned, const Environment* environment) {
  if ((report.flags & kAtOdds) != 0 || report.count != whole.census) {
    return {};
  }
  if ((report.flags & kMoreAnnounced) != 0) {
    is_same_shape_ = false;
    return renew_plan(setup, 0, report.cell, planned, environment);
  }
  if ((report.flags & kNewLoop) != 0) {
    has_factors = false;
    Order again = order_of(Operation::kRenew);
    again.flags = kIsUnchanged;
    return again;
  }
  const bool is_fixed = (report.flags & kAnyFixed) != 0;
  if (is_same_shape_ && is_fixed == whole.is_fixed &&
      report.count + static_cast<std::uint32_t>(planned.count()) == whole.effort.module_count) {
    whole.planned_count = static_cast<std::uint8_t>(planned.count());
    return order_of(Operation::kVerdict);
  }
  whole.is_fixed = is_fixed;
  return weigh(whole, setup, report, planned, environment) ? order_of(Operation::kResume) : Order{};
}

bool Renewal::weigh(Whole& whole, const Setup& setup, const Report& report, const Planned& planned,
                    const Environment* environment) {
  if (planned.count() > resumed_planned_max(face_count(setup))) {
    return false;  // Their masks have no room in one order.
  }
  whole.planned_count = static_cast<std::uint8_t>(planned.count());
  whole.effort = {.module_count = whole.census + whole.planned_count, .method = setup.method};
  std::array<std::int64_t, 2> moment = {report.moment[0], report.moment[1]};
  std::int64_t extent = report.extent;
  std::int64_t mass = report.mass();
  bool is_known = true;
  whole.totals = {};
  for (int k = 0; k < planned.count(); ++k) {
    const base::Cell& cell = planned.cell(k);
    const std::int64_t x = cell.x - whole.root.x;
    const std::int64_t y = cell.y - whole.root.y;
    const std::int64_t z = cell.z - whole.root.z;
    const base::Cell away = floor_place(setup, cell, whole.root);
    const Place place = place_of(setup, environment, cell);
    moment[0] += place.mass * away.x;
    moment[1] += place.mass * away.y;
    mass += place.mass;
    is_known = is_known && place.is_known;
    const std::int64_t reach =
        (x < 0 ? -x : x) + (y < 0 ? -y : y) + (z < 0 ? -z : z) + (setup.is_cubic() ? 0 : 1);
    extent = extent < reach ? reach : extent;
    whole.totals[static_cast<std::size_t>(k)] = planned.touching(k).mask();
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
  whole.is_any_remote = is_bent;
  whole.has_many_loops = is_bent || (report.flags & kManyLoops) != 0;
  whole.extent = static_cast<std::uint16_t>(extent);
  whole.mass = static_cast<std::int32_t>(mass);
  whole.moment = {static_cast<std::int32_t>(moment[0]), static_cast<std::int32_t>(moment[1])};
  return (report.flags & kSumOverflow) == 0 && extent <= kExtentMax && whole.depth <= kExtentMax &&
         fits_exact_check(setup, mass);
}

}  // namespace holdfast::agent
