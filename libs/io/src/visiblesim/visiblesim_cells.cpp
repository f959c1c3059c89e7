// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/visiblesim_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

using Lengths = std::array<double, 3>;

/// The block size of VisibleSim's lattice of Blinky Blocks.
constexpr Lengths kBlockSize = {40, 40, 41};

/// Whether a block is fixed: what is not one of VisibleSim's words for no, in any case, is a yes,
/// with a note if it is no word for that either.
bool is_fixed(XmlReading& reading, const pugi::xml_node& block) {
  const pugi::xml_attribute fixed = block.attribute("fixed");
  std::string lower(trimmed(fixed.value()));
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const bool is_no = !fixed || is_one_of(lower, {"0", "false", "no"});
  if (!is_no && !is_one_of(lower, {"1", "true", "yes"})) {
    reading.warn_at(
        block, fmt::format("fixed of <block> is {}, which counts as yes", excerpt(fixed.value())));
  }
  return !is_no;
}

/// Whether an element has more attributes than its position: most have none, and a search for
/// attributes that are not there takes time.
bool has_more_than_position(const pugi::xml_node& node) {
  return node.first_attribute().next_attribute();
}

/// Reads the attributes of ours for what a module has of its own, if there are any.
void read_own(XmlReading& reading, const pugi::xml_node& node, OwnParameters own) {
  if (!has_more_than_position(node)) {
    return;
  }
  const pugi::xml_attribute kind = node.attribute(kOwnKindAttribute);
  const pugi::xml_attribute mass = node.attribute(kOwnMassAttribute);
  own.kind = kind.value();
  if (own.kind.empty() && !mass) {
    return;
  }
  if (mass) {
    own.mass_kg = reading.number(node, mass);
    if (!(*own.mass_kg > 0)) {
      reading.fail(node, fmt::format("{} of <{}> is {}, expected a positive number",
                                     kOwnMassAttribute, node.name(), excerpt(mass.value())));
    }
  }
  reading.document.extension.own.push_back(std::move(own));
}

ModuleEntry read_block(XmlReading& reading, const pugi::xml_node& block) {
  reading.expect_no_content(block);
  if (has_more_than_position(block) && block.attribute(kDatomAttribute)) {
    reading.fail(block, fmt::format("<block {}> is a datom: {}", kDatomAttribute, kNoDatoms),
                 base::ErrorCode::kUnsupported);
  }
  read_own(reading, block, {0, reading.document.modules.size(), {}, {}});
  return {.cell = reading.cell(block),
          .is_fixed = has_more_than_position(block) && is_fixed(reading, block),
          .color = reading.color(block),
          .attributes = reading.attributes(block, is_module_attribute)};
}

PlannedEntry read_cell(XmlReading& reading, const pugi::xml_node& cell) {
  reading.expect_no_content(cell);
  return {.cell = reading.cell(cell),
          .color = reading.color(cell),
          .attributes = reading.attributes(cell, is_planned_attribute)};
}

/// The orientation of all modules of a row or box, which each of them then has.
Attributes read_orientation(const pugi::xml_node& node) {
  const pugi::xml_attribute attribute = node.attribute(kOrientation);
  return attribute ? Attributes{{kOrientation, attribute.value()}} : Attributes();
}

/// Reads <blocksLine> or <targetLine>: a row along x, one character per cell. A row without a plane
/// lies in that of the row before.
template <class Entry>
void read_row(XmlReading& reading, const pugi::xml_node& row, std::int32_t& plane,
              std::vector<Entry>& entries) {
  reading.expect_no_content(row);
  reading.expect_attributes(row, kRowAttributes);
  const auto coordinate = [&](const char* name, std::int32_t fallback) {
    const pugi::xml_attribute attribute = row.attribute(name);
    return attribute ? reading.integer(row, attribute, kCoordinateRange) : fallback;
  };
  const std::int32_t line = coordinate("line", 0);
  plane = coordinate("plane", plane);
  const std::optional<Color> color = reading.color(row);
  const Attributes orientation = read_orientation(row);
  const char* const text = reading.required(row, "values");
  const std::string_view values = text == nullptr ? "" : text;
  if (values.size() > base::kCoordinateMax + 1U) {
    reading.fail(row, fmt::format("values of <{}> has {} characters, expected at most {}",
                                  row.name(), values.size(), base::kCoordinateMax + 1));
  }
  const auto count = static_cast<std::size_t>(std::ranges::count(values, '1'));
  if (!reading.take_room(count, [&] { return reading.line(row); })) {
    return;
  }
  for (std::int32_t x = 0; const char value : values) {
    if (value == '1') {
      Entry& entry = entries.emplace_back();
      entry.cell = {x, line, plane};
      entry.color = color;
      entry.attributes = orientation;
    } else if (value != '0') {
      reading.warn_at(
          row, fmt::format("in values of <{}>, {} counts as 0", row.name(), excerpt({&value, 1})));
    }
    ++x;
  }
}

