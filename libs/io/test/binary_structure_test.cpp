// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A binary structure makes the same robot as the document that it was written of, its modules lie
// along the Morton curve, and no byte of it can be changed or cut off unnoticed.
#include "holdfast/io/binary_structure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include "document_support.hpp"

namespace holdfast::io {
namespace {

using base::Cell;

constexpr std::string_view kCubes = R"({"format": "holdfast-structure", "version": 2,
  "name": "mixed", "support_z": -1, "kinds": {"battery": {"mass_kg": 0.2}},
  "obstacles": [{"cells": [[4,0,0]]}],
  "modules": [{"cell": [2,-1,-1], "mass_kg": 0.3}, [1,-1,-1], {"cell": [0,-1,-1], "fixed": true},
              [0,-1,0], {"cell": [0,-1,1], "kind": "battery"}, [0,0,1]],
  "planned": [{"cell": [0,1,1], "kind": "battery", "mass_kg": 0.4}, [0,1,0]]})";

constexpr std::string_view kBalls = R"({"format": "holdfast-structure", "version": 2,
  "lattice": "face-centred", "modules": [[0,0,0],[1,0,0],[2,0,0],[0,1,0],[1,1,0],[0,0,1],
  [1,1,1]]})";

Document document_of(std::string_view text) {
  return document_test::accepted(read_document(text)).document;
}

std::string binary(const Document& document) {
  std::ostringstream out;
  write_binary(out, make_binary(document).value());
  return out.str();
}

/// The parts of a robot, in no order.
auto content(const Document& document) {
  const model::RobotSpec spec = make_spec(document).value();
  std::set<std::tuple<Cell, int>> kinds;
  std::set<std::tuple<Cell, double>> masses;
  for (const model::OwnKind& own : spec.own_kinds) {
    kinds.emplace(own.cell, own.kind);
  }
  for (const model::OwnMass& own : spec.own_masses) {
    masses.emplace(own.cell, own.mass_kg);
  }
  const auto set_of = [](const std::vector<Cell>& cells) {
    return std::set<Cell>(cells.begin(), cells.end());
  };
  return std::tuple(set_of(spec.existing), set_of(spec.planned), set_of(spec.fixed), kinds, masses,
                    spec.support_z, spec.obstacles.size(), spec.kinds.size());
}

TEST(BinaryStructure, makes_the_same_robot) {
  for (const std::string_view text : {kCubes, kBalls}) {
    const Document document = document_of(text);
    const Document back = document_test::accepted(read_document(binary(document))).document;
    EXPECT_EQ(content(back), content(document));
    EXPECT_EQ(back.name, document.name);
    EXPECT_EQ(back.extension.lattice, document.extension.lattice);
    const auto modules = [&](const Document& one) {
      return binary(one).substr(binary(one).size() - make_binary(document).value().records.size() *
                                                         sizeof(ModuleRecord));
    };
    EXPECT_EQ(modules(back), modules(document));
  }
}

/// The bits of the coordinates in turns, one at a time.
std::uint64_t key_by_bits(const Cell& cell, const Cell& low) {
  std::uint64_t key = 0;
  for (unsigned bit = 0; bit < 21; ++bit) {
    const std::array<std::int32_t, 3> from_low = {cell.x - low.x, cell.y - low.y, cell.z - low.z};
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto value = static_cast<std::uint64_t>(from_low[axis]);
      key |= (value >> bit & 1U) << (3 * bit + axis);
    }
  }
  return key;
}

TEST(BinaryStructure, has_its_modules_along_the_morton_curve) {
  const BinaryStructure structure = make_binary(document_of(kCubes)).value();
  EXPECT_EQ(structure.low, (Cell{0, -1, -1}));
  std::vector<std::uint64_t> keys;
  for (const ModuleRecord& record : structure.records) {
    keys.push_back(key_by_bits(record.place(), structure.low));
  }
  EXPECT_EQ(keys.size(), 8U);
  EXPECT_TRUE(std::ranges::is_sorted(keys));
}

TEST(BinaryStructure, is_refused_where_any_byte_is_changed) {
  const std::string whole = binary(document_of(kCubes));
  ASSERT_TRUE(read_binary(whole));
  const std::size_t text_end =
      sizeof(BinaryHead) + make_binary(document_of(kCubes)).value().text.size();
  const std::size_t records = whole.size() - 8 * sizeof(ModuleRecord);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (i >= text_end && i < records) {
      continue;  // Zeros that fill up to 16 bytes.
    }
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 1);
    EXPECT_FALSE(read_binary(changed)) << "byte " << i;
  }
}

TEST(BinaryStructure, is_refused_where_it_is_cut_and_says_at_which_byte) {
  const std::string whole = binary(document_of(kBalls));
  for (std::size_t size = kBinaryMagic.size(); size < whole.size(); ++size) {
    const auto read = read_document(whole.substr(0, size));
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(read.error().where, "byte " + std::to_string(size));
  }
  EXPECT_FALSE(read_document(whole + "x"));
}

