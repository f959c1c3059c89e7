// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "campaign.hpp"

namespace holdfast::test {

/// The right verdict at every module, and every load ratio within 0.01 + 1 %.
inline void expect_right(const Comparison& comparison) {
  EXPECT_FALSE(comparison.is_wrong()) << comparison.text();
  EXPECT_FALSE(comparison.is_undecided()) << comparison.text();
  EXPECT_TRUE(comparison.result.all_agree) << comparison.text();
  EXPECT_LT(comparison.ratio_error(), 1) << comparison.text();
}

}  // namespace holdfast::test
