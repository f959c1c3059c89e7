// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What the block code's options mean; the numbers are those of the texts.
#include "settings.hpp"

#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace holdfast::visiblesim {
namespace {

TEST(Settings, take_changes_with_their_times_in_microseconds) {
  Settings settings;
  EXPECT_FALSE(settings.take('K', "12@0.5"));
  EXPECT_FALSE(settings.take('A', "3,-1,20@2"));
  ASSERT_EQ(settings.changes.size(), 2U);
  EXPECT_EQ(settings.changes[0].kind, Change::Kind::kKill);
  EXPECT_EQ(settings.changes[0].id, 12U);
  EXPECT_EQ(settings.changes[0].at, 500'000U);
  EXPECT_EQ(settings.changes[1].kind, Change::Kind::kAttach);
  EXPECT_EQ(settings.changes[1].cell, (base::Cell{3, -1, 20}));
  EXPECT_EQ(settings.changes[1].at, 2'000'000U);
}

TEST(Settings, take_method_and_computing_time_and_keep_the_lines_of_version_1) {
  Settings settings;
  EXPECT_FALSE(settings.take('M', "polynomial"));
  EXPECT_FALSE(settings.take('C', "1500"));
  EXPECT_EQ(settings.simulation.method, agent::Method::kPolynomial);
  EXPECT_EQ(settings.simulation.link.compute_time, 1500U);
  EXPECT_EQ(settings.simulation.link.packet_bytes, 17);
}

TEST(Settings, refuse_what_is_no_value_and_say_what_is) {
  constexpr std::array<std::pair<char, const char*>, 12> kWrong = {{{'K', "12"},
                                                                    {'K', "@1"},
                                                                    {'K', "0@1"},
                                                                    {'T', "1,2,3@1"},
                                                                    {'D', "1@-1"},
                                                                    {'D', "1@nan"},
                                                                    {'A', "1,2@1"},
                                                                    {'A', "1,2,3,4@1"},
                                                                    {'P', "1,2,x@1"},
                                                                    {'C', "1e3"},
                                                                    {'M', "magic"},
                                                                    {'J', ""}}};
  for (const auto& [letter, value] : kWrong) {
    Settings settings;
    const auto error = settings.take(letter, value);
    ASSERT_TRUE(error) << letter << ' ' << value;
    EXPECT_NE(error->find("expected"), std::string::npos) << *error;
    EXPECT_TRUE(settings.changes.empty());
  }
}

TEST(Settings, have_a_line_of_help_for_every_letter) {
  for (const char letter : kOptionLetters) {
    EXPECT_NE(option_help().find(std::string("-") + letter + " "), std::string_view::npos);
    const auto error = Settings{}.take(letter, "?");
    EXPECT_TRUE(!error || error->find("no option") == std::string::npos);
  }
  EXPECT_TRUE(Settings{}.take('Z', "1"));
}

}  // namespace
}  // namespace holdfast::visiblesim
