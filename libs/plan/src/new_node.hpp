// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/solver/influence.hpp"
#include "site.hpp"

namespace holdfast::plan {

/// A new module's node, eliminated: what it does to its hosts. With the load p on the new node, the
/// stiffness D there and B_i between host i and it, host i feels
///   t_i = q_i - sum over j of C_ij u_j,   q = -B D^-1 p,   C = A - B D^-1 B',
/// where A_i is what the new beam adds at host i. With one beam and no facet C is zero.
class NewNode {
 public:
  using Vec = base::Vec6<double>;
  using Mat = base::Mat6<double>;

  /// No new module at all.
  NewNode() = default;

  /// With its own facet on the floor, if it has one, in a state.
  NewNode(const solver::Influence& influence, const Site& site, const Vec& load,
          const solver::FacetState* own);

  /// Whether it is nothing but a load.
  bool is_load() const { return coupling_.size() <= 1 && !has_facet_; }

  std::size_t host_count() const { return coupling_.size(); }

  const Vec& load(std::size_t host) const { return loads_[host]; }

  Mat stiffness(std::size_t host_i, std::size_t host_j) const;

  /// How it moves when its hosts do.
  Vec displacement(std::span<const Vec> hosts) const;

 private:
  bool has_facet_ = false;
  Vec load_{};
  Mat inverse_;                ///< D^-1
  std::vector<Mat> coupling_;  ///< B_i
  std::vector<Mat> own_;       ///< A_i
  std::vector<Vec> loads_;     ///< q_i
};

}  // namespace holdfast::plan
