// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/block_lu.hpp"
#include "local_balance.hpp"

namespace holdfast::plan {

/// Loads that go down to supports through all modules near a way, as if these were a robot of their
/// own: forces that balance the load in the whole robot as well, and cost a fraction of what those
/// along a single file of modules do, which bends by whatever leads the load aside.
class LoadSpread {
 public:
  using Vec = base::Vec6<double>;

  /// Modules of the target that take a load together.
  struct Part {
    struct Beam {
      std::int32_t a = 0;  ///< Places in `modules`; b is negative for one that is fixed.
      std::int32_t b = 0;
      base::Direction direction{};  ///< From a.
    };

    std::vector<std::size_t> modules;
    std::size_t inner_count = 0;  ///< So many of them, the first ones, are not at its edge.
    std::vector<Beam> beams;
    solver::BlockLu factor;
  };

  /// Where a way comes to a part.
  struct Entry {
    const Part* part = nullptr;
    std::size_t place = 0;   ///< In its modules.
    std::size_t on_way = 0;  ///< That module's place on the way.
  };

  /// So many modules for each on the way a part must have: fewer bend like the way itself. In a
  /// scaffold of 9,100 modules parts of two to four made an order a fifth slower.
  static constexpr std::size_t kWidthMin = 5;

  /// Keeps a reference to the robot, all modules of which are there in the end.
  explicit LoadSpread(const model::Robot& target, std::size_t width_min = kWidthMin);

  /// A part that a way, which ends at a support, comes to soon: one of those that were found last,
  /// or all modules that are there within some steps of the way, all facets stuck. None if there
  /// are too few or too many of these, or if they cannot be solved. It is known until the next
  /// call.
  std::optional<Entry> find(std::span<const std::size_t> way, const LocalBalance& there);

  /// How the part's modules move under a load on one of them if there are no others; empty if that
  /// cannot be told to all digits.
  std::vector<Vec> displacement(const Entry& entry, const Vec& load) const;

  /// Forgets all parts, which are large, or have modules that are gone.
  void clear() { parts_.clear(); }

 private:
  bool is_fixed(std::size_t module) const;
  std::optional<Entry> find_known(std::span<const std::size_t> way) const;
  std::optional<Part> make(std::span<const std::size_t> way, const LocalBalance& there);
  std::vector<Part::Beam> beams(const std::vector<std::size_t>& modules,
                                const LocalBalance& there) const;
  std::optional<solver::BlockLu> factored(const std::vector<std::size_t>& modules,
                                          const std::vector<Part::Beam>& beams) const;
  void subtract_forces(const Part& part, const std::vector<Vec>& u, std::vector<Vec>& rest) const;

  static constexpr std::int32_t kAbsent = -1;

  const model::Robot* target_;
  std::size_t width_min_;
  model::LatticeBeam<double> beam_;
  std::array<base::Mat6<double>, base::Lattice::kDirectionCountMax> k11_{};  ///< By direction.
  std::array<base::Mat6<double>, base::Lattice::kDirectionCountMax> k12_{};
  std::vector<std::size_t> first_facet_;  ///< By module.
  std::vector<std::int32_t> place_;       ///< By module: in a part that is made, or kAbsent.
  std::deque<Part> parts_;                ///< The latest first.
};

}  // namespace holdfast::plan
