// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "equilibria/site.hpp"
#include "equilibria/solved_core.hpp"
#include "holdfast/model/robot.hpp"

namespace holdfast::plan {

/// New modules' nodes, eliminated: what they do to the modules that they are linked to, their
/// hosts. With loads p on the new nodes, the stiffness D there and B_i between the host of link i
/// and these, that host feels
///   t_i = q_i - sum over j of C_ij u_j,   q = -B D^-1 p,   C = A - B D^-1 B',
/// where A_i is what the new beam adds at its host. With one link and no facet C is zero.
class NewModules {
 public:
  using Vec = base::Vec6<double>;
  using Mat = base::Mat6<double>;

  /// There are no new modules at all.
  NewModules() = default;

  /// `loads` by new module; `beams` between these, and their `facets` with states, by place in it.
  NewModules(const SolvedCore& core, std::span<const Link> links,
             std::span<const model::Connection> beams, std::span<const Vec> loads,
             std::span<const solver::FacetState> facets);

  /// Whether they are nothing but a load on the host of one link.
  bool is_load() const { return coupling_.size() <= 1 && !has_facet_; }

  /// q of a link.
  const Vec& load(std::size_t link) const { return link_loads_[link]; }

  /// C between two links.
  Mat stiffness(std::size_t link_i, std::size_t link_j) const;

  /// How they move when hosts do, by link.
  std::vector<Vec> displacements(std::span<const Vec> hosts) const;

 private:
  /// A block of D^-1.
  const Mat& inverse(std::size_t row, std::size_t column) const {
    return inverse_[row * loads_.size() + column];
  }

  bool has_facet_ = false;
  std::vector<Vec> loads_;
  std::vector<Mat> inverse_;
  std::vector<std::size_t> to_;  ///< By link, as what follows: the new module,
  std::vector<Mat> coupling_;    ///< B_i there,
  std::vector<Mat> own_;         ///< A_i
  std::vector<Vec> link_loads_;  ///< and q_i.
};

}  // namespace holdfast::plan
