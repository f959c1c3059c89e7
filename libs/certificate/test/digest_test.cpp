// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The digest of a robot. SHA-256's values are those of FIPS 180-4's examples; what is put into it
// is written here once more by hand. It knows the robot, and nothing of how it is told or proved.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "holdfast/certificate/certificate.hpp"
#include "sha256.hpp"

namespace holdfast::certificate {
namespace {

Certificate post_with_arm() {
  Certificate made;
  made.name = "post";
  made.law = Law::kRegularised;
  made.material = {.pitch = 40,
                   .facet = 30,
                   .area = 1600,
                   .moment_x = 213333,
                   .moment_y = 213334,
                   .torsion = 360000,
                   .poisson = 0.25,
                   .mass = 0.0625,
                   .gravity = 9.75,
                   .strength_vertical = 12,
                   .strength_lateral = 16,
                   .gamma = 0.125};
  for (const std::array<std::int32_t, 3> cell :
       {std::array{0, 0, 0}, std::array{-1, 0, 0}, std::array{0, 0, 1}, std::array{1, 0, 1}}) {
    made.modules.push_back({.cell = cell, .is_fixed = cell[0] < 0, .state = {}});
  }
  made.planned_count = 1;
  made.bits = 8;
  made.fields = {Field(4)};
  return made;
}

TEST(Sha256, gives_the_values_of_the_standard) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Digest, is_of_material_support_and_sorted_modules) {
  EXPECT_EQ(digest(post_with_arm()),
            sha256("pitch_mm 40\nfacet_mm 30\nsection_area_mm2 1600\nmoment_x_mm4 213333\n"
                   "moment_y_mm4 213334\ntorsion_mm4 360000\npoisson_ratio 0.25\nmass_kg 0.0625\n"
                   "gravity_m_s2 9.75\nstrength_vertical_n 12\nstrength_lateral_n 16\n"
                   "contact_gamma 0.125\nsupport_z 0\n-1 0 0 fixed existing\n"
                   "0 0 0 ground existing\n0 0 1 free existing\n1 0 1 free planned\n"));
}

TEST(Digest, is_of_the_robot_however_it_is_told_and_proved) {
  const std::string known = digest(post_with_arm());
  Certificate other = post_with_arm();
  std::swap(other.modules[0], other.modules[2]);
  other.name = "other";
  other.law = Law::kUnilateral;
  other.modules[2].state = {.is_pressed = true, .tilt_x = 1};
  other.fields = {Field(4), Field(4)};
  other.bits = 64;
  EXPECT_EQ(digest(other), known);
  EXPECT_EQ(digest(read(write(other)).certificate), known);
}

/// Every number by its last bit, every module by one cell, by being fixed, by being planned.
TEST(Digest, is_another_for_every_other_robot) {
  std::vector<Certificate> robots = {post_with_arm()};
  for (double Material::*number :
       {&Material::pitch, &Material::facet, &Material::area, &Material::moment_x,
        &Material::moment_y, &Material::torsion, &Material::poisson, &Material::mass,
        &Material::gravity, &Material::strength_vertical, &Material::strength_lateral,
        &Material::gamma}) {
    double& changed = robots.emplace_back(post_with_arm()).material.*number;
    changed *= 1 + 2.3e-16;
  }
  robots.emplace_back(post_with_arm()).support_z = 1;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      robots.emplace_back(post_with_arm()).modules[i].cell[axis] += 5;
    }
    Module& module = robots.emplace_back(post_with_arm()).modules[i];
    module.is_fixed = !module.is_fixed;
  }
  for (const std::size_t planned_count : {0U, 2U, 3U}) {
    robots.emplace_back(post_with_arm()).planned_count = planned_count;
  }
  robots.emplace_back(post_with_arm()).modules.push_back({.cell = {2, 0, 1}, .state = {}});
  std::set<std::string> digests;
  for (const Certificate& robot : robots) {
    digests.insert(digest(robot));
    EXPECT_EQ(digest(read(write(robot)).certificate), digest(robot));
  }
  EXPECT_EQ(digests.size(), robots.size());
}

TEST(Name, is_one_line_or_refused) {
  for (const std::string name : {"", "an arm on a post",
                                 "Gr\xC3\xB6\xC3\x9F"
                                 "e 7",
                                 " end "}) {
    Certificate made = post_with_arm();
    made.name = name;
    const Reading reading = read(write(made));
    EXPECT_EQ(reading.fault, "") << name;
    EXPECT_EQ(reading.certificate.name, name);
  }
  const std::string text = write(post_with_arm());
  for (const std::string control : {"\x1B[2J", "\t", "\x7F", "\r",
                                    "\xC2\x9B"
                                    "2J"}) {
    std::string changed = text;
    changed.replace(changed.find("robot post"), 10, "robot po" + control + "st");
    EXPECT_NE(read(changed).fault.find("a name without control characters"), std::string::npos);
    Certificate made = post_with_arm();
    made.name = "po" + control + "st";
    EXPECT_EQ(read(write(made)).certificate.name, "") << "what cannot be read is not written";
  }
}

TEST(Words, say_how_many_modules_are_planned) {
  EXPECT_EQ(robot_words("post", 4, 1), "post, 4 modules, 1 of them planned");
  EXPECT_EQ(robot_words("", 1, 0), "without a name, 1 module");
}

}  // namespace
}  // namespace holdfast::certificate
