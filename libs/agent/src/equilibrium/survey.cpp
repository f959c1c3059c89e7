// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibrium/survey.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/beams.hpp"
#include "equilibrium/bending_report.hpp"
#include "equilibrium/kept_changes.hpp"
#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/mechanics/connector.hpp"
#include "messages/resume_masks.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

base::Cell from_root(const Workspace& ws, int node) {
  const base::Cell& cell = ws.cell_of(node);
  const base::Cell& root = ws.tree.root_cell();
  return {cell.x - root.x, cell.y - root.y, cell.z - root.z};
}

/// Where a node is from the root, in cells of FeetCheck.
base::Cell floor_place(const Workspace& ws, int node) {
  return floor_place(ws.setup, ws.cell_of(node), ws.tree.root_cell());
}

/// All planned modules have their hosts: nodes for those emulated here.
void prepare_nodes(Workspace& ws) {
  for (int i = 0; i < ws.node_count(); ++i) {
    if (i > 0) {
      ws.node(i) = {};
    }
    prepare_node(ws, i);
  }
}

/// What is to be said of announcements when one plan has changed; what else would need a new
/// learning of all plans is at odds with it.
void report_announcements(const Workspace& ws, const Announcements& announcements,
                          const Order& order, Report& report) {
  for (int i = 0; i < announcements.count(); ++i) {
    const Told told = announcements.told(i);
    const base::Cell& cell = announcements.cell(i);
    const bool is_plain = told == Told::kPlan || told == Told::kKnownPlan;
    if (is_plain && cell != kEveryCell && ws.planned.find(cell) < 0) {
      merge(Operation::kRenew, report, {.flags = kMoreAnnounced, .cell = cell});
    } else if (told != Told::kCarriedWithdrawal && (!is_plain || cell == kEveryCell)) {
      report.flags = static_cast<std::uint8_t>(report.flags | kAtOdds);
    }
  }
  const bool is_new = is_new_plan(order);
  const bool is_taken = is_new && order.cell == ws.tree.cell();
  // Nobody above a module that has come knows what planned modules it touches besides.
  bool is_touched = false;
  for (int k = 0; k < ws.planned.count(); ++k) {
    is_touched = is_touched || !ws.planned.own_touching(k).is_empty();
  }
  const bool has_come = (order.flags & kIsGrown) != 0 && order.cell == ws.tree.cell();
  report.flags = static_cast<std::uint8_t>(report.flags |
                                           (is_taken || (has_come && is_touched) ? kAtOdds : 0U));
}

Report renewal_report(const Workspace& ws, const Announcements& announcements, const Order& order) {
  Report report = mass_report(ws);
  report_announcements(ws, announcements, order, report);
  const int newest = ws.planned.count() - 1;
  if (newest >= 0 && ws.planned.cell(newest) == order.cell) {
    report.mask = ws.planned.own_touching(newest).mask();
  }
  return report;
}

/// One plan more or less, the same in every module.
void renew(Workspace& ws, Announcements& announcements, const Order& order) {
  ws.planned.forget_hosts();
  ws.exchange.enter();  // A module that has come counts exchanges from here on.
  if ((order.flags & kIsEnded) != 0) {
    announcements.forget(order.cell, (order.flags & kIsFulfilled) != 0);
    const int index = ws.planned.find(order.cell);
    if (index >= 0) {
      ws.planned.remove(index);
    }
  } else if (is_new_plan(order)) {
    ws.planned.add(order.cell, ws.tree.cell());
  }
}

Report announcement_report(const Order& order, bool has_last, const Announcements& announcements,
                           int i) {
  const Told told = announcements.told(i);
  Report report{.cell = announcements.cell(i)};
  if (is_withdrawal(told)) {
    report.flags = told == Told::kWithdrawal ? kEnded : std::uint8_t{0};
  } else if (report.cell == kEveryCell) {
    report.flags = kTooManyAnnounced;
  } else {
    const bool is_disputed = told == Told::kDisputedPlan || told == Told::kKnownDispute;
    const bool is_next = !has_last || report.cell > order.cell;
    report.flags =
        static_cast<std::uint8_t>((is_disputed ? kDisputed : 0U) | (is_next ? kFound : 0U));
  }
  return report;
}

