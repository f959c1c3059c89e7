// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "beam_blocks.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"

namespace holdfast::plan {

/// Single modules of a part of a robot in balance with their neighbours, all facets stuck.
class LocalBalance {
 public:
  using Vec = base::Vec6<double>;

  /// K_mm of a module.
  struct Stiffness {
    base::Mat6<double> sum{};
    base::Mat6<double> inverse{};
  };

  /// What a module gets from a neighbour that moves by u: less K_12 u.
  struct Beam {
    const base::Mat6<double>* block_12 = nullptr;
    std::size_t other = 0;
  };

  /// Keeps a reference to the whole robot, of which nothing is there.
  explicit LocalBalance(const model::Robot& target);

  /// Nothing but these is there.
  void assign(const std::vector<Element>& elements);

  void insert(std::size_t module) { is_there_[module] = 1; }

  void erase(std::size_t module) { is_there_[module] = 0; }

  bool is_there(std::size_t module) const { return is_there_[module] != 0; }

  /// The module that is there in a direction, or kNoNeighbour.
  std::int32_t neighbour(std::size_t module, int direction) const {
    const std::int32_t other = target_->connected()[module][base::at(direction)];
    return other != model::Robot::kNoNeighbour && is_there(base::at(other))
               ? other
               : model::Robot::kNoNeighbour;
  }

  /// each(direction, other) for every module that is there beside one.
  template <class Each>
  void for_each_neighbour(std::size_t module, const Each& each) const {
    for (const base::Direction direction : base::directions(target_->lattice())) {
      const std::int32_t other = neighbour(module, base::index(direction));
      if (other != model::Robot::kNoNeighbour) {
        each(direction, base::at(other));
      }
    }
  }

  /// The stiffness of a module that touches something. Stays where it is.
  const Stiffness& stiffness(std::size_t module);

  /// Adds the beams of a module; they are valid as long as *this stays where it is.
  void add_beams(std::size_t module, std::vector<Beam>& beams) const;

  /// What is out of balance at a module if it does not move, and others by u.
  Vec pull(std::size_t module, const std::vector<Vec>& u) const;

  /// What is out of balance there, by beams that were looked up before.
  Vec pull(std::size_t module, std::span<const Beam> beams, const std::vector<Vec>& u) const;

  /// The force that a stuck facet in a direction takes from its module.
  Vec facet_force(base::Direction direction, const Vec& u) const;

 private:
  const model::Robot* target_;
  BeamBlocks blocks_;
  std::vector<std::size_t> first_facet_;  ///< By module.
  std::vector<std::uint8_t> is_there_;
  /// What is known by the directions of a module's beams and facets.
  std::unordered_map<std::uint32_t, Stiffness> known_;
};

}  // namespace holdfast::plan
