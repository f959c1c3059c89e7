// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What VisibleSim's users write is read as VisibleSim means it. Expected cells are written out by
// hand from the rules in docs/formats.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

ReadDocument read(std::string_view text) { return document_test::accepted(read_visiblesim(text)); }

/// A world with these children of <blockList> and these further children.
std::string world(std::string_view blocks, std::string_view rest = "") {
  return "<parameters/><world gridSize=\"5,4,3\"><blockList>" + std::string(blocks) +
         "</blockList>" + std::string(rest) + "</world>";
}

std::vector<Cell> cells_of(const std::vector<ModuleEntry>& modules) {
  std::vector<Cell> cells;
  for (const ModuleEntry& module : modules) {
    cells.push_back(module.cell);
  }
  return cells;
}

std::vector<Cell> cells_read(std::string_view blocks) {
  return cells_of(read(world(blocks)).document.modules);
}

/// The only warning, or all of them in one line.
std::string warning_of(std::string_view text) {
  std::string all;
  for (const std::string& warning : read(text).warnings) {
    all += (all.empty() ? "" : " | ") + warning;
  }
  return all;
}

bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

TEST(VisibleSim, parameters_beside_the_root_do_not_go_unread) {
  const std::string robot = "<vs>" + world("<block position=\"1,1,1\"/>") + "</vs>";
  EXPECT_EQ(read("<!-- a comment -->" + robot).document.modules.size(), 1U);
  for (const char* beside : {"<parameters globalMass=\"7\"/>", "<world/>"}) {
    const auto error = read_visiblesim(robot + beside);
    ASSERT_FALSE(error) << beside;
    EXPECT_TRUE(contains(error.error().message, "is beside <vs>")) << error.error().message;
  }
  EXPECT_TRUE(contains(warning_of(robot + "<robot/>"), "'robot' is unknown"));
}

TEST(VisibleSim, is_read_with_two_roots_comments_and_a_byte_order_mark) {
  const ReadDocument result = read(
      "\xEF\xBB\xBF<?xml version=\"1.0\" standalone=\"no\" ?>\n"
      "<!-- before --><parameters globalMass=\"0.08\" nofIterations=\"500\" "
      "globalSupportZ=\"1\"/>\n"
      "<!-- <world/> -->\n"
      "<world gridSize=\"4,4,4\" windowSize=\"800,600\">\n"
      "  <camera target=\"1,2,3\" angle=\"45\"/>\n"
      "  <blockList color=\"1,2,3\" blockSize=\"40,40,41\">\n"
      "    <block position=\"1,1,1\" color=\"0,255,0\" centroid=\"1\"/>\n"
      "    <!-- <block position=\"3,3,3\"/> -->\n"
      "    <block position=\"1,1,2\"/>\n"
      "  </blockList>\n"
      "  <targetList><target format=\"grid\"><cell position=\"2,1,2\"/></target></targetList>\n"
      "</world>\n");
  EXPECT_TRUE(result.warnings.empty());

  Document expected;
  expected.support_z = 1;
  expected.material.mass_kg = 0.08;
  expected.modules = {{{1, 1, 1}, false, Color{0, 255, 0}, {{"centroid", "1"}}},
                      {{1, 1, 2}, false, std::nullopt, {}}};
  expected.steps = {{{{2, 1, 2}, std::nullopt, {}}}};
  expected.parameters = {{"nofIterations", "500"}};
  expected.world = {{"gridSize", "4,4,4"}, {"windowSize", "800,600"}};
  expected.block_list = {{"color", "1,2,3"}, {"blockSize", "40,40,41"}};
  expected.scenery = {{"camera", {{"target", "1,2,3"}, {"angle", "45"}}, "", {}}};
  EXPECT_EQ(result.document, expected);
}

