// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Conversion loses nothing: what one format says comes back from the other as an equal document.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "document_support.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/model/robot_catalogue.hpp"

namespace holdfast::io {
namespace {

Document through_json(const Document& document) {
  return document_test::accepted(read_json(write_json(document))).document;
}

Document through_xml(const Document& document) {
  return document_test::accepted(read_visiblesim(write_visiblesim(document))).document;
}

void expect_equal_after_conversion(const Document& document) {
  EXPECT_EQ(through_json(document), document) << write_json(document);
  EXPECT_EQ(through_xml(document), document) << write_visiblesim(document);
}

/// Documents of any content, the same for a seed everywhere.
class RandomDocument {
 public:
  explicit RandomDocument(std::uint64_t seed) : rng_(seed) {}

  Document make() {
    Document document;
    document.name = text();
    document.description = text();
    document.support_z = coordinate();
    document.material.mass_kg = figure();
    document.material.moment_x_mm4 = figure();
    document.material.gravity_m_s2 = figure();
    for (std::uint64_t i = below(6); i > 0; --i) {
      document.modules.push_back({cell(), below(2) == 0, color(), attributes()});
    }
    for (std::uint64_t i = below(4); i > 0; --i) {
      Step& step = document.steps.emplace_back();
      const bool is_last_or_later = i == 1 || document.steps.size() > 1;
      for (std::uint64_t j = below(3) + (is_last_or_later ? 1 : 0); j > 0; --j) {
        step.push_back({cell(), color(), attributes()});
      }
    }
    if (below(2) == 0) {
      document.known_answer = KnownAnswer{"safe", number(), std::nullopt, text()};
    }
    document.parameters = attributes();
    document.world = attributes();
    document.block_list = attributes();
    document.scenery = elements(0);
    for (Element target : elements(1)) {
      target.name = "target";
      document.targets.push_back(target);
    }
    return document;
  }

  /// Returns the document of make() with members that only version 2 of holdfast JSON has.
  Document make_extended() {
    Document document = make();
    Extension& extension = document.extension;
    if (below(2) == 0) {
      const auto robots = model::robot_catalogue();
      extension.robot = robots[below(robots.size())].name;
    }
    extension.lattice = kNamedLattices[below(kNamedLattices.size())].lattice;
    extension.has_floor = below(2) == 0;
    document.support_z = extension.has_floor ? document.support_z : 0;
    extension.floor_friction = maybe(positive());
    if (below(2) == 0) {
      extension.gravity_m_s2 = std::array{number(), number(), positive()};
      document.material.gravity_m_s2 = model::Material{}.gravity_m_s2;
    }
    extension.connectors = connectors(extension.lattice);
    extension.foot_mm = maybe(positive());
    const double mass_kg = std::clamp(positive(), 1e-12, 1e12);
    extension.kinds = {{text() + "a", mass_kg, connectors(extension.lattice)}, {"b", {}, {}}};
    for (std::size_t i = 0; i < document.modules.size(); i += 1 + below(3)) {
      extension.own.push_back({0, i, extension.kinds[below(2)].name, maybe(positive())});
    }
    for (std::size_t i = 0; i < document.steps.size(); ++i) {
      if (!document.steps[i].empty()) {
        extension.own.push_back({i + 1, document.steps[i].size() - 1, "b", maybe(positive())});
      }
    }
    extension.obstacle_list = attributes();
    for (std::uint64_t i = below(3); i > 0; --i) {
      const base::Cell low = cell();
      extension.obstacles.push_back({low, {1'000'000, low.y, 1'000'000}, {}, {}});
      extension.obstacles.push_back({low, low, {}, {}});
      const model::Touch touch = {static_cast<model::Hold>(below(2)), maybe(positive())};
      extension.obstacles.push_back({{}, {}, {cell(), cell()}, touch});
      if (below(2) == 0) {
        extension.obstacle_colors.resize(extension.obstacles.size(), Color{1, 2, 3});
      }
      extension.payloads.push_back({cell(), {number(), 0, 1}, {0, number(), -1}});
      extension.plan.push_back({{cell()}, {cell(), cell()}, {}, {}, {}});
      extension.plan.push_back({{},
                                {},
                                {{cell(), cell(), maybe(cell())}},
                                {{cell(), cell()}},
                                {{cell(), cell()}, {cell(), cell()}}});
    }
    if (!extension.obstacle_colors.empty()) {
      extension.obstacle_colors.resize(extension.obstacles.size());
    }
    return document;
  }

