// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "local_balance.hpp"

namespace holdfast::plan {

/// The connections of a growing robot without which a part of it would have no support. Statics
/// alone says what each bears: the loads of that part. So however the rest moves, they are known
/// exactly, while a module that is attached makes anything else uncertain.
class CutConnections {
 public:
  using Vec = base::Vec6<double>;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  explicit CutConnections(const model::Robot& target);

  /// Begins with a connected state that has a support.
  void assign(const std::vector<Element>& elements);

  /// None are known, until the next assign().
  void clear() {
    cuts_.clear();
    released_ratio_ = 0;
  }

  /// Attaches a module beside one that is there. Where a loop, or a support, then bears a part of
  /// what some of them bore alone, these are released: they are none any more.
  void add(std::size_t module);

  /// Whether the connection between these is one of them. Connections of modules that have been
  /// attached since assign() are not.
  bool contains(std::size_t a, std::size_t b) const;

  /// The largest load ratio that one that was released since assign() has had since then, else 0.
  double released_ratio() const { return released_ratio_; }

  /// The largest load ratio of all of them, 0 if there is none.
  double load_ratio() const;

  /// That of all other connections between modules that were there at assign(), by displacements by
  /// module; 0 if there is none.
  double load_ratio_of_others(const std::vector<Vec>& u) const;

 private:
  static constexpr std::int32_t kNone = -1;

  struct Cut {
    std::size_t module = 0;  ///< Its end in the part without a support, and the other one.
    std::size_t other = 0;
    int direction = 0;            ///< From the first.
    std::int32_t behind = kNone;  ///< The next one on the way to a support.
    Vec borne{};                  ///< All loads of that part, about the origin.
    double ratio = 0;
    double ratio_max = 0;  ///< Of all so far.
    bool is_released = false;
  };

  /// A module on the way of the depth-first search.
  struct Visit {
    std::size_t module = 0;
    int next = 0;  ///< The direction to look in.
  };

  bool is_support(std::size_t module) const;
  void visit(std::size_t first);
  void leave(std::vector<Visit>& way);
  void name_blocks();
  void bear(Cut& cut, const Vec& load);
  std::int32_t first_of(std::int32_t cut) const;
  std::int32_t join(std::int32_t a, std::int32_t b);

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  LocalBalance local_;
  std::vector<std::uint8_t> has_facet_;
  std::vector<Cut> cuts_;
  std::vector<std::int32_t> own_;    ///< By module: the cut whose first end it is.
  std::vector<std::int32_t> block_;  ///< By module: the nearest cut on the way to a support.
  std::vector<std::int32_t> order_;  ///< Of the search, by module; the ground is 0.
  std::vector<std::int32_t> low_;    ///< The least order that the part beyond is beside.
  double released_ratio_ = 0;
  std::vector<std::size_t> visited_;  ///< As they came.
  std::vector<int> way_to_;           ///< By module: the direction back.
};

}  // namespace holdfast::plan
