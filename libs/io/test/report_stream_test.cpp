// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// What is written as a stream is what a tree of the same values would be: nlohmann-json is the
// second method, for layout and for every digit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <sstream>

#include "checked_robot.hpp"
#include "holdfast/io/report.hpp"
#include "random_robot.hpp"

namespace holdfast::io {
namespace {

using Json = nlohmann::ordered_json;

struct Checked : CheckedRobot {
  using CheckedRobot::CheckedRobot;

  ReportEntry entry() const {
    return {.name = "robot", .robot = &robot, .assessment = &assessment, .warnings = {}};
  }

  std::string report(const ReportOptions& options, const MoreKeys& more = {}) const {
    std::ostringstream out;
    write_report_json(out, entry(), options, more);
    return out.str();
  }

  std::string table(const ReportOptions& options = {}) const {
    std::ostringstream out;
    write_connections_csv(out, robot, assessment, options);
    return out.str();
  }
};

model::RobotSpec cube(std::int32_t size) {
  model::RobotSpec spec;
  for (std::int32_t i = 0; i < size * size * size; ++i) {
    spec.existing.push_back({i % size, i / size % size, i / (size * size)});
  }
  return spec;
}

ReportOptions choose(std::string_view text) {
  ReportOptions options;
  options.connections = find_connection_choice(text).value();
  return options;
}

void write_sample(JsonStream& json) {
  json.begin_object();
  json.member("text", "a \"b\"\n\x01 \xff \u00e4");
  json.member("none", nullptr);
  json.key("empty");
  json.begin_object();
  json.end_object();
  json.key("list");
  json.begin_array();
  json.value(true);
  json.value(-7);
  json.value(std::numeric_limits<std::uint64_t>::max());
  json.begin_array();
  json.end_array();
  json.value(0.1);
  json.end_array();
  json.member("last", std::optional<double>());
  json.end_object();
}

TEST(JsonStream, lays_values_out_as_a_tree_would) {
  const Json tree = {
      {"text", "a \"b\"\n\x01 \xff \u00e4"},
      {"none", nullptr},
      {"empty", Json::object()},
      {"list", {true, -7, std::numeric_limits<std::uint64_t>::max(), Json::array(), 0.1}},
      {"last", nullptr}};
  for (const auto& [layout, indent] :
       {std::pair{JsonStream::Layout::kIndented, 2}, std::pair{JsonStream::Layout::kCompact, -1}}) {
    std::string text;
    JsonStream json(text, layout);
    write_sample(json);
    EXPECT_EQ(text, tree.dump(indent, ' ', false, Json::error_handler_t::replace));
  }
}

TEST(JsonStream, writes_numbers_that_are_read_back_as_they_were) {
  std::mt19937_64 random(17);
  std::vector<double> numbers = {0,    -0.0, 1,      100,     1e15,    1e16,
                                 1e-4, 1e-5, 5e-324, 1.5e300, 1 / 3.0, 123456789012345678.0};
  for (int i = 0; i < 2000; ++i) {
    numbers.push_back(std::bit_cast<double>(random()));
  }
  for (const double number : numbers) {
    std::string text;
    JsonStream(text).value(number);
    EXPECT_EQ(text, Json(number).dump());
    if (std::isfinite(number)) {
      EXPECT_EQ(std::strtod(text.c_str(), nullptr), number) << text;
    }
  }
}

/// Blocks of 512 connections: 10^3 modules have 2,700.
TEST(Report, has_the_same_bytes_with_any_number_of_threads_and_is_laid_out_as_a_tree) {
  const Checked solid(cube(10));
  ReportOptions one;
  one.thread_count = 1;
  ReportOptions three;
  three.thread_count = 3;
  const std::string text = solid.report(one);
  EXPECT_EQ(text, solid.report(three));
  EXPECT_EQ(text, write_report_json(solid.entry()));
  const Json tree = Json::parse(text);
  EXPECT_EQ(text, tree.dump(2));
  ASSERT_EQ(tree["connections"].size(), solid.assessment.connections.size());
  for (std::size_t i = 0; i < solid.assessment.connections.size(); ++i) {
    const Json& connection = tree["connections"][i];
    EXPECT_EQ(connection["load_ratio"], solid.assessment.connections[i].load_ratio);
    EXPECT_EQ(connection["torsion_nmm"], solid.assessment.connections[i].torsion_nmm);
    EXPECT_EQ(connection["a"][2], model::ends(solid.robot, i)[0].z);
  }
}

/// The chain's connections carry 25, 24, ... modules from the top.
TEST(Report, lists_the_connections_that_are_asked_for) {
  const Checked chain(long_chain());
  EXPECT_EQ(Json::parse(chain.report(choose("all")))["connections"].size(), 25U);
  EXPECT_EQ(Json::parse(chain.report(choose("0")))["connections"], Json::array());
  EXPECT_EQ(Json::parse(chain.report(choose("99")))["connections"].size(), 25U);
  const Json broken = Json::parse(chain.report(choose("broken")))["connections"];
  ASSERT_EQ(broken.size(), 5U);
  const Json largest = Json::parse(chain.report(choose("7")))["connections"];
  ASSERT_EQ(largest.size(), 7U);
  for (std::size_t i = 0; i < largest.size(); ++i) {
    const int z = 50 - static_cast<int>(i);
    EXPECT_EQ(largest[i]["b"], Json::array({0, 0, z}));
    if (i < broken.size()) {
      EXPECT_EQ(broken[i], largest[i]);
    }
  }
  for (const char* text : {"", "some", "-1", "3x", "1.5", "99999999999999999999999"}) {
    EXPECT_FALSE(find_connection_choice(text)) << text;
  }
}

TEST(Report, takes_further_keys_at_its_end) {
  const Checked chain(long_chain());
  const std::string text = chain.report({}, [](JsonStream& json) { json.member("more", 1); });
  EXPECT_TRUE(text.ends_with("],\n  \"more\": 1\n}")) << text.substr(text.size() - 40);
}

TEST(Report, ends_early_where_nothing_more_can_be_written) {
  const Checked solid(cube(10));
  ReportOptions options;
  int calls = 0;
  options.progress = [&](double /*share*/) { ++calls; };
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  write_report_json(out, solid.entry(), options);
  write_connections_csv(out, solid.robot, solid.assessment, options);
  EXPECT_LE(calls, 2);
}

TEST(Table, has_a_line_for_each_connection_with_what_it_carries) {
  const Checked chain(long_chain());
  std::istringstream table(chain.table());
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line,
            "ax,ay,az,bx,by,bz,direction,load_ratio,axial_n,bending_nmm,shear_n,torsion_nmm,"
            "breaks");
  for (std::size_t i = 0; i < chain.assessment.connections.size(); ++i) {
    ASSERT_TRUE(std::getline(table, line));
    const auto [a, b] = model::ends(chain.robot, i);
    const verdict::ConnectionResult& result = chain.assessment.connections[i];
    EXPECT_TRUE(
        line.starts_with("0,0," + std::to_string(a.z) + ",0,0," + std::to_string(b.z) + ",+z,"))
        << line;
    std::istringstream numbers(line.substr(line.find("+z,") + 3));
    for (const double number : {result.load_ratio, result.axial_n, result.bending_nmm,
                                result.shear_n, result.torsion_nmm}) {
      std::string text;
      std::getline(numbers, text, ',');
      EXPECT_EQ(std::strtod(text.c_str(), nullptr), number) << line;
    }
    EXPECT_EQ(line.back(), result.load_ratio > 1 ? '1' : '0') << line;
  }
  EXPECT_FALSE(std::getline(table, line));
}

TEST(Table, of_a_choice_is_the_lines_of_the_whole_that_were_chosen) {
  const Checked solid(cube(10));
  const std::string whole = solid.table();
  EXPECT_EQ(std::ranges::count(whole, '\n'), 2701);
  std::istringstream chosen(solid.table(choose("3")));
  for (std::string line; std::getline(chosen, line);) {
    EXPECT_NE(whole.find(line + "\n"), std::string::npos) << line;
  }
}

TEST(Reason, has_words_and_a_name_whatever_its_code) {
  const Checked chain(long_chain());
  std::set<std::string> names;
  std::set<std::string> sentences;
  for (int code = 0; code < verdict::kReasonCodeCount; ++code) {
    const verdict::Reason reason{
        .code = static_cast<verdict::ReasonCode>(code), .numbers = {1, 2, 3, 4, 5}, .quoted = {}};
    names.insert(verdict::name(reason.code));
    sentences.insert(reason_text(chain.robot, reason));
  }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(verdict::kReasonCodeCount));
  EXPECT_EQ(sentences.size(), names.size());
  EXPECT_FALSE(sentences.contains(""));
}

