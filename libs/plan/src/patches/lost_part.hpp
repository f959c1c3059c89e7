// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "cut_vertices.hpp"
#include "equilibria/changed_robot.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/losses.hpp"

namespace holdfast::plan {

/// One loss in terms of the robot's indices.
struct LostPart {
  Loss loss;
  std::optional<std::size_t> module = {};  ///< If one is lost.
  std::size_t fallen_count = 0;            ///< As of LossAnswer.
  bool is_apart = false;  ///< What is left is in several parts, fallen ones included.
  /// What the robot lacks. A lost module hangs on its first beam, without weight.
  Change change = {};
  std::optional<model::Connection> hanging = {};  ///< That beam.
  bool has_fixed = false;                         ///< Something fixed is lost.
  /// The modules of a body that is lost, by index; `change` says nothing of it, so it takes a
  /// check.
  std::vector<std::int32_t> body = {};

  /// Whether a connection is not among those that are left.
  bool lacks(const model::Connection& pair) const {
    if (has_lost(pair.a) || has_lost(pair.b)) {
      return true;
    }
    const auto is_same = [&](const model::Connection& other) {
      return pair.a == other.a && pair.b == other.b;
    };
    return (hanging && is_same(*hanging)) || std::ranges::any_of(change.lost_beams, is_same);
  }

  /// Whether a module is lost.
  bool has_lost(std::int32_t index) const {
    return (module && static_cast<std::int32_t>(*module) == index) ||
           std::ranges::binary_search(body, index);
  }
};

/// Finds the parts of a robot that may be lost, and what falls with them, in time that grows with
/// its size. Keeps a reference.
class PartFinder {
 public:
  explicit PartFinder(const model::Robot& robot);

  std::vector<LostPart> find(const std::array<bool, kLossKindCount>& kinds) const;

 private:
  void add_connections(std::vector<LostPart>& parts) const;
  void add_modules(std::vector<LostPart>& parts) const;
  void add_feet(std::vector<LostPart>& parts) const;
  LostPart without_module(std::size_t module) const;
  LostPart without_body(std::int32_t body, std::vector<std::int32_t> modules) const;

  const model::Robot& robot_;
  DepthFirstTree tree_;
  std::vector<std::size_t> first_facet_;  ///< By module.
  std::vector<std::size_t> below_;        ///< By module: how many are below it and itself,
  std::vector<std::size_t> held_below_;   ///< and of these held by the environment.
  std::vector<std::vector<std::size_t>> loose_children_;  ///< By module: those that hang on it.
};

}  // namespace holdfast::plan
