// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "json/json_text.hpp"
#include "robot_defaults.hpp"
#include "vocabulary.hpp"

/// The text is put together by hand because a person is to read it: cells side by side, each layer
/// from a new line.
namespace holdfast::io {
namespace {

Items members_of(const Attributes& attributes) {
  Items members;
  for (const auto& [name, value] : attributes) {
    members.push_back(member(name, json_text(value)));
  }
  return members;
}

/// A bare cell if nothing else is known; `own` may be nullptr.
template <class Entry>
std::string entry_text(const Entry& entry, const OwnParameters* own) {
  Items members = {member("cell", json_text(entry.cell))};
  if constexpr (std::is_same_v<Entry, ModuleEntry>) {
    if (entry.is_fixed) {
      members.push_back(member("fixed", "true"));
    }
  }
  if (own != nullptr) {
    add_own_members(members, *own);
  }
  if (entry.color) {
    members.push_back(member("color", json_text(*entry.color)));
  }
  if (!entry.attributes.empty()) {
    members.push_back(member("attributes", object(members_of(entry.attributes))));
  }
  return members.size() == 1 ? json_text(entry.cell) : object(members);
}

template <class Entry>
std::string cell_list(const std::vector<Entry>& entries, std::size_t indent,
                      std::span<const OwnParameters> own) {
  Items rows;
  const Entry* before = nullptr;  // Its row may go on.
  auto next_own = own.begin();
  for (const Entry& entry : entries) {
    const bool has_own = next_own != own.end() &&
                         next_own->module == static_cast<std::size_t>(&entry - entries.data());
    const std::string item = entry_text(entry, has_own ? &*next_own++ : nullptr);
    const bool is_bare = item.front() == '[';
    if (before != nullptr && is_bare && before->cell.z == entry.cell.z &&
        indent + rows.back().size() + item.size() + 5 <= kColumns) {
      rows.back() += ", " + item;
    } else {
      rows.push_back(item);
    }
    before = is_bare ? &entry : nullptr;
  }
  const bool is_short = rows.size() == 1 && rows.front().size() <= kShortMax;
  return is_short ? "[" + rows.front() + "]" : array(rows, indent);
}

std::string element_text(const Element& element) {
  Items members = {member("element", json_text(element.name))};
  if (!element.attributes.empty()) {
    members.push_back(member("attributes", object(members_of(element.attributes))));
  }
  if (!element.text.empty()) {
    members.push_back(member("text", json_text(element.text)));
  }
  Items children;
  for (const Element& child : element.children) {
    children.push_back(element_text(child));
  }
  if (!children.empty()) {
    members.push_back(member("children", row(children)));
  }
  return object(members);
}

std::string element_list(const std::vector<Element>& elements, std::size_t indent) {
  Items items;
  for (const Element& element : elements) {
    items.push_back(element_text(element));
  }
  return array(items, indent);
}

/// The members of the material that differ from the defaults. Gravity stands here or as a vector at
/// the top, not in both.
Items material_members(const Document& document) {
  const model::Material& material = document.material;
  const model::Material defaults = default_material(document);
  Items members;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    const bool is_overridden =
        (parameter.value == &model::Material::gravity_m_s2 &&
         document.extension.gravity_m_s2.has_value()) ||
        (parameter.value == &model::Material::pitch_mm && document.extension.pitch_mm.has_value());
    if (!is_overridden && is_said(parameter, defaults, document)) {
      members.push_back(member(parameter.key, json_text(material.*parameter.value)));
    }
  }
  std::ranges::move(material_extension_members(document.extension), std::back_inserter(members));
  return members;
}

std::string known_answer_text(const KnownAnswer& answer) {
  Items members = {member("verdict", json_text(answer.verdict))};
  if (answer.margin_mm) {
    members.push_back(member("margin_mm", json_text(*answer.margin_mm)));
  }
  if (answer.load_ratio_max) {
    members.push_back(member("load_ratio_max", json_text(*answer.load_ratio_max)));
  }
  if (!answer.source.empty()) {
    members.push_back(member("source", json_text(answer.source)));
  }
  return object(members, 2);
}

Items visiblesim_members(const Document& document) {
  Items members;
  const auto add_attributes = [&](std::string_view key, const Attributes& attributes) {
    if (!attributes.empty()) {
      members.push_back(member(key, object(members_of(attributes), 4)));
    }
  };
  const auto add_elements = [&](std::string_view key, const std::vector<Element>& elements) {
    if (!elements.empty()) {
      members.push_back(member(key, element_list(elements, 4)));
    }
  };
  add_attributes("parameters", document.parameters);
  add_attributes("world", document.world);
  add_attributes("block_list", document.block_list);
  add_attributes("obstacle_list", document.extension.obstacle_list);
  add_elements("scenery", document.scenery);
  add_elements("targets", document.targets);
  return members;
}

/// The parameters that modules of a step have of their own; `step` is that of OwnParameters.
std::span<const OwnParameters> own_of(const Extension& extension, std::size_t step) {
  const auto first = std::ranges::lower_bound(extension.own, step, {}, &OwnParameters::step);
  const auto last = std::ranges::upper_bound(extension.own, step, {}, &OwnParameters::step);
  // As a place and a count: Emscripten's span takes no iterators of a vector.
  return std::span(extension.own)
      .subspan(static_cast<std::size_t>(first - extension.own.begin()),
               static_cast<std::size_t>(last - first));
}

/// Writes "planned" and "later_steps".
void add_steps(Items& members, const Document& document) {
  const std::vector<Step>& steps = document.steps;
  if (!steps.empty() && !steps.front().empty()) {
    members.push_back(
        member("planned", cell_list(steps.front(), 2, own_of(document.extension, 1))));
  }
  if (steps.size() > 1) {
    Items later;
    for (std::size_t i = 1; i < steps.size(); ++i) {
      later.push_back(cell_list(steps[i], 4, own_of(document.extension, i + 1)));
    }
    members.push_back(member("later_steps", array(later, 2)));
  }
}

}  // namespace

int json_version(const Document& document) {
  return document.extension == Extension{} ? 1 : kJsonVersionMax;
}

std::string write_json(const Document& document) {
  const Extension& extension = document.extension;
  Items members = {member("format", fmt::format("\"{}\"", kJsonFormatName)),
                   member("version", fmt::format("{}", json_version(document)))};
  if (!document.name.empty()) {
    members.push_back(member("name", json_text(document.name)));
  }
  if (!document.description.empty()) {
    members.push_back(member("description", json_text(document.description)));
  }
  members.push_back(member("support_z", extension.has_floor ? fmt::format("{}", document.support_z)
                                                            : std::string("null")));
  add_setting_members(members, extension, default_lattice(extension.robot));
  if (const Items material = material_members(document); !material.empty()) {
    members.push_back(member("material", object(material, 2)));
  }
  add_kind_members(members, extension);
  add_connection_members(members, extension);
  members.push_back(member("modules", cell_list(document.modules, 2, own_of(extension, 0))));
  add_steps(members, document);
  add_obstacle_members(members, extension);
  add_plan_members(members, extension);
  if (document.known_answer) {
    members.push_back(member("known_answer", known_answer_text(*document.known_answer)));
  }
  if (const Items visiblesim = visiblesim_members(document); !visiblesim.empty()) {
    members.push_back(member("visiblesim", lines('{', visiblesim, '}', 2)));
  }
  return lines('{', members, '}', 0) + "\n";
}

}  // namespace holdfast::io
