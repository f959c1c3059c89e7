// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The compiler keeps roundings to single precision. What modules share is rounded to it, and they
// go on with what the others have got, so a rounding that one build loses gives it other packets.
// g++ 12.2 loses them from -O2 on: its vectoriser of straight code makes one conversion of two
// doubles to two floats and one back, correctly, and a later pass takes the two for none (the pass
// forwprop4 of -fdump-tree-all). The expected values are rounded one by one, through a volatile.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>

namespace holdfast::base {
namespace {

template <std::size_t Count>
struct Shared {
  std::array<float, Count> sent{};
  std::array<double, Count> kept{};
};

template <std::size_t Count>
[[gnu::noinline]] void share(const std::array<double, Count>& values, Shared<Count>& shared) {
  for (std::size_t i = 0; i < Count; ++i) {
    shared.sent[i] = static_cast<float>(values[i]);
  }
  for (std::size_t i = 0; i < Count; ++i) {
    shared.kept[i] -= static_cast<double>(shared.sent[i]);
  }
}

template <std::size_t Count>
[[gnu::noinline]] void round_all(std::array<double, Count>& values) {
  for (double& value : values) {
    value = static_cast<double>(static_cast<float>(value));
  }
}

template <std::size_t Count>
void expect_rounded() {
  std::array<double, Count> values{};
  for (std::size_t i = 0; i < Count; ++i) {
    values[i] = static_cast<double>(i + 1) / 3;
  }
  Shared<Count> shared;
  share(values, shared);
  std::array<double, Count> rounded = values;
  round_all(rounded);
  for (std::size_t i = 0; i < Count; ++i) {
    const volatile auto single = static_cast<float>(values[i]);
    EXPECT_EQ(shared.kept[i], -static_cast<double>(single)) << i << " of " << Count;
    EXPECT_EQ(rounded[i], static_cast<double>(single)) << i << " of " << Count;
  }
}

TEST(Rounding, to_single_precision_is_kept_in_loops_of_any_length) {
  expect_rounded<1>();
  expect_rounded<2>();
  expect_rounded<3>();
  expect_rounded<4>();
  expect_rounded<6>();
  expect_rounded<8>();
  expect_rounded<36>();
  expect_rounded<1000>();
}

}  // namespace
}  // namespace holdfast::base
