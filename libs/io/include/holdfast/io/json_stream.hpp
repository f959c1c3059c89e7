// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "holdfast/base/cell.hpp"

namespace holdfast::io {

/// Appends JSON to a text, value by value, without a tree of it in memory. The layout and the
/// digits are those of nlohmann-json's dump. Who calls sees to it that keys stand in objects only
/// and that whatever is begun is ended.
class JsonStream {
 public:
  enum class Layout : std::uint8_t {
    kIndented,  ///< By two blanks, a line for every value.
    kLine,      ///< In one line, with a blank behind every comma and colon.
    kCompact,   ///< Without blanks and line feeds.
  };

  /// Keeps a reference to the text, which may be emptied between two calls.
  explicit JsonStream(std::string& out, Layout layout = Layout::kIndented)
      : out_(&out), layout_(layout) {}

  void begin_object() { begin('{'); }

  void end_object() { end('}'); }

  void begin_array() { begin('['); }

  void end_array() { end(']'); }

  void key(std::string_view name);

  void value(std::nullptr_t);
  void value(bool flag);
  void value(double number);  ///< The shortest digits that give it back; null if it is not finite.
  void value(std::string_view text);   ///< What is not UTF-8 becomes U+FFFD.
  void value(const base::Cell& cell);  ///< An array of three numbers.

  void value(const char* text) { value(std::string_view(text)); }

  template <std::integral Integer>
  void value(Integer number) {
    if constexpr (std::is_signed_v<Integer>) {
      integer(static_cast<std::int64_t>(number));
    } else {
      integer(static_cast<std::uint64_t>(number));
    }
  }

  template <class T>
  void value(const std::optional<T>& number) {
    number ? value(*number) : value(nullptr);
  }

  template <class T>
  void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

  /// A stream into another text that continues the container that is open here; `is_first` if
  /// nothing stands in it yet. What it appends can be put behind this one's text.
  JsonStream part(std::string& out, bool is_first) const;

  /// Says that the parts of the open container, which are not empty, were put into it.
  void end_parts() { is_first_ = false; }

 private:
  void integer(std::int64_t number);
  void integer(std::uint64_t number);
  void begin(char bracket);
  void end(char bracket);
  void begin_value();  ///< The comma and the line in front of a value or key.
  void begin_line();

  std::string* out_;
  Layout layout_;
  int depth_ = 0;
  bool is_first_ = true;  ///< Nothing stands in the open container yet.
  bool is_after_key_ = false;
};

}  // namespace holdfast::io