/// The words are those of the program before reasons became data.
TEST(Reason, is_told_with_its_numbers) {
  using verdict::ReasonCode;
  const Checked chain(long_chain());
  const auto text = [&](ReasonCode code, std::array<double, verdict::Reason::kNumberMax> numbers,
                        const char* quoted = "") {
    return reason_text(chain.robot, {.code = code, .numbers = numbers, .quoted = quoted});
  };
  EXPECT_EQ(text(ReasonCode::kTopples, {100, 60, 60, 100, 2.5713}),
            "it topples over the edge (100, 60)-(60, 100) mm: the centre of mass lies 2.57 mm "
            "beyond it");
  EXPECT_EQ(text(ReasonCode::kConnectionsBreak, {5, 25, 24, 1.0003}),
            "5 of 25 connections would break; the worst, " + model::ends_text(chain.robot, 24) +
                ", is loaded to 100.03 % of its strength");
  EXPECT_EQ(text(ReasonCode::kNoKnownTension, {0.00012}),
            "stable, and no connection is known to be in tension: none carries more than 0.0002 "
            "of its strength");
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text(ReasonCode::kSolutionsDisagree, {2, 0.9, 1.1, infinity, -infinity}),
            "stable, but the paper's contact law (Eqs. 9-12) has several solutions here: the "
            "largest load ratio is 0.9000 to 1.1000 in the 2 that were found, not known by exact "
            "unilateral contact (Eqs. 6-8); they do not agree whether anything breaks");
  EXPECT_EQ(text(ReasonCode::kVerdictOfTheRobot, {0}, "a module does not answer"),
            "the robot's own verdict: a module does not answer; not every module knows it");
  const std::string second = model::text(chain.robot.modules()[1].cell);
  EXPECT_EQ(text(ReasonCode::kBuckles, {0.5, 1, 0, -1, 0, 0}),
            "it buckles at 0.5000 of its loads: " + second + " sways along y");
  EXPECT_EQ(text(ReasonCode::kCollapses, {0.0001234, 1, 0, 0, -1, 0}),
            "it collapses at 0.000123 of its loads: " + second + " goes towards -z");
  EXPECT_EQ(text(ReasonCode::kCollapses, {0.9163, 1, 0.6, 0, -0.8, 1}),
            "it tips over as it bends at 0.9163 of its loads: " + second +
                " goes towards (0.60, 0.00, -0.80)");
  EXPECT_EQ(text(ReasonCode::kTouchesFloor, {0.75, 1}),
            "at 0.7500 of its loads " + second +
                " bends down to the floor: what follows is not "
                "known");
  EXPECT_EQ(text(ReasonCode::kNotProved, {}, "the bound is not finite"),
            "not proved: the bound is not finite");
}

}  // namespace
}  // namespace holdfast::io
