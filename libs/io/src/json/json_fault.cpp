// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "json/json_fault.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "text_input.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kBlanks = " \t\n\r";
constexpr std::string_view kMarks = "{}[]:,";
constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kFoundMax = 20;

/// Removes digits from the front of a text; false if there are none.
bool take_digits(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_not_of(kDigits), text.size());
  text.remove_prefix(end);
  return end > 0;
}

bool take(std::string_view& text, std::string_view letters) {
  const bool is_there = !text.empty() && letters.find(text.front()) != std::string_view::npos;
  text.remove_prefix(is_there ? 1 : 0);
  return is_there;
}

/// Whether a word is a number [RFC 8259, section 6].
bool is_number(std::string_view word) {
  take(word, "-");
  return (take(word, "0") || take_digits(word)) && (!take(word, ".") || take_digits(word)) &&
         (!take(word, "eE") || (take(word, "+-"), take_digits(word))) && word.empty();
}

/// What in a string, quotes included, is not allowed; empty if nothing is.
std::string_view string_problem(std::string_view string) {
  for (std::size_t i = 1; i < string.size(); ++i) {
    if (string[i] >= '\0' && string[i] < ' ') {
      return "a string ends in the line in which it begins: '\"' is missing, or '\\n' is meant";
    }
    if (string[i] == '"') {
      return "";
    }
    if (string[i] == '\\' && ++i < string.size() &&
        std::string_view("\"\\/bfnrtu").find(string[i]) == std::string_view::npos) {
      return "in a string '\\' is written as '\\\\'";
    }
  }
  return "'\"' is missing at the end of a string";
}

