// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Sets of directions against std::set, over all sets that six (and, in steps, twelve) directions
// have; everything is constexpr.
#include "holdfast/base/faces.hpp"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace holdfast::base {
namespace {

template <class Bits>
std::set<Direction> elements(BasicFaces<Bits> faces) {
  std::set<Direction> result;
  for (int i = 0; i < BasicFaces<Bits>::kDirectionCountMax; ++i) {
    if (faces.has(static_cast<Direction>(i))) {
      result.insert(static_cast<Direction>(i));
    }
  }
  return result;
}

TEST(Faces, have_one_bit_for_every_direction_by_index) {
  static_assert(Faces{Direction::kPlusX, Direction::kMinusZ}.mask() == 0b100001);
  static_assert(Faces::from_mask(0b000110) == Faces{Direction::kMinusX, Direction::kPlusY});
  static_assert(Faces::all().mask() == 0x3f);
  static_assert(Faces::all(8).mask() == 0xff);
  static_assert(WideFaces::all(12).mask() == 0xfff);
  static_assert(WideFaces::all(16).mask() == 0xffff);
  static_assert(Faces{}.is_empty() && Faces{}.mask() == 0);
  EXPECT_EQ(Faces::all().count(), kDirectionCount);
}

TEST(Faces, are_walked_through_by_ascending_index) {
  for (unsigned mask = 0; mask < 256; ++mask) {
    const Faces faces = Faces::from_mask(static_cast<std::uint8_t>(mask));
    std::vector<Direction> walked;
    for (const Direction direction : faces) {
      walked.push_back(direction);
    }
    const std::set<Direction> expected = elements(faces);
    EXPECT_TRUE(std::equal(walked.begin(), walked.end(), expected.begin(), expected.end()));
    EXPECT_EQ(faces.count(), static_cast<int>(expected.size()));
    EXPECT_EQ(faces.is_empty(), expected.empty());
  }
}

TEST(Faces, may_change_while_they_are_walked_through) {
  Faces faces = Faces::all();
  int walked = 0;
  for (const Direction direction : faces) {
    faces.remove(opposite(direction));
    ++walked;
  }
  EXPECT_EQ(walked, 6);
  EXPECT_TRUE(faces.is_empty());
}

TEST(Faces, gain_and_lose_single_directions) {
  Faces faces;
  faces.add(Direction::kPlusY);
  faces.add(Direction::kPlusY);
  faces.set(Direction::kMinusZ, true);
  EXPECT_EQ(faces, (Faces{Direction::kPlusY, Direction::kMinusZ}));
  faces.set(Direction::kPlusY, false);
  faces.remove(Direction::kPlusX);  // Was no element.
  EXPECT_EQ(faces, Faces{Direction::kMinusZ});
  EXPECT_EQ(faces.first(), Direction::kMinusZ);
}

TEST(Faces, unite_intersect_and_subtract_as_sets_do) {
  for (unsigned a = 0; a < 64; ++a) {
    for (unsigned b = 0; b < 64; ++b) {
      const Faces first = Faces::from_mask(static_cast<std::uint8_t>(a));
      const Faces second = Faces::from_mask(static_cast<std::uint8_t>(b));
      Faces united = first;
      Faces common = first;
      Faces rest = first;
      united |= second;
      common &= second;
      rest -= second;
      for (const Direction direction : kDirections) {
        const bool is_first = first.has(direction);
        const bool is_second = second.has(direction);
        EXPECT_EQ(united.has(direction), is_first || is_second);
        EXPECT_EQ(common.has(direction), is_first && is_second);
        EXPECT_EQ(rest.has(direction), is_first && !is_second);
      }
    }
  }
}

TEST(Faces, turn_into_the_opposite_ones_in_any_width) {
  for (unsigned mask = 0; mask < 0x1000; ++mask) {
    const WideFaces faces = WideFaces::from_mask(static_cast<std::uint16_t>(mask));
    std::set<Direction> expected;
    for (const Direction direction : faces) {
      expected.insert(opposite(direction));
    }
    ASSERT_EQ(elements(faces.opposite()), expected) << mask;
    ASSERT_EQ(faces.opposite().opposite(), faces) << mask;
  }
  static_assert(Faces{Direction::kPlusX}.opposite() == Faces{Direction::kMinusX});
  static_assert(WideFaces::from_mask(0x8000).opposite() == WideFaces::from_mask(0x4000));
}

}  // namespace
}  // namespace holdfast::base