TEST(VisibleSim, parameters_are_independent_of_each_other) {
  // VisibleSim's Iy bends lateral beams in the vertical plane: our Ix.
  const std::pair<const char*, double model::Material::*> parameters[] = {
      {"E", &model::Material::elastic_modulus_mpa},
      {"globalL", &model::Material::pitch_mm},
      {"a", &model::Material::facet_mm},
      {"A", &model::Material::section_area_mm2},
      {"globalIy", &model::Material::moment_x_mm4},
      {"globalIz", &model::Material::moment_y_mm4},
      {"globalJ", &model::Material::torsion_mm4},
      {"globalNu", &model::Material::poisson_ratio},
      {"globalMass", &model::Material::mass_kg},
      {"globalGamma", &model::Material::contact_gamma}};
  for (const auto& [name, value] : parameters) {
    model::Material expected;
    expected.*value = 0.0625;
    const ReadDocument result =
        read("<parameters " + std::string(name) + "=\" 0.0625 \"/><world><blockList/></world>");
    EXPECT_EQ(result.document.material, expected) << name;
    EXPECT_TRUE(result.document.parameters.empty()) << name;
    // So small a pitch is noted, and leaves the facets too wide.
    EXPECT_EQ(result.warnings.size(), value == &model::Material::pitch_mm ? 2U : 0U) << name;
  }
}

TEST(VisibleSim, support_level_may_be_written_with_a_point) {
  EXPECT_EQ(
      read("<parameters globalSupportZ=\"-2.0\"/><world><blockList/></world>").document.support_z,
      -2);
}

TEST(VisibleSim, parameters_without_meaning_for_mechanics_are_kept) {
  const ReadDocument result = read(
      "<parameters preconditioner=\"1\" globalBeta=\"0.6\" globalEps=\"1\" globalMu=\"1\" "
      "globalOmega=\"1\" globalI=\"1\" speed=\"9\"/><world><blockList/></world>");
  ASSERT_EQ(result.document.parameters.size(), 7U);
  EXPECT_EQ(result.document.parameters[1],
            std::make_pair(std::string("globalBeta"), std::string("0.6")));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(contains(result.warnings[0], "'speed'"));
}

TEST(VisibleSim, missing_parameters_mean_the_defaults_and_a_warning) {
  const ReadDocument result = read("<world><blockList/></world>");
  EXPECT_EQ(result.document.material, model::Material{});
  EXPECT_EQ(result.document.support_z, 0);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(contains(result.warnings[0], "<parameters>"));
}

TEST(VisibleSim, numbers_may_have_blanks_around_them) {
  EXPECT_EQ(cells_read("<block position=\" 1,\t2 , 0 \"/>"), (std::vector<Cell>{{1, 2, 0}}));
}

TEST(VisibleSim, negative_coordinates_are_read_with_a_warning) {
  const ReadDocument result = read(world("<block position=\"-1,0,0\"/>"));
  EXPECT_EQ(result.document.modules[0].cell, (Cell{-1, 0, 0}));
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(contains(result.warnings[0], "(-1,0,0)"));
  EXPECT_TRUE(contains(result.warnings[0], "outside gridSize"));
}

TEST(VisibleSim, a_grid_of_two_numbers_is_kept_and_heeded_by_nobody) {
  const ReadDocument result = read(
      "<world gridSize=\"2,2\"><blockList><block position=\"0,0,0\"/>"
      "<block position=\"0,0,1\"/></blockList></world>");
  EXPECT_EQ(result.document.modules.size(), 2U);
  EXPECT_TRUE(std::ranges::any_of(result.warnings, [](const std::string& warning) {
    return contains(warning, "gridSize '2,2' has two numbers");
  }));
  EXPECT_TRUE(contains(write_visiblesim(result.document), "gridSize=\"2,2\""));
}

TEST(VisibleSim, fixed_is_what_is_not_denied) {
  for (const char* no : {"0", "false", "False", "FALSE", "no", " No "}) {
    EXPECT_FALSE(read(world("<block position=\"0,0,0\" fixed=\"" + std::string(no) + "\"/>"))
                     .document.modules[0]
                     .is_fixed)
        << no;
  }
  for (const std::string yes : {"1", "true", "yes", "TRUE", "anything", ""}) {
    const auto result = read(world("<block position=\"0,0,0\" fixed=\"" + yes + "\"/>"));
    EXPECT_TRUE(result.document.modules[0].is_fixed) << yes;
    const bool is_noted = std::ranges::any_of(result.warnings, [&](const std::string& warning) {
      return contains(warning, "fixed of <block> is '" + yes + "', which counts as yes");
    });
    EXPECT_EQ(is_noted, yes == "anything" || yes.empty()) << yes;
  }
}

