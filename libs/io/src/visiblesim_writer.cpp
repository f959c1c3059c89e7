// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>

#include "holdfast/io/document.hpp"
#include "reading.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

void add(pugi::xml_node& node, const char* name, const std::string& value) {
  node.append_attribute(name).set_value(value.c_str());
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

void add_cell(pugi::xml_node& node, const base::Cell& cell, const std::optional<Color>& color) {
  add(node, "position", fmt::format("{},{},{}", cell.x, cell.y, cell.z));
  if (color) {
    add(node, "color", fmt::format("{},{},{}", color->red, color->green, color->blue));
  }
}

void add_element(pugi::xml_node parent, const Element& element) {
  pugi::xml_node node = parent.append_child(element.name.c_str());
  add_all(node, element.attributes);
  if (!element.text.empty()) {
    node.append_child(pugi::node_pcdata).set_value(element.text.c_str());
  }
  for (const Element& child : element.children) {
    add_element(node, child);
  }
}

/// Mass and support level always, as users of VisibleSim do; the rest if it is not the default.
void add_parameters(pugi::xml_node parent, const Document& document) {
  pugi::xml_node node = parent.append_child("parameters");
  const model::Material defaults;
  for (const MaterialParameter& parameter : kMaterialParameters) {
    const double value = document.material.*parameter.value;
    const bool is_mass = parameter.value == &model::Material::mass_kg;
    if (parameter.visiblesim != nullptr && (is_mass || value != defaults.*parameter.value)) {
      add(node, parameter.visiblesim, value);
    }
  }
  add(node, kSupportParameter, fmt::format("{}", document.support_z));
  add_all(node, document.parameters);
}

void add_modules(pugi::xml_node world, const Document& document) {
  pugi::xml_node list = world.append_child("blockList");
  add_all(list, document.block_list);
  for (const ModuleEntry& module : document.modules) {
    pugi::xml_node block = list.append_child("block");
    add_cell(block, module.cell, module.color);
    if (module.is_fixed) {
      add(block, "fixed", "true");
    }
    add_all(block, module.attributes);
  }
}

/// At least one target, as users of VisibleSim write it even where nothing is planned.
void add_targets(pugi::xml_node world, const Document& document) {
  pugi::xml_node list = world.append_child("targetList");
  for (const Step& step : document.steps) {
    pugi::xml_node target = list.append_child("target");
    add(target, "format", "grid");
    for (const PlannedEntry& planned : step) {
      pugi::xml_node cell = target.append_child("cell");
      add_cell(cell, planned.cell, planned.color);
      add_all(cell, planned.attributes);
    }
  }
  for (const Element& target : document.targets) {
    add_element(list, target);
  }
  if (!list.first_child()) {
    pugi::xml_node nothing = list.append_child("target");
    add(nothing, "format", "grid");
  }
}

/// What VisibleSim has no word for, and ignores here.
void add_own_element(pugi::xml_node world, const Document& document, bool is_grid_computed) {
  pugi::xml_node node = world.append_child(kOwnElement);
  add_if_any(node, "name", document.name);
  add_if_any(node, "description", document.description);
  const model::Material defaults;
  for (const MaterialParameter& parameter : kMaterialParameters) {
    const double value = document.material.*parameter.value;
    if (parameter.visiblesim == nullptr && value != defaults.*parameter.value) {
      add(node, parameter.key, value);
    }
  }
  if (is_grid_computed) {
    add(node, "computed", kGridSize);
  }
  if (const auto& answer = document.known_answer) {
    pugi::xml_node known = node.append_child("knownAnswer");
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
std::string smallest_grid(const Document& document) {
  base::Cell size{1, 1, 1};
  const auto hold = [&](const base::Cell& cell) {
    size = {std::max(size.x, cell.x + 1), std::max(size.y, cell.y + 1),
            std::max(size.z, cell.z + 1)};
  };
  std::ranges::for_each(document.modules, hold, &ModuleEntry::cell);
  for (const Step& step : document.steps) {
    std::ranges::for_each(step, hold, &PlannedEntry::cell);
  }
  return fmt::format("{},{},{}", size.x, size.y, size.z);
}

class StringWriter : public pugi::xml_writer {
 public:
  void write(const void* data, std::size_t size) override {
    text.append(static_cast<const char*>(data), size);
  }

  std::string text;
};

}  // namespace

std::string write_visiblesim(const Document& document) {
  pugi::xml_document tree;
  add_parameters(tree.root(), document);
  pugi::xml_node world = tree.append_child("world");
  add_all(world, document.world);
  const bool is_grid_computed = find_attribute(document.world, kGridSize) == nullptr;
  if (is_grid_computed) {
    add(world, kGridSize, smallest_grid(document));
  }
  for (const Element& element : document.scenery) {
    add_element(world, element);
  }
  add_modules(world, document);
  add_targets(world, document);
  add_own_element(world, document, is_grid_computed);
  StringWriter writer;
  tree.save(writer, "  ", pugi::format_default, pugi::encoding_utf8);
  return std::move(writer.text);
}

}  // namespace holdfast::io
