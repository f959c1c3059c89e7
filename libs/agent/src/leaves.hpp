// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/planned.hpp"

namespace holdfast::agent {

/// The planned modules of one host as a tree, parents before children.
struct Leaves {
  int count = 0;
  std::array<int, kPlannedMax> node{};    ///< Index into nodes_.
  std::array<int, kPlannedMax> parent{};  ///< The same; 0 is the host.
  std::array<base::Direction, kPlannedMax> to_parent{};
};

Leaves leaves_of(const Planned& planned);

/// Connections between the planned modules of one host, and with it.
int leaf_connections(const Planned& planned);

}  // namespace holdfast::agent
