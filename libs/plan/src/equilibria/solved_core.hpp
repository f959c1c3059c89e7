// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// A load on one module.
struct PointLoad {
  std::size_t module = 0;
  base::Vec6<double> load{};
};

/// A robot that was solved, all its facets stuck, by its Influence, and how it answers to more
/// loads as long as they are. Answers are known where somebody asked the Influence for its inverse,
/// and wherever one of both modules has a column. Keeps a reference.
class SolvedCore {
 public:
  using Vec = base::Vec6<double>;
  using Mat = base::Mat6<double>;

  explicit SolvedCore(const solver::Influence& influence)
      : influence_(influence), columns_(influence.displacement().size()) {}

  /// Finds the columns of these modules, what loads on them do to all others, as far as they are
  /// not known. False if all columns together need more memory.
  bool find_columns(std::span<const std::size_t> modules, std::size_t memory_bytes_max);

  /// The facets, all of them stuck.
  std::span<const solver::FacetState> facets() const { return influence_.facets(); }

  const solver::FacetLaw<double>& law() const { return influence_.law(); }

  const model::LatticeBeam<double>& beam() const { return influence_.beam(); }

  /// How far a module is displaced by the robot's own loads.
  const Vec& displacement(std::size_t module) const { return influence_.displacement()[module]; }

  /// How far a module moves by one more load.
  Vec answer(std::size_t module, const PointLoad& load) const;

  /// The memory that columns take.
  std::size_t column_bytes() const { return column_count_ * columns_.size() * sizeof(Mat); }

 private:
  bool has_column(std::size_t module) const { return !columns_[module].empty(); }

  const solver::Influence& influence_;
  std::vector<std::vector<Mat>> columns_;  ///< By module; empty: not known.
  std::size_t column_count_ = 0;
};

/// The most by which rounding of what Influence::solve() gives may move a load ratio, as a share of
/// the largest or of 1; not a number if load ratios are none.
double rounding_share(const model::Robot& robot, const solver::Influence& influence);

/// Rounding beyond this share is left to checks, which refine.
inline constexpr double kRoundingShareMax = 1e-9;

}  // namespace holdfast::plan