/// Was this module told of a step that has not been learned yet?
[[maybe_unused]] bool is_step_told(const Workspace& ws) {
  return ws.stages() != nullptr && ws.stage() == Stage::kNone && ws.stages()->has_told();
}

/// Where this module is for planned ones: one that leaves touches none.
base::Cell touching_cell(const Workspace& ws) {
  return ws.is_gone(ws.tree.cell()) ? kEveryCell : ws.tree.cell();
}

/// The order has come that says what was judged, or teaches a word.
void take_stage_order(Workspace& ws, const Order& order) {
  if (order.operation == Operation::kStage) {
    if (order.flags != 0) {
      ws.stages()->note(static_cast<Stage>(order.flags), order.answer);
    }
    ws.stages()->enter(static_cast<Stage>(order.index), static_cast<std::uint8_t>(order.count));
  } else if (order.index != kNoWord) {
    ws.stages()->learn(order.index, static_cast<std::uint8_t>(order.count),
                       word_of(static_cast<std::uint32_t>(order.mass), order.cell));
  }
}

/// Where this module touches what does not move, as it knows before any node is made ready.
void note_touching(const Workspace& ws, StageSite& site) {
  const Environment* environment = ws.environment();
  if (!kIsGeneral || environment == nullptr) {
    site.is_standing = !site.is_fixed && site.cell.z == ws.setup.support_z;
    return;
  }
  Surroundings here{.environment = environment};
  environment->describe(environment->map, site.cell, here);
  for (int i = 0; i < here.facet_count; ++i) {
    const Direction direction = here.facets[static_cast<std::size_t>(i)].direction;
    const bool is_face = base::index(direction) < face_count(ws.setup);
    site.is_standing = site.is_standing || !is_face;
    site.touching.set(direction, is_face || site.touching.has(direction));
  }
}

Report stage_report(const Workspace& ws, const Order& order) {
  const base::Cell& cell = ws.tree.cell();
  if (order.operation == Operation::kWord) {
    StageSite site{.cell = cell, .used = ws.links.used(), .is_fixed = ws.is_fixed};
    note_touching(ws, site);
    return ws.stages()->report(order.index, site);
  }
  const Faces working = ws.links.working();
  const bool is_changed = (ws.links.hidden() & working) != (ws.stages()->hidden(cell) & working);
  return {.flags = is_changed ? kNewLinks : std::uint8_t{0}, .count = 1};
}

/// What touches the planned module just learned, and the next announced cell after it; or a plan
/// that has ended: it is withdrawn, or this module sits in its cell.
Report plan_report(const Workspace& ws, const Announcements& announcements, const Order& order) {
  Report report;
  const bool has_last = order.operation == Operation::kPlan && order.index != kNoPlanned;
  if (ws.stage() == Stage::kRelease || ws.stage() == Stage::kShift) {
    return report;
  }
  if (has_last && order.index < ws.planned.count()) {
    report.mask = ws.planned.own_touching(order.index).mask();
  }
  if (has_last && order.cell == ws.tree.cell()) {
    merge(Operation::kPlan, report, {.flags = kEnded | kFulfilled, .cell = order.cell});
  }
  for (int i = 0; i < announcements.count(); ++i) {
    merge(Operation::kPlan, report, announcement_report(order, has_last, announcements, i));
  }
  if constexpr (kKeepsAnswers) {
    Report planned{.flags = kFound};
    if (ws.stage() == Stage::kConnect &&
        ws.stages()->find_planned(has_last, order.cell, planned.cell)) {
      merge(Operation::kPlan, report, planned);
    }
    report.flags = static_cast<std::uint8_t>(report.flags | (is_step_told(ws) ? kStepTold : 0U));
  }
  return report;
}

