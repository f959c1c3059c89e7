// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "holdfast/large/follow.hpp"

namespace holdfast::large {
namespace {

TEST(follow, compiles) {}

}  // namespace
}  // namespace holdfast::large
