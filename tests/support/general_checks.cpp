// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "general_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "holdfast/holdfast.hpp"

namespace holdfast::test {
namespace {

using base::Vec6;
using verdict::Assessment;
using verdict::Verdict;

double largest(const std::vector<Vec6<double>>& vectors) {
  double size = 1e-12;
  for (const Vec6<double>& vector : vectors) {
    for (const double component : vector) {
      size = std::max(size, std::abs(component));
    }
  }
  return size;
}

/// The imbalance of loads and supports of the robot as a whole, about the origin, beyond 1e-6 of
/// the forces; for moments 100 times that, as arms are some 100 mm long.
std::string imbalance(const model::Robot& robot, const Assessment& assessment) {
  const std::vector<Vec6<double>> forces = solver::ground_forces(robot, assessment.equilibrium);
  Vec6<double> sum{};
  double size = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    auto place = base::node_place(robot.lattice(), robot.modules()[i].cell);
    std::ranges::for_each(place, [&](double& x) { x *= robot.material().pitch_mm; });
    for (const Vec6<double>& f : {robot.loads()[i], forces[i]}) {
      base::add_to(sum, {f[0], f[1], f[2], f[3] + place[1] * f[2] - place[2] * f[1],
                         f[4] + place[2] * f[0] - place[0] * f[2],
                         f[5] + place[0] * f[1] - place[1] * f[0]});
      size += std::hypot(f[0], f[1], f[2]);
    }
  }
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(std::abs(sum[k]) <= 1e-6 * size * (k < 3 ? 1 : 100))) {
      return fmt::format("component {} of all forces adds up to {:.3g}, of {:.3g} N", k, sum[k],
                         size);
    }
  }
  return {};
}

/// Gives all directions one law, which knows no axes.
void take_round_law(model::RobotSpec& spec) {
  model::ModuleKind kind = model::default_kind(spec.material, spec.lattice);
  std::fill(kind.connectors.begin(), kind.connectors.end(),
            model::ConnectorLaw{.strength_n = 12,
                                .lever_mm = spec.material.pitch_mm / 2,
                                .bending = model::BendingLaw::kRound,
                                .friction = 0.4,
                                .torsion_radius_mm = spec.material.pitch_mm / 3});
  spec.kinds = {kind};
  spec.own_kinds.clear();
}

std::string displacement_fault(const Assessment& a, const Assessment& b, const Symmetry& turn) {
  const double size = largest(a.equilibrium.displacement);
  for (std::size_t i = 0; i < a.equilibrium.displacement.size(); ++i) {
    const Vec6<double> expected = turn(a.equilibrium.displacement[i]);
    for (std::size_t k = 0; k < 6; ++k) {
      const double difference = std::abs(b.equilibrium.displacement[i][k] - expected[k]);
      if (!(difference <= 1e-7 * size)) {
        return fmt::format("module {}: component {} differs by {:.3g} of {:.3g}", i, k, difference,
                           size);
      }
    }
  }
  return {};
}

}  // namespace

bool has_loads(const Assessment& assessment) {
  // Where the contact laws are at odds the loads are those of the exact one.
  const bool is_standing = assessment.is_stable ||
                           assessment.reasons.front().code == verdict::ReasonCode::kStatesDisagree;
  return assessment.equilibrium.outcome == solver::Outcome::kSettled && is_standing &&
         assessment.equilibrium.open_but_held_count == 0;
}

Checked check_answer(const model::Robot& robot, const Assessment& assessment) {
  Checked checked;
  if (assessment.reasons.empty()) {
    checked.fault = "no reason";
  } else if (assessment.verdict == Verdict::kSafe &&
             !(assessment.rigid.holds() && assessment.model.is_settled &&
               assessment.model.is_stable)) {
    checked.fault = fmt::format("safe, but rigid: {}, model settled: {}, stable: {}",
                                limit::name(assessment.rigid.answer), assessment.model.is_settled,
                                assessment.model.is_stable);
  } else if (has_loads(assessment) && robot.fixed_count() == 0) {
    checked.is_compared = true;
    checked.fault = imbalance(robot, assessment);
  }
  return checked;
}

