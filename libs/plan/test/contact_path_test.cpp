// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0

// Paths over contact states end where states prescribe themselves, and nowhere else.

#include <gtest/gtest.h>

#include "equilibria/changed_robot.hpp"

namespace holdfast::plan {
namespace {

/// The states of one facet by their codes: what each prescribes; a negative code is not certain.
std::optional<int> end_of_path(const std::vector<int>& prescribed, std::size_t step_max) {
  const auto settled =
      settled_states({mechanics::ContactState::from_code(0)}, step_max,
                     [&](const ContactStates& states) -> std::optional<ContactStates> {
                       const int code = prescribed[base::at(states.front().code())];
                       if (code < 0) {
                         return std::nullopt;
                       }
                       return ContactStates{mechanics::ContactState::from_code(code)};
                     });
  return settled ? std::optional(settled->front().code()) : std::nullopt;
}

TEST(ContactPath, ends_where_states_prescribe_themselves) {
  EXPECT_EQ(end_of_path({0}, 5), 0);
  EXPECT_EQ(end_of_path({2, 3, 1, 3}, 5), 3);
}

TEST(ContactPath, has_no_end_where_it_comes_back_is_too_long_or_cannot_be_told) {
  EXPECT_FALSE(end_of_path({1, 2, 1}, 100));
  EXPECT_FALSE(end_of_path({1, 0}, 100));
  EXPECT_FALSE(end_of_path({1, 2, 3, 4, 4}, 4));
  EXPECT_EQ(end_of_path({1, 2, 3, 4, 4}, 5), 4);
  EXPECT_FALSE(end_of_path({1, -1}, 5));
}

}  // namespace
}  // namespace holdfast::plan
