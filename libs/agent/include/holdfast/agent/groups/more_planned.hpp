// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/groups/announcements.hpp"
#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/base/algebra.hpp"

namespace holdfast::agent {

/// What a module of a robot with more than kPlannedMax planned modules is lent: what it keeps of
/// those for which it has no room itself, each part under the name that it has for the others.
/// Messages are the same, but that several `hosts` orders are needed.
struct MorePlanned {
  /// Reals of a system with six unknowns for every planned module.
  static constexpr std::size_t kGroupReals = 36UL * kPlannedMost * kPlannedMost;

  template <class T>
  using List = std::array<T, kPlannedMost - kPlannedMax>;

  List<std::uint8_t> groups{};
  List<std::uint8_t> hosted{};
  std::array<List<Faces>, kFaceCountMax> below{};
  List<Faces> totals{};
  List<Faces> own_touching{};
  List<base::Cell> cells{};
  List<base::Vec6<float>> vector{};
  List<base::Vec6<double>> force{};
  List<Node> nodes{};

  // Of the method in use: new whenever one begins. Iterations need theirs in one piece.
  List<std::array<float, 15>> stiffness_above{};
  std::array<IterationMemory, 1 + kPlannedMost> iterations{};
  /// Where more than kPlannedMax are condensed here: factors, of the states they were made with.
  std::uint8_t group_count = 0;
  std::array<mechanics::ContactState, kPlannedMost> group_states{};

  AnnouncedPlaces announced{};  ///< All, in place of what a module has itself.

  /// Queues for the links, in place of theirs: the vectors of an iteration wait in it.
  std::array<std::uint8_t, static_cast<std::size_t>(kFaceCountMax) * Link::kPlannedBytes> queues{};

  std::span<double> group;  ///< kGroupReals; not owned.

  void clear_methods() {
    group_count = 0;
    stiffness_above = {};
    iterations = {};
  }
};

}  // namespace holdfast::agent