Checked check_doubling(const model::RobotSpec& spec) {
  model::RobotSpec other = spec;
  other.gravity_m_s2 =
      spec.gravity_m_s2.value_or(std::array<double, 3>{0, 0, -spec.material.gravity_m_s2});
  const Assessment once = verdict::assess(model::Robot::create(other).value());
  std::ranges::for_each(*other.gravity_m_s2, [](double& g) { g *= 2; });
  for (model::Payload& payload : other.payloads) {
    std::ranges::for_each(payload.force_n, [](double& f) { f *= 2; });
    std::ranges::for_each(payload.torque_nmm, [](double& m) { m *= 2; });
  }
  // Or other load ratios would be near 1, where more digits are sought.
  other.material.strength_vertical_n *= 2;
  other.material.strength_lateral_n *= 2;
  Assessment twice = verdict::assess(model::Robot::create(other).value());
  for (Vec6<double>& u : twice.equilibrium.displacement) {
    std::ranges::for_each(u, [](double& component) { component /= 2; });
  }
  Checked checked = {.is_compared = true};
  if (once.verdict != twice.verdict) {
    checked.fault =
        fmt::format("{}, doubled {}", verdict::name(once.verdict), verdict::name(twice.verdict));
  } else if (once.equilibrium.outcome != twice.equilibrium.outcome) {
    checked.fault = "another outcome when doubled";
  } else if (once.equilibrium.contact != twice.equilibrium.contact ||
             once.equilibrium.displacement != twice.equilibrium.displacement ||
             once.load_ratio_max != twice.load_ratio_max) {
    checked.fault = "other displacements, contact states or load ratios when doubled";
  }
  return checked;
}

Checked check_limit(const model::RobotSpec& spec) {
  constexpr double kBeside = 1e-5;
  const Assessment first = verdict::assess(model::Robot::create(spec).value());
  if (!has_loads(first) || !first.load_ratio_max || *first.load_ratio_max < 1e-3) {
    return {};
  }
  Checked checked = {.is_compared = true};
  for (const double share : {1 + kBeside, 1 - kBeside}) {
    model::RobotSpec other = spec;
    other.material.strength_vertical_n *= *first.load_ratio_max * share;
    other.material.strength_lateral_n *= *first.load_ratio_max * share;
    const Verdict found = verdict::assess(model::Robot::create(other).value()).verdict;
    if (found == (share > 1 ? Verdict::kOverload : Verdict::kSafe)) {
      checked.fault =
          fmt::format("{} with {} times the strength that it needs", verdict::name(found), share);
    }
  }
  return checked;
}

bool may_be_turned(const model::RobotSpec& spec, const Symmetry& symmetry) {
  if (spec.support_z && std::abs(symmetry.matrix[2][2] - 1) > 1e-9) {
    return false;
  }
  if (spec.support_z && std::abs(symmetry.matrix[0][0]) > 1e-9 &&
      std::abs(symmetry.matrix[0][1]) > 1e-9) {
    return false;  // A floor's facets are squares along x and y.
  }
  const auto robot = model::Robot::create(spec);
  const bool has_squares =
      robot.value().foot_half_width_mm() > 0 &&
      std::ranges::any_of(robot.value().facets(),
                          [](const model::Facet& facet) { return !facet.is_bonded(); });
  return !has_squares || keeps_frames(spec.lattice, symmetry);
}

