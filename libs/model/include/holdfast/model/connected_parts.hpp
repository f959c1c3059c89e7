// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "holdfast/model/connections.hpp"

namespace holdfast::model {

/// Finds which modules are connected with each other, directly or through others, as connections
/// are named one after another [Galler and Fischer 1964].
class ConnectedParts {
 public:
  /// Begins with modules 0 to `count` - 1, each a part by itself.
  explicit ConnectedParts(std::size_t count);

  /// Makes one part of those of two modules.
  void join(std::int32_t a, std::int32_t b);

  /// The smallest module of the part that a module belongs to.
  std::int32_t first_of(std::int32_t module);

  /// The parts of the first `count` modules, each ascending, ordered by their first.
  std::vector<std::vector<std::int32_t>> lists(std::size_t count);

  std::vector<std::vector<std::int32_t>> lists() { return lists(parent_.size()); }

 private:
  std::vector<std::int32_t> parent_;
};

/// The parts of `count` modules that are joined by those connections of which is_whole(index,
/// connection) is true; the index counts in `connections`.
template <class IsWhole>
ConnectedParts connected_parts(const Connections& connections, std::size_t count,
                               const IsWhole& is_whole) {
  ConnectedParts parts(count);
  std::size_t index = 0;
  for (const Connection& pair : connections) {
    if (is_whole(index++, pair)) {
      parts.join(pair.a, pair.b);
    }
  }
  return parts;
}

}  // namespace holdfast::model
