// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/visiblesim_cells.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <set>

#include "text_input.hpp"
#include "visiblesim/csg.hpp"
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

/// VisibleSim counts boxes in mm up to 2022, in cells since, when files came to have the root <vs>;
/// but it reads others still.
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

/// The loops of VisibleSim end before the last layer of the grid.
BoxRanges ranges_in_cells(const BoxText& box, const std::array<std::int32_t, 3>& grid) {
  BoxRanges ranges;
  for (std::size_t i = 0; i < 3; ++i) {
    const double end = std::ceil(box.origin[i] + box.size[i]) - 1;
    ranges.axes[i] = Box{box.origin[i], end, 1}.cells(grid[i] - 1);
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

/// Reads a box in cells, and notes what VisibleSim leaves out of it.
BoxRanges read_cell_ranges(XmlReading& reading, const pugi::xml_node& box, const BoxText& text,
                           const std::array<std::int32_t, 3>& grid) {
  BoxRanges ranges = ranges_in_cells(text, grid);
  const BoxRanges whole = ranges_in_cells(text, {grid[0] + 1, grid[1] + 1, grid[2] + 1});
  if (whole.count() != ranges.count()) {
    reading.warn_at(box, fmt::format("a <blockBox> reaches the last layer of the grid, which "
                                     "VisibleSim leaves out, and so it is here: {} modules of {}",
                                     ranges.count(), whole.count()));
  }
  return ranges;
}

/// Reads a box outside <vs>: in cells if it is one of the grid then, as VisibleSim reads it today,
/// with a note where it would differ in mm, in which older versions count; else in mm.
BoxRanges read_plain_ranges(XmlReading& reading, const pugi::xml_node& box, const BoxText& text,
                            const std::array<std::int32_t, 3>& grid) {
  const Lengths pitch = read_lengths(reading, box.parent(), "blockSize", kBlockSize);
  const bool may_be_mm =
      reading.document.extension.lattice == base::kCubic && std::ranges::min(pitch) > 0;
  if (is_within(text, grid)) {
    const BoxRanges ranges = read_cell_ranges(reading, box, text, grid);
    const BoxRanges in_mm = may_be_mm ? ranges_in_mm(text, pitch, grid) : ranges;
    if (in_mm.axes != ranges.axes && in_mm.count() + ranges.count() > 0) {
      reading.warn_at(box, fmt::format("<blockBox> counts in cells, as VisibleSim does since 2022: "
                                       "{} modules; in mm, as it counted before, it would be {}",
                                       ranges.count(), in_mm.count()));
    }
    return ranges;
  }
  if (std::ranges::min(pitch) <= 0) {
    reading.fail(box.parent(), fmt::format("blockSize of <blockList> is '{},{},{}', expected "
                                           "lengths above 0",
                                           pitch[0], pitch[1], pitch[2]));
    return {};
  }
  if (!may_be_mm) {
    reading.fail(box, "<blockBox> in mm is for cubes only: write its modules as <block>",
                 base::ErrorCode::kUnsupported);
    return {};
  }
  return ranges_in_mm(text, pitch, grid);
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
                              : read_plain_ranges(reading, box, text, grid);
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

/// More questions whether a part of a solid holds a point than these take too long: seconds.
constexpr std::size_t kSolidWorkMax = 200'000'000;

/// How VisibleSim lays a solid over the grid: the centre of cell (0, 0, 0), and the cells that may
/// be in it.
struct SolidGrid {
  Solid::Point origin;
  base::Cell low;
  base::Cell high;

  double count() const {
    return std::max(0.0, high.x - low.x + 1.0) * std::max(0.0, high.y - low.y + 1.0) *
           std::max(0.0, high.z - low.z + 1.0);
  }
};

SolidGrid lay(XmlReading& reading, const pugi::xml_node& node, const Solid& solid) {
  const bool is_centred = reading.document.extension.lattice == base::kFaceCentred;
  const double half = is_centred ? 0.5 : 0;
  const double layer = is_centred ? std::sqrt(0.5) : 1;
  SolidGrid grid{.origin = {half, half, half * layer}, .low = {}, .high = {}};
  const bool is_from_corner = node.attribute("boundingBox").as_bool(true);
  const double back = node.attribute("offset").as_bool(true) ? 1 : 0;
  const Solid::Box box = solid.bounds();
  const Solid::Point step = {1, 1, layer};
  const std::array<std::int32_t, 3> size = {reading.grid()->x, reading.grid()->y,
                                            reading.grid()->z};
  std::array<std::int32_t, 3> low{};
  std::array<std::int32_t, 3> high{};
  for (std::size_t i = 0; i < 3; ++i) {
    grid.origin[i] += (is_from_corner ? solid.filled_from()[i] : 0) - back;
    // One more on either side: layers of a face-centred lattice are staggered.
    low[i] = static_cast<std::int32_t>(
        std::clamp(std::floor((box.low[i] - grid.origin[i]) / step[i]) - 1, 0.0, size[i] - 0.0));
    high[i] = static_cast<std::int32_t>(
        std::clamp(std::ceil((box.high[i] - grid.origin[i]) / step[i]) + 1, -1.0, size[i] - 1.0));
  }
  grid.low = {low[0], low[1], low[2]};
  grid.high = {high[0], high[1], high[2]};
  return grid;
}

/// Adds the modules of a solid whose centres lie in it, but where there is one already.
void fill(XmlReading& reading, const pugi::xml_node& node, const Solid& solid,
          const SolidGrid& grid) {
  std::vector<ModuleEntry>& modules = reading.document.modules;
  std::set<base::Cell> taken;
  std::ranges::transform(modules, std::inserter(taken, taken.end()), &ModuleEntry::cell);
  const std::optional<Color> color = reading.color(node);
  const Attributes orientation = read_orientation(node);
  const std::size_t before = modules.size();
  std::size_t work = 0;
  for (std::int32_t z = grid.low.z; z <= grid.high.z; ++z) {
    for (std::int32_t y = grid.low.y; y <= grid.high.y; ++y) {
      if (work > kSolidWorkMax) {
        reading.fail(node, fmt::format("<csg> has {} parts over {} cells, more than can be filled",
                                       solid.node_count(), grid.count()));
        return;
      }
      for (std::int32_t x = grid.low.x; x <= grid.high.x; ++x) {
        const base::Cell cell = {x, y, z};
        const auto place = base::node_place(reading.document.extension.lattice, cell);
        if (solid.contains(
                {place[0] + grid.origin[0], place[1] + grid.origin[1], place[2] + grid.origin[2]},
                work) &&
            !taken.contains(cell)) {
          modules.push_back({cell, false, color, orientation});
        }
      }
    }
  }
  if (modules.size() == before) {
    reading.warn_at(node, "a <csg> holds no cell");
  }
  reading.take_room(modules.size() - before, [&] { return reading.line(node); });
}

/// Reads <csg>, a solid whose attribute `content` says what it is.
void read_csg(XmlReading& reading, const pugi::xml_node& node) {
  reading.expect_no_content(node);
  reading.expect_attributes(node, kSolidAttributes);
  const char* const content = reading.required(node, "content");
  if (content == nullptr) {
    return;
  }
  if (!reading.grid()) {
    reading.fail(node, "<csg> needs the attribute 'gridSize' of <world>, which is missing");
    return;
  }
  const base::Lattice& lattice = reading.document.extension.lattice;
  if (lattice != base::kCubic && lattice != base::kFaceCentred) {
    reading.fail(node, "<csg> is for cubes and catoms3D only: write its modules as <block>",
                 base::ErrorCode::kUnsupported);
    return;
  }
  const auto solid = Solid::parse(content);
  if (!solid) {
    reading.fail(node, solid.error().message);
    return;
  }
  const SolidGrid grid = lay(reading, node, solid.value());
  fill(reading, node, solid.value(), grid);
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
    } else if (name == "mesh") {
      reading.fail(child,
                   "<mesh> in <blockList> is not supported: read the mesh alone, with --pitch, or "
                   "write its modules as <block>",
                   base::ErrorCode::kUnsupported);
    } else if (name != "csg") {
      reading.warn_of_unknown_child(child, kBlockListElements);
    }
    if (reading.has_failed()) {
      return;
    }
  }
  // VisibleSim reads solids last, and the first one only: they leave out cells that are taken.
  if (const pugi::xml_node solid = list.child("csg")) {
    read_csg(reading, solid);
    if (const pugi::xml_node second = solid.next_sibling("csg")) {
      reading.warn_at(second, "a further <csg> is ignored, as VisibleSim reads the first only");
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
