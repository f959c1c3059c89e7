// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// VisibleSim XML of modules other than Blinky Blocks, and of obstacles. VisibleSim does not write
// down which modules a file is for; neighbours and places of its lattices are as in its
// documentation: catoms3D have 4 neighbours above that lie half a cell aside, hexanodes 6 in the
// plane, catoms2D 6 in the plane x-z.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "document_support.hpp"
#include "holdfast/io/lattice_names.hpp"

namespace holdfast::io {
namespace {

using base::Cell;
using document_test::accepted;

std::string world(std::string_view block_list, std::string_view blocks,
                  std::string_view rest = "") {
  return "<parameters/><world gridSize=\"9,9,9\"><blockList" + std::string(block_list) + ">" +
         std::string(blocks) + "</blockList>" + std::string(rest) + "</world>";
}

base::Error refused(const std::string& text, const ReadOptions& options = {}) {
  const auto result = read_visiblesim(text, options);
  EXPECT_FALSE(result) << text;
  return result ? base::Error{} : result.error();
}

std::string all(const std::vector<std::string>& warnings) {
  std::string text;
  for (const std::string& warning : warnings) {
    text += warning + "\n";
  }
  return text;
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

/// One above two, as VisibleSim's catoms3D stand on each other: three modules in one piece.
constexpr const char* kCatoms =
    R"(<block position="2,2,0" orientation="3"/>
       <block position="3,2,0"/><block position="2,2,1"/>)";

TEST(VisibleSimLattice, is_what_is_asked_for) {
  const std::string text = world(R"( blockSize="10,10,10")", kCatoms);
  const ReadDocument read = accepted(read_visiblesim(text, {.lattice = base::kFaceCentred}));
  EXPECT_EQ(read.document.extension.lattice, base::kFaceCentred);
  EXPECT_EQ(read.document.modules[0].attributes, (Attributes{{"orientation", "3"}}));
  EXPECT_TRUE(read.warnings.empty()) << all(read.warnings);
  const auto robot = make_robot(read.document);
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot.value().connections().size(), 3U);
  EXPECT_EQ(robot.value().facets().size(), 2U);
}

TEST(VisibleSimLattice, is_written_where_it_is_not_cubic_and_read_back) {
  for (const NamedLattice& row : kNamedLattices) {
    SCOPED_TRACE(row.name);
    Document document;
    document.modules = {{{1, 0, 0}, false, std::nullopt, {}}};
    document.extension.lattice = row.lattice;
    const std::string text = write_visiblesim(document);
    EXPECT_EQ(contains(text, "lattice=\"" + std::string(row.name) + "\""),
              row.lattice != base::kCubic);
    EXPECT_EQ(accepted(read_visiblesim(text)).document, document);
    EXPECT_EQ(accepted(read_visiblesim(text, {.lattice = row.lattice})).document, document);
    EXPECT_EQ(accepted(read_json(write_json(document))).document, document);
  }
}

TEST(VisibleSimLattice, that_is_asked_for_must_be_that_of_the_file) {
  const std::string text = world("", kCatoms, R"(<holdfast lattice="hexagonal"/>)");
  const base::Error xml = refused(text, {.lattice = base::kFaceCentred});
  EXPECT_EQ(xml.where, "line 2");  // After the two lines of the blocks.
  EXPECT_TRUE(contains(xml.message, "is 'hexagonal' here, but 'face-centred' is asked for"));
  const auto json = read_json(
      R"({"format": "holdfast-structure", "version": 2, "modules": [], "lattice": "cubic"})",
      {.lattice = base::kFaceCentred});
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().where, "/lattice");
}

TEST(VisibleSimLattice, is_known_by_blocks_that_only_one_kind_of_modules_has) {
  const auto lattice_of = [](const std::string& size) {
    const ReadDocument read = accepted(
        read_visiblesim(world(" blockSize=\"" + size + "\"", R"(<block position="0,0,0"/>)")));
    EXPECT_EQ(read.warnings.size(), 1U);
    return read.document.extension.lattice;
  };
  EXPECT_EQ(lattice_of("50,50,12.5"), base::kHexagonalPrism);
  EXPECT_EQ(lattice_of(" 1.0,5,1"), base::kHexagonal);
}

