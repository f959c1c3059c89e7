// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "reading.hpp"

namespace holdfast::io {

/// Takes values out of XML elements: a failure, and an empty value, if they are not what they
/// should be.
class XmlReading : public Reading {
 public:
  /// The text must outlive the reading.
  explicit XmlReading(std::string_view text) : text_(text) {}

  using Reading::fail;

  /// The tree of the whole text, several root elements allowed; a failure if there is none.
  void parse(pugi::xml_document& tree);

  /// Takes time proportional to the text before the element.
  std::string line(const pugi::xml_node& node) const;

  void fail(const pugi::xml_node& node, std::string message,
            base::ErrorCode code = base::ErrorCode::kBadInput);
  void warn_at(const pugi::xml_node& node, std::string message);

  /// Checks an element that is not kept: attributes once each, known ones only, no content.
  void expect_attributes(const pugi::xml_node& node, Names known);
  void expect_no_content(const pugi::xml_node& node);
  void warn_of_unknown_child(const pugi::xml_node& child, Names known);

  /// The attributes for which `is_read` is false.
  Attributes attributes(const pugi::xml_node& node, bool (*is_read)(std::string_view name));

  /// The value of an attribute; nullptr, and a failure, if there is none.
  const char* required(const pugi::xml_node& node, const char* name);

  // Of an attribute that is there.
  double number(const pugi::xml_node& node, const pugi::xml_attribute& attribute);

  /// Reads an integer, which may be written as "2.0".
  std::int32_t integer(const pugi::xml_node& node, const pugi::xml_attribute& attribute,
                       IntegerRange range);

  /// Reads the attribute "position".
  base::Cell cell(const pugi::xml_node& node);

  /// Reads the attribute "color", if there is one.
  std::optional<Color> color(const pugi::xml_node& node);

  /// Takes back what our writer has added to every cell, lest any be negative, by the attribute of
  /// <holdfast>.
  void take_back_shift(const pugi::xml_node& own);

  /// An element with everything in it. `depth` counts from 1.
  Element element(const pugi::xml_node& node, int depth = 1);

 private:
  std::array<std::int32_t, 3> triple(const pugi::xml_node& node, const char* name,
                                     IntegerRange range);

  std::string_view text_;
};

}  // namespace holdfast::io
