// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// Random robots of any lattice with supports anywhere: campaigns behind docs/.
//   general_bench invariants LATTICE FIRST COUNT   what must hold of every answer; exit 1 if not
//   general_bench limits LATTICE FIRST COUNT       elastic, brittle and limit factor of each, as
//   CSV general_bench supports LATTICE FIRST COUNT     model and rigid answer of each, as CSV
// LATTICE: cubic, face-centred, hexagonal, hexagonal-prism; limits also of floor, which are cubes
// on a floor as random_robot() grows them. FIRST is the first of COUNT seeds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "general_checks.hpp"
#include "hard_robot.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/limit/robot.hpp"
#include "random_robot.hpp"

namespace {

using namespace holdfast;
using verdict::Assessment;

// ---- Invariants

struct Tally {
  int compared_count = 0;
  int fault_count = 0;
};

void look_at(const base::Lattice& lattice, const std::vector<test::Symmetry>& turns,
             std::uint64_t seed, bool is_hard, std::map<std::string, Tally>& tallies) {
  const model::RobotSpec spec =
      is_hard ? test::hard_robot(lattice, seed) : test::general_robot(lattice, seed);
  const std::string what = is_hard ? test::name(test::hardness_of(seed)) : "general";
  const auto note = [&](const char* check, const test::Checked& checked, int turn = 0) {
    Tally& tally = tallies[fmt::format("{:12} {}", what, check)];
    tally.compared_count += checked.is_compared ? 1 : 0;
    if (!checked.fault.empty()) {
      ++tally.fault_count;
      fmt::print("{}_robot {} ({}): {}{}: {}\n", is_hard ? "hard" : "general", seed, what, check,
                 turn == 0 ? "" : fmt::format(" by {}", turn), checked.fault);
    }
  };
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    note("is a robot", {.fault = robot.error().message});
    return;
  }
  note("answer", test::check_answer(robot.value(), verdict::assess(robot.value())));
  note("doubling", test::check_doubling(spec));
  note("limit", test::check_limit(spec));
  // As many tries as find a symmetry for most robots.
  for (std::size_t i = 0; i < turns.size() - 1; ++i) {
    const std::size_t turn = 1 + (seed + i) % (turns.size() - 1);
    if (test::may_be_turned(spec, turns[turn])) {
      note("turned", test::check_turning(spec, turns[turn]), static_cast<int>(turn));
      break;
    }
  }
  if (lattice == base::kCubic) {
    note("floor", test::check_floor(spec));
    note("versions", test::check_versions(spec));
  }
}

int check_invariants(const base::Lattice& lattice, std::uint64_t first, std::uint64_t count) {
  const auto turns = test::symmetries(lattice);
  std::map<std::string, Tally> tallies;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    look_at(lattice, turns, seed, false, tallies);
    look_at(lattice, turns, seed, true, tallies);
  }
  int fault_count = 0;
  for (const auto& [name, tally] : tallies) {
    fmt::print("{:22} {:6} compared, {} faults\n", name, tally.compared_count, tally.fault_count);
    fault_count += tally.fault_count;
  }
  return fault_count == 0 ? 0 : 1;
}

// ---- Elastic, brittle and limit load

/// Lets loads grow and connections break for good: the connections at the largest load ratio are
/// released, all or one at a time, and the rest is solved again.
struct Breaking {
  double first = 0;    ///< Factor of all loads at which the first breaks.
  double highest = 0;  ///< The highest factor that any stage on the way bears.
  int stage_count = 0;
};

/// The largest load ratio by every solution that the verdict heeds. Where facets are open, and by
/// the paper's law pull by their weak springs, that is the exact law's as well.
double ratio_heeded(const Assessment& assessment) {
  double ratio = *assessment.load_ratio_max;
  if (assessment.several) {
    ratio = std::max(ratio, assessment.several->regularised.high);
    if (assessment.several->unilateral) {
      ratio = std::max(ratio, assessment.several->unilateral->high);
    }
  }
  return ratio;
}

constexpr double kNoLoad = 1e-6;  ///< Load ratios below are none: the rest holds any load.
constexpr double kTie = 1e-9;

Breaking break_all(model::RobotSpec spec, bool is_one_by_one) {
  Breaking breaking;
  while (const auto robot = model::Robot::create(spec)) {
    const Assessment assessment = verdict::assess(robot.value());
    if (!test::has_loads(assessment) || !assessment.load_ratio_max) {
      break;  // Falls, or nothing is known of its loads.
    }
    const double ratio = *assessment.load_ratio_max;
    const double heeded = ratio_heeded(assessment);
    const double factor = heeded < kNoLoad ? limit::kFactorMax : 1 / heeded;
    breaking.first = breaking.stage_count == 0 ? factor : breaking.first;
    breaking.highest = std::max(breaking.highest, factor);
    ++breaking.stage_count;
    if (ratio < kNoLoad) {
      break;
    }
    for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
      if (assessment.connections[i].load_ratio >= ratio * (1 - kTie)) {
        spec.released.push_back(model::ends(robot.value(), i));
        if (is_one_by_one) {
          break;
        }
      }
    }
  }
  return breaking;
}