 private:
  template <class Value>
  std::optional<Value> maybe(const Value& value) {
    return below(2) == 0 ? std::optional(value) : std::nullopt;
  }

  /// A number, or none at all.
  double limit() { return below(4) == 0 ? model::ConnectorLaw::kUnlimited : positive(); }

  /// Parameters in every form that they can have.
  Connectors connectors(const base::Lattice& lattice) {
    Connectors found{{{"gap_limit_mm", Spread::kAll, {limit()}}}, maybe(model::BendingLaw::kRound)};
    found.parameters.push_back({"friction", Spread::kClasses, {limit(), maybe(limit())}});
    ConnectorParameter list{"lever_mm", Spread::kPairs, {}};
    for (int pair = 0; pair < lattice.direction_count / 2; ++pair) {
      list.values.emplace_back(limit());
    }
    found.parameters.push_back(list);
    return found;
  }

  double positive() { return std::abs(number()) + 1e-9; }

  std::uint64_t below(std::uint64_t bound) { return rng_.below(bound); }

  std::int32_t coordinate() { return static_cast<std::int32_t>(below(2'000'001)) - 1'000'000; }

  base::Cell cell() { return {coordinate(), coordinate(), coordinate()}; }

  /// A number that a material may have, with all its digits.
  double figure() {
    const double digits = static_cast<double>(below(std::uint64_t{1} << 52U));
    return std::ldexp(1 + std::ldexp(digits, -52), static_cast<int>(below(78)) - 39);
  }

  /// Any finite number: sign, exponent and digits at random.
  double number() {
    const double digits = static_cast<double>(below(std::uint64_t{1} << 53U));
    const int exponent = static_cast<int>(below(600)) - 300;
    return std::ldexp(below(2) == 0 ? digits : -digits, exponent);
  }

  std::optional<Color> color() {
    const auto part = [&] { return static_cast<int>(below(256)); };
    return below(2) == 0 ? std::nullopt : std::optional(Color{part(), part(), part()});
  }

  /// A text with everything that markup, quotes, escapes and lines could break.
  std::string text() {
    constexpr std::array<const char*, 14> kPieces = {
        "a",   "Z9", "<",  ">", "&amp;", "\"", "'", "\\", "\\u0041", "\xC3\xA9", "\xF0\x9F\xA4\x96",
        "]]>", "--", "{,}"};
    constexpr std::array<const char*, 4> kBlanks = {" ", "\t", "\n", "  "};
    std::string text;
    for (std::uint64_t i = below(6); i > 0; --i) {
      text += (text.empty() ? "" : kBlanks[below(kBlanks.size())]);
      text += kPieces[below(kPieces.size())];
    }
    return text;
  }

  Attributes attributes() {
    Attributes attributes;
    for (const char* name : {"zeta", "x:y", "_a-1.b", "\xC3\xA9t\xC3\xA9", "alpha"}) {
      if (below(3) == 0) {
        attributes.emplace_back(name, text());
      }
    }
    return attributes;
  }

  std::vector<Element> elements(int depth) {
    std::vector<Element> list;
    for (std::uint64_t i = depth < 4 ? below(3) : 0; i > 0; --i) {
      list.push_back(
          {below(2) == 0 ? "camera" : "other", attributes(), text(), elements(depth + 1)});
    }
    return list;
  }

