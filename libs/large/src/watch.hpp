// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "equilibrium.hpp"
#include "touching.hpp"

/// What is to be known of an equilibrium, and what happens there.
namespace holdfast::large {

/// An equilibrium, and what is watched there: an event has happened where its value is 0 or more.
struct Stop {
  Found found;
  State state = {};
  std::array<double, kEventKindCount> value{};
  std::array<std::vector<std::size_t>, kEventKindCount> modules{};
};

/// Watches the equilibria of a robot. Keeps references.
class Watch {
 public:
  Watch(const System& system, const Options& options)
      : system_(system), bodies_(system.robot(), options.obstacles) {}

  /// All that is to be known of an equilibrium, found by examined() as the last.
  Stop stop_at(Found found) const;

 private:
  std::vector<std::size_t> most_strained() const;

  const System& system_;
  Bodies bodies_;
};

}  // namespace holdfast::large
