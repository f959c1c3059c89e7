// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "holdfast/base/check.hpp"

/// Expected failures as values. For hosts only: `Error` owns strings, so `agent` must not use it.
namespace holdfast::base {

enum class ErrorCode : std::uint8_t {
  kBadInput,     ///< A file or a structure breaks a rule of its format or of physics.
  kUnreadable,   ///< A file cannot be opened, is not a file or is too large.
  kUnwritable,   ///< A file cannot be written.
  kUnsupported,  ///< Well-formed, but beyond what this version handles.
};

/// An error: what went wrong and where. `message` names the value found and the value allowed.
struct Error {
  ErrorCode code = ErrorCode::kBadInput;
  std::string message = {};
  std::string where = {};               ///< File, line, or path inside a document; may be empty.
  std::vector<std::string> notes = {};  ///< What a reader had noted before it met the error.
};

/// The error of something that breaks a rule.
inline Error bad_input(std::string message, std::string where = {}) {
  return {.code = ErrorCode::kBadInput, .message = std::move(message), .where = std::move(where)};
}

/// A value or an Error. Reading the one that is not there is a bug and aborts.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}  // NOLINT(google-explicit-constructor)

  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return state_.index() == 0; }

  explicit operator bool() const { return has_value(); }

  const T& value() const& {
    HOLDFAST_CHECK(has_value());
    return *std::get_if<0>(&state_);
  }

  T&& value() && {
    HOLDFAST_CHECK(has_value());
    return std::move(*std::get_if<0>(&state_));
  }

  const Error& error() const {
    HOLDFAST_CHECK(!has_value());
    return *std::get_if<1>(&state_);
  }

 private:
  std::variant<T, Error> state_;
};

}  // namespace holdfast::base
