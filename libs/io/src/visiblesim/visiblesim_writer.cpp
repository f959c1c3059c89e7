// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <pugixml.hpp>

#include "holdfast/io/document.hpp"
#include "holdfast/io/goal_shape.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "json/json_text.hpp"
#include "reading.hpp"
#include "robot_defaults.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// Appends an element, or throws if there is no memory, which pugixml reports by an empty handle.
pugi::xml_node append(pugi::xml_node parent, const char* name) {
  const pugi::xml_node node = parent.append_child(name);
  if (!node) {
    throw std::bad_alloc();
  }
  return node;
}

void add(pugi::xml_node& node, const char* name, const std::string& value) {
  if (!node.append_attribute(name).set_value(value.c_str())) {
    throw std::bad_alloc();
  }
}

/// The shortest text that reads back as the same number.
void add(pugi::xml_node& node, const char* name, double value) {
  add(node, name, fmt::format("{}", value));
}

void add_if_any(pugi::xml_node& node, const char* name, const std::string& value) {
  if (!value.empty()) {
    add(node, name, value);
  }
}

void add_all(pugi::xml_node& node, const Attributes& attributes) {
  for (const auto& attribute : attributes) {
    add(node, attribute.first.c_str(), attribute.second);
  }
}

/// The sum; coordinates and shifts are so small that it cannot overflow.
base::Cell moved(const base::Cell& cell, const base::Cell& shift) {
  return {cell.x + shift.x, cell.y + shift.y, cell.z + shift.z};
}

std::string triple(const base::Cell& cell) {
  return fmt::format("{},{},{}", cell.x, cell.y, cell.z);
}

/// Calls use(cell) for every cell of the document, and both corners of boxes.
template <class Use>
void for_each_cell(const Document& document, const Use& use) {
  std::ranges::for_each(document.modules, use, &ModuleEntry::cell);
  for (const Step& step : document.steps) {
    std::ranges::for_each(step, use, &PlannedEntry::cell);
  }
  for (const model::Obstacle& obstacle : document.extension.obstacles) {
    std::ranges::for_each(obstacle.cells, use);
    if (obstacle.cells.empty()) {
      use(obstacle.from);
      use(obstacle.to);
    }
  }
}

/// Gives out what modules have of their own, module by module, in the order of the extension.
class OwnAttributes {
 public:
  explicit OwnAttributes(const Extension& extension)
      : next_(extension.own.begin()), end_(extension.own.end()) {}

  void add_to(pugi::xml_node& node, std::size_t step, std::size_t module) {
    if (next_ == end_ || next_->step != step || next_->module != module) {
      return;
    }
    add_if_any(node, kOwnKindAttribute, next_->kind);
    if (next_->mass_kg) {
      add(node, kOwnMassAttribute, *next_->mass_kg);
    }
    ++next_;
  }

 private:
  std::vector<OwnParameters>::const_iterator next_;
  std::vector<OwnParameters>::const_iterator end_;
};

void add_cell(pugi::xml_node& node, const base::Cell& cell, const std::optional<Color>& color) {
  add(node, "position", triple(cell));
  if (color) {
    add(node, "color", fmt::format("{},{},{}", color->red, color->green, color->blue));
  }
}

void add_element(pugi::xml_node parent, const Element& element) {
  pugi::xml_node node = append(parent, element.name.c_str());
  add_all(node, element.attributes);
  if (!element.text.empty()) {
    if (!node.append_child(pugi::node_pcdata).set_value(element.text.c_str())) {
      throw std::bad_alloc();
    }
  }
  for (const Element& child : element.children) {
    add_element(node, child);
  }
}

/// Mass and support level always, as users of VisibleSim do; the rest if it is not the default.
void add_parameters(pugi::xml_node parent, const Document& document, const base::Cell& shift) {
  pugi::xml_node node = append(parent, "parameters");
  const model::Material defaults = default_material(document);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = document.material.*parameter.value;
    const bool is_mass = parameter.value == &model::Material::mass_kg;
    if (parameter.visiblesim != nullptr && (is_mass || is_said(parameter, defaults, document))) {
      add(node, parameter.visiblesim, value);
    }
  }
  if (document.extension.has_floor) {
    add(node, kSupportParameter, fmt::format("{}", document.support_z + shift.z));
  }
  add_all(node, document.parameters);
}

