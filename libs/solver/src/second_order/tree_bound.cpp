// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// For a motion x let theta_i be the rotation of module i, and of a beam between p and q
//   m = (theta_p + theta_q) / 2,   psi = theta_q - theta_p,   rho its strains of length and shear,
//   E = k_rho rho^2 + k_psi psi^2 at least, twice its energy,
//   Q, N, M its shear, its compression (0 if drawn) and its moment under the loads, f its force.
// The second derivative of its strains at rest (large_beam.hpp) is
//   rho_2 = -m x (m x a0) / 2 - psi x (psi x a0) / 24 - m x rho,   psi_2 = -m x psi / 2,
// so that what its stresses take from the stiffness, S = -K_G, is
//   x . S x <= L (N + Q/2) m^2 + 2 f m rho + M m psi + L/12 (N + Q/2) psi^2 + 6/5 N/L rho^2
// with m^2 <= (theta_p^2 + theta_q^2) / 2. Along a path of d beams from a support, which does not
// turn, theta_i is the sum of the psi, so by Cauchy and Schwarz
//   theta_i^2 <= d_i / k_psi times the sum of the energies E on the path,
// and a product like m rho is at most half the sum of the squares, weighted. With one path to each
// module, together a tree, x . S x is at most the sum of the E, each times the sum of what all
// modules beyond it need: W. The factor is the smallest x . K x / x . S x, so at least 1 / max W.
#include "second_order/tree_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace holdfast::solver {
namespace {

using base::Vec6;

/// What is no number is larger than all.
void take_larger(double value, double& largest) { largest = value <= largest ? largest : value; }

double length(double x, double y, double z = 0) { return std::sqrt(x * x + y * y + z * z); }

/// What stresses need of the energy of beams, in shares of it.
class Needs {
 public:
  /// Where beams differ, the softest counts, and of lengths what needs more.
  Needs(const model::LargeBeams& beams, const base::Lattice& lattice) {
    for (const base::Direction direction : base::facet_directions(lattice)) {
      const Vec6<double>& k = beams[direction].stiffness();
      k_rho_ = std::min({k_rho_, k[0], k[1], k[2]});
      k_psi_ = std::min({k_psi_, k[3], k[4], k[5]});
      longest_ = std::max(longest_, beams[direction].length());
      shortest_ = std::min(shortest_, beams[direction].length());
    }
  }

  /// Takes the stresses of a beam or facet.
  void take(const Vec6<double>& stress) {
    const double pressed = std::max(0.0, -stress[2]) + length(stress[0], stress[1]) / 2;
    const double force = length(stress[0], stress[1], stress[2]);
    const double moment = length(stress[3], stress[4], stress[5]);
    turning_ = longest_ * pressed / (2 * k_psi_);
    mixed_ = force / (2 * std::sqrt(k_rho_ * k_psi_)) + moment / (4 * k_psi_);
    own_ =
        longest_ * pressed / (12 * k_psi_) + 1.2 * std::max(0.0, -stress[2]) / (shortest_ * k_rho_);
  }

  /// The need of all beams on the path to an end which is so many beams away from a support.
  double on_path(double depth) const { return turning_ * depth + mixed_ * std::sqrt(depth); }

  /// The need of the beam itself besides.
  double of_beam(double depth_p, double depth_q) const {
    return own_ + mixed_ * (std::sqrt(depth_p) + std::sqrt(depth_q));
  }

