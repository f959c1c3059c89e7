// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "holdfast/base/double_double.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/robot.hpp"

/// Load ratios by another way than the library's: Eqs. (1)-(13) assembled into a general sparse
/// matrix, Eigen's SparseLU, and iterative refinement with coefficients, displacements and
/// residuals of 106 bits. Only the formulas of one beam and one facet are the library's.
namespace holdfast::test {

class ExactLoads {
 public:
  explicit ExactLoads(const model::Robot& robot)
      : robot_(robot),
        ground_(mechanics::ground_facet(model::beam_section(robot.material()),
                                        robot.material().facet_mm, robot.material().contact_gamma,
                                        mechanics::ContactLaw::kRegularised)),
        precise_ground_(mechanics::ground_facet<Precise>(
            precise_section(), robot.material().facet_mm, robot.material().contact_gamma,
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
  using Precise = base::DoubleDouble;

  struct Entry {
    int row = 0;
    int column = 0;
    Precise value;
  };

  mechanics::BeamSection<Precise> precise_section() const {
    const auto section = model::beam_section(robot_.material());
    return {.elastic_modulus = section.elastic_modulus,
            .length = section.length,
            .area = section.area,
            .moment_x = section.moment_x,
            .moment_y = section.moment_y,
            .torsion = section.torsion};
  }

  int index(std::size_t module, int component) const { return 6 * node_[module] + component; }

  void add(std::size_t row, std::size_t column, const base::Mat6<Precise>& block) {
    for (int i = 0; node_[row] >= 0 && node_[column] >= 0 && i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        const Precise value = block.at(i, j);
        if (value.high != 0) {
          entries_.push_back({index(row, i), index(column, j), value});
        }
      }
    }
  }

  void assemble() {
    entries_.clear();
    const auto beam = mechanics::beam_stiffness(precise_section());
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
        add(i, i, mechanics::contact_tangent(precise_ground_, states_[i], true));
      }
    }
    std::vector<Eigen::Triplet<double>> rounded;
    for (const Entry& entry : entries_) {
      rounded.emplace_back(entry.row, entry.column, static_cast<double>(entry.value));
    }
    matrix_.resize(6 * count_, 6 * count_);
    matrix_.setFromTriplets(rounded.begin(), rounded.end());
  }

  void solve(Eigen::SparseLU<Matrix>& lu) {
    const auto n = static_cast<std::size_t>(6 * count_);
    u_.assign(n, {});
    for (int step = 0; step < 12; ++step) {
      std::vector<Precise> r(n);
      for (std::size_t i = 2; i < n; i += 6) {
        r[i] = -model::module_weight_n(robot_.material());
      }
      for (const Entry& entry : entries_) {
        r[static_cast<std::size_t>(entry.row)] -=
            entry.value * u_[static_cast<std::size_t>(entry.column)];
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

  Precise u(std::size_t module, std::size_t component) const {
    return node_[module] < 0
               ? Precise()
               : u_[static_cast<std::size_t>(index(module, static_cast<int>(component)))];
  }

  long double difference(std::size_t module, std::size_t other, std::size_t component) const {
    const Precise value = u(module, component) - u(other, component);
    return static_cast<long double>(value.high) + value.low;
  }

  bool update_states() {
    bool is_changed = false;
    for (std::size_t i = 0; i < node_.size(); ++i) {
      if (robot_.modules()[i].support == model::Support::kGround) {
        base::Vec6<double> here;
        for (std::size_t k = 0; k < 6; ++k) {
          here[k] = static_cast<double>(u(i, k));
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
      const auto axis = static_cast<std::size_t>(base::index(pair.direction)) / 2;
      const long double e_by_l = static_cast<long double>(section.elastic_modulus) / section.length;
      const long double axial = e_by_l * section.area * difference(b, a, axis);
      long double bending = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        // Local y is horizontal on a lateral beam: bending about it is the one in a vertical plane.
        const bool is_about_local_x = k == (axis == 2 ? 0 : 2);
        const double moment = is_about_local_x ? section.moment_y : section.moment_x;
        if (k != axis) {
          bending = std::max(bending, std::abs(e_by_l * moment * difference(a, b, 3 + k)));
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
  mechanics::GroundFacet<Precise> precise_ground_;
  std::vector<int> node_;
  int count_ = 0;
  std::vector<mechanics::ContactState> states_;
  std::vector<Entry> entries_;
  Matrix matrix_;
  std::vector<Precise> u_;
};

}  // namespace holdfast::test
