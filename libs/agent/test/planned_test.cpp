// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Who emulates planned modules. Robots of a few modules with trees drawn by hand; the test plays
// the sweep: masks go up the tree, their union comes down. Expected hosts are the lowest common
// ancestors of the participants, read off the drawings.
#include "holdfast/agent/groups/planned.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace holdfast::agent {
namespace {

using base::Cell;
using base::Direction;

/// A module: its cell, and the face of its parent; the first one is the root and has none.
struct Member {
  Cell cell;
  Direction parent_face = Direction::kPlusX;
};

constexpr Direction kPlusX = Direction::kPlusX;
constexpr Direction kMinusX = Direction::kMinusX;
constexpr Direction kMinusY = Direction::kMinusY;

/// A set of planned modules, as in messages.
unsigned indices(const Planned& part) { return part.from_above().bits(); }

/// Members are listed parents first. Afterwards every module knows its part.
std::vector<Planned> share(const std::vector<Member>& members, const std::vector<Cell>& cells) {
  std::vector<Planned> parts(members.size());
  PlannedMasks totals{};
  for (std::size_t k = 0; k < cells.size(); ++k) {
    for (std::size_t i = members.size(); i-- > 0;) {
      parts[i].add(cells[k], members[i].cell);
    }
    // All have learned the cell; masks come up, deepest first.
    for (std::size_t i = members.size(); i-- > 1;) {
      const auto face = members[i].parent_face;
      for (std::size_t parent = 0; parent < i; ++parent) {
        if (members[parent].cell == base::neighbour(members[i].cell, face)) {
          parts[parent].add_below(base::opposite(face), static_cast<int>(k),
                                  parts[i].touching(static_cast<int>(k)));
        }
      }
    }
    totals[k] = parts[0].touching(static_cast<int>(k)).mask();
  }
  for (Planned& part : parts) {
    part.decide_hosts(totals);
  }
  return parts;
}

std::vector<int> hosted(const Planned& part) {
  std::vector<int> list;
  for (int i = 0; i < part.hosted_count(); ++i) {
    list.push_back(part.hosted(i));
    EXPECT_EQ(part.node_of(part.hosted(i)), 1 + i);
  }
  return list;
}

using List = std::vector<int>;

/// Root (0,0,0), then a row along x.
const std::vector<Member> kRow = {{{0, 0, 0}}, {{1, 0, 0}, kMinusX}, {{2, 0, 0}, kMinusX}};

/// Root (0,0,0) with two arms, at -x and +x, both bent to +y: a U.
const std::vector<Member> kU = {{{0, 0, 0}},
                                {{-1, 0, 0}, kPlusX},
                                {{1, 0, 0}, kMinusX},
                                {{-1, 1, 0}, kMinusY},
                                {{1, 1, 0}, kMinusY}};

TEST(Planned, a_single_participant_is_the_host) {
  const auto parts = share(kRow, {{2, 0, 1}});
  EXPECT_EQ(hosted(parts[2]), List{0});
  EXPECT_EQ(hosted(parts[1]), List{});
  EXPECT_EQ(hosted(parts[0]), List{});
  EXPECT_EQ(parts[2].own_face(0), Faces{Direction::kPlusZ});
  EXPECT_EQ(parts[2].at_face(Direction::kPlusZ), 0);
  EXPECT_EQ(parts[2].at_face(kPlusX), -1);
  EXPECT_TRUE(parts[1].own_face(0).is_empty());
  EXPECT_EQ(parts[2].total(0), Faces{Direction::kMinusZ});
  for (const Planned& part : parts) {
    EXPECT_EQ(part.count(), 1);
    EXPECT_FALSE(part.is_any_remote());
    EXPECT_EQ(indices(part), 0);
    EXPECT_FALSE(part.is_needed_below(kPlusX, 0));  // The host needs nobody.
  }
}

/// (0,1,0) lies between the arms and on the root: the root is the host, and (1,1,0) and (-1,1,0)
/// hear of it through the arms.
TEST(Planned, the_host_of_two_subtrees_is_their_common_ancestor) {
  const auto parts = share(kU, {{0, 1, 0}});
  EXPECT_EQ(hosted(parts[0]), List{0});
  EXPECT_TRUE(parts[0].is_any_remote());
  EXPECT_TRUE(parts[0].is_needed_below(kPlusX, 0));
  EXPECT_TRUE(parts[0].is_needed_below(kMinusX, 0));
  EXPECT_FALSE(parts[0].is_from_above(0));
  for (std::size_t i = 1; i < parts.size(); ++i) {
    EXPECT_EQ(hosted(parts[i]), List{});
    EXPECT_TRUE(parts[i].is_from_above(0));
    EXPECT_EQ(parts[i].node_of(0), -1);
  }
  EXPECT_EQ(parts[0].total(0), (Faces{Direction::kMinusX, Direction::kPlusX, Direction::kMinusY}));
  EXPECT_TRUE(parts[1].is_needed_below(Direction::kPlusY, 0));
  EXPECT_FALSE(parts[3].is_needed_below(Direction::kPlusY, 0));  // A leaf.
}

/// Three planned modules bridge the ends of the U. The root touches none of them, but it is the
/// only module above both ends.
TEST(Planned, the_host_need_not_touch_what_it_emulates) {
  const auto parts = share(kU, {{-1, 2, 0}, {0, 2, 0}, {1, 2, 0}});
  EXPECT_EQ(hosted(parts[0]), (List{0, 1, 2}));
  EXPECT_TRUE(parts[0].touching(1).is_empty());
  EXPECT_EQ(indices(parts[3]), 1);  // Each end needs what it touches, ...
  EXPECT_EQ(indices(parts[4]), 4);
  EXPECT_TRUE(parts[0].is_needed_below(kMinusX, 0));
  EXPECT_FALSE(parts[0].is_needed_below(kMinusX, 2));  // ... and nothing else.
  EXPECT_FALSE(parts[0].is_needed_below(kMinusX, 1));
}

/// Both lie below one arm: the root, above, has nothing to do with them.
TEST(Planned, the_host_is_the_deepest_common_ancestor) {
  std::vector<Member> members = kU;
  members.push_back({{2, 0, 0}, kMinusX});
  const auto parts = share(members, {{2, 1, 0}});  // Between (1,1,0) and (2,0,0).
  EXPECT_EQ(hosted(parts[2]), List{0});
  EXPECT_TRUE(parts[2].is_any_remote());
  EXPECT_EQ(hosted(parts[0]), List{});
  EXPECT_EQ(indices(parts[0]), 0);
  EXPECT_FALSE(parts[0].is_needed_below(kPlusX, 0));
  EXPECT_TRUE(parts[2].is_needed_below(kPlusX, 0));
  EXPECT_TRUE(parts[2].is_needed_below(Direction::kPlusY, 0));
  EXPECT_TRUE(parts[4].is_from_above(0));
  EXPECT_TRUE(parts[5].is_from_above(0));
  EXPECT_FALSE(parts[1].is_from_above(0));
  EXPECT_FALSE(parts[3].is_from_above(0));
}

/// Node 0 is the module itself, then come those emulated here, then those kept of hosts above.
TEST(Planned, every_module_that_hears_of_a_planned_one_has_a_place_for_it) {
  const auto parts = share(kRow, {{0, 0, 1}, {1, 1, 0}, {2, 0, 1}, {2, 1, 0}});
  EXPECT_EQ(hosted(parts[1]), (List{1, 3}));
  EXPECT_EQ(parts[1].slot_of(1), 1);
  EXPECT_EQ(parts[1].slot_of(3), 2);
  EXPECT_EQ(hosted(parts[2]), List{2});
  EXPECT_EQ(indices(parts[2]), 8);
  EXPECT_EQ(parts[2].slot_of(2), 1);
  EXPECT_EQ(parts[2].slot_of(3), 2);
}

TEST(Planned, a_participant_above_the_other_hosts) {
  const auto parts = share(kRow, {{1, 1, 0}, {2, 1, 0}});
  EXPECT_EQ(hosted(parts[1]), (List{0, 1}));
  EXPECT_EQ(indices(parts[2]), 2);
  EXPECT_TRUE(parts[1].is_needed_below(kPlusX, 1));
  EXPECT_FALSE(parts[1].is_needed_below(kPlusX, 0));
  EXPECT_EQ(hosted(parts[0]), List{});
}

TEST(Planned, a_group_hangs_together_by_one_foot) {
  const auto parts = share(kRow, {{2, 0, 1}, {2, 0, 2}});
  EXPECT_EQ(hosted(parts[2]), (List{0, 1}));
  EXPECT_FALSE(parts[2].is_any_remote());
  EXPECT_TRUE(parts[2].total(1).is_empty());
  EXPECT_EQ(parts[2].neighbour_of(0, Direction::kPlusZ), 1);
  EXPECT_EQ(parts[2].neighbour_of(1, Direction::kMinusZ), 0);
  EXPECT_EQ(parts[2].neighbour_of(1, Direction::kPlusZ), -1);
}

TEST(Planned, groups_have_hosts_of_their_own) {
  const auto parts = share(kRow, {{0, 0, 1}, {2, 0, 1}});
  EXPECT_EQ(hosted(parts[0]), List{0});
  EXPECT_EQ(hosted(parts[2]), List{1});
  EXPECT_FALSE(parts[0].is_any_remote());
  EXPECT_FALSE(parts[0].is_needed_below(kPlusX, 1));
}

TEST(Planned, what_touches_nothing_is_hosted_by_nobody) {
  const auto parts = share(kRow, {{0, 0, 1}, {9, 9, 0}, {9, 9, 1}});
  EXPECT_EQ(hosted(parts[0]), List{0});
  for (std::size_t i = 1; i < parts.size(); ++i) {
    EXPECT_EQ(hosted(parts[i]), List{});
  }
  for (const Planned& part : parts) {
    EXPECT_EQ(part.node_of(1), -1);
    EXPECT_EQ(indices(part), 0);
  }
}

/// The root asks for one more than there may be, as its plan may have ended.
TEST(Planned, one_too_many_is_not_kept) {
  Planned part;
  for (int i = 0; i <= kPlannedMax; ++i) {
    part.add({1, 1, i}, {0, 0, 0});
    part.add_below(kPlusX, i, Faces{Direction::kMinusX});
  }
  EXPECT_EQ(part.count(), kPlannedMax);
  EXPECT_EQ(part.cell(kPlannedMax - 1), (Cell{1, 1, kPlannedMax - 1}));
  EXPECT_EQ(part.touching(kPlannedMax - 1), Faces{Direction::kMinusX});
}

/// There are as many as there may be, in a pile at the end of the row. Only the first touches the
/// robot, the second is at the top, and from there the indices go down: names must travel against
/// them.
TEST(Planned, as_many_as_there_may_be) {
  std::vector<Cell> pile = {{2, 0, 1}};
  List all = {0};
  for (int i = 1; i < kPlannedMax; ++i) {
    pile.push_back({2, 0, kPlannedMax + 1 - i});
    all.push_back(i);
  }
  const auto parts = share(kRow, pile);
  EXPECT_EQ(hosted(parts[2]), all);
  EXPECT_EQ(parts[2].at_face(Direction::kPlusZ), 0);
}

TEST(Planned, clear_forgets_everything) {
  auto parts = share(kRow, {{2, 0, 1}});
  parts[2].clear();
  EXPECT_EQ(parts[2].count(), 0);
  EXPECT_EQ(parts[2].hosted_count(), 0);
  EXPECT_EQ(parts[2].at_face(Direction::kPlusZ), -1);
}

}  // namespace
}  // namespace holdfast::agent
