// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "visiblesim/xml_spelling.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/near_miss.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// The content that may stand in an element that is read.
struct Content {
  std::string_view element;
  Names attributes;
  Names children;
};

/// The elements that are read; the first, whose name is empty, is the document.
const std::vector<Content>& contents() {
  static const std::vector<Content> list = {{"", {}, kRootElements},
                                            {kRootElement, {}, kRootElements},
                                            {"parameters", parameter_names(), {}},
                                            {"world", kWorldAttributes, kWorldElements},
                                            {"blockList", kBlockListAttributes, kBlockListElements},
                                            {"block", kBlockAttributes, {}},
                                            {"blocksLine", kRowAttributes, {}},
                                            {"blockBox", kBoxAttributes, {}},
                                            {"csg", kSolidAttributes, {}},
                                            {"targetList", {}, kTargetListElements},
                                            {"target", kTargetAttributes, kTargetElements},
                                            {"cell", kCellAttributes, {}},
                                            {"targetLine", kRowAttributes, {}},
                                            {kObstacleListElement, {}, kObstacleListElements},
                                            {kObstacleElement, kObstacleAttributes, {}},
                                            {kOwnElement, own_element_names(), kOwnElements},
                                            {kOwnElements[0], kKnownAnswerKeys, {}}};
  return list;
}

/// An element or an attribute.
template <class Named>
void spell(Named named, Names known) {
  const std::string_view name = named.name();
  const auto spelling = known_spelling(name, known);
  if (spelling && *spelling != name) {
    named.set_name(std::string(*spelling).c_str());
  }
}

void spell_content(pugi::xml_node node, const Content& content) {
  for (const pugi::xml_attribute attribute : node.attributes()) {
    spell(attribute, content.attributes);
  }
  const bool is_kept = content.element == std::string_view("target") &&
                       node.attribute("format").value() != std::string_view("grid");
  if (content.children.empty() || is_kept) {
    return;
  }
  // Most children have the name of the one before.
  std::string_view last;
  std::optional<Content> inner;
  for (const pugi::xml_node child : node.children()) {
    if (child.type() != pugi::node_element) {
      continue;
    }
    spell(child, content.children);
    if (child.name() != last) {
      last = child.name();
      const auto found = std::ranges::find(contents(), last, &Content::element);
      const bool is_read = found != contents().end() && known_spelling(last, content.children);
      inner = is_read ? std::optional(*found) : std::nullopt;
    }
    if (inner) {
      spell_content(child, *inner);
    }
  }
}

}  // namespace

void spell_as_known(pugi::xml_node tree) { spell_content(tree, contents().front()); }

}  // namespace holdfast::io
