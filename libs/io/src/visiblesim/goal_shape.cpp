// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/goal_shape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <set>

#include "numbers.hpp"
#include "reading.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// The cell of a <cell>; none for another element.
std::optional<base::Cell> goal_cell(const Element& element) {
  const std::string* const position = find_attribute(element.attributes, "position");
  if (position == nullptr || element.name != "cell" || !element.children.empty() ||
      !element.text.empty()) {
    return std::nullopt;
  }
  const std::array<std::int32_t, 3> none = {base::kCoordinateMax + 1, 0, 0};
  const auto [x, y, z] = parse_triple<std::int32_t>(*position).value_or(none);
  const bool is_in_range =
      kCoordinateRange.contains(x) && kCoordinateRange.contains(y) && kCoordinateRange.contains(z);
  return is_in_range ? std::optional(base::Cell{x, y, z}) : std::nullopt;
}

}  // namespace

bool is_goal_shape(const std::vector<ModuleEntry>& modules, const Step& cells) {
  if (cells.empty() || 2 * cells.size() < modules.size()) {
    return false;
  }
  std::set<base::Cell> taken;
  for (const ModuleEntry& module : modules) {
    taken.insert(module.cell);
  }
  return std::ranges::any_of(cells,
                             [&](const PlannedEntry& entry) { return taken.contains(entry.cell); });
}

const Step* find_goal_shape(const std::vector<ModuleEntry>& modules,
                            const std::vector<Step>& steps) {
  const auto first = std::ranges::find_if(steps, [](const Step& step) { return !step.empty(); });
  return first == steps.end() || !is_goal_shape(modules, *first) ? nullptr : &*first;
}

bool is_goal(const Element& target) {
  const std::string* const format = find_attribute(target.attributes, "format");
  return target.name == "target" && format != nullptr && *format == "grid";
}

Element make_goal(const Step& cells) {
  Element target{"target", {{"format", "grid"}}, "", {}};
  for (const PlannedEntry& entry : cells) {
    const auto& [x, y, z] = entry.cell;
    Element& cell = target.children.emplace_back();
    cell.name = "cell";
    cell.attributes = {{"position", fmt::format("{},{},{}", x, y, z)}};
    if (const auto& color = entry.color) {
      cell.attributes.emplace_back("color",
                                   fmt::format("{},{},{}", color->red, color->green, color->blue));
    }
    cell.attributes.insert(cell.attributes.end(), entry.attributes.begin(), entry.attributes.end());
  }
  return target;
}

base::Result<Step> goal_cells(const Element& target) {
  Step cells;
  for (const Element& child : target.children) {
    const auto cell = goal_cell(child);
    if (!cell) {
      return base::bad_input(
          fmt::format("a target of the format grid holds {}, expected <cell position=\"x,y,z\">",
                      excerpt(child.name)));
    }
    PlannedEntry& entry = cells.emplace_back();
    entry.cell = *cell;
    const std::string* const color = find_attribute(child.attributes, "color");
    entry.color = color == nullptr ? std::nullopt : parse_color(*color);
    std::ranges::copy_if(
        child.attributes, std::back_inserter(entry.attributes),
        [](const auto& attribute) { return !is_planned_attribute(attribute.first); });
  }
  return cells;
}

base::Result<Document> goal_of(const Document& document) {
  const auto target = std::ranges::find_if(document.targets, is_goal);
  if (target == document.targets.end()) {
    return base::bad_input(
        "the structure has no goal shape, which is a <target format=\"grid\"> of VisibleSim XML "
        "that overlaps the modules: name a second file, in which the modules have the shape that "
        "is wanted");
  }
  const auto cells = goal_cells(*target);
  if (!cells) {
    return cells.error();
  }
  std::set<base::Cell> fixed;
  for (const ModuleEntry& module : document.modules) {
    if (module.is_fixed) {
      fixed.insert(module.cell);
    }
  }
  Document goal = document;
  goal.modules.clear();
  for (const PlannedEntry& entry : cells.value()) {
    goal.modules.push_back({entry.cell, fixed.contains(entry.cell), entry.color, {}});
  }
  goal.steps.clear();
  goal.targets.clear();
  goal.extension.plan.clear();
  goal.extension.own.clear();
  return goal;
}

Document with_targets(Document document) {
  std::vector<model::Step>& plan = document.extension.plan;
  const bool only_attaches =
      document.steps.empty() && std::ranges::none_of(document.targets, is_goal) &&
      std::ranges::all_of(
          plan, [](const model::Step& step) { return step == model::Step{.attach = step.attach}; });
  if (only_attaches) {
    for (const model::Step& step : plan) {
      Step& target = document.steps.emplace_back();
      for (const base::Cell& cell : step.attach) {
        target.emplace_back().cell = cell;
      }
    }
    plan.clear();
  }
  return document;
}

}  // namespace holdfast::io
