// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/json_stream.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "holdfast/host/interruption.hpp"

namespace holdfast::io {
namespace {

template <class Integer>
void append_integer(std::string& out, Integer number) {
  std::array<char, 24> digits;
  const auto [end, fault] = std::to_chars(digits.data(), digits.data() + digits.size(), number);
  out.append(digits.data(), end);
}

}  // namespace

void JsonStream::begin_line() {
  if (layout_ == Layout::kIndented) {
    *out_ += '\n';
    out_->append(2 * static_cast<std::size_t>(depth_), ' ');
  }
}

void JsonStream::begin_value() {
  if (is_after_key_) {
    is_after_key_ = false;
    return;
  }
  if (depth_ > 0) {
    if (!is_first_) {
      *out_ += layout_ == Layout::kLine ? ", " : ",";
    }
    begin_line();
  }
  is_first_ = false;
}

void JsonStream::begin(char bracket) {
  host::ask_whether_to_go_on();
  begin_value();
  *out_ += bracket;
  ++depth_;
  is_first_ = true;
}

void JsonStream::end(char bracket) {
  --depth_;
  if (!is_first_) {
    begin_line();
  }
  *out_ += bracket;
  is_first_ = false;
}

void JsonStream::key(std::string_view name) {
  begin_value();
  *out_ += '"';
  *out_ += name;
  *out_ += layout_ == Layout::kCompact ? "\":" : "\": ";
  is_after_key_ = true;
}

void JsonStream::value(std::nullptr_t) {
  begin_value();
  *out_ += "null";
}

void JsonStream::value(bool flag) {
  begin_value();
  *out_ += flag ? "true" : "false";
}

void JsonStream::value(double number) {
  if (!std::isfinite(number)) {
    value(nullptr);
    return;
  }
  begin_value();
  // std::to_chars gives other digits for six numbers in ten thousand: those that this one, Grisu2,
  // writes one digit longer than needed. A report has to stay the same byte for byte.
  std::array<char, 64> digits;
  const char* begin = digits.data();
  const char* end = nlohmann::detail::to_chars(digits.data(), begin + digits.size(), number);
  out_->append(begin, end);
}

void JsonStream::value(std::string_view text) {
  begin_value();
  *out_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void JsonStream::value(const base::Cell& cell) {
  begin_array();
  value(cell.x);
  value(cell.y);
  value(cell.z);
  end_array();
}

void JsonStream::integer(std::int64_t number) {
  begin_value();
  append_integer(*out_, number);
}

void JsonStream::integer(std::uint64_t number) {
  begin_value();
  append_integer(*out_, number);
}

JsonStream JsonStream::part(std::string& out, bool is_first) const {
  JsonStream copy = *this;
  copy.out_ = &out;
  copy.is_first_ = is_first;
  return copy;
}

}  // namespace holdfast::io