TEST(VisibleSimLattice, that_may_be_another_one_is_noted) {
  const ReadDocument read = accepted(read_visiblesim(world("", kCatoms)));
  EXPECT_EQ(read.document.extension.lattice, base::kCubic);
  EXPECT_TRUE(contains(all(read.warnings), "catoms3D"));
}

TEST(VisibleSimLattice, has_the_names_of_files_and_of_visiblesims_modules) {
  EXPECT_EQ(find_lattice("face-centred").value(), base::kFaceCentred);
  EXPECT_EQ(find_lattice("catoms3D").value(), base::kFaceCentred);
  EXPECT_EQ(find_lattice("catoms2D").value(), base::kHexagonal);
  EXPECT_EQ(find_lattice("hexanodes").value(), base::kHexagonalPrism);
  EXPECT_EQ(find_lattice("slidingCubes").value(), base::kCubic);
  EXPECT_TRUE(contains(find_lattice("fcc").error().message, "face-centred, hexagonal"));
  EXPECT_EQ(find_lattice("datoms").error().code, base::ErrorCode::kUnsupported);
  const base::Error piston = refused(world("", R"(<block position="0,0,0" piston="2345"/>)"));
  EXPECT_EQ(piston.code, base::ErrorCode::kUnsupported);
  EXPECT_TRUE(contains(piston.message, "datoms"));
  const auto json = read_json(document_test::json(
      R"("modules": [[1,0,0], {"cell": [0,0,0], "attributes": {"piston": "2345"}}])"));
  ASSERT_FALSE(json);
  EXPECT_EQ(json.error().code, base::ErrorCode::kUnsupported);
  EXPECT_EQ(json.error().where, "/modules/1/attributes");
  EXPECT_TRUE(contains(json.error().message, "datoms"));
}