TEST(VisibleSim, lines_of_blocks_run_along_x) {
  const Document document =
      read(world("<blocksLine line=\"2\" plane=\"1\" values=\"01101\" color=\"7,8,9\"/>")).document;
  EXPECT_EQ(cells_of(document.modules), (std::vector<Cell>{{1, 2, 1}, {2, 2, 1}, {4, 2, 1}}));
  EXPECT_EQ(document.modules[2].color, (Color{7, 8, 9}));
}

TEST(VisibleSim, a_line_without_a_plane_lies_in_that_of_the_line_before) {
  EXPECT_EQ(cells_read("<blocksLine line=\"1\" values=\"1\"/>"
                       "<blocksLine plane=\"2\" values=\"1\"/>"
                       "<block position=\"0,0,0\"/>"
                       "<blocksLine line=\"3\" values=\"1\"/>"),
            (std::vector<Cell>{{0, 1, 0}, {0, 0, 2}, {0, 0, 0}, {0, 3, 2}}));
}

TEST(VisibleSim, values_other_than_0_and_1_are_warned_of) {
  const std::string text = world("<blocksLine values=\"1xx1\"/>");
  EXPECT_EQ(cells_of(read(text).document.modules), (std::vector<Cell>{{0, 0, 0}, {3, 0, 0}}));
  EXPECT_TRUE(contains(warning_of(text), "'x' counts as 0 (2 times"));
}

TEST(VisibleSim, a_box_holds_the_cells_whose_position_lies_in_it) {
  // Positions are 0, 40, 80... along x and y, and 0, 41, 82 along z; the ends belong to the box.
  EXPECT_EQ(cells_read("<blockBox boxOrigin=\"40,1,41\" boxSize=\"40,79.5,40.9\"/>"),
            (std::vector<Cell>{{1, 1, 1}, {2, 1, 1}, {1, 2, 1}, {2, 2, 1}}));
  EXPECT_EQ(cells_read("<blockBox boxOrigin=\"-500,0,0\" boxSize=\"500,0,82\" color=\"1,1,1\"/>"),
            (std::vector<Cell>{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}}));
}

TEST(VisibleSim, a_box_without_bounds_fills_the_grid) {
  EXPECT_EQ(cells_read("<blockBox/>").size(), 5U * 4U * 3U);
  EXPECT_EQ(cells_read("<blockBox boxOrigin=\"160,120,82\"/>"), (std::vector<Cell>{{4, 3, 2}}));
}

TEST(VisibleSim, a_box_is_measured_in_blocks_of_the_given_size) {
  EXPECT_EQ(cells_of(read("<parameters/><world gridSize=\"9,9,9\"><blockList blockSize=\"10,20,5\">"
                          "<blockBox boxOrigin=\"30,20,5\" boxSize=\"0,0,5\"/></blockList></world>")
                         .document.modules),
            (std::vector<Cell>{{3, 1, 1}, {3, 1, 2}}));
}

/// VisibleSim counts boxes in mm up to 2022 and in cells since, with or without <vs>. Every box of
/// whole numbers within a small grid: those that both ways read alike are read so, others in cells,
/// with a note.
TEST(VisibleSim, a_box_that_can_be_counted_in_cells_is_with_a_note_where_mm_would_differ) {
  constexpr int kPitch[] = {2, 3};  // Of blocks along x and y.
  constexpr int kGrid = 4;
  for (int code = 0; code < kGrid * kGrid * 5 * 5; ++code) {
    const int from[] = {code % kGrid, code / kGrid % kGrid};
    const int size[] = {code / 16 % 5, code / 80};
    int in_mm = 1;
    int in_cells = 1;
    bool is_alike = true;
    bool is_in_grid = true;
    for (int axis = 0; axis < 2; ++axis) {
      int mm = 0;
      int cells = 0;
      for (int i = 0; i < kGrid; ++i) {
        const int at = i * kPitch[axis];
        const bool in = at >= from[axis] && at <= from[axis] + size[axis];
        // VisibleSim leaves out the last of the grid.
        const bool counted = i >= from[axis] && i < from[axis] + size[axis] && i < kGrid - 1;
        mm += in ? 1 : 0;
        cells += counted ? 1 : 0;
        is_alike = is_alike && in == counted;
      }
      in_mm *= mm;
      in_cells *= cells;
      is_in_grid = is_in_grid && size[axis] > 0 && from[axis] + size[axis] <= kGrid;
    }
    const ReadDocument result = read(fmt::format(
        R"(<parameters/><world gridSize="4,4,2"><blockList blockSize="2,3,4">
           <blockBox boxOrigin="{},{},0" boxSize="{},{},1"/></blockList></world>)",
        from[0], from[1], size[0], size[1]));
    EXPECT_EQ(result.document.modules.size(),
              static_cast<std::size_t>(is_in_grid ? in_cells : in_mm))
        << code;
    const bool is_noted = std::ranges::any_of(result.warnings, [](const std::string& warning) {
      return contains(warning, "counts in cells, as VisibleSim does since 2022");
    });
    EXPECT_EQ(is_noted, is_in_grid && !is_alike && in_mm + in_cells > 0) << code;
  }
}

