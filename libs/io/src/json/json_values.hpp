// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "json/json_tree.hpp"
#include "reading.hpp"

namespace holdfast::io {

/// A value's place in the tree; its JSON pointer is put together only when someone asks. Outlived
/// by its parent.
struct JsonPlace {
  const JsonPlace* parent = nullptr;
  std::string_view key;  ///< Void if there is an index.
  std::optional<std::size_t> index;

  JsonPlace at(std::string_view member) const { return {this, member, {}}; }

  JsonPlace at(std::size_t element) const { return {this, {}, element}; }

  std::string pointer() const;
};

/// Takes values out of a tree by their type: a failure, and an empty value, if it is another.
class JsonReading : public Reading {
 public:
  using Reading::fail;

  void fail(const JsonPlace& place, std::string message);

  /// An object lacks a key that it must have; those that it has are named.
  void fail_missing(const Json& object, const JsonPlace& place, std::string_view key,
                    std::string_view expected = "");

  /// The one message for a value that is not what it should be.
  void refuse(const Json& value, const JsonPlace& place, std::string_view expected);

  /// A key that is none of the known ones: a failure, or a note if unknown ones are allowed;
  /// neither if it begins with `x-`.
  void note_unknown_key(const JsonPlace& place, Names known);

  const Json::object_t& members(const Json& value, const JsonPlace& place,
                                std::string_view expected = "an object");
  const Json::array_t& elements(const Json& value, const JsonPlace& place,
                                std::string_view expected = "an array");
  std::string string(const Json& value, const JsonPlace& place);
  bool boolean(const Json& value, const JsonPlace& place);
  double number(const Json& value, const JsonPlace& place);
  std::int32_t integer(const Json& value, const JsonPlace& place, IntegerRange range);
  base::Cell cell(const Json& value, const JsonPlace& place);

  /// Three numbers; `expected` says so for people, with an example.
  std::array<double, 3> vector(const Json& value, const JsonPlace& place,
                               std::string_view expected);
  Color color(const Json& value, const JsonPlace& place);

  /// Fails if a box between these corners has no cell.
  void expect_corners(const base::Cell& from, const base::Cell& to, const JsonPlace& place);

  /// Reads attributes; `is_reserved` tells names that have a place of their own.
  Attributes attributes(const Json& value, const JsonPlace& place,
                        bool (*is_reserved)(std::string_view name));

  /// Reads an element; `depth` counts from 1.
  Element element(const Json& value, const JsonPlace& place, int depth);
  std::vector<Element> element_list(const Json& value, const JsonPlace& place, int depth);

 private:
  std::array<std::int32_t, 3> triple(const Json& value, const JsonPlace& place, IntegerRange range);
};

/// Fails unless an object says that it is of version 1 of a format.
void expect_format(JsonReading& reading, const Json& value, const JsonPlace& place,
                   std::string_view format);

}  // namespace holdfast::io