Checked check_turning(const model::RobotSpec& spec, const Symmetry& symmetry) {
  model::RobotSpec here = spec;
  take_round_law(here);
  const auto other = model::Robot::create(turned(here, symmetry));
  if (!other) {
    return {.fault = other.error().message};
  }
  const Assessment a = verdict::assess(model::Robot::create(here).value());
  const Assessment b = verdict::assess(other.value());
  Checked checked;
  if (a.rigid.answer != b.rigid.answer) {
    checked.fault = fmt::format("rigid: {} (margin {:.3g}), turned {} (margin {:.3g})",
                                limit::name(a.rigid.answer), a.rigid.margin.value_or(0),
                                limit::name(b.rigid.answer), b.rigid.margin.value_or(0));
  } else if (a.is_stable != b.is_stable) {
    checked.fault = fmt::format("stable: {}, turned {}", a.is_stable, b.is_stable);
  } else if (has_loads(a) != has_loads(b)) {
    checked.fault = fmt::format("has loads: {}, turned {}", has_loads(a), has_loads(b));
  } else if (has_loads(a)) {
    checked.is_compared = true;
    checked.fault = displacement_fault(a, b, symmetry);
    const double ratio = a.load_ratio_max.value_or(0);
    const double turned_ratio = b.load_ratio_max.value_or(0);
    if (checked.fault.empty() &&
        !(std::abs(ratio - turned_ratio) <= 1e-6 * std::max(1.0, std::abs(ratio)))) {
      checked.fault = fmt::format("load ratio {}, turned {}", ratio, turned_ratio);
    }
  }
  return checked;
}

Checked check_floor(const model::RobotSpec& spec) {
  model::RobotSpec plain = {.existing = spec.existing};
  const auto lowest = std::ranges::min_element(plain.existing, {}, &base::Cell::z)->z;
  plain.support_z = lowest;
  const Assessment floor = verdict::assess(model::Robot::create(plain).value());
  plain.support_z.reset();
  plain.obstacles = {{.from = {-100, -100, lowest - 1}, .to = {100, 100, lowest - 1}}};
  const Assessment obstacle = verdict::assess(model::Robot::create(plain).value());
  Checked checked = {.is_compared = true};
  if (floor.verdict != obstacle.verdict) {
    checked.fault = fmt::format("{}, on obstacles {}", verdict::name(floor.verdict),
                                verdict::name(obstacle.verdict));
  } else if (floor.simplified.margin_mm != obstacle.simplified.margin_mm ||
             floor.load_ratio_max != obstacle.load_ratio_max ||
             floor.equilibrium.displacement != obstacle.equilibrium.displacement) {
    checked.fault = "other margins, load ratios or displacements on obstacles";
  }
  return checked;
}

Checked check_versions(const model::RobotSpec& spec) {
  std::string cells;
  for (const base::Cell& cell : spec.existing) {
    cells += fmt::format("{}[{},{},{}]", cells.empty() ? "" : ",", cell.x, cell.y, cell.z);
  }
  const auto lowest = std::ranges::min_element(spec.existing, {}, &base::Cell::z)->z;
  const auto check_text = [&](const char* head) {
    return check(load_text(fmt::format(R"({{"format": "holdfast-structure", {}, "support_z": {},
        "modules": [{}]}})",
                                       head, lowest, cells))
                     .value());
  };
  const Assessment one = check_text(R"("version": 1)").assessment;
  const Assessment two =
      check_text(R"("version": 2, "lattice": "cubic", "gravity_m_s2": [0, 0, -9.81], "floor": {},
          "material": {"mass_kg": 0.06106, "foot_mm": 40}, "kinds": {}, "obstacles": [],
          "loads": [])")
          .assessment;
  Checked checked = {.is_compared = true};
  if (one.verdict != two.verdict || one.reasons != two.reasons ||
      one.simplified.margin_mm != two.simplified.margin_mm ||
      one.load_ratio_max != two.load_ratio_max ||
      one.equilibrium.displacement != two.equilibrium.displacement) {
    checked.fault = fmt::format("{} of version 1, {} of version 2, or other numbers",
                                verdict::name(one.verdict), verdict::name(two.verdict));
  }
  return checked;
}

}  // namespace holdfast::test