TEST(VisibleSim, says_that_blocks_which_are_not_as_long_as_wide_are_read_as_cubes) {
  const auto notes = [](std::string_view size, std::string_view own = "") {
    return warning_of(fmt::format(
        R"(<vs><parameters/><world gridSize="4,4,4"><blockList blockSize="{}">
           <block position="1,1,0"/></blockList>{}</world></vs>)",
        size, own));
  };
  EXPECT_TRUE(
      contains(notes("25,25,11"), "blockSize is '25,25,11', and modules are taken as long"));
  EXPECT_FALSE(contains(notes("25,25,25"), "blockSize"));
  EXPECT_FALSE(contains(notes("40,40,41"), "blockSize"));
  EXPECT_FALSE(contains(notes("25,25,11", R"(<holdfast lattice="hexagonal"/>)"), "blockSize is"));
}

/// VisibleSim's loops run to the last layer of the grid, without it (simulator.cpp, March 2025).
TEST(VisibleSim, a_box_at_the_end_of_the_grid_lacks_what_visiblesim_leaves_out) {
  const auto notes = [](std::string_view box) {
    return warning_of(
        fmt::format(R"(<vs><world gridSize="3,4,5"><blockList>{}</blockList></world></vs>)", box));
  };
  EXPECT_TRUE(contains(notes("<blockBox/>"), "24 modules of 60"));
  EXPECT_TRUE(
      contains(notes(R"(<blockBox boxOrigin="0,0,1" boxSize="2,3,4"/>)"), "18 modules of 24"));
  EXPECT_FALSE(contains(notes(R"(<blockBox boxSize="2,3,4"/>)"), "leaves out"));
}

/// A catom in an even layer touches the four at the same place and half a cell aside in the layer
/// above (formats.md); as cubes all but one of them touch it at an edge or a corner.
TEST(VisibleSim, modules_that_another_lattice_connects_are_refused_with_its_name) {
  const auto message = [](const Cell& second) {
    const auto robot = make_robot(
        read(world(fmt::format(R"(<block position="2,2,0"/><block position="{},{},{}"/>)", second.x,
                               second.y, second.z)))
            .document);
    return robot ? std::string() : robot.error().message;
  };
  const std::string hint = "; the lattice is cubic, in face-centred it is connected";
  for (const Cell& second : {Cell{1, 2, 1}, Cell{2, 1, 1}, Cell{1, 1, 1}}) {
    EXPECT_TRUE(contains(message(second), "not connected")) << message(second);
    EXPECT_TRUE(contains(message(second), hint)) << message(second);
  }
  EXPECT_EQ(message({2, 2, 1}), "");
  EXPECT_TRUE(contains(message({4, 2, 0}), "not connected"));
  EXPECT_FALSE(contains(message({4, 2, 0}), "the lattice is"));
}

TEST(VisibleSim, a_box_without_cells_is_warned_of) {
  EXPECT_TRUE(contains(warning_of(world("<blockBox boxOrigin=\"1,1,1\" boxSize=\"9,9,9\"/>")),
                       "holds no cell"));
}