  base::Rng rng_;
};

TEST(Conversion, keeps_any_document) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    expect_equal_after_conversion(RandomDocument(seed).make());
  }
}

TEST(Conversion, keeps_any_document_of_version_2) {
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Document document = RandomDocument(seed).make_extended();
    EXPECT_EQ(json_version(document), 2);
    expect_equal_after_conversion(document);
  }
}

/// Obstacles can say their cells in two more ways: boxes of which VisibleSim is shown every cell,
/// and neighbours in a list that differ in nothing but that they are two.
TEST(Conversion, keeps_obstacles_apart) {
  Document document;
  document.extension.obstacles = {{{}, {}, {{1, 0, 0}, {2, 0, 0}}, {}},
                                  {{}, {}, {{3, 0, 0}}, {}},
                                  {{-1, -1, -1}, {4, 5, -1}, {}, {}},
                                  {{}, {}, {{4, 5, -1}}, {}},
                                  {{0, 0, 7}, {0, 0, 7}, {}, {model::Hold::kBonded, 0.25}}};
  expect_equal_after_conversion(document);
  document.extension.obstacle_colors = {Color{1, 2, 3}, std::nullopt, Color{4, 5, 6},
                                        Color{4, 5, 6}, Color{}};
  document.extension.obstacle_list = {{"color", "9,9,9"}};
  expect_equal_after_conversion(document);
}

/// A layer of catoms lies over the gaps of the layer below: an odd shift would tear the robot.
TEST(Conversion, moves_staggered_layers_by_an_even_number) {
  Document document;
  document.extension.lattice = base::kFaceCentred;
  document.modules = {{{0, 0, -1}, false, std::nullopt, {}}, {{0, 0, 0}, false, std::nullopt, {}}};
  const auto shift = visiblesim_shift(document);
  ASSERT_TRUE(shift);
  EXPECT_EQ(shift.value(), (base::Cell{0, 0, 2}));
  expect_equal_after_conversion(document);
}

TEST(Conversion, writes_gravity_once) {
  Document document;
  document.material.gravity_m_s2 = 1.62;
  document.extension.gravity_m_s2 = {1, 0, -9};
  EXPECT_EQ(through_json(document).extension, document.extension);
}

TEST(Conversion, keeps_an_empty_document) { expect_equal_after_conversion({}); }

TEST(Conversion, keeps_every_digit_of_a_number) {
  for (const double value :
       {0.1, 1.0 / 3, 1e-5, 1e21, 123456789.123456789, -0.0,
        std::numeric_limits<double>::denorm_min(), std::numeric_limits<double>::max()}) {
    Document document;
    document.known_answer = KnownAnswer{
        .verdict = "safe", .margin_mm = value, .load_ratio_max = std::nullopt, .source = ""};
    expect_equal_after_conversion(document);
  }
  // The ends of what is allowed, which XML is refused beyond, and digits between.
  for (const double share : {0.0, 1.0 / 3, 0.123456789123456789, 1 - 1e-16, 1.0}) {
    Document document;
    for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
      document.material.*parameter.value = std::min(
          parameter.highest, parameter.lowest + share * (parameter.highest - parameter.lowest));
    }
    expect_equal_after_conversion(document);
  }
}

TEST(Conversion, keeps_a_first_step_without_cells_before_another) {
  Document document;
  document.steps = {{}, {{{1, 2, 3}, std::nullopt, {}}}};
  expect_equal_after_conversion(document);
}

TEST(Conversion, from_xml_and_back_gives_the_same_text_again) {
  const char* const text =
      "<parameters globalMass=\"0.0700\" nofIterations=\"8\" globalSupportZ=\"1.0\"/>"
      "<world windowSize=\"8,6\" gridSize=\"6,6,6\"><spotlight/>"
      "<blockList color=\"1,1,1\"><blocksLine plane=\"1\" values=\"0110\"/>"
      "<block position=\"1,0,2\" fixed=\"yes\"/></blockList><targetList><target format=\"csg\"/>"
      "<target format=\"grid\"><cell position=\"2,0,2\"/></target></targetList></world>";
  const auto first = read_visiblesim(text);
  ASSERT_TRUE(first);
  const Document second = through_xml(through_json(first.value().document));
  EXPECT_EQ(second, first.value().document);
  EXPECT_EQ(write_json(second), write_json(first.value().document));
  EXPECT_EQ(write_visiblesim(second), write_visiblesim(first.value().document));
}

