// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A Result holds a value or an Error, never both; reading the one that is not there is a bug and
// ends the program with file, line and condition.
#include "holdfast/base/result.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace holdfast::base {
namespace {

Result<std::string> failure() {
  return Error{.code = ErrorCode::kUnreadable, .message = "no such file", .where = "a.json"};
}

TEST(Result, holds_a_value) {
  const Result<int> result = 7;
  EXPECT_TRUE(result.has_value());
  EXPECT_TRUE(static_cast<bool>(result));
  EXPECT_EQ(result.value(), 7);
}

TEST(Result, holds_an_error) {
  const Result<std::string> result = failure();
  EXPECT_FALSE(result.has_value());
  EXPECT_FALSE(static_cast<bool>(result));
  EXPECT_EQ(result.error().code, ErrorCode::kUnreadable);
  EXPECT_EQ(result.error().message, "no such file");
  EXPECT_EQ(result.error().where, "a.json");
}

TEST(Result, gives_away_a_value_that_can_only_be_moved) {
  Result<std::unique_ptr<int>> result = std::make_unique<int>(3);
  const std::unique_ptr<int> taken = std::move(result).value();
  ASSERT_NE(taken, nullptr);
  EXPECT_EQ(*taken, 3);
}

TEST(ResultDeathTest, ends_the_program_when_the_missing_side_is_read) {
  const Result<int> good = 1;
  const Result<std::string> bad = failure();
  EXPECT_DEATH_IF_SUPPORTED(static_cast<void>(bad.value()),
                            "result.hpp:[0-9]+: broken check: has_value");
  EXPECT_DEATH_IF_SUPPORTED(static_cast<void>(failure().value()), "broken check: has_value");
  EXPECT_DEATH_IF_SUPPORTED(static_cast<void>(good.error()),
                            "result.hpp:[0-9]+: broken check: !has_value");
}

}  // namespace
}  // namespace holdfast::base
