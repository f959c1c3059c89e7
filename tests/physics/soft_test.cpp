// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Equilibria in the deformed shape of structures whose answers an independent program has found
// (tests/reference/README.md). Tolerances are what that program's own two runs agree to.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "holdfast/holdfast.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using Json = nlohmann::json;

constexpr double kCriticalTolerance = 2e-4;
constexpr double kEventTolerance = 1e-4;
constexpr double kStateTolerance = 1e-5;

base::Cell cell_of(const Json& json) {
  return {json[0].get<int>(), json[1].get<int>(), json[2].get<int>()};
}

std::array<int, 3> key_of(const base::Cell& cell) { return {cell.x, cell.y, cell.z}; }

void expect_critical(const Json& expected, const large::Path& path) {
  ASSERT_EQ(path.critical.has_value(), !expected.is_null());
  if (path.critical) {
    const double factor = expected["factor"].get<double>();
    EXPECT_NEAR(path.critical->factor, factor, kCriticalTolerance * factor);
    EXPECT_EQ(large::name(path.critical->loss), expected["kind"].get<std::string>());
  }
}

void expect_events(const Json& expected, const large::Path& path) {
  for (const large::Event& event : path.events) {
    if (event.kind == large::EventKind::kTouchesItself) {
      continue;  // Not in the references.
    }
    const std::string name = large::name(event.kind);
    ASSERT_TRUE(expected.contains(name)) << name << " at " << event.factor;
    const double factor = expected[name].get<double>();
    EXPECT_NEAR(event.factor, factor, kEventTolerance * factor) << name;
  }
  const auto count = std::ranges::count_if(path.events, [](const large::Event& event) {
    return event.kind != large::EventKind::kTouchesItself;
  });
  EXPECT_EQ(static_cast<std::size_t>(count), expected.size());
}

void expect_state(const Json& expected, const model::Robot& robot, const large::Path& path) {
  ASSERT_EQ(path.loaded.has_value(), !expected.is_null());
  if (!path.loaded) {
    return;
  }
  const large::State& state = *path.loaded;
  const double largest = expected["displacement_max_mm"].get<double>();
  EXPECT_NEAR(state.displacement_max_mm, largest, kStateTolerance * largest);
  EXPECT_NEAR(state.rotation_max_rad, expected["rotation_max_rad"].get<double>(), kStateTolerance);
  EXPECT_NEAR(state.edge_strain_max, expected["edge_strain_max"].get<double>(), kStateTolerance);
  EXPECT_NEAR(state.load_ratio_max, expected["load_ratio_max"].get<double>(), kStateTolerance);
  std::map<std::array<int, 3>, Json> displacement;
  for (const Json& one : expected["displacements_mm"]) {
    displacement[key_of(cell_of(one[0]))] = one[1];
  }
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const Json& u = displacement.at(key_of(robot.modules()[i].cell));
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(state.poses[i].displacement[k], u[k].get<double>(), kStateTolerance * largest);
    }
  }
  std::map<std::array<std::array<int, 3>, 2>, double> ratio;
  for (const Json& one : expected["load_ratios"]) {
    std::array ends = {key_of(cell_of(one[0])), key_of(cell_of(one[1]))};
    std::ranges::sort(ends);
    ratio[ends] = one[2].get<double>();
  }
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    const auto [a, b] = model::ends(robot, i);
    std::array ends = {key_of(a), key_of(b)};
    std::ranges::sort(ends);
    EXPECT_NEAR(state.load_ratio[i], ratio.at(ends), kStateTolerance);
  }
}

TEST(SoftReferences, have_the_answers_of_an_independent_program) {
  std::ifstream file(HOLDFAST_SOFT_FILE);
  int count = 0;
  for (std::string line; std::getline(file, line);) {
    const Json json = Json::parse(line);
    const Json& expected = json["expected"];
    if (!expected.contains("critical") || count++ % test::every(4) > 0) {
      continue;
    }
    const auto structure = load_text(json["structure"].dump());
    ASSERT_TRUE(structure) << structure.error().message;
    SCOPED_TRACE(structure.value().name);
    const CheckResult result = check(structure.value(), {.is_deformed_wanted = true});
    EXPECT_EQ(verdict::name(result.assessment.verdict), expected["verdict"].get<std::string>());
    const verdict::ReasonCode code = result.assessment.reasons.front().code;
    if (code != verdict::ReasonCode::kNoTension) {  // Which is a word of its own for "holds".
      EXPECT_EQ(verdict::name(code), expected["reason"].get<std::string>());
    }
    ASSERT_TRUE(result.deformed);
    expect_critical(expected["critical"], *result.deformed);
    expect_events(expected["events"], *result.deformed);
    expect_state(expected["at_weight"], structure.value().robot, *result.deformed);
  }
  EXPECT_EQ(count, 39);
}

}  // namespace
}  // namespace holdfast