/// What a word that JSON does not have is meant to be.
std::string_view advice(std::string_view word) {
  std::string small(word);
  std::ranges::transform(small, small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const auto begins = [&](std::string_view start) { return small.starts_with(start); };
  if (begins("//") || begins("/*") || begins("#")) {
    return "; JSON has no comments";
  }
  if (begins("'") || begins("\xE2\x80")) {  // Or a quotation mark of typography.
    return "; keys and strings stand in straight double quotes, \"";
  }
  if (begins("(")) {
    return "; a cell is [x, y, z]";
  }
  if (small == "true" || small == "false" || small == "none" || small == "nil") {
    return "; JSON has true, false and null";
  }
  if (small == "nan" || small.find("inf") < 2) {
    return "; numbers are finite";
  }
  return kDigits.find(small.front()) != std::string_view::npos || begins("+") || begins("-") ||
                 begins(".")
             ? "; numbers are written as 12, -0.5 or 1e-3"
             : "";
}

/// Goes from token to token and knows at each of them what may come.
class Walk {
 public:
  explicit Walk(std::string_view text) : text_(text) {}

  std::optional<base::Error> run() {
    while (true) {
      begin_ = std::min(text_.find_first_not_of(kBlanks, begin_), text_.size());
      token_ = next_token();
      if (token_.empty() && state_ == State::kEnd) {
        return std::nullopt;
      }
      const std::string_view problem = token_.starts_with('"') ? string_problem(token_) : "";
      if (!problem.empty()) {
        return fault(std::string(problem));
      }
      if (!step()) {
        return fault(fmt::format("expected {}, found {}{}", expected(), found(), hint()));
      }
      last_ = token_;
      begin_ += token_.size();
    }
  }

 private:
  enum class State { kFirstValue, kValue, kFirstKey, kKey, kColon, kComma, kEnd };

  /// A bracket that is not closed yet.
  struct Open {
    char bracket;
    std::size_t begin;
    std::string_view key;  ///< The key that it is the value of; empty in arrays.
  };

  std::string_view next_token() const {
    const std::string_view rest = text_.substr(begin_);
    if (rest.empty() || kMarks.find(rest.front()) != std::string_view::npos) {
      return rest.substr(0, 1);
    }
    if (!rest.starts_with('"')) {
      return rest.substr(0, rest.find_first_of(" \t\n\r{}[]:,\""));
    }
    std::size_t end = 1;
    while (end < rest.size() && rest[end] != '"') {
      end += rest[end] == '\\' ? 2 : 1;
    }
    return rest.substr(0, end + 1);
  }

  /// Takes the token; false if it may not stand here.
  bool step() {
    const char mark = token_.size() == 1 ? token_.front() : '\0';
    switch (state_) {
      case State::kFirstKey:
      case State::kKey:
        if (token_.starts_with('"')) {
          key_ = token_;
          state_ = State::kColon;
          return true;
        }
        return state_ == State::kFirstKey && close(mark);
      case State::kColon:
        state_ = mark == ':' ? State::kValue : state_;
        return mark == ':';
      case State::kFirstValue:
      case State::kValue:
        return value(mark) || (state_ == State::kFirstValue && close(mark));
      case State::kComma:
        if (mark == ',') {
          state_ = open_.back().bracket == '[' ? State::kValue : State::kKey;
          return true;
        }
        return close(mark);
      case State::kEnd:
        break;
    }
    return false;
  }

  bool value(char mark) {
    if (mark == '[' || mark == '{') {
      open_.push_back({mark, begin_, key_});
      key_ = "";
      state_ = mark == '[' ? State::kFirstValue : State::kFirstKey;
      return true;
    }
    const bool is_value = token_.starts_with('"') || token_ == "true" || token_ == "false" ||
                          token_ == "null" || is_number(token_);
    state_ = !is_value ? state_ : open_.empty() ? State::kEnd : State::kComma;
    return is_value;
  }

  char closing() const { return open_.back().bracket == '[' ? ']' : '}'; }

  bool close(char mark) {
    if (mark != closing()) {
      return false;
    }
    open_.pop_back();
    key_ = "";
    state_ = open_.empty() ? State::kEnd : State::kComma;
    return true;
  }

  std::string expected() const {
    switch (state_) {
      case State::kFirstKey:
        return "a key in double quotes or '}'";
      case State::kKey:
        return "a key in double quotes";
      case State::kColon:
        return "':' behind a key";
      case State::kFirstValue:
        return "a value or ']'";
      case State::kValue:
        return "a value";
      case State::kComma:
        return fmt::format("',' or '{}'", closing());
      case State::kEnd:
        break;
    }
    return "nothing behind the end";
  }

  std::string found() const {
    return token_.empty() ? "the end of the text" : excerpt(token_.substr(0, kFoundMax));
  }

  std::string hint() const {
    const bool is_closing = token_ == "]" || token_ == "}";
    if (last_ == "," && is_closing && token_.front() == closing()) {
      return fmt::format("; remove the ',' before '{}'", closing());
    }
    if (!open_.empty() && (token_.empty() || is_closing)) {
      const Open& open = open_.back();
      return fmt::format("; the {}{}{} that begins in {} is not closed",
                         open.bracket == '[' ? "array" : "object", open.key.empty() ? "" : " ",
                         open.key.empty() ? "" : excerpt(open.key.substr(1, open.key.size() - 2)),
                         place_at(text_, open.begin));
    }
    return token_.empty() ? "" : std::string(advice(token_));
  }

  base::Error fault(std::string message) const {
    return {base::ErrorCode::kBadInput, "no valid JSON: " + std::move(message),
            place_at(text_, begin_)};
  }

  std::string_view text_;
  std::size_t begin_ = 0;   ///< Of the token.
  std::string_view token_;  ///< Empty at the end of the text.
  std::string_view last_;   ///< The token before.
  std::string_view key_;    ///< Whose value comes.
  std::vector<Open> open_;
  State state_ = State::kValue;
};

}  // namespace

std::optional<base::Error> find_json_fault(std::string_view text) { return Walk(text).run(); }

}  // namespace holdfast::io
