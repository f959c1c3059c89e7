// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The series of a column that buckles: its files are there, the loads grow in them, and verdicts
// are those of each equilibrium alone.
#include "holdfast/deformed_series.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace holdfast {
namespace {

constexpr const char* kColumn = R"({"format": "holdfast-structure", "version": 1, "support_z": -1,
    "material": {"elastic_modulus_mpa": 0.12},
    "modules": [{"cell": [0, 0, 0], "fixed": true}, [0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4],
                [0, 0, 5]]})";

std::string text_in(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in) << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The number behind a field's head, at whose end there is a line feed.
double field(const std::string& text, const std::string& name) {
  const std::size_t head = text.find("Name=\"" + name + "\"");
  return head == std::string::npos ? -1 : std::stod(text.substr(text.find('\n', head) + 1, 40));
}

TEST(DeformedSeries, has_a_file_for_each_level_of_the_loads) {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "holdfast_deformed_series_test";
  std::filesystem::create_directories(folder);
  const auto structure = load_text(kColumn);
  ASSERT_TRUE(structure);
  CheckOptions options{.thread_count = 1, .is_deformed_wanted = true, .is_followed_behind = true};
  DeformedSeries series(folder / "path.pvd", structure.value(), options);
  options.on_deformed_state = series.writer();
  const CheckResult result = check(structure.value(), options);
  ASSERT_FALSE(series.finish());
  const std::string index = text_in(folder / "path.pvd");
  double before = 0;
  std::size_t count = 0;
  for (; index.find("path_" + std::to_string(count) + ".vtu") != std::string::npos; ++count) {
    const std::string text =
        text_in(folder / ("path_" + std::to_string(count) + ".vtu")).substr(0, 3000);
    const double factor = field(text, "load_factor");
    if (factor <= result.deformed->critical->factor && before < 2) {
      EXPECT_GT(factor, before);
    }
    // The word as character codes: safe, or where it leans much a connection breaks, overload.
    const bool breaks = field(text, "load_ratio_max") >= 1;
    EXPECT_NE(text.find(breaks ? "\n111 118 101" : "\n115 97 102 101"), std::string::npos);
    before = factor;
  }
  EXPECT_GE(count, 30U);
  EXPECT_LT(count, result.deformed->points.size() + result.deformed->behind[0].points.size() +
                       result.deformed->behind[1].points.size());
  EXPECT_NEAR(before, 2, 1e-3);
  std::filesystem::remove_all(folder);
}

TEST(DeformedSeries, says_that_there_is_nothing_to_write) {
  const auto structure = load_text(R"({"format": "holdfast-structure", "version": 1,
      "modules": [[0, 0, 0], [0, 0, 1], [1, 0, 1], [2, 0, 1]]})");
  ASSERT_TRUE(structure);
  CheckOptions options{.thread_count = 1, .is_deformed_wanted = true};
  DeformedSeries series("none.pvd", structure.value(), options);
  options.on_deformed_state = series.writer();
  EXPECT_FALSE(check(structure.value(), options).deformed);
  const auto error = series.finish();
  ASSERT_TRUE(error);
  EXPECT_NE(error->message.find("no equilibrium"), std::string::npos);
  DeformedSeries bad("a\nb.pvd", structure.value(), options);
  EXPECT_TRUE(bad.finish());
}

/// Held by feet that stick, (1,0,0)-(2,0,0) would break; one foot slips before, and it holds. With
/// a floor that holds more than feet push, both say the same.
TEST(Deformed, does_not_call_an_overload_what_holds_where_feet_slip) {
  const auto judge = [](const std::string& friction, bool is_deformed) {
    const auto structure = load_text(
        R"({"format": "holdfast-structure", "version": 2, "floor": {"friction": )" + friction +
        R"(}, "material": {"pitch_mm": [25, 25, 11], "elastic_modulus_mpa": 1e5},
            "modules": [[0,0,0], [0,0,1], [0,0,2], [1,0,0], [1,0,1], [2,0,0], [2,0,1], [3,0,1],
                        [4,0,1], [5,0,1]],
            "open": [[[1,0,1], [2,0,1]], [[1,0,0], [1,0,1]]],
            "connections": [{"between": [[1,0,0], [2,0,0]], "strength_n": 4.72}]})");
    EXPECT_TRUE(structure);
    return check(structure.value(), {.thread_count = 1, .is_deformed_wanted = is_deformed})
        .assessment;
  };
  EXPECT_EQ(judge("0.3", false).verdict, verdict::Verdict::kSafe);
  const verdict::Assessment slips = judge("0.3", true);
  EXPECT_EQ(slips.verdict, verdict::Verdict::kUndecided);
  EXPECT_EQ(slips.reasons.front().code, verdict::ReasonCode::kMaySlip);
  EXPECT_EQ(judge("9", false).verdict, verdict::Verdict::kOverload);
  EXPECT_EQ(judge("9", true).verdict, verdict::Verdict::kOverload);
}

}  // namespace
}  // namespace holdfast
