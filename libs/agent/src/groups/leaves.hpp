// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/groups/planned.hpp"

namespace holdfast::agent {

/// The planned modules of one host as trees, parents before children.
struct Leaves {
  int count = 0;
  std::array<int, kPlannedMost> node{};    ///< Index into nodes_.
  std::array<int, kPlannedMost> parent{};  ///< The same; 0 is the host, or none.
  std::array<base::Direction, kPlannedMost> to_parent{};
};

/// All of them hang on the host, or on each other.
Leaves leaves_of(const Planned& planned);

/// All of them hang on each other: of each group one module has no parent.
Leaves group_trees(const Planned& planned);

/// Connections between the planned modules of one host, and with it.
int leaf_connections(const Planned& planned);

}  // namespace holdfast::agent
