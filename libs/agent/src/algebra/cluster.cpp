// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/algebra/cluster.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/algebra/system.hpp"

namespace holdfast::agent {
namespace {

using base::Mat6;
using base::Vec6;

constexpr int kSize = 6;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec6<double> unit(int i) {
  Vec6<double> vector{};
  vector[at(i)] = 1;
  return vector;
}

Mat6<double> converted(const Mat6<float>& matrix) {
  Mat6<double> result;
  for (std::size_t i = 0; i < matrix.values.size(); ++i) {
    result.values[i] = static_cast<double>(matrix.values[i]);
  }
  return result;
}

void add_block(Mat6<float>& into, const Mat6<double>& block) {
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    into.values[i] += static_cast<float>(block.values[i]);
  }
}

void set_column(Mat6<double>& matrix, int column, const Vec6<double>& vector) {
  for (int row = 0; row < kSize; ++row) {
    matrix.at(row, column) = vector[at(row)];
  }
}

/// Part i: column i from its diagonal down, behind it column 6 - i. Branch has the inverse.
Cluster::Parts parts_of(const Mat6<double>& matrix) {
  Cluster::Parts parts{};
  for (int i = 0; i < Branch::kPartCount; ++i) {
    const bool has_second = i > 0 && i + 1 < Branch::kPartCount;
    for (int row = i; row < kSize; ++row) {
      parts[at(i)][at(row - i)] = static_cast<float>(matrix.at(row, i));
    }
    for (int row = kSize - i; row < kSize && has_second; ++row) {
      parts[at(i)][at(row)] = static_cast<float>(matrix.at(row, kSize - i));
    }
  }
  return parts;
}

/// 1 + A B, factored.
System in_series(const Mat6<float>& a, const Mat6<float>& b) {
  System system;
  for (int column = 0; column < kSize; ++column) {
    for (int row = 0; row < kSize; ++row) {
      double sum = row == column ? 1 : 0;
      for (int k = 0; k < kSize; ++k) {
        sum += static_cast<double>(a.at(row, k)) * static_cast<double>(b.at(k, column));
      }
      system.at(row, column) = sum;
    }
  }
  system.factor();
  return system;
}

}  // namespace

Mat6<double> carried(const Joint& joint, const Mat6<double>& stiffness) {
  Mat6<double> result;
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> moved = unit(column);
    joint.carry(moved);
    Vec6<double> force = base::multiply(stiffness, moved);
    joint.hand_on(force);
    set_column(result, column, force);
  }
  return result;
}

void Cluster::add_to_joint(const Mat6<double>& block) { add_block(joint_, block); }

void Cluster::add_to_joint(int part, const Vec6<float>& vector) { add_part(joint_, part, vector); }

void Cluster::find_joint_up(const Joint& to_parent, Parts& parts) const {
  parts = parts_of(carried(to_parent, converted(joint_)));
}

void Cluster::close_joint() {
  System stiffness(converted(joint_));
  stiffness.factor();
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> give = unit(column);
    stiffness.solve(give);
    for (int row = column; row < kSize; ++row) {
      joint_.at(row, column) = static_cast<float>(kReach * give[at(row)]);
      joint_.at(column, row) = joint_.at(row, column);
    }
  }
}

void Cluster::clear() {
  stiffness_ = {};
  load_ = {};
  is_held_ = false;
}

void Cluster::add_stiffness(const Mat6<double>& block) { add_block(stiffness_, block); }

void Cluster::add_stiffness(int part, const Vec6<float>& vector) {
  add_part(stiffness_, part, vector);
}

bool Cluster::is_free() const {
  for (const float value : stiffness_.values) {
    if (value != 0) {
      return false;
    }
  }
  return !is_held_;
}

void Cluster::find_stiffness_up(const Joint& to_parent, bool is_top, Parts& parts) const {
  if (!is_top) {
    parts = parts_of(carried(to_parent, converted(stiffness_)));
    return;
  }
  // A held cluster leaves the joint alone: S' = T^t F^-1 T.
  System system = is_held_ ? System(converted(joint_)) : in_series(stiffness_, joint_);
  if (is_held_) {
    system.factor();
  }
  const Mat6<double> stiffness = converted(stiffness_);
  Mat6<double> result;
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> force = unit(column);
    to_parent.carry(force);
    if (!is_held_) {
      force = base::multiply(stiffness, force);
    }
    system.solve(force);
    to_parent.hand_on(force);
    set_column(result, column, force);
  }
  parts = parts_of(result);
}

void Cluster::find_load_up(const Joint& to_parent, bool is_top, Vec6<double>& load) const {
  load = is_held_ ? Vec6<double>{} : load_;
  if (is_top && !is_held_ && !is_free()) {
    in_series(stiffness_, joint_).solve(load);
  }
  to_parent.hand_on(load);
}

void Cluster::find_displacement(const Joint& to_parent, bool is_top, Vec6<double>& u) const {
  to_parent.carry(u);
  if (is_top && is_held_) {
    u = {};
  } else if (is_top) {
    base::add_to(u, base::multiply(converted(joint_), load_));
    in_series(joint_, stiffness_).solve(u);
  }
}

void Cluster::find_displacement_of_root(Vec6<double>& u) const {
  u = {};
  if (is_held_) {
    return;
  }
  System system(converted(stiffness_));
  system.factor();
  u = load_;
  system.solve(u);
  for (const double value : u) {
    if (!is_number(value)) {
      u = {};
      return;
    }
  }
}

}  // namespace holdfast::agent
