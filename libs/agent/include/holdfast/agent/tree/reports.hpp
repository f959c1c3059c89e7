// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/links/more_faces.hpp"
#include "holdfast/agent/wire/wire.hpp"

namespace holdfast::agent {

/// The reports of a module's children, as they have come. They are added up in the order of the
/// faces when all are here, not of their arrival, so that rounding does not depend on the timing.
class Reports {
 public:
  void await(Faces children) { awaited_ = children; }

  bool are_here() const { return awaited_.is_empty(); }

  bool awaits(base::Direction face) const { return awaited_.has(face); }

  Faces awaited() const { return awaited_; }

  void take(MoreFaces* more, base::Direction face, std::span<const std::uint8_t> message) {
    auto& into = at_face(messages_, more, &MoreFaces::messages, face);
    for (std::size_t i = 0; i < message.size(); ++i) {
      into[i] = message[i];
    }
    awaited_.remove(face);
  }

  std::span<const std::uint8_t> of(const MoreFaces* more, base::Direction face) const {
    return at_face(messages_, more, &MoreFaces::messages, face);
  }

 private:
  Faces awaited_;
  ByFace<std::array<std::uint8_t, wire::kMessageBytesMax>> messages_{};
};

}  // namespace holdfast::agent
