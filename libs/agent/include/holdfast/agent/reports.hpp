// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/wire.hpp"
#include "holdfast/base/faces.hpp"

namespace holdfast::agent {

/// The reports of a module's children, as they have come. They are added up in the order of the
/// faces when all are here, not of their arrival, so that rounding does not depend on the timing.
class Reports {
 public:
  void await(base::Faces children) { awaited_ = children; }

  bool are_here() const { return awaited_.is_empty(); }

  bool awaits(base::Direction face) const { return awaited_.has(face); }

  base::Faces awaited() const { return awaited_; }

  void take(base::Direction face, std::span<const std::uint8_t> message) {
    for (std::size_t i = 0; i < message.size(); ++i) {
      messages_[static_cast<std::size_t>(face)][i] = message[i];
    }
    awaited_.remove(face);
  }

  std::span<const std::uint8_t> of(base::Direction face) const {
    return messages_[static_cast<std::size_t>(face)];
  }

 private:
  base::Faces awaited_;
  std::array<std::array<std::uint8_t, wire::kMessageBytesMax>, base::kDirectionCount> messages_{};
};

}  // namespace holdfast::agent