TEST(VisibleSim, only_the_first_of_several_steps_is_checked) {
  const ReadDocument result = read(world(
      "<block position=\"0,0,0\"/>",
      "<targetList><target format=\"grid\"><cell position=\"1,0,0\" color=\"9,9,9\"/></target>"
      "<target format=\"grid\"><targetLine line=\"1\" plane=\"0\" values=\"11\"/></target>"
      "</targetList>"));
  ASSERT_EQ(result.document.steps.size(), 2U);
  EXPECT_EQ(result.document.steps[0], (Step{{{1, 0, 0}, Color{9, 9, 9}, {}}}));
  EXPECT_EQ(result.document.steps[1],
            (Step{{{0, 1, 0}, std::nullopt, {}}, {{1, 1, 0}, std::nullopt, {}}}));
  EXPECT_TRUE(result.warnings.empty());

  const auto robot = make_robot(result.document);
  ASSERT_TRUE(robot);
  EXPECT_EQ(robot.value().planned_count(), 1U);
}

TEST(VisibleSim, an_empty_target_plans_nothing) {
  const ReadDocument result = read(
      world("<block position=\"0,0,0\"/>", "<targetList><target format=\"grid\"/></targetList>"));
  EXPECT_TRUE(result.document.steps.empty());
  EXPECT_TRUE(result.warnings.empty());
}

TEST(VisibleSim, targets_that_are_no_grids_are_kept_and_warned_of) {
  const ReadDocument result =
      read(world("<block position=\"0,0,0\"/>",
                 "<targetList><target format=\"csg\"><csg content=\"cube([1,1,1])\"/></target>"
                 "<target format=\"grid\"><cell position=\"1,0,0\"/></target></targetList>"));
  EXPECT_EQ(result.document.steps.size(), 1U);
  const std::vector<Element> expected = {
      {"target", {{"format", "csg"}}, "", {{"csg", {{"content", "cube([1,1,1])"}}, "", {}}}}};
  EXPECT_EQ(result.document.targets, expected);
  ASSERT_EQ(result.warnings.size(), 1U);
  EXPECT_TRUE(contains(result.warnings[0], "'csg' is not supported"));
}

TEST(VisibleSim, scenery_is_kept_with_everything_in_it) {
  const ReadDocument result =
      read(world("",
                 "<camera angle=\"45\"/><customization><rotationDelay multiplier=\"2\">\n"
                 "  slow &amp; steady <![CDATA[<really>]]>\n</rotationDelay></customization>"));
  const std::vector<Element> expected = {
      {"camera", {{"angle", "45"}}, "", {}},
      {"customization",
       {},
       "",
       {{"rotationDelay", {{"multiplier", "2"}}, "slow & steady <really>", {}}}}};
  EXPECT_EQ(result.document.scenery, expected);
  EXPECT_TRUE(result.warnings.empty());
}

TEST(VisibleSim, unknown_elements_are_kept_and_warned_of) {
  const std::string text = world("", "<weather/>");
  EXPECT_EQ(read(text).document.scenery.size(), 1U);
  EXPECT_TRUE(contains(warning_of(text), "'weather' is unknown"));
}

TEST(VisibleSim, unknown_attributes_are_kept_and_warned_of_once_per_name) {
  const std::string text = world(
      "<block position=\"0,0,0\" master=\"1\" mood=\"good\"/>"
      "<block position=\"1,0,0\" mood=\"bad\" id=\"3\" solver=\"1\" stabilityCheck=\"x\"/>");
  EXPECT_EQ(read(text).document.modules[1].attributes,
            (Attributes{{"mood", "bad"}, {"id", "3"}, {"solver", "1"}, {"stabilityCheck", "x"}}));
  EXPECT_EQ(warning_of(text),
            "module (0,0,0): the attribute 'mood' is unknown and kept (2 times, first here)");
}

TEST(VisibleSim, text_between_elements_is_warned_of_with_its_line) {
  EXPECT_TRUE(
      contains(warning_of("<parameters/>\n<world>\nhello<blockList/></world>"), "line 2: "));
}

TEST(VisibleSim, our_own_element_holds_what_visiblesim_has_no_word_for) {
  const ReadDocument result =
      read(world("",
                 "<holdfast name=\"n\" description=\"a&#10;b\" gravity_m_s2=\"1.62\" "
                 "strength_vertical_n=\"11\" strength_lateral_n=\"12\" computed=\"gridSize\">"
                 "<knownAnswer verdict=\"unstable\" margin_mm=\"-8\" source=\"s\"/>"
                 "</holdfast>"));
  EXPECT_TRUE(result.warnings.empty());
  Document expected;
  expected.name = "n";
  expected.description = "a\nb";
  expected.material.gravity_m_s2 = 1.62;
  expected.material.strength_vertical_n = 11;
  expected.material.strength_lateral_n = 12;
  expected.known_answer = KnownAnswer{"unstable", -8.0, std::nullopt, "s"};
  EXPECT_EQ(result.document, expected);
}