/// The root knows by itself that many planned modules are emulated.
Report hosts_report(const Workspace& ws) {
  PlannedSet hosted;
  const bool is_said = !kIsGeneral || ws.planned.count() <= kPlannedMax;
  for (int i = 0; is_said && i < ws.planned.hosted_count(); ++i) {
    hosted.add(ws.planned.hosted(i));
  }
  Report report;
  report.mask =
      static_cast<std::uint8_t>(hosted.bits() | (ws.planned.is_any_remote() ? kAnyRemote : 0U));
  return report;
}

Report angles_report(const Workspace& ws, const Order& order) {
  const FeetCheck check(ws.setup, order.mass, order.moment);
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    if (ws.node(i).is_ground) {
      const base::Cell away = floor_place(ws, i);
      report.feet = check.merge(report.feet, check.of_foot(away.x, away.y));
    }
  }
  return report;
}

/// Masses in half units: half way between two cells first moments are whole numbers, too. In a
/// plane of supports no length is one.
void weigh_in_stage(const Workspace& ws, int node, const base::Cell& away, Report& report) {
  const bool is_gone = node == 0 && ws.is_gone(ws.tree.cell());
  const HungMass hung = node == 0 ? ws.stages()->hung_mass(ws.tree.cell(), ws.setup) : HungMass{};
  const std::uint32_t parts = is_gone ? 0 : ws.setup.has_plane ? 1 : 2;
  const std::array<std::int32_t, 3> place = {away.x, away.y, away.z};
  report.number = parts * report.number + static_cast<std::uint32_t>(hung.mass);
  for (std::size_t k = 0; k < report.moment.size(); ++k) {
    report.moment[k] = std::int64_t{parts} * report.moment[k] + std::int64_t{hung.mass} * place[k] +
                       hung.moment[k];
  }
}

/// Does the node alone keep the robot from toppling?
bool is_held(const Node& node) {
  const Surroundings* surroundings = surroundings_of(node);
  return node.is_fixed || (surroundings != nullptr && is_any_bonded(*surroundings));
}

Report corners_report(const Workspace& ws) {
  Report report;
  for (int i = 0; i < ws.node_count(); ++i) {
    const Node& node = ws.node(i);
    Report own;
    if (node.is_fixed) {
      own.corners = mechanics::fixed_support();
    } else if (node.is_ground) {
      const Surroundings* surroundings = surroundings_of(node);
      own.corners = surroundings != nullptr
                        ? support_corners(*surroundings, ws.contact, node.u, ws.cell_of(i))
                        : mechanics::support_corners(ws.cell_of(i), node.state);
    }
    add_report(ws.setup, {.operation = Operation::kCorners}, report, own);
  }
  return report;
}

/// The worst connection here; notes this module's own.
Report loads_report(Workspace& ws) {
  ws.own_load_ratio = 0;
  Report report;
  report.reals[0] = kNoLoadRatio;
  report.number = static_cast<std::uint32_t>(ws.node_count());
  visit_loads(ws, [&](const base::Cell& cell, Direction direction, double ratio) {
    const auto value = static_cast<float>(ratio);
    Report own;
    own.reals[0] = value;
    own.cell = cell;
    own.direction = direction;
    own.count = mechanics::breaks(ratio) ? 1 : 0;
    own.remarks = remarks_on(ws, cell, direction, ratio);
    merge(Operation::kLoads, report, own);
    if (cell == ws.tree.cell()) {
      ws.own_load_ratio = larger(ws.own_load_ratio, value);
    }
  });
  for (int i = 0; ws.setup.has_friction && i < ws.node_count(); ++i) {
    report.remarks |= may_slip(ws.node(i), ws.contact) ? kFacetSlips : std::uint8_t{0};
  }
  return report;
}

}  // namespace

