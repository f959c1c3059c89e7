// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "equilibria/solved_core.hpp"
#include "holdfast/solver/influence.hpp"

namespace holdfast::plan {

/// A robot all of whose facets are stuck, by its Influence: modules answer to loads where that was
/// asked for their inverse, and wherever one of both has a facet, after find_columns(). Keeps a
/// reference.
class InfluenceCore final : public SolvedCore {
 public:
  explicit InfluenceCore(const solver::Influence& influence) : influence_(influence) {}

  /// Finds what loads on modules with facets do to all others; false if that needs more memory.
  bool find_columns(std::size_t memory_bytes_max);

  std::span<const solver::FacetState> facets() const override { return influence_.facets(); }

  const solver::FacetLaw<double>& law() const override { return influence_.law(); }

  const model::LatticeBeam<double>& beam() const override { return influence_.beam(); }

  const Vec& displacement(std::size_t module) const override {
    return influence_.displacement()[module];
  }

  bool knows(std::span<const std::size_t> /*modules*/) const override { return true; }

  Vec answer(std::size_t module, const PointLoad& load) const override;

 private:
  using Mat = base::Mat6<double>;

  static constexpr std::int32_t kNone = -1;

  /// Of a module that has a facet, by loads on one that has.
  const Mat& column(std::size_t module, std::int32_t place) const {
    return columns_[module * modules_.size() + base::at(place)];
  }

  const solver::Influence& influence_;
  std::vector<std::size_t> modules_;  ///< Those that have facets.
  std::vector<std::int32_t> place_;   ///< By module: in modules_, or kNone. Empty: no columns.
  std::vector<Mat> columns_;          ///< By module, then place.
};

}  // namespace holdfast::plan
