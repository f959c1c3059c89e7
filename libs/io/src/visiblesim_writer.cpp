// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <new>
#include <pugixml.hpp>

#include "holdfast/io/document.hpp"
#include "reading.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// pugixml tells with an empty handle, not with an exception, that there is no memory left.
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

/// Calls use(cell) for every cell of the document.
template <class Use>
void for_each_cell(const Document& document, const Use& use) {
  std::ranges::for_each(document.modules, use, &ModuleEntry::cell);
  for (const Step& step : document.steps) {
    std::ranges::for_each(step, use, &PlannedEntry::cell);
  }
}

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
  const model::Material defaults;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = document.material.*parameter.value;
    const bool is_mass = parameter.value == &model::Material::mass_kg;
    if (parameter.visiblesim != nullptr && (is_mass || value != defaults.*parameter.value)) {
      add(node, parameter.visiblesim, value);
    }
  }
  add(node, kSupportParameter, fmt::format("{}", document.support_z + shift.z));
  add_all(node, document.parameters);
}

void add_modules(pugi::xml_node world, const Document& document, const base::Cell& shift) {
  pugi::xml_node list = append(world, "blockList");
  add_all(list, document.block_list);
  for (const ModuleEntry& module : document.modules) {
    pugi::xml_node block = append(list, "block");
    add_cell(block, moved(module.cell, shift), module.color);
    if (module.is_fixed) {
      add(block, "fixed", "true");
    }
    add_all(block, module.attributes);
  }
}

/// At least one target, as users of VisibleSim write it even where nothing is planned.
void add_targets(pugi::xml_node world, const Document& document, const base::Cell& shift) {
  pugi::xml_node list = append(world, "targetList");
  for (const Step& step : document.steps) {
    pugi::xml_node target = append(list, "target");
    add(target, "format", "grid");
    for (const PlannedEntry& planned : step) {
      pugi::xml_node cell = append(target, "cell");
      add_cell(cell, moved(planned.cell, shift), planned.color);
      add_all(cell, planned.attributes);
    }
  }
  for (const Element& target : document.targets) {
    add_element(list, target);
  }
  if (!list.first_child()) {
    pugi::xml_node nothing = append(list, "target");
    add(nothing, "format", "grid");
  }
}

/// What VisibleSim has no word for, and ignores here.
void add_own_element(pugi::xml_node world, const Document& document, const base::Cell& shift,
                     bool is_grid_computed) {
  pugi::xml_node node = append(world, kOwnElement);
  add_if_any(node, "name", document.name);
  add_if_any(node, "description", document.description);
  const model::Material defaults;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = document.material.*parameter.value;
    if (parameter.visiblesim == nullptr && value != defaults.*parameter.value) {
      add(node, parameter.key, value);
    }
  }
  if (is_grid_computed) {
    add(node, "computed", kGridSize);
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

base::Result<base::Cell> visiblesim_shift(const Document& document) {
  if (json_version(document) > 1) {
    return base::Error{base::ErrorCode::kUnsupported,
                       "VisibleSim XML has no words for what only version 2 of holdfast JSON says: "
                       "write .json",
                       ""};
  }
  base::Cell lowest;
  base::Cell highest;
  for_each_cell(document, [&](const base::Cell& cell) {
    lowest = {std::min(lowest.x, cell.x), std::min(lowest.y, cell.y), std::min(lowest.z, cell.z)};
    highest = {std::max(highest.x, cell.x), std::max(highest.y, cell.y),
               std::max(highest.z, cell.z)};
  });
  const base::Cell shift = {-lowest.x, -lowest.y, -lowest.z};
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
  add_modules(world, document, shift);
  add_targets(world, document, shift);
  add_own_element(world, document, shift, is_grid_computed);
  StringWriter writer;
  tree.save(writer, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(writer.text);
}

}  // namespace holdfast::io
