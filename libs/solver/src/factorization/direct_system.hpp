// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/solver/block_lu.hpp"
#include "holdfast/solver/linear_system.hpp"

namespace holdfast::solver {

/// A robot's equations, factorized (BlockLu): one node per module that is not fixed. What a changed
/// facet touches is factorized again.
class DirectSystem final : public LinearSystem {
 public:
  /// Makes the system; none if it needs more memory, or fills in more, than the options allow, or
  /// would take more products of two blocks to be factorized, known before anything is laid out.
  /// The factors are symmetric until a facet tilts under the regularised law.
  static std::unique_ptr<DirectSystem> make(
      const model::Robot& robot, const EquilibriumOptions& options,
      std::size_t product_count_max = std::numeric_limits<std::size_t>::max());

  [[nodiscard]] LinearOutcome solve(double tolerance) override;

  [[nodiscard]] LinearOutcome approach() override { return solve(0); }

  std::vector<Vec> displacement() override;
  std::vector<Vec> facet_displacement() override;
  [[nodiscard]] bool refine(Solution& solution) override;
  [[nodiscard]] std::optional<std::vector<std::vector<Vec>>> solve_each(
      std::span<const model::Loads> loads, double tolerance) override;

  [[nodiscard]] std::optional<bool> is_definite(StressedBeams& beams, double factor) override;

  bool is_exact() const override { return true; }

  std::vector<double> facet_errors() const override { return {}; }

  double energy_error() const override { return 0; }

  /// The factors, one node per module that is not fixed, as of the last solve().
  const BlockLu& factors() const { return *lu_; }

  /// A module's node; -1 if it is fixed.
  std::int32_t node_of(std::int32_t module) const;

  LinearReport report() const override {
    return {.solve_count = solve_count_, .made_column_count = lu_->made_column_count()};
  }

 private:
  DirectSystem(const model::Robot& robot, const EquilibriumOptions& options);

  void take_law() override;
  void take_facet(std::size_t facet) override;

  void take_loads() override {}

  void order(const EquilibriumOptions& options);
  bool is_symmetric(const FacetState& facet) const;
  void assemble();
  std::vector<base::Mat6<double>> set_connections();
  std::size_t first_facet_after(std::size_t facet) const;
  void add_stress(StressedBeams& beams, double factor, BlockLu& lu) const;
  std::vector<Vec> by_module(const std::vector<Vec>& by_node) const;
  template <class Load>
  std::vector<Vec> by_node(const Load& load) const;
  std::vector<Vec> solve_for(const std::vector<Vec>& load) const;
  void refine_once(Solution& solution, const FacetLaw<double>& law) const;
  void take_back_weak_springs(Solution& solution) const;
  bool refine_precisely(Solution& solution);
  bool refine_without_weak_springs(Solution& solution);

  bool is_bonded_ = false;
  bool is_precise_ = false;
  int thread_count_ = 1;
  std::vector<std::int32_t> node_of_module_;  ///< -1 for fixed modules
  std::vector<base::Mat6<double>> diagonal_;  ///< By node, contact excluded.
  std::optional<BlockLu> lu_;
  std::vector<Vec> x_;  ///< The last solution, by node.
  int solve_count_ = 0;
};

}  // namespace holdfast::solver
