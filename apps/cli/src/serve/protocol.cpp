// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/protocol.hpp"

#include <fmt/format.h>

#include "holdfast/exit_code.hpp"

namespace holdfast::cli {
namespace {

/// Whether a text is UTF-8 without control characters that no text has.
bool is_text(const std::string& bytes) {
  if (bytes.find('\0') != std::string::npos) {
    return false;
  }
  try {
    static_cast<void>(Json(bytes).dump());
    return true;
  } catch (const Json::type_error&) {
    return false;
  }
}

}  // namespace

std::optional<RpcError> find_failure(const Finished& finished) {
  switch (finished.end) {
    case Finished::End::kCancelled:
      return RpcError{RpcCode::kCancelled, "cancelled"};
    case Finished::End::kTooLong:
      return RpcError{RpcCode::kTooLong,
                      "ended by the time limit of holdfast serve (--request-seconds)"};
    case Finished::End::kBySignal:
      return RpcError{RpcCode::kFailure,
                      "the command ended without an answer: out of memory, or a fault of holdfast"};
    case Finished::End::kByItself:
      break;
  }
  switch (finished.exit_code) {
    case kExitUsage:
      return RpcError{RpcCode::kInvalidParameters, finished.errors};
    case kExitBadInput:
      return RpcError{RpcCode::kBadInput, finished.errors};
    case kExitFailure:
      return RpcError{RpcCode::kFailure, finished.errors};
    default:
      return std::nullopt;
  }
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=';
    }
  }
  return text;
}

Json content_of(const std::string& bytes) {
  return is_text(bytes) ? Json(bytes) : Json{{"base64", base64(bytes)}};
}

}  // namespace holdfast::cli
