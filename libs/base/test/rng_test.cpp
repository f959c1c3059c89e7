// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The generator is SplitMix64: its first outputs for the seed 1234567 are the published ones of the
// reference program in C (Vigna, splitmix64.c), so every platform draws the same random robots.
#include "holdfast/base/rng.hpp"

#include <gtest/gtest.h>

#include <array>

namespace holdfast::base {
namespace {

TEST(Rng, gives_the_published_outputs_of_splitmix64) {
  constexpr std::array<std::uint64_t, 5> kPublished = {6457827717110365317U, 3203168211198807973U,
                                                       9817491932198370423U, 4593380528125082431U,
                                                       16408922859458223821U};
  Rng rng(1234567);
  for (const std::uint64_t expected : kPublished) {
    EXPECT_EQ(rng.next(), expected);
  }
}

TEST(Rng, below_is_the_next_output_modulo_the_bound) {
  Rng rng(1234567);
  EXPECT_EQ(rng.below(1000), 317U);
  EXPECT_EQ(rng.below(7), 3203168211198807973U % 7);
  EXPECT_EQ(rng.below(1), 0U);
}

TEST(Rng, below_reaches_every_number_and_never_the_bound) {
  // Chance that 600 fair draws miss one of six numbers: 6 (5/6)^600, below 1e-46.
  std::array<int, 6> count{};
  Rng rng(1);
  for (int i = 0; i < 600; ++i) {
    const std::uint64_t number = rng.below(6);
    ASSERT_LT(number, 6U);
    ++count[number];
  }
  for (const int hits : count) {
    EXPECT_GT(hits, 0);
  }
}

TEST(Rng, repeats_for_a_seed_and_differs_between_seeds) {
  Rng a(42);
  Rng b(42);
  Rng c(43);
  const std::uint64_t first = a.next();
  EXPECT_EQ(first, b.next());
  EXPECT_NE(first, c.next());
}

}  // namespace
}  // namespace holdfast::base