void add_modules(pugi::xml_node world, const Document& document, const base::Cell& shift,
                 OwnAttributes& own) {
  pugi::xml_node list = append(world, "blockList");
  add_all(list, document.block_list);
  for (std::size_t i = 0; i < document.modules.size(); ++i) {
    const ModuleEntry& module = document.modules[i];
    pugi::xml_node block = append(list, "block");
    add_cell(block, moved(module.cell, shift), module.color);
    if (module.is_fixed) {
      add(block, "fixed", "true");
    }
    own.add_to(block, 0, i);
    add_all(block, module.attributes);
  }
}

/// Calls use(cell) for what VisibleSim is shown of an obstacle: all its cells, the one that says
/// the most first, or of a large box that one only.
template <class Use>
void for_each_shown(const model::Obstacle& obstacle, const Use& use) {
  if (!obstacle.cells.empty()) {
    std::ranges::for_each(obstacle.cells, use);
    return;
  }
  const base::Cell& from = obstacle.from;
  const base::Cell last = is_large_box(obstacle) ? from : obstacle.to;
  for (std::int32_t z = from.z; z <= last.z; ++z) {
    for (std::int32_t y = from.y; y <= last.y; ++y) {
      for (std::int32_t x = from.x; x <= last.x; ++x) {
        use({x, y, z});
      }
    }
  }
}

/// Adds what makes an <obstacle> begin a further obstacle.
void add_touch(pugi::xml_node& node, const model::Obstacle& obstacle, const base::Cell& shift) {
  add(node, "hold", std::string(kHoldNames[static_cast<std::size_t>(obstacle.touch.hold)]));
  if (obstacle.touch.friction) {
    add(node, "friction", *obstacle.touch.friction);
  }
  if (obstacle.cells.empty()) {
    add(node, "to", triple(moved(obstacle.to, shift)));
  }
}

void add_obstacles(pugi::xml_node world, const Document& document, const base::Cell& shift) {
  const Extension& extension = document.extension;
  if (extension.obstacles.empty() && extension.obstacle_list.empty()) {
    return;
  }
  pugi::xml_node list = append(world, kObstacleListElement);
  add_all(list, extension.obstacle_list);
  for (std::size_t i = 0; i < extension.obstacles.size(); ++i) {
    const model::Obstacle& obstacle = extension.obstacles[i];
    const bool is_plain = i == 0 && obstacle.touch == model::Touch{} && !obstacle.cells.empty();
    bool begins = !is_plain;
    for_each_shown(obstacle, [&](const base::Cell& cell) {
      pugi::xml_node node = append(list, kObstacleElement);
      add_cell(node, moved(cell, shift),
               i < extension.obstacle_colors.size() ? extension.obstacle_colors[i] : std::nullopt);
      if (begins) {
        add_touch(node, obstacle, shift);
      }
      begins = false;
    });
  }
}

/// Writes the targets; one empty target where nothing is planned, as users of VisibleSim write it.
void add_targets(pugi::xml_node world, const Document& document, const base::Cell& shift,
                 OwnAttributes& own) {
  pugi::xml_node list = append(world, "targetList");
  for (std::size_t i = 0; i < document.steps.size(); ++i) {
    pugi::xml_node target = append(list, "target");
    add(target, "format", "grid");
    for (std::size_t j = 0; j < document.steps[i].size(); ++j) {
      const PlannedEntry& planned = document.steps[i][j];
      pugi::xml_node cell = append(target, "cell");
      add_cell(cell, moved(planned.cell, shift), planned.color);
      own.add_to(cell, i + 1, j);
      add_all(cell, planned.attributes);
    }
  }
  for (const Element& target : document.targets) {
    const auto cells = is_goal(target) ? goal_cells(target) : base::Result<Step>(Step{});
    if (!is_goal(target) || !cells) {
      add_element(list, target);
      continue;
    }
    Step there = cells.value();
    for (PlannedEntry& entry : there) {
      entry.cell = moved(entry.cell, shift);
    }
    add_element(list, make_goal(there));
  }
  if (!list.first_child()) {
    pugi::xml_node nothing = append(list, "target");
    add(nothing, "format", "grid");
  }
}