/// An attribute of three lengths, or what stands for it where it is missing.
Lengths read_lengths(XmlReading& reading, const pugi::xml_node& node, const char* name,
                     const Lengths& fallback) {
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute) {
    return fallback;
  }
  const auto lengths = parse_triple<double>(attribute.value());
  if (!lengths) {
    reading.fail(node, fmt::format("{} of <{}> is {}, expected three numbers, such as 40,40,41",
                                   name, node.name(), excerpt(attribute.value())));
  }
  return lengths.value_or(fallback);
}

/// Indices of cells along one axis; none if `last` is less than `first`.
struct IndexRange {
  std::int32_t first = 0;
  std::int32_t last = -1;

  bool operator==(const IndexRange&) const = default;

  std::size_t count() const { return static_cast<std::size_t>(std::max(0, last - first + 1)); }
};

/// The cells i with origin <= i * pitch <= end in a grid of `count` cells.
struct Box {
  double origin = 0;
  double end = 0;
  double pitch = 1;

  IndexRange cells(std::int32_t count) const {
    const double first = std::clamp(std::ceil(origin / pitch), 0.0, static_cast<double>(count));
    const double last = std::clamp(std::floor(end / pitch), -1.0, static_cast<double>(count - 1));
    return {static_cast<std::int32_t>(first), static_cast<std::int32_t>(last)};
  }
};

/// VisibleSim counts boxes in mm up to 2022, in cells since, when files came to have the root <vs>.
bool counts_in_cells(const pugi::xml_node& box) {
  return box.parent().parent().parent().name() == std::string_view(kRootElement);
}

/// The cells of a box along the three axes.
struct BoxRanges {
  std::array<IndexRange, 3> axes;

  std::size_t count() const { return axes[0].count() * axes[1].count() * axes[2].count(); }
};

/// The text of <blockBox>, in mm or in cells.
struct BoxText {
  Lengths origin;
  Lengths size;  ///< Infinite where the box reaches the end of the grid.
};

BoxRanges ranges_in_cells(const BoxText& box, const std::array<std::int32_t, 3>& grid) {
  BoxRanges ranges;
  for (std::size_t i = 0; i < 3; ++i) {
    const double end = std::ceil(box.origin[i] + box.size[i]) - 1;
    ranges.axes[i] = Box{box.origin[i], end, 1}.cells(grid[i]);
  }
  return ranges;
}

BoxRanges ranges_in_mm(const BoxText& box, const Lengths& pitch,
                       const std::array<std::int32_t, 3>& grid) {
  BoxRanges ranges;
  for (std::size_t i = 0; i < 3; ++i) {
    ranges.axes[i] = Box{box.origin[i], box.origin[i] + box.size[i], pitch[i]}.cells(grid[i]);
  }
  return ranges;
}

/// Whether a box, counted in cells, is one of the grid: so it may be meant, whatever the root is.
bool is_within(const BoxText& box, const std::array<std::int32_t, 3>& grid) {
  bool is = true;
  for (std::size_t i = 0; i < 3; ++i) {
    is = is && box.origin[i] >= 0 && box.size[i] > 0 && box.origin[i] + box.size[i] <= grid[i];
  }
  return is;
}

/// Reads a box outside <vs> in mm, unless cells may be meant as well and make other modules.
BoxRanges read_mm_ranges(XmlReading& reading, const pugi::xml_node& box, const BoxText& text,
                         const std::array<std::int32_t, 3>& grid) {
  const Lengths pitch = read_lengths(reading, box.parent(), "blockSize", kBlockSize);
  if (reading.document.extension.lattice != base::kCubic) {
    reading.fail(box, "<blockBox> in mm is for cubes only: write its modules as <block>",
                 base::ErrorCode::kUnsupported);
    return {};
  }
  if (std::ranges::min(pitch) <= 0) {
    reading.fail(box.parent(), fmt::format("blockSize of <blockList> is '{},{},{}', expected "
                                           "lengths above 0",
                                           pitch[0], pitch[1], pitch[2]));
    return {};
  }
  const BoxRanges ranges = ranges_in_mm(text, pitch, grid);
  const BoxRanges counted = ranges_in_cells(text, grid);
  if (is_within(text, grid) && counted.axes != ranges.axes) {
    reading.fail(box,
                 fmt::format("<blockBox> is {} modules in mm, as VisibleSim counts up to 2022, "
                             "but {} in cells, as it counts since: put the file within <vs> "
                             "to count cells, or write the modules as <block>",
                             ranges.count(), counted.count()));
  }
  return ranges;
}

