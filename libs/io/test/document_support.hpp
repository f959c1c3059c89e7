// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "holdfast/io/document.hpp"

/// Serves the tests of readers and writers.
namespace holdfast::io::document_test {

/// The document that was read; if it was refused, a failed expectation that says why, and nothing.
inline ReadDocument accepted(base::Result<ReadDocument> read) {
  EXPECT_TRUE(read) << read.error().where << ": " << read.error().message;
  return read ? std::move(read).value() : ReadDocument{};
}

/// A holdfast JSON text with these members, after the keys that must be there.
inline std::string json(std::string_view members) {
  return R"({"format": "holdfast-structure", "version": 1, )" + std::string(members) + "}";
}

}  // namespace holdfast::io::document_test
