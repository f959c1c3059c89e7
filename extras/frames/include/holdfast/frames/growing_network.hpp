// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/frames/growing_factor.hpp"
#include "holdfast/frames/spring_network.hpp"

namespace holdfast::frames {

/// The amount of work that a GrowingNetwork has done.
struct GrowingWork {
  std::int64_t solution_count = 0;       ///< Solutions, refinements included.
  std::int64_t refinement_count = 0;     ///< Of these, those that mended a residual.
  std::int64_t factorization_count = 0;  ///< Factorizations anew, as the residual stayed.
};

/// The part of a network that is there, in equilibrium, while elements come and go one by one.
///
/// Every displacement it gives is checked: the residual of all equations, of the sum of loads, is
/// at most kResidualMax, by refinement and at last by factorizing anew.
class GrowingNetwork {
 public:
  /// The largest residual, as a share of the sum of all loads' magnitudes; rounding leaves about
  /// 1e-12.
  static constexpr double kResidualMax = 1e-10;

  /// Starts without elements. The network must outlive this.
  explicit GrowingNetwork(const SpringNetwork& network);

  const SpringNetwork& network() const { return *network_; }

  bool has_element(std::size_t element) const { return has_element_[element] != 0; }

  std::size_t element_count() const { return element_count_; }

  /// Whether the node is the ground or an element that is there touches it.
  bool has_node(std::int32_t node) const {
    return node == kGround || factor_.is_present(base::at(node));
  }

  /// Whether the element could be added: at least one of its ends is there.
  bool can_be_added(std::size_t element) const;

  /// Adds or removes an element; returns false, and changes nothing, if something would then be
  /// held by nothing, as far as the factorization detects it. Callers that remove must check this
  /// first.
  [[nodiscard]] bool add(std::size_t element);
  [[nodiscard]] bool remove(std::size_t element);

  /// Adds to what loads a node by itself, beside the elements there: none at first and after
  /// assign(). A node that goes must have lost it before it is solved again.
  void add_load(std::size_t node, const base::Vec6<double>& load);

  /// Takes back the last add() or remove(); once.
  void undo();

  /// Starts anew with these elements. Returns false if not all are held.
  [[nodiscard]] bool assign(std::span<const std::size_t> elements);

  /// Displacements by node, zero where there is none: mm and rad. They are solved when first asked
  /// for after a change. Empty if the equations cannot be solved to kResidualMax.
  const std::vector<base::Vec6<double>>& displacements();

  /// The largest translation of a node, in mm, infinite if the equations cannot be solved.
  double translation_max();

  /// Blocks below the diagonal of the factors of the whole network.
  std::size_t block_count() const { return factor_.lower_block_count(); }

  const GrowingWork& work() const { return work_; }

 private:
  void load(std::size_t element, double sign);
  double make_residual(const std::vector<base::Vec6<double>>& u);
  bool refine();

  const SpringNetwork* network_;
  GrowingFactor factor_;
  std::vector<std::uint8_t> has_element_;
  std::vector<base::Vec6<double>> loads_;     ///< by node
  std::vector<base::Vec6<double>> solution_;  ///< by node
  std::vector<base::Vec6<double>> residual_;  ///< by node
  double arm_mm_ = 0;                         ///< the longest lever: what moments are measured by
  std::size_t element_count_ = 0;
  std::size_t last_element_ = 0;
  int last_sign_ = 0;
  bool is_solved_ = false;
  GrowingWork work_;
};

}  // namespace holdfast::frames
