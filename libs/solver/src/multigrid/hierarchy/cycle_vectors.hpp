// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "multigrid/coarsening/level.hpp"

namespace holdfast::solver {

/// Hands out parts of memory that is given to it, and beyond that memory of its own.
template <class Item>
class Shelf {
 public:
  Shelf() = default;

  explicit Shelf(std::span<Item> lent) : lent_(lent) {}

  std::span<Item> take(std::size_t count) {
    if (count > lent_.size()) {
      return own_.emplace_back(count);
    }
    const std::span<Item> taken = lent_.first(count);
    lent_ = lent_.subspan(count);
    return taken;
  }

 private:
  std::span<Item> lent_;
  std::vector<std::vector<Item>> own_;
};

/// The memory of the vectors that the levels' cycle works in.
///
/// In double precision the finest level's z and its rough r say nothing while the levels below
/// work: z is then made from what these find and the sweeps' rough z, and the rough r anew from r
/// and that z. So these levels' vectors lie there, but for the z that the finest one is made from.
template <class Real>
class CycleVectors {
 public:
  /// Gives every level its vectors, unless they have them.
  void take(std::vector<Level<Real>>& levels) {
    if (levels.empty() || !z_.empty()) {
      return;
    }
    Level<Real>& finest = levels.front();
    const std::size_t count = finest.place_count + 1;
    r_.resize(count);
    z_.resize(count);
    rough_r_.resize(kIsDouble ? count : 0);
    rough_z_.resize(rough_r_.size());
    finest.r = r_;
    finest.z = z_;
    finest.rough_r = rough_r_;
    finest.rough_z = rough_z_;
    const std::size_t lent_count = kIsDouble ? finest.node_count : 0;
    coarse_ = Shelf(std::span(z_).first(lent_count));
    rough_ = Shelf(std::span(rough_r_).first(lent_count));
    for (Level<Real>& level : std::span(levels).subspan(1)) {
      take(level, &level == &levels[1] ? kept_ : coarse_);
    }
  }

  /// Takes all of them back but the finest level's r.
  void drop(std::vector<Level<Real>>& levels) {
    std::vector<Six<Real>> r = std::move(r_);
    *this = {};
    r_ = std::move(r);
    for (Level<Real>& level : levels) {
      level.r = &level == levels.data() ? r_ : std::span<Six<Real>>();
      level.z = level.first = level.first_image = {};
      level.rough_r = level.rough_z = {};
    }
  }

 private:
  static constexpr bool kIsDouble = std::is_same_v<Real, double>;

  void take(Level<Real>& level, Shelf<Six<Real>>& z) {
    const std::size_t count = level.place_count;
    level.z = z.take(count);
    level.r = coarse_.take(count);
    level.first = coarse_.take(count);
    level.first_image = coarse_.take(count);
    level.rough_r = rough_.take(kIsDouble ? count : 0);
    level.rough_z = rough_.take(kIsDouble ? count : 0);
  }

  std::vector<Six<Real>> r_;
  std::vector<Six<Real>> z_;
  std::vector<Six<float>> rough_r_;
  std::vector<Six<float>> rough_z_;
  Shelf<Six<Real>> kept_;  ///< The z of the level next to the finest one.
  Shelf<Six<Real>> coarse_;
  Shelf<Six<float>> rough_;
};

}  // namespace holdfast::solver