TEST(Conversion, gives_visiblesim_a_grid_that_holds_every_cell) {
  Document document;
  document.modules = {{{0, 4, 0}, false, std::nullopt, {}}, {{-3, 0, 0}, false, std::nullopt, {}}};
  document.steps = {{{{2, 0, 6}, std::nullopt, {}}}};
  EXPECT_NE(write_visiblesim(document).find("<world gridSize=\"6,5,7\">"), std::string::npos);
  // It is no part of the document: it would not be there if the file had not been needed.
  EXPECT_TRUE(through_xml(document).world.empty());

  document.world = {{"gridSize", "9,9,9"}};
  EXPECT_NE(write_visiblesim(document).find("<world gridSize=\"9,9,9\">"), std::string::npos);
  expect_equal_after_conversion(document);
}

TEST(Conversion, writes_for_visiblesim_only_what_visiblesim_knows) {
  Document document;
  document.modules = {{{0, 0, 0}, true, Color{1, 2, 3}, {{"centroid", "1"}}}};
  document.world = {{"gridSize", "1,1,1"}};
  EXPECT_EQ(write_visiblesim(document), R"(<?xml version="1.0"?>
<parameters globalMass="0.06106" globalSupportZ="0" />
<world gridSize="1,1,1">
  <blockList>
    <block position="0,0,0" color="1,2,3" fixed="true" centroid="1" />
  </blockList>
  <targetList>
    <target format="grid" />
  </targetList>
</world>
)");
}

/// VisibleSim's cells are counted from 0: all are moved, the ground with them, and come back.
TEST(Conversion, moves_cells_below_zero_and_takes_it_back) {
  Document document;
  document.support_z = -1;
  document.modules = {{{-3, -2, -1}, false, std::nullopt, {}}, {{-3, -2, 0}, true, Color{}, {}}};
  document.steps = {{{{-4, -2, 0}, std::nullopt, {}}}, {{{-3, 5, 0}, std::nullopt, {}}}};
  EXPECT_EQ(visiblesim_shift(document).value(), (base::Cell{4, 2, 1}));
  const std::string text = write_visiblesim(document);
  EXPECT_NE(text.find("<cell position=\"0,0,1\""), std::string::npos) << text;
  EXPECT_NE(text.find("globalSupportZ=\"0\""), std::string::npos) << text;
  EXPECT_NE(text.find("gridSize=\"2,8,2\""), std::string::npos) << text;
  EXPECT_NE(text.find("shift=\"4,2,1\""), std::string::npos) << text;
  expect_equal_after_conversion(document);
  EXPECT_TRUE(read_visiblesim(text).value().warnings.empty());
  // Nothing is moved, or said, without need.
  document.modules.clear();
  document.steps.clear();
  document.support_z = 0;
  EXPECT_EQ(visiblesim_shift(document).value(), base::Cell{});
  EXPECT_EQ(write_visiblesim(document).find("shift"), std::string::npos);
}

TEST(Conversion, says_so_where_cells_reach_beyond_any_grid) {
  Document document;
  document.modules = {{{-1, 0, 0}, false, std::nullopt, {}},
                      {{base::kCoordinateMax, 0, 0}, false, std::nullopt, {}}};
  EXPECT_FALSE(visiblesim_shift(document));
  expect_equal_after_conversion(document);
  document.modules.back().cell.x -= 1;
  EXPECT_TRUE(visiblesim_shift(document));
  expect_equal_after_conversion(document);
}

}  // namespace
}  // namespace holdfast::io
