// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_tree.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/host/interruption.hpp"
#include "holdfast/io/document.hpp"
#include "json/json_fault.hpp"
#include "reading.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

/// A string, every character of it an escape, fits in. What is longer is noise, and the parser
/// would copy it several times.
constexpr std::size_t kTokenBytesMax = 8 * kStringBytesMax;

/// A pointer shows so much of a key.
constexpr std::size_t kTokenShownMax = 60;

/// One pass over the text, before the parser takes memory for it.
class ShapeCheck {
 public:
  explicit ShapeCheck(std::string_view text) : text_(text) {}

  std::optional<base::Error> run() {
    for (std::size_t i = 0; i < text_.size(); ++i) {
      is_in_string_ ? step_in_string(i) : step(i);
      if (depth_ > kNestingMax) {
        return syntax_error(text_, i,
                            fmt::format("brackets nested deeper than the {} allowed", kNestingMax));
      }
      if (i > token_begin_ + kTokenBytesMax) {
        return syntax_error(
            text_, token_begin_,
            fmt::format("a string or number longer than the {} bytes allowed", kTokenBytesMax));
      }
    }
    return std::nullopt;
  }

 private:
  void step_in_string(std::size_t& i) {
    is_in_string_ = text_[i] != '"';
    i += text_[i] == '\\' ? 1 : 0;
  }

  void step(std::size_t i) {
    switch (text_[i]) {
      case '"':
        is_in_string_ = true;
        return;
      case '[':
      case '{':
        ++depth_;
        break;
      case ']':
      case '}':
        --depth_;
        break;
      case ',':
      case ':':
      case ' ':
      case '\t':
      case '\r':
      case '\n':
        break;
      default:
        return;
    }
    token_begin_ = i + 1;
  }

  std::string_view text_;
  int depth_ = 0;
  bool is_in_string_ = false;
  std::size_t token_begin_ = 0;
};

/// Takes the parser's events and builds the tree, as nlohmann's own builder does, with the checks
/// that are its reason to be.
class TreeBuilder {
 public:
  explicit TreeBuilder(std::string_view text) : text_(text) {}

  base::Result<Json> take() && {
    if (error_) {
      return *error_;
    }
    return std::move(root_);
  }

  // Called by the parser, which goes on while they are true.
  bool null() { return add(nullptr); }

  bool boolean(bool value) { return add(value); }

  bool number_integer(Json::number_integer_t value) { return add(value); }

  bool number_unsigned(Json::number_unsigned_t value) { return add(value); }

  bool number_float(Json::number_float_t value, const std::string& /*text*/) { return add(value); }

  bool string(std::string& value) { return add(std::move(value)); }

  bool binary(Json::binary_t& /*value*/) { return false; }

  bool start_object(std::size_t /*count*/) {
    open_.push_back(&put(Json::object()));
    return true;
  }

  bool start_array(std::size_t /*count*/) {
    host::ask_whether_to_go_on();
    Json& array = put(Json::array());
    array.get_ref<Json::array_t&>().reserve(3);  // Most are cells.
    open_.push_back(&array);
    return true;
  }

  bool end_object() { return close(); }

  bool end_array() { return close(); }

  bool key(std::string& name) {
    Json& object = *open_.back();
    if (object.size() == kAttributeCountMax) {
      return fail(name, fmt::format("one object has more than {} keys", kAttributeCountMax));
    }
    if (object.contains(name)) {
      return fail(name, "the same key twice in one object, expected once");
    }
    member_ = &object[name];
    return true;
  }

  bool parse_error(std::size_t position, const std::string& /*token*/,
                   const nlohmann::detail::exception& fault) {
    // 406 is the parser's number for a number beyond the range of double.
    const auto known = fault.id == 406 ? std::nullopt : find_json_fault(text_);
    error_ =
        syntax_error(text_, position == 0 ? 0 : position - 1,
                     fault.id == 406 ? "a number beyond the range of double" : "no valid JSON");
    if (known && !error_->message.starts_with(kConflict)) {
      error_ = known;
    }
    return false;
  }

 private:
  bool add(Json value) {
    put(std::move(value));
    return true;
  }

  /// Puts a value where it belongs. Containers keep their address while they are open: only the
  /// innermost one grows.
  Json& put(Json value) {
    if (open_.empty()) {
      return root_ = std::move(value);
    }
    if (open_.back()->is_array()) {
      return open_.back()->emplace_back(std::move(value));
    }
    return *member_ = std::move(value);
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  /// Records an error at a key of the innermost open object, and returns false.
  bool fail(const std::string& key, std::string message) {
    std::string pointer = "/" + pointer_token(key);
    for (std::size_t i = open_.size() - 1; i > 0; --i) {
      if (pointer.size() > kPointerShownMax) {
        pointer.insert(0, "...");
        break;
      }
      const auto* object = open_[i - 1]->get_ptr<const Json::object_t*>();
      pointer.insert(0, "/" + (object == nullptr ? std::to_string(open_[i - 1]->size() - 1)
                                                 : pointer_token(object->back().first)));
    }
    error_ = {base::ErrorCode::kBadInput, std::move(message), std::move(pointer)};
    return false;
  }

  std::string_view text_;
  Json root_;
  std::vector<Json*> open_;  ///< From the root to the innermost open container.
  Json* member_ = nullptr;   ///< Where the value of the last key goes.
  std::optional<base::Error> error_;
};

}  // namespace

std::string pointer_token(std::string_view key) {
  std::string token;
  for (const char c : key.substr(0, kTokenShownMax)) {
    if (c == '~' || c == '/') {
      token += c == '~' ? "~0" : "~1";
    } else {
      token += c < ' ' || c > '~' ? '?' : c;
    }
  }
  return token;
}

base::Result<Json> parse_json(std::string_view text) {
  if (const auto fault = ShapeCheck(text).run()) {
    return *fault;
  }
  TreeBuilder builder(text);
  Json::sax_parse(text.begin(), text.end(), &builder);
  return std::move(builder).take();
}

}  // namespace holdfast::io
