// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// 100 structures of four lattices with floors, walls, ceilings, steps, slopes, masses and payloads
// against numbers that were computed independently of this project (tests/reference/README.md).
#include <gtest/gtest.h>

#include <algorithm>
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
using Ends = std::pair<base::Cell, base::Cell>;

std::vector<Json> read_cases() {
  std::ifstream file(HOLDFAST_GENERAL_FILE);
  std::vector<Json> cases;
  for (std::string line; std::getline(file, line);) {
    cases.push_back(Json::parse(line));
  }
  return cases;
}

base::Cell cell(const Json& json) {
  return {json[0].get<std::int32_t>(), json[1].get<std::int32_t>(), json[2].get<std::int32_t>()};
}

/// The numbers of a connection in the order of ConnectionResult; torsion without its sign, which
/// depends on which module comes first.
std::array<double, 5> numbers(const verdict::ConnectionResult& result) {
  return {result.load_ratio, result.axial_n, result.bending_nmm, result.shear_n,
          std::abs(result.torsion_nmm)};
}

verdict::ConnectionResult result_of(const Json& json) {
  return {.load_ratio = json["load_ratio"].get<double>(),
          .axial_n = json["axial_n"].get<double>(),
          .bending_nmm = json["bending_nmm"].get<double>(),
          .shear_n = json["shear_n"].get<double>(),
          .torsion_nmm = json["torsion_nmm"].get<double>()};
}

std::map<Ends, verdict::ConnectionResult> loads_of(const model::Robot& robot,
                                                   const verdict::Assessment& assessment) {
  std::map<Ends, verdict::ConnectionResult> loads;
  for (std::size_t i = 0; i < assessment.connections.size(); ++i) {
    const auto [a, b] = model::ends(robot, i);
    loads[std::minmax(a, b)] = assessment.connections[i];
  }
  return loads;
}

/// The loads agree within 1e-6 of the structure's largest, or of what is rounding in every
/// structure.
void expect_same_loads(const Json& expected, const model::Robot& robot,
                       const verdict::Assessment& assessment) {
  const auto found = loads_of(robot, assessment);
  ASSERT_EQ(found.size(), expected["connections"].size());
  std::array<double, 5> size = {1e-6, 1e-6, 1e-6, 1e-6, 1e-6};
  std::array<double, 5> difference{};
  for (const Json& json : expected["connections"]) {
    const auto place = found.find(std::minmax(cell(json["a"]), cell(json["b"])));
    ASSERT_NE(place, found.end());
    const auto here = numbers(place->second);
    const auto there = numbers(result_of(json));
    for (std::size_t k = 0; k < size.size(); ++k) {
      size[k] = std::max(size[k], std::abs(there[k]));
      difference[k] = std::max(difference[k], std::abs(here[k] - there[k]));
    }
  }
  for (std::size_t k = 0; k < size.size(); ++k) {
    EXPECT_LE(difference[k], 1e-6 * size[k]) << "number " << k;
  }
}

TEST(General, has_all_structures) { EXPECT_EQ(read_cases().size(), 100U); }

TEST(General, loads_stability_and_rigid_answers_agree) {
  int without_settled_law_count = 0;
  int case_count = 0;
  for (const Json& json : read_cases()) {
    const Json& expected = json["expected"];
    if (++case_count % test::every(8) > 0 && expected["settled"].get<bool>()) {
      continue;
    }
    SCOPED_TRACE(json["structure"]["name"].get<std::string>());
    const auto structure = load_text(json["structure"].dump());
    ASSERT_TRUE(structure) << structure.error().message;
    const model::Robot& robot = structure.value().robot;
    const verdict::Assessment assessment = verdict::assess(robot);

    EXPECT_EQ(assessment.rigid.holds(), expected["holds_no_slip"].get<bool>());
    EXPECT_NE(assessment.verdict, verdict::Verdict::kUndecided);
    if (!expected["settled"].get<bool>()) {
      // The paper's law has no answer; the exact one has.
      EXPECT_EQ(assessment.contact_model, verdict::ContactModel::kUnilateral);
      ++without_settled_law_count;
      continue;
    }
    EXPECT_NE(assessment.contact_model, verdict::ContactModel::kUnilateral);
    EXPECT_EQ(assessment.model.is_stable, expected["stable"].get<bool>());
    EXPECT_EQ(assessment.verdict == verdict::Verdict::kUnstable,
              !expected["stable"].get<bool>() || !expected["holds_no_slip"].get<bool>());
    expect_same_loads(expected, robot, assessment);
  }
  EXPECT_EQ(without_settled_law_count, 5);
}

}  // namespace
}  // namespace holdfast