 private:
  double k_rho_ = std::numeric_limits<double>::infinity();
  double k_psi_ = std::numeric_limits<double>::infinity();
  double shortest_ = std::numeric_limits<double>::infinity();  ///< Of beams, mm.
  double longest_ = 0;
  double turning_ = 0;  ///< Times the depth of an end.
  double mixed_ = 0;    ///< Times its root: products of rotations and strains.
  double own_ = 0;
};

/// The shortest paths from supports to all modules.
class Tree {
 public:
  explicit Tree(const LinearSystem& system)
      : parent_(system.robot().modules().size(), kUnknown), depth_(parent_.size(), 0) {
    const model::Robot& robot = system.robot();
    order_.reserve(parent_.size());
    for (std::size_t i = 0; i < parent_.size(); ++i) {
      if (robot.modules()[i].support == model::Support::kFixed) {
        add(i, kNone, 0);
      }
    }
    for (const FacetState& facet : system.facets()) {
      if (facet.state == mechanics::kStuck && facet.is_held && parent_[facet.module] == kUnknown) {
        add(facet.module, kNone, 1);
      }
    }
    for (std::size_t k = 0; k < order_.size(); ++k) {
      const std::size_t from = order_[k];
      for (const std::int32_t next : robot.connected()[from]) {
        if (next >= 0 && parent_[base::at(next)] == kUnknown) {
          add(base::at(next), static_cast<std::int32_t>(from), depth_[from] + 1);
        }
      }
    }
  }

  bool is_whole() const { return order_.size() == parent_.size(); }

  double depth(std::size_t module) const { return depth_[module]; }

  /// Whether a beam is the last one on the path to module `to`.
  bool leads(std::int32_t from, std::int32_t to) const { return parent_[base::at(to)] == from; }

  /// The largest sum, over all modules, of what a module's last beam needs and what those beyond
  /// it do.
  double largest_sum(std::vector<double> of_path, const std::vector<double>& of_beam) const {
    double largest = 0;
    for (std::size_t k = order_.size(); k-- > 0;) {
      const std::size_t module = order_[k];
      if (depth_[module] > 0) {
        take_larger(of_path[module] + of_beam[module], largest);
      }
      if (parent_[module] >= 0) {
        of_path[base::at(parent_[module])] += of_path[module];
      }
    }
    return largest;
  }

 private:
  static constexpr std::int32_t kNone = -1;
  static constexpr std::int32_t kUnknown = -2;

  void add(std::size_t module, std::int32_t parent, double depth) {
    parent_[module] = parent;
    depth_[module] = depth;
    order_.push_back(module);
  }

  std::vector<std::int32_t> parent_;
  std::vector<double> depth_;       ///< Beams on the path, a facet's too.
  std::vector<std::size_t> order_;  ///< Those nearer to a support first.
};

/// Whether a facet takes nothing.
bool is_open(const LinearSystem& system, const FacetState& facet) {
  return !facet.state.pressed && !facet.is_held && system.ground().gamma == 0 &&
         system.ground().law == mechanics::ContactLaw::kUnilateral;
}

}  // namespace

double buckling_factor_at_least(const StressedBeams& beams) {
  const LinearSystem& system = beams.system();
  const Tree tree(system);
  if (!tree.is_whole()) {
    return 0;
  }
  Needs needs(beams.beams(), system.robot().lattice());
  std::vector<double> of_path(system.robot().modules().size());
  std::vector<double> of_beam(of_path.size());
  double largest = 0;
  for (const model::Connection connection : system.robot().connections()) {
    needs.take(beams.stress(connection));
    const std::size_t p = base::at(connection.a);
    const std::size_t q = base::at(connection.b);
    of_path[p] += needs.on_path(tree.depth(p));
    of_path[q] += needs.on_path(tree.depth(q));
    const double own = needs.of_beam(tree.depth(p), tree.depth(q));
    if (tree.leads(connection.a, connection.b) || tree.leads(connection.b, connection.a)) {
      of_beam[tree.leads(connection.a, connection.b) ? q : p] += own;
    } else {
      take_larger(own, largest);
    }
  }
  for (std::size_t i = 0; i < system.facets().size(); ++i) {
    const FacetState& facet = system.facets()[i];
    if (is_open(system, facet)) {
      continue;
    }
    if (facet.state != mechanics::kStuck || !facet.is_held) {
      return 0;
    }
    needs.take(beams.facet_stress(i));
    // Of a module that stands on several facets any may be the one on its path.
    of_path[facet.module] += needs.on_path(tree.depth(facet.module));
    of_beam[facet.module] += needs.of_beam(0, tree.depth(facet.module));
  }
  take_larger(tree.largest_sum(std::move(of_path), of_beam), largest);
  return largest == 0 ? std::numeric_limits<double>::infinity() : 1 / largest;
}

}  // namespace holdfast::solver