/// One of every attribute and element that VisibleSim's reader asks for or its examples have: none
/// is called a slip of another.
TEST(VisibleSim, knows_every_name_of_visiblesim) {
  const std::string text =
      "<visuals windowSize=\"1,1\" showGrid=\"1\"/><vm serverport=\"1\"/>"
      "<parameters nofIterations=\"1\" preconditioner=\"1\" E=\"100\" a=\"40\" A=\"1600\" "
      "globalL=\"40\" globalI=\"1\" globalIy=\"1\" globalIz=\"1\" globalJ=\"1\" globalNu=\"0.3\" "
      "globalMu=\"1\" globalBeta=\"1\" globalOmega=\"1\" globalEps=\"1\" globalGamma=\"0.001\" "
      "globalMass=\"1\" globalSupportZ=\"0\"/>"
      "<world gridSize=\"9,9,9\" windowSize=\"1,1\" maxSimulationTime=\"1\" "
      "separatorPlane=\"1\"><camera/><spotlight/><customization/><capabilities/><targetGrid/>"
      "<trash/><blockList blockSize=\"1,1,1\" color=\"1,1,1\" size=\"1\" "
      "ids=\"MANUAL\" idseed=\"1\" seed=\"1\" step=\"1\" format=\"1\">"
      "<block position=\"0,0,0\" color=\"1,1,1\" fixed=\"1\" centroid=\"1\" solver=\"1\" "
      "stabilityCheck=\"1\" id=\"1\" master=\"1\" leader=\"1\" alive=\"1\" angle=\"1\" "
      "orientation=\"1\" rotation=\"1\" isTarget=\"1\" isWall=\"1\"/>"
      "<blocksLine line=\"1\" plane=\"0\" values=\"10\" color=\"1,1,1\" isTarget=\"1\"/>"
      "<blockBox boxOrigin=\"2,2,2\" boxSize=\"0,0,0\" color=\"1,1,1\"/></blockList>"
      "<targetList><target format=\"grid\"><cell position=\"3,3,3\" color=\"1,1,1\"/>"
      "<targetLine line=\"4\" plane=\"4\" values=\"1\"/></target><target format=\"csg\"/>"
      "<target format=\"relativeGrid\"/><target format=\"surface\"/></targetList></world>";
  const ReadDocument result = read(text);
  EXPECT_EQ(result.document.modules.front().attributes.size(), 12U);
  EXPECT_FALSE(contains(warning_of(text), "did you mean"));
}

TEST(VisibleSim, names_that_look_like_known_ones_are_errors) {
  const auto refused = [](const std::string& text, const std::string& meant) {
    const auto result = read_visiblesim(text);
    EXPECT_FALSE(result) << text;
    EXPECT_TRUE(contains(result ? "" : result.error().message, "did you mean '" + meant + "'?"))
        << text;
  };
  const std::string block = "<block position=\"0,0,0\"/>";
  refused("<parameters gobalMass=\"1\"/><world><blockList/></world>", "globalMass");
  refused("<parameter/><world><blockList/></world>", "parameters");
  refused(world("<block position=\"0,0,0\" fixd=\"1\"/>"), "fixed");
  refused(world("<block position=\"0,0,0\" colour=\"1,1,1\"/>"), "color");
  refused(world("<blok position=\"0,0,0\"/>"), "block");
  refused(world("<blockLine values=\"1\"/>"), "blocksLine");
  refused(world("<blocksLine values=\"1\" plan=\"2\"/>"), "plane");
  refused(world("<blockBox boxorign=\"0,0,0\"/>"), "boxOrigin");
  refused(world(block, "<targetlst/>"), "targetList");
  refused(world(block, "<targetList><targt/></targetList>"), "target");
  refused(world(block, "<targetList><target format=\"Grid\"/></targetList>"), "grid");
  refused(world(block, "<targetList><target format=\"grid\"><cel/></target></targetList>"), "cell");
  refused(world(block, "<holdfast gravity=\"1\"/>"), "gravity_m_s2");
}

}  // namespace
}  // namespace holdfast::io
