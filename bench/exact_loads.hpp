// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "holdfast/mechanics/connector.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"

/// Load ratios by another way than the library's: Eqs. (1)-(13) assembled into a general sparse
/// matrix, Eigen's SparseLU, and iterative refinement with displacements and residuals in long
/// double (80 bits on x86). Only the formulas of one beam and one facet are the library's.
namespace holdfast::bench {

class ExactLoads {
 public:
  explicit ExactLoads(const model::Robot& robot)
      : robot_(robot),
        ground_(mechanics::ground_facet(model::beam_section(robot.material()),
                                        robot.material().facet_mm, robot.material().contact_gamma,
                                        mechanics::ContactLaw::kRegularised)) {
    node_.assign(robot.modules().size(), -1);
    for (std::size_t i = 0; i < node_.size(); ++i) {
      if (robot.modules()[i].support != model::Support::kFixed) {
        node_[i] = count_++;
      }
    }
    states_.assign(node_.size(), {});
  }

  /// Newton's method on Eqs. (9)-(12) from "all stuck". None if it does not settle.
  std::optional<std::vector<long double>> load_ratios() {
    for (int step = 0; step < 30; ++step) {
      assemble();
      Eigen::SparseLU<Matrix> lu(matrix_);
      if (lu.info() != Eigen::Success) {
        return std::nullopt;
      }
      solve(lu);
      if (!update_states()) {
        return ratios();
      }
    }
    return std::nullopt;
  }

 private:
  using Matrix = Eigen::SparseMatrix<double>;

  int index(std::size_t module, int component) const { return 6 * node_[module] + component; }

  void add(std::size_t row, std::size_t column, const base::Mat6<double>& block) {
    for (int i = 0; node_[row] >= 0 && node_[column] >= 0 && i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        if (block.at(i, j) != 0) {
          entries_.emplace_back(index(row, i), index(column, j), block.at(i, j));
        }
      }
    }
  }

  void assemble() {
    entries_.clear();
    const auto beam = mechanics::beam_stiffness(model::beam_section(robot_.material()));
    for (const model::Connection& pair : robot_.connections()) {
      const auto a = static_cast<std::size_t>(pair.a);
      const auto b = static_cast<std::size_t>(pair.b);
      const base::Direction back = base::opposite(pair.direction);
      add(a, a, mechanics::block_11(beam, pair.direction));
      add(a, b, mechanics::block_12(beam, pair.direction));
      add(b, b, mechanics::block_11(beam, back));
      add(b, a, mechanics::block_12(beam, back));
    }
    for (std::size_t i = 0; i < node_.size(); ++i) {
      if (robot_.modules()[i].support == model::Support::kGround) {
        add(i, i, mechanics::contact_tangent(ground_, states_[i], true));
      }
    }
    matrix_.resize(6 * count_, 6 * count_);
    matrix_.setFromTriplets(entries_.begin(), entries_.end());
  }

  void solve(Eigen::SparseLU<Matrix>& lu) {
    const auto n = static_cast<std::size_t>(6 * count_);
    u_.assign(n, 0);
    for (int step = 0; step < 12; ++step) {
      std::vector<long double> r(n, 0);
      for (std::size_t i = 2; i < n; i += 6) {
        r[i] = -static_cast<long double>(model::module_weight_n(robot_.material()));
      }
      for (const auto& entry : entries_) {
        r[static_cast<std::size_t>(entry.row())] -=
            static_cast<long double>(entry.value()) * u_[static_cast<std::size_t>(entry.col())];
      }
      Eigen::VectorXd right(static_cast<Eigen::Index>(n));
      for (std::size_t i = 0; i < n; ++i) {
        right[static_cast<Eigen::Index>(i)] = static_cast<double>(r[i]);
      }
      const Eigen::VectorXd correction = lu.solve(right);
      for (std::size_t i = 0; i < n; ++i) {
        u_[i] += correction[static_cast<Eigen::Index>(i)];
      }
    }
  }

  long double u(std::size_t module, int component) const {
    return node_[module] < 0 ? 0 : u_[static_cast<std::size_t>(index(module, component))];
  }

  bool update_states() {
    bool is_changed = false;
    for (std::size_t i = 0; i < node_.size(); ++i) {
      if (robot_.modules()[i].support == model::Support::kGround) {
        base::Vec6<double> here;
        for (int k = 0; k < 6; ++k) {
          here[static_cast<std::size_t>(k)] = static_cast<double>(u(i, k));
        }
        const auto state = mechanics::contact_state(ground_, mechanics::trial_force(ground_, here));
        is_changed = is_changed || !(state == states_[i]);
        states_[i] = state;
      }
    }
    return is_changed;
  }

  /// Eqs. (16)-(17): axial force and bending in the middle follow from differences alone.
  std::vector<long double> ratios() const {
    std::vector<long double> list;
    const model::Material& material = robot_.material();
    const auto section = model::beam_section(material);
    for (const model::Connection& pair : robot_.connections()) {
      const auto a = static_cast<std::size_t>(pair.a);
      const auto b = static_cast<std::size_t>(pair.b);
      const int axis = base::index(pair.direction) / 2;
      const long double e_by_l = static_cast<long double>(section.elastic_modulus) / section.length;
      const long double axial = e_by_l * section.area * (u(b, axis) - u(a, axis));
      long double bending = 0;
      for (int k = 0; k < 3; ++k) {
        // Local y is horizontal on a lateral beam: bending about it is the one in a vertical plane.
        const bool is_vertical = axis == 2;
        const bool is_about_local_x = is_vertical ? k == 0 : k == 2;
        const double moment = is_about_local_x ? section.moment_y : section.moment_x;
        if (k != axis) {
          bending = std::max(bending, std::abs(e_by_l * moment * (u(a, 3 + k) - u(b, 3 + k))));
        }
      }
      const double strength =
          axis == 2 ? material.strength_vertical_n : material.strength_lateral_n;
      list.push_back((2 * bending / material.facet_mm + axial) / strength);
    }
    return list;
  }

  const model::Robot& robot_;
  mechanics::GroundFacet<double> ground_;
  std::vector<int> node_;
  int count_ = 0;
  std::vector<mechanics::ContactState> states_;
  std::vector<Eigen::Triplet<double>> entries_;
  Matrix matrix_;
  std::vector<long double> u_;
};

}  // namespace holdfast::bench