/// Reads a box within <vs>. The loops of VisibleSim end before the last layer of the grid.
BoxRanges read_cell_ranges(XmlReading& reading, const pugi::xml_node& box, const BoxText& text,
                           const std::array<std::int32_t, 3>& grid) {
  const BoxRanges ranges = ranges_in_cells(text, grid);
  std::size_t count_there = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const IndexRange& axis = ranges.axes[i];
    count_there *= axis.count() - (axis.count() > 0 && axis.last == grid[i] - 1 ? 1 : 0);
  }
  if (count_there != ranges.count()) {
    reading.warn_at(box, fmt::format("a <blockBox> reaches the last layer of the grid, which "
                                     "VisibleSim leaves out: {} modules here, {} there",
                                     ranges.count(), count_there));
  }
  return ranges;
}

BoxRanges read_box_ranges(XmlReading& reading, const pugi::xml_node& box) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  const BoxText text = {read_lengths(reading, box, "boxOrigin", {0, 0, 0}),
                        read_lengths(reading, box, "boxSize", {kFar, kFar, kFar})};
  if (!reading.grid()) {
    reading.fail(box, "<blockBox> needs the attribute 'gridSize' of <world>, which is missing");
    return {};
  }
  const std::array<std::int32_t, 3> grid = {reading.grid()->x, reading.grid()->y,
                                            reading.grid()->z};
  return counts_in_cells(box) ? read_cell_ranges(reading, box, text, grid)
                              : read_mm_ranges(reading, box, text, grid);
}

void read_box(XmlReading& reading, const pugi::xml_node& box) {
  reading.expect_no_content(box);
  reading.expect_attributes(box, kBoxAttributes);
  const std::optional<Color> color = reading.color(box);
  const Attributes orientation = read_orientation(box);
  const BoxRanges ranges = read_box_ranges(reading, box);
  const auto& [xs, ys, zs] = ranges.axes;
  const std::size_t count = ranges.count();
  if (count == 0) {
    reading.warn_at(box, "a <blockBox> holds no cell");
  }
  if (!reading.take_room(count, [&] { return reading.line(box); })) {
    return;
  }
  for (std::int32_t z = zs.first; z <= zs.last; ++z) {
    for (std::int32_t y = ys.first; y <= ys.last; ++y) {
      for (std::int32_t x = xs.first; x <= xs.last; ++x) {
        ModuleEntry& entry = reading.document.modules.emplace_back();
        entry.cell = {x, y, z};
        entry.color = color;
        entry.attributes = orientation;
      }
    }
  }
}

}  // namespace

void read_block_list(XmlReading& reading, const pugi::xml_node& list) {
  std::vector<ModuleEntry>& modules = reading.document.modules;
  std::int32_t plane = 0;
  for (const pugi::xml_node& child : list.children()) {
    const std::string_view name = child.name();
    if (name == "block" && reading.take_room(1, [&] { return reading.line(child); })) {
      modules.push_back(read_block(reading, child));
    } else if (name == "blocksLine") {
      read_row(reading, child, plane, modules);
    } else if (name == "blockBox") {
      read_box(reading, child);
    } else if (name == "csg" || name == "mesh") {
      reading.fail(
          child,
          fmt::format("<{}> in <blockList> is not supported: write its modules as <block>", name),
          base::ErrorCode::kUnsupported);
    } else {
      reading.warn_of_unknown_child(child, kBlockListElements);
    }
    if (reading.has_failed()) {
      return;
    }
  }
}

Step read_grid_target(XmlReading& reading, const pugi::xml_node& target) {
  reading.expect_attributes(target, kTargetAttributes);
  Step step;
  std::int32_t plane = 0;
  for (const pugi::xml_node& child : target.children()) {
    const std::string_view name = child.name();
    if (name == "cell" && reading.take_room(1, [&] { return reading.line(child); })) {
      read_own(reading, child, {reading.document.steps.size() + 1, step.size(), {}, {}});
      step.push_back(read_cell(reading, child));
    } else if (name == "targetLine") {
      read_row(reading, child, plane, step);
    } else {
      reading.warn_of_unknown_child(child, kTargetElements);
    }
    if (reading.has_failed()) {
      return step;
    }
  }
  return step;
}

}  // namespace holdfast::io