void prepare_node(Workspace& ws, int index) {
  Node& node = ws.node(index);
  node.is_fixed = index == 0 && ws.is_fixed;
  node.is_ground = !node.is_fixed && ws.cell_of(index).z == ws.setup.support_z;
  if (const Environment* environment = ws.environment(); environment != nullptr) {
    Surroundings& surroundings = ws.lent->surroundings[index];
    const bool is_kept = index == 0 && node.surroundings == &surroundings;
    const Surroundings before = is_kept ? surroundings : Surroundings{};
    surroundings = {.environment = environment};
    environment->describe(environment->map, ws.cell_of(index), surroundings);
    if (is_kept && before.facet_count == surroundings.facet_count) {
      surroundings.facets = before.facets;  // Nothing but the states may be others.
    }
    const bool is_gone = index == 0 && ws.is_gone(ws.tree.cell());
    if (is_gone) {
      surroundings.load = {};  // The map may know nothing of it any more.
      surroundings.mass = 0;
    }
    surroundings.facet_count =
        node.is_fixed || is_gone ? std::uint8_t{0} : surroundings.facet_count;
    node.is_ground = surroundings.facet_count > 0;
    node.surroundings = &surroundings;
  }
  if (index == 0 && ws.stage() != Stage::kNone) {
    node.is_ground = node.is_ground && !ws.is_gone(ws.tree.cell());
    ws.stages()->hang(ws.tree.cell(), ws.setup);
  }
}

base::Vec6<double> stiff_motion(const Workspace& ws, base::Vec6<double> u, const base::Cell& cell) {
  const base::Cell& own = ws.tree.cell();
  const double pitch = ws.setup.section.length;
  double x = pitch * (cell.x - own.x);
  double y = pitch * (cell.y - own.y);
  double z = pitch * (cell.z - own.z);
  if (!ws.setup.is_cubic()) {
    const auto from = base::node_place(ws.setup.lattice, own);
    const auto to = base::node_place(ws.setup.lattice, cell);
    x = pitch * (to[0] - from[0]);
    y = pitch * (to[1] - from[1]);
    z = pitch * (to[2] - from[2]);
  }
  u[0] += u[4] * z - u[5] * y;
  u[1] += u[5] * x - u[3] * z;
  u[2] += u[3] * y - u[4] * x;
  return u;
}

void resume_survey(Workspace& ws, Announcements& announcements, const Order& order) {
  announcements.settle();
  ws.planned.decide_hosts(masks_of_resume(order.masks, face_count(ws.setup)));
  prepare_nodes(ws);
  for (int i = 1; i < ws.node_count(); ++i) {
    reset(ws.node(i));
    if ((order.flags & kKeepsMotion) != 0) {
      ws.node(i).u = stiff_motion(ws, ws.node(0).u, ws.cell_of(i));
    }
  }
}

void report_last(Workspace& ws, Report& report) {
  const Report worst = loads_report(ws);
  report.reals[1] = worst.reals[0];
  report.cell = worst.cell;
  report.direction = worst.direction;
  report.remarks = worst.remarks;
  report.corners = corners_report(ws).corners;
}

Report resume_report(const Workspace& ws, const Order& order) {
  Report report = (order.flags & kRests) != 0 ? angles_report(ws, order) : Report{};
  report.mask = hosts_report(ws).mask;
  if (kKeepsAnswers && order.operation == Operation::kResumeDeflated) {
    report_along(ws, report);
  }
  return report;
}

void begin_survey(Workspace& ws, Announcements& announcements, const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
      if (order.index == kNoPlanned) {
        ws.planned.clear();
      } else {
        ws.planned.add(order.cell, touching_cell(ws));
      }
      break;
    case Operation::kForget:
      ws.planned.clear();
      if (order.cell == kEveryCell && ws.stages() != nullptr) {
        ws.stages()->forget_told(true);
      }
      announcements.forget(order.cell, (order.flags & kIsFulfilled) != 0);
      break;
    case Operation::kHosts:
      announcements.settle();
      ws.planned.decide_hosts(order.masks, order.index);
      prepare_nodes(ws);
      break;
    case Operation::kMass:
      ws.tree.set_root_cell(order.cell);
      break;
    case Operation::kRenew:
      if (kKeepsAnswers) {
        renew(ws, announcements, order);
      }
      break;
    case Operation::kWord:
    case Operation::kStage:
      if (kKeepsAnswers) {
        take_stage_order(ws, order);
      }
      break;
    case Operation::kVerdict:
      if (order.answer.reason == Reason::kPlannedTooMany ||
          order.answer.reason == Reason::kPlanDisputed) {
        announcements.settle();
      }
      break;
    default:
      break;
  }
}