/// Adds the element for what VisibleSim has no word for, and ignores here.
void add_own_element(pugi::xml_node world, const Document& document, const base::Cell& shift,
                     bool is_grid_computed) {
  pugi::xml_node node = append(world, kOwnElement);
  add_if_any(node, "name", document.name);
  add_if_any(node, "description", document.description);
  const model::Material defaults = default_material(document);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = document.material.*parameter.value;
    if (parameter.visiblesim == nullptr && is_said(parameter, defaults, document)) {
      add(node, std::string(parameter.key).c_str(), value);
    }
  }
  add_if_any(node, "robot", document.extension.robot);
  // Blocks of some sizes would be taken for a simulated module's, of another lattice.
  const bool is_guessed = document.extension.robot.empty() &&
                          std::ranges::any_of(document.block_list, [](const auto& attribute) {
                            return attribute.first == "blockSize";
                          });
  if (is_guessed || document.extension.lattice != default_lattice(document.extension.robot)) {
    add(node, "lattice", std::string(lattice_name(document.extension.lattice)));
  }
  if (is_grid_computed) {
    add(node, "computed", kGridSize);
  }
  if (find_goal_shape(document.modules, document.steps) != nullptr) {
    add(node, kTargets, kPlannedTargets);
  }
  if (shift != base::Cell{}) {
    add(node, kShift, triple(shift));
  }
  if (const auto& answer = document.known_answer) {
    pugi::xml_node known = append(node, "knownAnswer");
    add(known, "verdict", answer->verdict);
    if (answer->margin_mm) {
      add(known, "margin_mm", *answer->margin_mm);
    }
    if (answer->load_ratio_max) {
      add(known, "load_ratio_max", *answer->load_ratio_max);
    }
    add_if_any(known, "source", answer->source);
  }
  if (const std::string text = extension_text(document.extension); !text.empty()) {
    pugi::xml_node extension = append(node, kExtensionElement);
    if (!extension.append_child(pugi::node_pcdata).set_value(text.c_str())) {
      throw std::bad_alloc();
    }
  }
  if (!node.first_attribute() && !node.first_child()) {
    world.remove_child(node);
  }
}

/// The smallest grid that holds every cell; VisibleSim needs one.
std::string smallest_grid(const Document& document, const base::Cell& shift) {
  base::Cell size{1, 1, 1};
  for_each_cell(document, [&](const base::Cell& unmoved) {
    const base::Cell cell = moved(unmoved, shift);
    size = {std::max(size.x, cell.x + 1), std::max(size.y, cell.y + 1),
            std::max(size.z, cell.z + 1)};
  });
  return triple(size);
}

class StringWriter : public pugi::xml_writer {
 public:
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }

  std::string text;
};

}  // namespace

bool is_large_box(const model::Obstacle& obstacle) {
  const auto& [from, to, cells, touch] = obstacle;
  const auto count = [](std::int32_t first, std::int32_t last) {
    return std::int64_t{last} - first + 1;
  };
  const std::int64_t layer = count(from.x, to.x) * count(from.y, to.y);
  return cells.empty() && (layer > kBoxCellsMax || layer * count(from.z, to.z) > kBoxCellsMax);
}

base::Result<base::Cell> visiblesim_shift(const Document& document) {
  base::Cell lowest;
  base::Cell highest;
  for_each_cell(document, [&](const base::Cell& cell) {
    lowest = {std::min(lowest.x, cell.x), std::min(lowest.y, cell.y), std::min(lowest.z, cell.z)};
    highest = {std::max(highest.x, cell.x), std::max(highest.y, cell.y),
               std::max(highest.z, cell.z)};
  });
  // Every second layer lies as the one below it, whatever the lattice.
  const std::int32_t up =
      -lowest.z + (document.extension.lattice == base::kCubic ? 0 : lowest.z & 1);
  const base::Cell shift = {-lowest.x, -lowest.y, up};
  const base::Cell end = moved(highest, shift);
  if (std::max({end.x, end.y, end.z, document.support_z + shift.z}) > base::kCoordinateMax) {
    return base::Error{base::ErrorCode::kUnsupported,
                       fmt::format("the cells from ({}) to ({}) reach further than VisibleSim's "
                                   "grid, which goes from 0 to {}",
                                   triple(lowest), triple(highest), base::kCoordinateMax),
                       ""};
  }
  return shift;
}

std::string write_visiblesim(const Document& document) {
  const auto found_shift = visiblesim_shift(document);
  const base::Cell shift = found_shift ? found_shift.value() : base::Cell{};
  pugi::xml_document tree;
  add_parameters(tree.root(), document, shift);
  pugi::xml_node world = append(tree.root(), "world");
  add_all(world, document.world);
  const bool is_grid_computed = find_attribute(document.world, kGridSize) == nullptr;
  if (is_grid_computed) {
    add(world, kGridSize, smallest_grid(document, shift));
  }
  for (const Element& element : document.scenery) {
    add_element(world, element);
  }
  OwnAttributes own(document.extension);
  add_modules(world, document, shift, own);
  add_obstacles(world, document, shift);
  add_targets(world, document, shift, own);
  add_own_element(world, document, shift, is_grid_computed);
  StringWriter writer;
  tree.save(writer, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(writer.text);
}

}  // namespace holdfast::io