/// Magnets that hold by pressing: the coefficient of plastic on plastic, and the mean lever of a
/// square that presses evenly, 0.3826 of its width.
void take_friction(model::RobotSpec& spec) {
  model::ModuleKind kind = model::default_kind(spec.material, spec.lattice);
  for (model::ConnectorLaw& law : kind.connectors) {
    law.friction = 0.5;
    law.torsion_radius_mm = 0.3826 * spec.material.pitch_mm;
  }
  spec.kinds = {kind};
}

void print_limits(const model::RobotSpec& spec, std::string_view name, std::uint64_t seed,
                  const char* law) {
  const auto robot = model::Robot::create(spec);
  if (!robot) {
    return;
  }
  const Assessment assessment = verdict::assess(robot.value());
  if (!test::has_loads(assessment) || !assessment.load_ratio_max ||
      assessment.load_ratio_max < kNoLoad) {
    return;
  }
  const limit::Structure structure = limit::structure_of(robot.value());
  const auto known =
      limit::known_forces(robot.value(), structure, assessment.equilibrium.displacement,
                          assessment.equilibrium.facet_force);
  const limit::LimitLoad load = limit::limit_load(structure, {.known_forces = known});
  const Breaking all = break_all(spec, false);
  const Breaking one = break_all(spec, true);
  fmt::print("{},{},{},{},{},{:.9g},{:.9g},{:.9g},{},{:.9g},{},{:.9g},{}\n", name, seed, law,
             robot.value().modules().size(), robot.value().connections().size(), all.first,
             load.low, load.high, limit::name(load.outcome), all.highest, all.stage_count,
             one.highest, one.stage_count);
}

int print_limits(std::string_view name, const base::Lattice& lattice, std::uint64_t first,
                 std::uint64_t count) {
  fmt::print(
      "lattice,seed,law,modules,connections,elastic,limit_low,limit_high,outcome,"
      "brittle_all,stages_all,brittle_one,stages_one\n");
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    model::RobotSpec spec =
        name == "floor" ? test::random_robot(seed) : test::general_robot(lattice, seed);
    print_limits(spec, name, seed, "opens");
    take_friction(spec);
    print_limits(spec, name, seed, "friction");
  }
  return 0;
}

// ---- Model and rigid answer

int print_supports(std::string_view name, const base::Lattice& lattice, std::uint64_t first,
                   std::uint64_t count) {
  fmt::print(
      "lattice,seed,modules,facets,rigid,friction_needed,regularised,law,model,open_held,"
      "verdict,reason\n");
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    model::RobotSpec spec = test::general_robot(lattice, seed);
    if (spec.obstacles.empty()) {
      continue;
    }
    spec.fixed.clear();
    for (model::Obstacle& obstacle : spec.obstacles) {
      obstacle.touch = {};
    }
    const auto robot = model::Robot::create(spec);
    const Assessment a = verdict::assess(robot.value());
    const auto& attempts = a.equilibrium.attempts;
    const bool is_regularised = !attempts.empty() &&
                                attempts[0].law == mechanics::ContactLaw::kRegularised &&
                                attempts[0].outcome == solver::Outcome::kSettled;
    fmt::print("{},{},{},{},{},{:.6g},{},{},{},{},{},{}\n", name, seed,
               robot.value().modules().size(), robot.value().facets().size(),
               limit::name(a.rigid.answer), a.rigid.friction_needed.value_or(NAN),
               is_regularised ? "settled" : "not settled", verdict::name(a.contact_model),
               !a.model.is_settled ? "not settled" : (a.model.is_stable ? "stable" : "falls"),
               a.equilibrium.open_but_held_count, verdict::name(a.verdict),
               verdict::name(a.reasons.front().code));
  }
  return 0;
}

int misused() {
  fmt::print(stderr, "general_bench: see the first lines of bench/general_bench.cpp\n");
  return 64;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    return misused();
  }
  const std::string_view what = argv[1];
  const std::string_view name = argv[2];
  const auto lattice = io::find_lattice(name == "floor" ? "cubic" : name);
  const std::uint64_t first = std::strtoull(argv[3], nullptr, 10);
  const std::uint64_t count = std::strtoull(argv[4], nullptr, 10);
  if (!lattice) {
    return misused();
  }
  if (what == "invariants") {
    return check_invariants(lattice.value(), first, count);
  }
  if (what == "limits") {
    return print_limits(name, lattice.value(), first, count);
  }
  return what == "supports" ? print_supports(name, lattice.value(), first, count) : misused();
}
