// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/plan/module_moves.hpp"

namespace holdfast::plan {

/// Where one module can get to along the surface of all others, which stay.
class SurfaceWalk {
 public:
  /// Is asked whether a move is safe from a robot in which the module is where it begins.
  using IsSafe = std::function<bool(const RobotState&, const model::Move&)>;

  /// `from`: a loose module's cell.
  SurfaceWalk(const RobotState& robot, const base::Cell& from, const MoveRule& rule);

  /// The cells that it can get to as far as geometry goes, nearest first; the first is its own.
  std::span<const base::Cell> places() const { return places_; }

  /// A shortest way to a place of which every move is safe; none if there is none, as far as is
  /// known when `is_safe` gives up. What has been asked is not asked again.
  std::optional<std::vector<model::Move>> find_way(std::size_t place, const IsSafe& is_safe);

 private:
  enum class Known : std::uint8_t { kNothing, kSafe, kUnsafe };

  struct Edge {
    std::size_t to = 0;
    model::Move move;
    Known known = Known::kNothing;
  };

  struct Hop {
    std::size_t from = 0;
    std::size_t edge = 0;
  };

  void put(std::size_t place);
  std::optional<std::vector<Hop>> shortest(std::size_t place) const;

  RobotState robot_;  ///< With the module at `current_`.
  std::int32_t module_;
  std::size_t current_ = 0;
  std::vector<base::Cell> places_;
  std::vector<std::vector<Edge>> edges_;  ///< By place.
};

}  // namespace holdfast::plan
