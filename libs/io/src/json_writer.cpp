// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "holdfast/io/document.hpp"
#include "json_tree.hpp"
#include "vocabulary.hpp"

/// The text is put together by hand because a person is to read it: cells side by side, each layer
/// from a new line. `indent` is always that of the line which the opening bracket stands in.
namespace holdfast::io {
namespace {

using Items = std::vector<std::string>;

constexpr std::size_t kColumns = 100;

/// An object or array of a single line may be so long, its key before it.
constexpr std::size_t kShortMax = 78;

std::string text(const std::string& value) {
  return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// The shortest text that reads back as the same number.
std::string text(double value) { return fmt::format("{}", value); }

std::string text(const base::Cell& cell) {
  return fmt::format("[{},{},{}]", cell.x, cell.y, cell.z);
}

std::string text(const Color& color) {
  return fmt::format("[{},{},{}]", color.red, color.green, color.blue);
}

std::string member(std::string_view key, const std::string& value) {
  return fmt::format("\"{}\": {}", key, value);
}

std::string object(const Items& members) { return fmt::format("{{{}}}", fmt::join(members, ", ")); }

/// An item a line.
std::string lines(char open, const Items& items, char close, std::size_t indent) {
  const std::string blanks(indent, ' ');
  return fmt::format("{}\n{}  {}\n{}{}", open, blanks, fmt::join(items, ",\n  " + blanks), blanks,
                     close);
}

/// On a line if it is a short one.
std::string object(const Items& members, std::size_t indent) {
  std::string line = object(members);
  return line.size() <= kShortMax ? line : lines('{', members, '}', indent);
}

std::string array(const Items& items, std::size_t indent) {
  return items.empty() ? "[]" : lines('[', items, ']', indent);
}

Items members_of(const Attributes& attributes) {
  Items members;
  for (const auto& [name, value] : attributes) {
    members.push_back(member(name, text(value)));
  }
  return members;
}

/// A bare cell if nothing else is known.
template <class Entry>
std::string entry_text(const Entry& entry) {
  Items members = {member("cell", text(entry.cell))};
  if constexpr (std::is_same_v<Entry, ModuleEntry>) {
    if (entry.is_fixed) {
      members.push_back(member("fixed", "true"));
    }
  }
  if (entry.color) {
    members.push_back(member("color", text(*entry.color)));
  }
  if (!entry.attributes.empty()) {
    members.push_back(member("attributes", object(members_of(entry.attributes))));
  }
  return members.size() == 1 ? text(entry.cell) : object(members);
}

template <class Entry>
std::string cell_list(const std::vector<Entry>& entries, std::size_t indent) {
  Items rows;
  const Entry* before = nullptr;  // Its row may go on.
  for (const Entry& entry : entries) {
    const std::string item = entry_text(entry);
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
  Items members = {member("element", text(element.name))};
  if (!element.attributes.empty()) {
    members.push_back(member("attributes", object(members_of(element.attributes))));
  }
  if (!element.text.empty()) {
    members.push_back(member("text", text(element.text)));
  }
  Items children;
  for (const Element& child : element.children) {
    children.push_back(element_text(child));
  }
  if (!children.empty()) {
    members.push_back(member("children", fmt::format("[{}]", fmt::join(children, ", "))));
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

/// What differs from the defaults.
Items material_members(const model::Material& material) {
  const model::Material defaults;
  Items members;
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    if (material.*parameter.value != defaults.*parameter.value) {
      members.push_back(member(parameter.key, text(material.*parameter.value)));
    }
  }
  return members;
}

std::string known_answer_text(const KnownAnswer& answer) {
  Items members = {member("verdict", text(answer.verdict))};
  if (answer.margin_mm) {
    members.push_back(member("margin_mm", text(*answer.margin_mm)));
  }
  if (answer.load_ratio_max) {
    members.push_back(member("load_ratio_max", text(*answer.load_ratio_max)));
  }
  if (!answer.source.empty()) {
    members.push_back(member("source", text(answer.source)));
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
  add_elements("scenery", document.scenery);
  add_elements("targets", document.targets);
  return members;
}

/// "planned" and "later_steps".
void add_steps(Items& members, const std::vector<Step>& steps) {
  if (!steps.empty() && !steps.front().empty()) {
    members.push_back(member("planned", cell_list(steps.front(), 2)));
  }
  if (steps.size() > 1) {
    Items later;
    for (auto step = steps.begin() + 1; step != steps.end(); ++step) {
      later.push_back(cell_list(*step, 4));
    }
    members.push_back(member("later_steps", array(later, 2)));
  }
}

}  // namespace

std::string write_json(const Document& document) {
  Items members = {member("format", fmt::format("\"{}\"", kJsonFormatName)),
                   member("version", fmt::format("{}", kJsonVersion))};
  if (!document.name.empty()) {
    members.push_back(member("name", text(document.name)));
  }
  if (!document.description.empty()) {
    members.push_back(member("description", text(document.description)));
  }
  members.push_back(member("support_z", fmt::format("{}", document.support_z)));
  if (const Items material = material_members(document.material); !material.empty()) {
    members.push_back(member("material", object(material, 2)));
  }
  members.push_back(member("modules", cell_list(document.modules, 2)));
  add_steps(members, document.steps);
  if (document.known_answer) {
    members.push_back(member("known_answer", known_answer_text(*document.known_answer)));
  }
  if (const Items visiblesim = visiblesim_members(document); !visiblesim.empty()) {
    members.push_back(member("visiblesim", lines('{', visiblesim, '}', 2)));
  }
  return lines('{', members, '}', 0) + "\n";
}

}  // namespace holdfast::io