TEST(BinaryStructure, is_refused_with_modules_out_of_order_twice_or_unknown_flags) {
  const BinaryStructure good = make_binary(document_of(kCubes)).value();
  const auto message_after = [&](const auto& change) {
    BinaryStructure bad = good;
    change(bad.records);
    std::ostringstream out;
    write_binary(out, bad);  // With the right checksums.
    const auto read = read_binary(out.str());
    return read ? std::string() : read.error().message;
  };
  const std::string place = "it is there twice, or not in its place along the curve";
  EXPECT_NE(message_after([](auto& records) { std::swap(records[2], records[3]); }).find(place),
            std::string::npos);
  EXPECT_NE(message_after([](auto& records) { records[2] = records[1]; }).find(place),
            std::string::npos);
  EXPECT_NE(message_after([](auto& records) { records[2].flags = 3; }).find("flags"),
            std::string::npos);
  EXPECT_NE(message_after([](auto& records) { records[0].cell[2] = -2; }).find("low corner"),
            std::string::npos);
  EXPECT_NE(message_after([](auto& records) { records.pop_back(); }).find("not there"),
            std::string::npos);
}

/// A structure that lies, with all checksums right: what its text says of modules has to be of
/// those behind it, and it has no steps.
TEST(BinaryStructure, is_refused_where_its_text_has_other_modules) {
  const BinaryStructure good = make_binary(document_of(kCubes)).value();
  const std::string modules = "\"modules\": [";
  const std::size_t key = good.text.find(modules);
  ASSERT_NE(key, std::string::npos);
  const auto is_read_with = [&](std::size_t place, const std::string& more) {
    BinaryStructure bad = good;
    bad.text.insert(place, more + ", ");
    std::ostringstream out;
    write_binary(out, bad);
    return static_cast<bool>(read_binary(out.str()));
  };
  const auto names = [&](const std::string& more) {
    return is_read_with(key + modules.size(), more);
  };
  EXPECT_TRUE(names("[1,-1,-1]"));
  EXPECT_FALSE(names("[9,9,9]"));
  EXPECT_FALSE(names("[0,0,1], [0,0,1]"));
  EXPECT_FALSE(names(R"({"cell": [2,-1,-1], "mass_kg": 9})"));
  const auto has = [&](const std::string& more) { return is_read_with(key, more); };
  EXPECT_TRUE(has(R"("description": "the same")"));
  EXPECT_FALSE(has(R"("planned": [[0,2,1]])"));
  EXPECT_FALSE(has(R"("planned": [{"cell": [0,2,1], "mass_kg": 9}])"));
  EXPECT_FALSE(has(R"("later_steps": [[{"cell": [0,2,1], "kind": "battery"}]])"));
  EXPECT_FALSE(has(R"("steps": [{"detach": [[0,0,1]]}])"));
}

TEST(BinaryStructure, is_refused_with_cells_and_corners_outside_the_lattice) {
  constexpr std::int32_t kFar = std::numeric_limits<std::int32_t>::max();
  for (const std::string_view text : {kCubes, kBalls}) {
    const auto is_read = [&](const auto& change) {
      BinaryStructure bad = make_binary(document_of(text)).value();
      change(bad);
      std::ostringstream out;
      write_binary(out, bad);
      return static_cast<bool>(read_binary(out.str()));
    };
    EXPECT_TRUE(is_read([](BinaryStructure& /*same*/) {}));
    EXPECT_FALSE(is_read([](BinaryStructure& bad) {
      bad.records.back().cell = {kFar, kFar, kFar};
    }));
    EXPECT_FALSE(is_read([](BinaryStructure& bad) { bad.low = {-kFar, -kFar, -kFar}; }));
  }
}

TEST(BinaryStructure, leaves_loads_out_with_the_modules_that_they_are_on) {
  const Document document = document_of(R"({"format": "holdfast-structure", "version": 2,
      "modules": [[0,0,0]], "planned": [[1,0,0]], "steps": [{"attach": [[3,0,0]]}],
      "loads": [{"cell": [1,0,0], "force_n": [0,0,-2]}, {"cell": [3,0,0], "force_n": [0,0,-4]}]})");
  const Document back = document_test::accepted(read_document(binary(document))).document;
  ASSERT_EQ(back.extension.payloads.size(), 1U);
  EXPECT_EQ(back.extension.payloads[0].force_n[2], -2);
  EXPECT_TRUE(make_robot(back));
}

TEST(BinaryStructure, says_what_it_has_no_room_for) {
  Document document = document_of(kBalls);
  EXPECT_TRUE(lost_in_binary(document).empty());
  document.modules[1].color = Color{1, 2, 3};
  document.description = "round";
  document.extension.plan.emplace_back();
  EXPECT_EQ(lost_in_binary(document).size(), 3U);
}

}  // namespace
}  // namespace holdfast::io
