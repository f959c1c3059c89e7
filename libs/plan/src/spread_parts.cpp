// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "spread_parts.hpp"

#include <span>
#include <utility>

namespace holdfast::plan {
namespace {

/// So many are known: each takes one or two megabytes.
constexpr std::size_t kPartCountMax = 32;

std::span<const std::size_t> inner_of(const SpreadPart& part) {
  return std::span(part.modules).first(part.inner_count);
}

}  // namespace

void SpreadParts::add(Part part) {
  if (parts_.size() == kPartCountMax) {
    remove_first();
  }
  for (const std::size_t module : inner_of(*part)) {
    last_[module] = part;
  }
  parts_.push_back(std::move(part));
}

void SpreadParts::clear() {
  while (!parts_.empty()) {
    remove_first();
  }
}

void SpreadParts::remove_first() {
  const Part first = std::move(parts_.front());
  parts_.pop_front();
  for (const std::size_t module : inner_of(*first)) {
    if (last_[module] == first) {
      last_[module].reset();
    }
  }
}

}  // namespace holdfast::plan