Report survey_report(Workspace& ws, const Announcements& announcements, const Order& order) {
  switch (order.operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return plan_report(ws, announcements, order);
    case Operation::kHosts:
      return hosts_report(ws);
    case Operation::kMass:
      return mass_report(ws);
    case Operation::kRenew:
      return kKeepsAnswers ? renewal_report(ws, announcements, order) : Report{};
    case Operation::kWord:
    case Operation::kStage:
      return kKeepsAnswers ? stage_report(ws, order) : Report{};
    case Operation::kAngles:
      return angles_report(ws, order);
    case Operation::kCorners:
      return corners_report(ws);
    case Operation::kLoads:
      return loads_report(ws);
    case Operation::kBend:
      return kIsGeneral ? bending_report(ws) : Report{};
    case Operation::kClose: {
      if constexpr (!kKeepsAnswers) {
        return {};
      }
      Report report = loads_report(ws);
      report.corners = corners_report(ws).corners;
      return report;
    }
    default:
      return {.count = 1};
  }
}

Report mass_report(const Workspace& ws) {
  Report report;
  const Environment* environment = ws.environment();
  for (int i = 0; i < ws.node_count(); ++i) {
    const base::Cell apart = from_root(ws, i);
    const base::Cell away = floor_place(ws, i);
    const auto size = [](std::int32_t value) { return value < 0 ? -value : value; };
    // Where layers are shifted cells are up to half a pitch further away than they count.
    const std::int32_t extent =
        size(apart.x) + size(apart.y) + size(apart.z) + (ws.setup.is_cubic() ? 0 : 1);
    Report own{.flags = is_held(ws.node(i)) ? kAnyFixed : std::uint8_t{0},
               .extent = static_cast<std::uint16_t>(extent < 0xffff ? extent : 0xffff),
               .count = 1,
               .number = 1,
               .moment = {away.x, away.y, away.z}};
    if (environment != nullptr) {
      const std::int32_t mass = surroundings_of(ws.node(i))->mass;
      own.number = static_cast<std::uint32_t>(mass);
      for (std::size_t k = 0; k < own.moment.size(); ++k) {
        own.moment[k] = mass * own.moment[k] + (k < 2 ? surroundings_of(ws.node(i))->moment[k] : 0);
      }
      const bool is_known = is_number(surroundings_of(ws.node(i))->load[0]);
      own.flags = static_cast<std::uint8_t>(own.flags | (environment->is_level ? 0U : kUneven) |
                                            (is_known ? 0U : kSumOverflow));
    }
    if (ws.stage() != Stage::kNone) {
      weigh_in_stage(ws, i, away, own);
    }
    merge(Operation::kMass, report, own);
  }
  return report;
}

void add_report(const Setup& setup, const Order& order, Report& into, const Report& theirs) {
  const bool is_resumed = is_resume(order.operation) && (order.flags & kRests) != 0;
  if (is_resumed || order.operation == Operation::kAngles) {
    const FeetCheck check(setup, order.mass, order.moment);
    into.feet = check.merge(into.feet, theirs.feet);
  }
  const bool has_corners = order.operation == Operation::kCorners ||
                           order.operation == Operation::kClose ||
                           (kKeepsAnswers && order.operation == Operation::kIterateLast);
  if (has_corners && !setup.is_cubic()) {
    const auto corners = mechanics::merge_rounded(into.corners, theirs.corners);
    merge(order.operation, into, theirs);
    into.corners = corners;
  } else if (order.operation != Operation::kAngles) {
    merge(order.operation, into, theirs);
  }
}

}  // namespace holdfast::agent
