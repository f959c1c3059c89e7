// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "json/json_tree.hpp"

namespace holdfast::io {

std::string json_text(const std::string& value) {
  return Json(value).dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string json_text(double value) { return fmt::format("{}", value); }

std::string json_text(const std::optional<double>& value) {
  return value ? json_text(*value) : std::string("null");
}

std::string json_text(const base::Cell& cell) {
  return fmt::format("[{},{},{}]", cell.x, cell.y, cell.z);
}

std::string json_text(std::span<const base::Cell> cells) {
  Items items;
  for (const base::Cell& cell : cells) {
    items.push_back(json_text(cell));
  }
  return row(items);
}

std::string json_text(const Color& color) {
  return fmt::format("[{},{},{}]", color.red, color.green, color.blue);
}

std::string member(std::string_view key, const std::string& value) {
  return fmt::format("\"{}\": {}", key, value);
}

std::string object(const Items& members) { return fmt::format("{{{}}}", fmt::join(members, ", ")); }

std::string object(const Items& members, std::size_t indent) {
  std::string line = object(members);
  return line.size() <= kShortMax ? line : lines('{', members, '}', indent);
}

std::string row(const Items& items) { return fmt::format("[{}]", fmt::join(items, ", ")); }

std::string array(const Items& items, std::size_t indent) {
  return items.empty() ? "[]" : lines('[', items, ']', indent);
}

std::string lines(char open, const Items& items, char close, std::size_t indent) {
  const std::string blanks(indent, ' ');
  return fmt::format("{}\n{}  {}\n{}{}", open, blanks, fmt::join(items, ",\n  " + blanks), blanks,
                     close);
}

}  // namespace holdfast::io
