// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// VisibleSim's <obstacleList>: an <obstacle position color> for each cell. What it has no words for
// is in attributes of ours. An <obstacle> with one of them begins an obstacle that goes on with all
// those behind it that have none; so does one of another colour. `to` makes the first cell a corner
// of a box, and those behind it that lie in the box are there for VisibleSim only.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "reading.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

bool holds(const model::Obstacle& box, const base::Cell& cell) {
  return box.from.x <= cell.x && cell.x <= box.to.x && box.from.y <= cell.y && cell.y <= box.to.y &&
         box.from.z <= cell.z && cell.z <= box.to.z;
}

/// Attributes of ours, with any of which an <obstacle> begins a further obstacle.
constexpr const char* kBeginning[] = {"hold", "friction", "to"};

class ObstacleListReader {
 public:
  ObstacleListReader(Reading& reading, const Reading::Where& where)
      : reading_(reading), extension_(reading.document.extension), where_(where) {}

  void read(const Element& list) {
    extension_.obstacle_list = list.attributes;
    if (!list.text.empty()) {
      reading_.warn("text outside of elements is ignored", where_);
    }
    if (!reading_.take_room(list.children.size(), where_)) {
      return;
    }
    for (const Element& child : list.children) {
      if (child.name == kObstacleElement) {
        read_obstacle(child);
      } else {
        reading_.note_unknown(fmt::format("the element {}", excerpt(child.name)), child.name,
                              kObstacleListElements, "ignored here", where_);
      }
    }
    if (std::ranges::none_of(extension_.obstacle_colors,
                             [](const auto& color) { return color.has_value(); })) {
      extension_.obstacle_colors.clear();
    }
  }

 private:
  void read_obstacle(const Element& element) {
    const Attributes& attributes = element.attributes;
    for (const auto& attribute : attributes) {
      if (std::ranges::find(kObstacleAttributes, attribute.first) == kObstacleAttributes.end()) {
        reading_.note_unknown(
            fmt::format("the attribute {} of <obstacle>", excerpt(attribute.first)),
            attribute.first, kObstacleAttributes, "ignored", where_);
      }
    }
    if (!element.text.empty() || !element.children.empty()) {
      reading_.warn("the content of <obstacle> is ignored", where_);
    }
    const std::string* const position = find_attribute(attributes, "position");
    if (position == nullptr) {
      refuse("<obstacle> has no attribute 'position'");
      return;
    }
    const base::Cell cell = read_cell("position", *position);
    const std::string* const color_text = find_attribute(attributes, "color");
    const std::optional<Color> color =
        color_text == nullptr ? std::nullopt
                              : reading_.take_color(kObstacleElement, *color_text, where_);
    const bool begins = std::ranges::any_of(
        kBeginning, [&](const char* name) { return find_attribute(attributes, name) != nullptr; });
    if (begins || extension_.obstacles.empty() || extension_.obstacle_colors.back() != color ||
        (is_box_ && !holds(extension_.obstacles.back(), cell))) {
      begin(cell, attributes);
      extension_.obstacle_colors.push_back(color);
    } else if (!is_box_) {
      extension_.obstacles.back().cells.push_back(cell);
    }
  }

  void begin(const base::Cell& cell, const Attributes& attributes) {
    model::Obstacle& obstacle = extension_.obstacles.emplace_back();
    if (const std::string* const hold = find_attribute(attributes, "hold")) {
      obstacle.touch.hold = read_hold(*hold);
    }
    if (const std::string* const friction = find_attribute(attributes, "friction")) {
      obstacle.touch.friction = read_friction(*friction);
    }
    const std::string* const to = find_attribute(attributes, "to");
    is_box_ = to != nullptr;
    if (!is_box_) {
      obstacle.cells = {cell};
      return;
    }
    obstacle.from = cell;
    obstacle.to = read_cell("to", *to);
    if (!holds(obstacle, cell)) {
      refuse("no coordinate of 'to' of <obstacle> may be below that of 'position'");
    }
  }

  base::Cell read_cell(const char* name, const std::string& text) {
    const auto triple = parse_triple<std::int32_t>(text);
    const auto is_good = [](auto value) { return kCoordinateRange.contains(value); };
    if (!triple || !std::ranges::all_of(*triple, is_good)) {
      refuse(
          fmt::format("{} of <obstacle> is {}, expected three integers from {} to {}, such "
                      "as 1,2,3",
                      name, excerpt(text), kCoordinateRange.lowest, kCoordinateRange.highest));
      return {};
    }
    return {(*triple)[0], (*triple)[1], (*triple)[2]};
  }

  model::Hold read_hold(const std::string& text) {
    const auto found = std::ranges::find(kHoldNames, text);
    if (found == kHoldNames.end()) {
      refuse(fmt::format("hold of <obstacle> is {}, expected {} or {}", excerpt(text),
                         kHoldNames[0], kHoldNames[1]));
      return {};
    }
    return static_cast<model::Hold>(found - kHoldNames.begin());
  }

  double read_friction(const std::string& text) {
    const auto friction = parse_number<double>(text);
    if (!friction || !(*friction >= 0)) {
      refuse(fmt::format("friction of <obstacle> is {}, expected a number that is not negative",
                         excerpt(text)));
    }
    return friction.value_or(0);
  }

  void refuse(std::string message) {
    reading_.fail({base::ErrorCode::kBadInput, std::move(message), where_()});
  }

  Reading& reading_;
  Extension& extension_;
  const Reading::Where& where_;
  bool is_box_ = false;
};

}  // namespace

void Reading::take_obstacles(const Element& list, const Where& where) {
  ObstacleListReader(*this, where).read(list);
}

}  // namespace holdfast::io
