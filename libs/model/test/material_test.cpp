// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The default material is Blinky Blocks, Table I of [Piranda 2021]; and no parameter that would
// spoil the arithmetic gets past the check, which names it with the value and the range.
#include "holdfast/model/material.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace holdfast::model {
namespace {

struct Parameter {
  const char* name;
  double Material::*member;
  const char* lowest;
  double good;  ///< An allowed value other than the default.
};

constexpr const char* kTiny = "1e-12";

constexpr Parameter kParameters[] = {
    {"elastic_modulus_mpa", &Material::elastic_modulus_mpa, kTiny, 2e5},
    {"pitch_mm", &Material::pitch_mm, kTiny, 1},
    {"facet_mm", &Material::facet_mm, kTiny, 39},
    {"section_area_mm2", &Material::section_area_mm2, kTiny, 100},
    {"moment_x_mm4", &Material::moment_x_mm4, kTiny, 1e-3},
    {"moment_y_mm4", &Material::moment_y_mm4, kTiny, 1e9},
    {"torsion_mm4", &Material::torsion_mm4, kTiny, 5},
    {"poisson_ratio", &Material::poisson_ratio, "-0.99", 0},
    {"mass_kg", &Material::mass_kg, kTiny, 1e-6},
    {"gravity_m_s2", &Material::gravity_m_s2, kTiny, 1.62},
    {"strength_vertical_n", &Material::strength_vertical_n, kTiny, 1e3},
    {"strength_lateral_n", &Material::strength_lateral_n, kTiny, 0.1},
    {"contact_gamma", &Material::contact_gamma, "1e-09", 1e-6},
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

Material with(const Parameter& parameter, double value) {
  Material material;
  material.*parameter.member = value;
  return material;
}

void expect_fault(const Parameter& parameter, double value, const std::string& value_text) {
  const auto fault = find_material_fault(with(parameter, value));
  ASSERT_TRUE(fault) << parameter.name << " = " << value_text;
  EXPECT_TRUE(contains(*fault, parameter.name)) << *fault;
  EXPECT_TRUE(contains(*fault, " is " + value_text + ",")) << *fault;
  EXPECT_TRUE(contains(*fault, "expected " + std::string(parameter.lowest) + " to ")) << *fault;
}

TEST(Material, is_that_of_table_1) {
  const Material material;
  const auto section = beam_section(material);
  const double l4 = 40.0 * 40.0 * 40.0 * 40.0;
  EXPECT_EQ(section.elastic_modulus, 100);
  EXPECT_EQ(section.length, 40);
  EXPECT_EQ(material.facet_mm, 40);
  EXPECT_EQ(section.area, 1600);
  EXPECT_DOUBLE_EQ(section.moment_x, l4 / 12);
  EXPECT_DOUBLE_EQ(section.moment_y, l4 / 12);
  EXPECT_DOUBLE_EQ(section.torsion, 2.25 * l4 / 41.6);
  EXPECT_EQ(material.strength_vertical_n, 11.98);
  EXPECT_EQ(material.strength_lateral_n, 14.97);
  EXPECT_EQ(material.contact_gamma, 1e-4);
  EXPECT_DOUBLE_EQ(module_weight_n(material), 9.81 * 0.06106);
  EXPECT_EQ(find_material_fault(material), std::nullopt);
}

/// Jv = J / (2 (1 + nu)): with nu = 0.25 the torsion constant is divided by 2.5.
TEST(Material, reaches_the_beam_parameter_by_parameter) {
  Material material;
  material.elastic_modulus_mpa = 3;
  material.pitch_mm = 5;
  material.facet_mm = 4;
  material.section_area_mm2 = 7;
  material.moment_x_mm4 = 11;
  material.moment_y_mm4 = 13;
  material.torsion_mm4 = 10;
  material.poisson_ratio = 0.25;
  const auto section = beam_section(material);
  EXPECT_EQ(section.elastic_modulus, 3);
  EXPECT_EQ(section.length, 5);
  EXPECT_EQ(section.area, 7);
  EXPECT_EQ(section.moment_x, 11);
  EXPECT_EQ(section.moment_y, 13);
  EXPECT_EQ(section.torsion, 4);
}

TEST(Material, has_a_parameter_for_each_key_and_for_no_other) {
  EXPECT_EQ(find_parameter("mass_kg")->value, &Material::mass_kg);
  EXPECT_EQ(find_parameter("contact_gamma")->value, &Material::contact_gamma);
  for (const char* const other : {"", "mass", "mass_kgs", "Mass_kg"}) {
    EXPECT_EQ(find_parameter(other), nullptr) << other;
  }
}

TEST(Material, accepts_any_reasonable_value) {
  for (const Parameter& parameter : kParameters) {
    EXPECT_EQ(find_material_fault(with(parameter, parameter.good)), std::nullopt);
  }
}

TEST(Material, reports_a_bad_value_with_name_value_and_range) {
  for (const Parameter& parameter : kParameters) {
    expect_fault(parameter, -1, "-1");
    expect_fault(parameter, std::numeric_limits<double>::quiet_NaN(), "nan");
    expect_fault(parameter, std::numeric_limits<double>::infinity(), "inf");
    expect_fault(parameter, -std::numeric_limits<double>::infinity(), "-inf");
    expect_fault(parameter, 1e300, "1e+300");
  }
}

/// A Poisson ratio of zero is a real material (cork); nothing else may vanish.
TEST(Material, reports_zero_for_all_but_the_poisson_ratio) {
  for (const Parameter& parameter : kParameters) {
    if (parameter.member != &Material::poisson_ratio) {
      expect_fault(parameter, 0, "0");
    }
  }
}

/// Beyond one half a material would gain volume under pressure; the weak spring must stay weak.
TEST(Material, bounds_poisson_ratio_and_gamma) {
  const Parameter& poisson = kParameters[7];
  EXPECT_EQ(find_material_fault(with(poisson, 0.5)), std::nullopt);
  EXPECT_EQ(find_material_fault(with(poisson, -0.5)), std::nullopt);
  expect_fault(poisson, 0.51, "0.51");
  const Parameter& gamma = kParameters[12];
  EXPECT_EQ(find_material_fault(with(gamma, 0.1)), std::nullopt);
  expect_fault(gamma, 0.2, "0.2");
}

}  // namespace
}  // namespace holdfast::model