TEST(VisibleSimLattice, turns_all_modules_of_a_row_or_box_as_it_says) {
  const Document document =
      accepted(read_visiblesim(world("", R"(<blocksLine values="11" orientation="4"/>
                          <blockBox boxOrigin="0,40,0" boxSize="0,0,0" orientation="5"/>)")))
          .document;
  ASSERT_EQ(document.modules.size(), 3U);
  EXPECT_EQ(document.modules[1].attributes, (Attributes{{"orientation", "4"}}));
  EXPECT_EQ(document.modules[2].attributes, (Attributes{{"orientation", "5"}}));
}

TEST(VisibleSimLattice, has_no_boxes_in_millimetres_but_for_cubes) {
  const base::Error error = refused(world("", "<blockBox/>"), {.lattice = base::kFaceCentred});
  EXPECT_EQ(error.code, base::ErrorCode::kUnsupported);
}

TEST(VisibleSimLattice, has_no_meshes_that_would_add_modules) {
  EXPECT_EQ(refused(world("", "<mesh/>")).code, base::ErrorCode::kUnsupported);
  EXPECT_EQ(refused(world("", "<csg content=\"sphere(2)\"/>"), {.lattice = base::kHexagonal}).code,
            base::ErrorCode::kUnsupported);
}

/// Newer files have one root; their boxes count in cells, and boxSize is how many.
TEST(VisibleSimLattice, is_read_within_the_newer_root_element) {
  const ReadDocument read = accepted(read_visiblesim(
      R"(<?xml version="1.0"?><vs><visuals/><world gridSize="10,10,5"><blockList>
         <blockBox boxOrigin="1,1,0" boxSize="2,1,3"/><block position="5,2,3" color="#FF8000"/>
         </blockList></world></vs>)"));
  ASSERT_EQ(read.document.modules.size(), 7U);
  EXPECT_EQ(read.document.modules[0].cell, (Cell{1, 1, 0}));
  EXPECT_EQ(read.document.modules[5].cell, (Cell{2, 1, 2}));
  EXPECT_EQ(read.document.modules[6].color, (Color{255, 128, 0}));
}

TEST(VisibleSimLattice, has_colours_in_three_notations) {
  const auto color = [](const std::string& text) {
    return accepted(
               read_visiblesim(world("", "<block position=\"0,0,0\" color=\"" + text + "\"/>")))
        .document.modules[0]
        .color;
  };
  EXPECT_EQ(color("1, 2,3"), (Color{1, 2, 3}));
  EXPECT_EQ(color("#0a0B0c"), (Color{10, 11, 12}));
  EXPECT_EQ(color("0xffffff"), (Color{255, 255, 255}));
  // A colour decides nothing. VisibleSim exports fractions and takes their whole part.
  EXPECT_EQ(color("127.5,127.5,127.5"), (Color{127, 127, 127}));
  EXPECT_EQ(color("255,139.995,0"), (Color{255, 139, 0}));
  EXPECT_EQ(color("256,-1,1e300"), (Color{255, 0, 255}));
  for (const char* bad : {"#fff", "#0a0b0cff", "#0a0b0g", "0x-00001", "red", "1,2,nan", ""}) {
    EXPECT_EQ(color(bad), std::nullopt) << bad;
  }
  for (const char* bad : {"127.5,127.5,127.5", "256,0,0", "red"}) {
    const std::string attributes = " position=\"0,0,0\" color=\"" + std::string(bad) + "\"/>";
    const ReadDocument read = accepted(read_visiblesim(world(
        "", "<block" + attributes, "<obstacleList><obstacle" + attributes + "</obstacleList>")));
    for (const char* element : {"block", "obstacle"}) {
      const std::string note = fmt::format("color of <{}> is '{}'", element, bad);
      EXPECT_EQ(
          std::ranges::count_if(
              read.warnings, [&](const std::string& warning) { return contains(warning, note); }),
          1)
          << note;
    }
  }
}

Extension obstacles_of(std::string_view list) {
  return accepted(read_visiblesim(world("", "", list))).document.extension;
}

TEST(VisibleSimObstacles, are_one_obstacle_that_holds_as_a_floor_does) {
  const Extension extension = obstacles_of(
      R"(<obstacleList><obstacle position="0,0,1"/><obstacle position="4,0,1"/></obstacleList>)");
  EXPECT_EQ(extension.obstacles,
            (std::vector<model::Obstacle>{{{}, {}, {{0, 0, 1}, {4, 0, 1}}, {}}}));
  EXPECT_TRUE(extension.obstacle_colors.empty());
}

TEST(VisibleSimObstacles, keep_their_colours) {
  const Extension extension = obstacles_of(R"(<obstacleList color="7,7,7">
      <obstacle position="0,0,1" color="1,2,3"/><obstacle position="1,0,1" color="1,2,3"/>
      <obstacle position="2,0,1"/></obstacleList>)");
  ASSERT_EQ(extension.obstacles.size(), 2U);
  EXPECT_EQ(extension.obstacles[0].cells.size(), 2U);
  EXPECT_EQ(extension.obstacle_colors,
            (std::vector<std::optional<Color>>{Color{1, 2, 3}, std::nullopt}));
  EXPECT_EQ(extension.obstacle_list, (Attributes{{"color", "7,7,7"}}));
}

TEST(VisibleSimObstacles, say_in_attributes_of_ours_how_they_hold) {
  const Extension extension = obstacles_of(R"(<obstacleList>
      <obstacle position="0,0,1" hold="bonded" friction="0.5"/><obstacle position="1,0,1"/>
      <obstacle position="0,0,2" hold="contact" to="1,0,2"/><obstacle position="1,0,2"/>
      </obstacleList>)");
  EXPECT_EQ(extension.obstacles, (std::vector<model::Obstacle>{
                                     {{}, {}, {{0, 0, 1}, {1, 0, 1}}, {model::Hold::kBonded, 0.5}},
                                     {{0, 0, 2}, {1, 0, 2}, {}, {}}}));
}

TEST(VisibleSimObstacles, hold_the_modules_beside_them) {
  Document document =
      accepted(read_visiblesim(world("", R"(<block position="0,0,2"/>)",
                                     R"(<obstacleList><obstacle position="1,0,2" hold="bonded"/>
                                        </obstacleList>)")))
          .document;
  const auto robot = make_robot(document);
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot.value().facets().size(), 1U);
  EXPECT_TRUE(robot.value().has_bonded_facets());
}

/// Older versions kept obstacles as scenery; files that they converted can still be read.
TEST(VisibleSimObstacles, are_found_in_the_scenery_of_older_files) {
  const Document document =
      accepted(read_json(document_test::json(R"("modules": [[0,0,2]], "visiblesim": {"scenery": [
          {"element": "camera"}, {"element": "obstacleList",
           "children": [{"element": "obstacle", "attributes": {"position": "1,0,2"}}]}]})")))
          .document;
  EXPECT_EQ(document.extension.obstacles.size(), 1U);
  EXPECT_EQ(document.scenery.size(), 1U);
}

TEST(VisibleSimLattice, cubes_as_large_as_other_modules_stay_cubes) {
  for (const char* size : {"50,50,12.5", "1,5,1"}) {
    Document document =
        accepted(read_json(document_test::json(R"("modules": [[0,0,0], [1,0,0]])"))).document;
    document.block_list = {{"blockSize", size}};
    const Document again = accepted(read_visiblesim(write_visiblesim(document))).document;
    EXPECT_EQ(again.extension.lattice, base::kCubic) << size;
  }
}

TEST(VisibleSimObstacles, say_what_is_wrong) {
  const auto bad = [](std::string_view obstacle, std::string_view message) {
    const base::Error error =
        refused(world("", "", "<obstacleList>" + std::string(obstacle) + "</obstacleList>"));
    EXPECT_EQ(error.where, "line 1");
    EXPECT_TRUE(contains(error.message, message)) << error.message;
  };
  bad("<obstacle/>", "has no attribute 'position'");
  bad("<obstacle position=\"1,2\"/>", "position of <obstacle> is '1,2'");
  bad("<obstacle position=\"1,2,9999999\"/>", "from -1000000 to 1000000");
  bad("<obstacle position=\"1,2,3\" hold=\"glued\"/>", "expected contact or bonded");
  bad("<obstacle position=\"1,2,3\" friction=\"-1\"/>", "not negative");
  bad("<obstacle position=\"1,2,3\" to=\"1,2,2\"/>", "may be below");
  bad("<obstacle position=\"1,2,3\" hld=\"bonded\"/>", "did you mean 'hold'?");
  bad("<obstcle position=\"1,2,3\"/>", "did you mean 'obstacle'?");
}

TEST(VisibleSimExtension, holds_what_only_version_2_says) {
  const Document document =
      accepted(read_visiblesim(world(
                   "", R"(<block position="0,0,0" holdfastKind="battery" holdfastMass="0.3"/>)",
                   R"(<holdfast><extension>{"floor": {"friction": 0.5},
                      "kinds": {"battery": {"mass_kg": 0.2}}}</extension></holdfast>)")))
          .document;
  EXPECT_EQ(document.extension.floor_friction, 0.5);
  EXPECT_EQ(document.extension.kinds.size(), 1U);
  EXPECT_EQ(document.extension.own, (std::vector<OwnParameters>{{0, 0, "battery", 0.3}}));
  EXPECT_TRUE(document.modules[0].attributes.empty());

  const std::string weather =
      world("", "", R"(<holdfast><extension>{"weather": 1}</extension></holdfast>)");
  const auto unknown = read_visiblesim(weather);
  ASSERT_FALSE(unknown);
  EXPECT_TRUE(contains(unknown.error().message, "'weather' is unknown, expected robot, "));
  EXPECT_TRUE(contains(all(accepted(read_visiblesim(weather, {.allow_unknown = true})).warnings),
                       "'weather' is unknown"));
  const Document moon =
      accepted(read_visiblesim(
                   R"(<parameters globalSupportZ="3"/><world><blockList/><holdfast><extension>
                      {"gravity_m_s2": [0, 0, -1.62], "support_z": null}</extension></holdfast>
                      </world>)"))
          .document;
  EXPECT_EQ(moon.material.gravity_m_s2, 1.62);
  EXPECT_EQ(moon.support_z, 0) << "there is no floor";

  const auto bad = [](std::string_view blocks, std::string_view text, std::string_view message) {
    const base::Error error = refused(
        world("", blocks, "<holdfast><extension>" + std::string(text) + "</extension></holdfast>"));
    EXPECT_EQ(error.where, "line 1");
    EXPECT_TRUE(contains(error.message, message)) << error.message;
  };
  bad("", "{", "no valid JSON");
  bad("", R"({"floor": {"friction": -1}})", "/floor/friction");
  bad("", R"({"material": {"lever_mm": [1]}})", "/material/lever_mm");
  bad(R"(<block position="0,0,0" holdfastKind="battery"/>)", "{}",
      "holdfastKind of <block> at (0,0,0)");
  bad(R"(<block position="0,0,0" holdfastMass="0"/>)", "{}", "a positive number");
  refused(world("", R"(<block position="0,0,0" holdfastKind="battery"/>)"));
}

}  // namespace
}  // namespace holdfast::io
