// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A setting has the effect of the same number in the file: each document that is read with settings
// is compared with one that is read without, of a file that says them.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "document_support.hpp"
#include "holdfast/io/document.hpp"

namespace holdfast::io {
namespace {

using document_test::accepted;

std::string file(std::string_view members) {
  return R"({"format": "holdfast-structure", "version": 2, "modules": [[0,0,0], [0,0,1]], )" +
         std::string(members) + "}";
}

ReadOptions with(std::initializer_list<std::string_view> texts) {
  ReadOptions options;
  for (const std::string_view text : texts) {
    const auto setting = find_setting(text);
    EXPECT_TRUE(setting) << text << ": " << setting.error().message;
    options.settings.push_back(setting.value());
  }
  return options;
}

std::string refusal(std::string_view text) {
  const auto setting = find_setting(text);
  EXPECT_FALSE(setting) << text;
  return setting ? std::string() : setting.error().message;
}

TEST(Setting, of_each_number_of_the_material_is_that_of_a_file) {
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const std::string key(parameter.key);
    const auto set = accepted(
        read_json(file(R"("material": {"mass_kg": 0.1})"), with({key + "=0.05", "mass_kg=0.3"})));
    const std::string said =
        key == "mass_kg" ? R"("mass_kg": 0.3)" : R"("mass_kg": 0.3, ")" + key + R"(": 0.05)";
    EXPECT_EQ(set.document, accepted(read_json(file(R"("material": {)" + said + "}"))).document)
        << key;
  }
}

TEST(Setting, of_a_robot_of_the_catalogue_moves_what_follows_from_it) {
  const auto set = accepted(read_json(file(R"("robot": "rofi")"), with({"pitch_mm=50"})));
  const auto said = accepted(read_json(file(R"("robot": "rofi", "material": {"pitch_mm": 50})")));
  EXPECT_EQ(set.document, said.document);
}

TEST(Setting, of_connectors_replaces_the_value_of_the_file) {
  const std::string own = R"("material": {"shear_strength_n": {"vertical": 1, "lateral": 2}})";
  const auto set = accepted(read_json(file(own), with({"material.shear_strength_n=3"})));
  const auto said = accepted(read_json(file(R"("material": {"shear_strength_n": 3})")));
  EXPECT_EQ(set.document, said.document);
}

TEST(Setting, of_one_strength_is_that_of_both_directions) {
  const std::string both = R"("material": {"strength_vertical_n": 9, "strength_lateral_n": 9})";
  const auto said = accepted(read_json(file(both)));
  for (const char* const own : {R"("material": {"strength_n": 5})", R"("support_z": 0)"}) {
    EXPECT_EQ(accepted(read_json(file(own), with({"strength_n=9"}))).document, said.document)
        << own;
  }
}

TEST(Setting, contradicts_no_file_in_silence) {
  const auto read =
      read_json(file(R"("material": {"strength_n": 5})"), with({"strength_lateral_n=9"}));
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("as the file gives strength_n"), std::string::npos);
}

TEST(Setting, holds_for_files_of_VisibleSim_and_is_named) {
  const std::string xml = R"(<world gridSize="3,3,3"><blockList><block position="1,1,0"/>)"
                          R"(</blockList></world>)";
  const auto set = accepted(read_visiblesim(xml, with({"mass_kg=0.5"})));
  EXPECT_EQ(set.document.material.mass_kg, 0.5);
  EXPECT_NE(std::ranges::find(set.warnings, "mass_kg is set to 0.5 by an option"),
            set.warnings.end());
}

TEST(Setting, is_refused_with_what_is_expected) {
  for (const char* text : {"mass_kg", "mass_kg=1kg", "mass_kg=nan", "mass_kg=", "mass_kg=1,5"}) {
    EXPECT_EQ(refusal(text), "expected KEY=NUMBER, such as strength_lateral_n=12, found '" +
                                 std::string(text) + "'");
  }
  EXPECT_EQ(refusal("mas_kg=1"), "a material has no 'mas_kg'; did you mean 'mass_kg'?");
  EXPECT_EQ(refusal("bending=1").find("a material has no 'bending'; it has strength_n, "), 0U);
  EXPECT_EQ(refusal("bending=1").find("bending,"), std::string::npos) << "it is no number";
  EXPECT_NE(refusal("poisson_ratio=1").find("poisson_ratio is 1"), std::string::npos);
  EXPECT_NE(refusal("gravity_m_s2=-9.81").find("here it is a size"), std::string::npos);
  EXPECT_NE(refusal("friction=0").find("expected a number of 1e-12 and more"), std::string::npos);
}

}  // namespace
}  // namespace holdfast::io
