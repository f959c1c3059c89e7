// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <utility>
#include <vector>

#include "holdfast/io/document.hpp"
#include "holdfast/io/goal_shape.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "json/json_extension.hpp"
#include "text_input.hpp"
#include "visiblesim/visiblesim_cells.hpp"
#include "visiblesim/xml_encoding.hpp"
#include "visiblesim/xml_reading.hpp"
#include "visiblesim/xml_spelling.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

bool is_free(std::string_view /*name*/) { return false; }

/// The child of that name, if there is one; a failure if there are more.
pugi::xml_node only_child(XmlReading& reading, const pugi::xml_node& parent, const char* name) {
  const pugi::xml_node child = parent.child(name);
  if (const pugi::xml_node second = child.next_sibling(name)) {
    reading.fail(second, fmt::format("a second <{}>, expected one", name));
  }
  return child;
}

void read_parameters(XmlReading& reading, const pugi::xml_node& node) {
  Document& document = reading.document;
  reading.expect_no_content(node);
  document.parameters = reading.attributes(node, is_mechanical_parameter);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const char* const name = parameter.visiblesim;
    if (const auto attribute = name == nullptr ? pugi::xml_attribute() : node.attribute(name)) {
      take_number(parameter, reading.number(node, attribute), document);
    }
  }
  if (const auto attribute = node.attribute(kSupportParameter)) {
    document.support_z = reading.integer(node, attribute, kCoordinateRange);
  }
}

void read_known_answer(XmlReading& reading, const pugi::xml_node& node) {
  reading.expect_attributes(node, kKnownAnswerKeys);
  const auto number = [&](const char* name) -> std::optional<double> {
    const pugi::xml_attribute attribute = node.attribute(name);
    return attribute ? std::optional(reading.number(node, attribute)) : std::nullopt;
  };
  KnownAnswer answer{.verdict = node.attribute("verdict").value(),
                     .margin_mm = number("margin_mm"),
                     .load_ratio_max = number("load_ratio_max"),
                     .source = node.attribute("source").value()};
  reading.take_known_answer(std::move(answer), [&] { return reading.line(node); });
}

/// Reads what only version 2 of holdfast JSON says, but for what VisibleSim or <holdfast> has words
/// for. The element may be missing.
void read_extension(XmlReading& reading, const pugi::xml_node& node) {
  std::string text = node ? "" : "{}";
  for (const pugi::xml_node& child : node.children()) {
    text += child.value();
  }
  read_extension_text(reading, text, [&] { return node ? reading.line(node) : std::string(); });
}

/// Reads <holdfast>, which our writer adds to the file.
void read_own_element(XmlReading& reading, const pugi::xml_node& node) {
  Document& document = reading.document;
  reading.expect_attributes(node, own_element_names());
  for (const pugi::xml_node& child : node.children()) {
    if (std::ranges::find(kOwnElements, child.name()) == kOwnElements.end()) {
      reading.warn_of_unknown_child(child, kOwnElements);
    }
  }
  document.name = node.attribute("name").value();
  document.description = node.attribute("description").value();
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const auto attribute = node.attribute(std::string(parameter.key).c_str());
    if (attribute && parameter.visiblesim == nullptr) {
      take_number(parameter, reading.number(node, attribute), document);
    }
  }
  if (const auto answer = only_child(reading, node, "knownAnswer")) {
    read_known_answer(reading, answer);
  }
  if (const auto extension = only_child(reading, node, kExtensionElement);
      extension || !document.extension.own.empty()) {
    read_extension(reading, extension);
  }
  document.support_z = document.extension.has_floor ? document.support_z : 0;
  reading.take_back_shift(node);
}

void read_targets(XmlReading& reading, const pugi::xml_node& list) {
  reading.expect_attributes(list, {});
  pugi::xml_node without_cells;
  for (const pugi::xml_node& child : list.children()) {
    if (child.name() != std::string_view("target")) {
      reading.warn_of_unknown_child(child, kTargetListElements);
    } else if (child.attribute("format").value() == std::string_view("grid")) {
      std::vector<Step>& steps = reading.document.steps;
      steps.push_back(read_grid_target(reading, child));
      if (!steps.back().empty() && without_cells) {
        reading.fail(without_cells,
                     "expected cells in <target> before another one with cells, found none");
      }
      without_cells = steps.size() > 1 && steps.back().empty() ? child : without_cells;
    } else {
      reading.document.targets.push_back(reading.element(child));
    }
    if (reading.has_failed()) {
      return;
    }
  }
}

