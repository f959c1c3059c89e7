// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/json.hpp"

namespace holdfast::cli {

std::optional<Json> read_json(std::string_view text) {
  bool is_deep = false;
  const Json::parser_callback_t guard = [&](int depth, Json::parse_event_t, Json&) {
    is_deep = is_deep || depth > kJsonDepthMax;
    return !is_deep;
  };
  Json value = Json::parse(text, guard, false);
  return is_deep || value.is_discarded() ? std::nullopt : std::optional(std::move(value));
}

std::string text_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string json_string(std::string_view text) { return text_of(Json(text)); }

std::string_view kind_of(const Json& value) {
  switch (value.type()) {
    case Json::value_t::object:
      return "an object";
    case Json::value_t::array:
      return "an array";
    case Json::value_t::string:
      return "a string";
    case Json::value_t::boolean:
      return "true or false";
    case Json::value_t::null:
      return "null";
    default:
      return "a number";
  }
}

}  // namespace holdfast::cli