/// Takes targets that overlap the modules for what they are: shapes to reach.
void take_goal_shapes(XmlReading& reading, const pugi::xml_node& list, const pugi::xml_node& own) {
  Document& document = reading.document;
  const Step* const shape = find_goal_shape(document.modules, document.steps);
  if (reading.has_failed() || shape == nullptr ||
      own.attribute(kTargets).value() == std::string_view(kPlannedTargets)) {
    return;
  }
  reading.warn(fmt::format("the target is taken for a shape to reach, as it overlaps the modules: "
                           "its {} cells are not attached, the {} modules are judged as they are; "
                           "holdfast move takes them there",
                           shape->size(), document.modules.size()),
               [&] { return reading.line(list); });
  for (const Step& step : document.steps) {
    if (!step.empty()) {
      document.targets.push_back(make_goal(step));
    }
  }
  document.steps.clear();
  std::erase_if(document.extension.own, [](const OwnParameters& entry) { return entry.step > 0; });
}

void read_scenery(XmlReading& reading, const pugi::xml_node& world) {
  for (const pugi::xml_node& child : world.children()) {
    if (child.type() != pugi::node_element) {
      reading.warn_of_unknown_child(child, kWorldElements);
    } else if (child.name() == std::string_view(kMetaModules) && child.first_child()) {
      reading.fail(child,
                   fmt::format("<{}> lists meta modules, whose modules a program for VisibleSim "
                               "places: let it run, and read the configuration that it exports",
                               kMetaModules),
                   base::ErrorCode::kUnsupported);
    } else if (!is_structural_element(child.name())) {
      reading.document.scenery.push_back(reading.element(child));
    }
    if (reading.has_failed()) {
      return;
    }
  }
}

/// Finds the lattice: the file's, or the one that is asked for, or the robot's, or the one whose
/// modules alone have blocks of this size.
void read_lattice(XmlReading& reading, const pugi::xml_node& blocks, const pugi::xml_node& own,
                  const ReadOptions& options) {
  const auto where = [&] { return reading.line(own ? own : blocks); };
  const pugi::xml_attribute named = own.attribute("lattice");
  if (reading.take_lattice(named ? std::optional<std::string_view>(named.value()) : std::nullopt,
                           options, where) ||
      !reading.document.extension.robot.empty()) {
    return;
  }
  const auto size = parse_triple<double>(blocks.attribute("blockSize").value());
  const auto* const modules = std::ranges::find_if(
      kSimulatedModules,
      [&](const SimulatedModules& row) { return size && row.block_size_mm == *size; });
  if (modules != kSimulatedModules.end()) {
    reading.document.extension.lattice = modules->lattice;
    reading.warn(fmt::format("blocks of the size {} are VisibleSim's {}, so the lattice is taken "
                             "to be {}",
                             excerpt(blocks.attribute("blockSize").value()), modules->name,
                             lattice_name(modules->lattice)),
                 where);
  } else if (blocks.find_child([](const pugi::xml_node& child) {
               return child.first_attribute().next_attribute() && child.attribute(kOrientation);
             })) {
    reading.warn(
        "blocks have an orientation, as VisibleSim's catoms3D have, but are read as cubes: if "
        "they are catoms, ask for the lattice face-centred (--lattice catoms3D)",
        where);
  }
}

/// Says that blocks which are not as long as wide are taken for cubes.
void note_block_size(XmlReading& reading, const pugi::xml_node& blocks) {
  constexpr double kEqual = 1.05;  // Blinky Blocks are 40, 40 and 41 mm.
  const pugi::xml_attribute stated = blocks.attribute("blockSize");
  const auto size = parse_triple<double>(stated.value());
  if (!size || reading.has_failed() || reading.document.extension.pitch_mm ||
      reading.document.extension.lattice != base::kCubic) {
    return;
  }
  const auto [least, most] = std::ranges::minmax(*size);
  if (least > 0 && most > kEqual * least) {
    reading.warn(fmt::format("blockSize is {}, and modules are taken as long as wide; \"pitch_mm\" "
                             "of holdfast JSON states lengths along x, y and z",
                             excerpt(stated.value())),
                 [&] { return reading.line(blocks); });
  }
}

void read_world(XmlReading& reading, const pugi::xml_node& world, const ReadOptions& options) {
  Document& document = reading.document;
  document.world = reading.attributes(world, is_free);
  reading.read_grid([&] { return reading.line(world); });
  const pugi::xml_node blocks = only_child(reading, world, "blockList");
  const pugi::xml_node targets = only_child(reading, world, "targetList");
  const pugi::xml_node obstacles = only_child(reading, world, kObstacleListElement);
  const pugi::xml_node own = only_child(reading, world, kOwnElement);
  if (!blocks) {
    reading.fail(world, "<world> has no <blockList>, which lists the modules");
  }
  if (reading.has_failed()) {
    return;
  }
  read_lattice(reading, blocks, own, options);
  document.block_list = reading.attributes(blocks, is_free);
  if (obstacles) {
    reading.take_obstacles(reading.element(obstacles), [&] { return reading.line(obstacles); });
  }
  read_block_list(reading, blocks);
  read_targets(reading, targets);
  read_scenery(reading, world);
  read_own_element(reading, own);
  note_block_size(reading, blocks);
  take_goal_shapes(reading, targets, own);
  if (own.attribute("computed").value() == std::string_view(kGridSize)) {
    std::erase_if(document.world, [](const auto& entry) { return entry.first == kGridSize; });
  }
}

/// Refuses content beside the root, which would go unread.
void expect_nothing_beside(XmlReading& reading, const pugi::xml_node& tree) {
  for (const pugi::xml_node& child : tree.children()) {
    if (is_one_of(child.name(), {"parameters", "world"})) {
      reading.fail(child, fmt::format("the element <{}> is beside <{}>; expected one within it",
                                      child.name(), kRootElement));
    } else if (std::string_view(child.name()) != kRootElement) {
      reading.warn_of_unknown_child(child, kRootElements);
    }
  }
}

/// Numbers of the material that no robot can have, in the words of the file; some follow from the
/// pitch.
void expect_possible_numbers(XmlReading& reading, const pugi::xml_node& parameters,
                             const pugi::xml_node& own) {
  const model::Material& material = reading.document.material;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const double value = material.*parameter.value;
    if (value >= parameter.lowest && value <= parameter.highest) {
      continue;
    }
    const bool is_simulated = parameter.visiblesim != nullptr;
    const pugi::xml_node node = is_simulated ? parameters : own;
    const std::string name(is_simulated ? parameter.visiblesim : parameter.key);
    const bool is_said = static_cast<bool>(node.attribute(name.c_str()));
    reading.fail(is_said ? node : parameters,
                 fmt::format("{} of <{}>{} is {}, expected {} to {}", name, node.name(),
                             is_said ? "" : ", which follows from globalL,", value,
                             parameter.lowest, parameter.highest));
  }
}

void read_roots(XmlReading& reading, const pugi::xml_node& tree, const ReadOptions& options) {
  for (const pugi::xml_node& child : tree.children()) {
    if (!is_one_of(child.name(), {"parameters", "world"})) {
      reading.warn_of_unknown_child(child, kRootElements);
    }
  }
  const pugi::xml_node parameters = only_child(reading, tree, "parameters");
  const pugi::xml_node world = only_child(reading, tree, "world");
  if (!world) {
    reading.fail({base::ErrorCode::kBadInput,
                  "expected a VisibleSim configuration, found no element <world>", ""});
    return;
  }
  if (!parameters && options.robot.empty() && !world.child(kOwnElement).attribute("robot")) {
    reading.warn("there is no element <parameters>: mass and material are those of Blinky Blocks",
                 [] { return std::string(); });
  }
  const pugi::xml_node own = world.child(kOwnElement);
  const auto where = [&] { return reading.line(own ? own : world); };
  reading.take_robot(own.attribute("robot").value(), options, where);
  read_parameters(reading, parameters);
  read_world(reading, world, options);
  reading.complete_material(options, where);
  expect_possible_numbers(reading, parameters, own);
}

}  // namespace

base::Result<ReadDocument> read_visiblesim(std::string_view text, const ReadOptions& options) {
  const auto recoded = recode(text);
  if (!recoded) {
    return recoded.error();
  }
  text = without_bom(recoded.value() ? std::string_view(*recoded.value()) : text);
  if (auto fault = find_input_fault(text)) {
    return *std::move(fault);
  }
  XmlReading reading(text);
  reading.document.origin.format = Format::kVisibleSimXml;
  pugi::xml_document tree;
  reading.allows_unknown = options.allow_unknown;
  reading.parse(tree);
  if (!reading.has_failed()) {
    spell_as_known(tree);
    const pugi::xml_node root = only_child(reading, tree.root(), kRootElement);
    if (root) {
      expect_nothing_beside(reading, tree);
    }
    read_roots(reading, root ? root : tree, options);
  }
  return std::move(reading).finish();
}

}  // namespace holdfast::io
