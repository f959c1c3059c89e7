// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/methods/front_contact.hpp"

#include "algebra/scalar.hpp"
#include "equilibrium/displacements.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

/// Newton's steps of the regularised law until it counts as going round in circles. The exact
/// solver takes five at most where it settles.
constexpr int kNewtonMax = 40;

/// What is tried where they do: all stuck, and the states that this leads to.
constexpr int kFirstSteps = 2;

/// Steps of the unilateral law; each settles some facets, the line search keeps them from
/// returning.
constexpr int kConvexMax = 200;

/// Halvings of the interval in which the slope changes its sign.
constexpr int kHalvingMax = 40;

/// A step is the last if its square is this part of the first one's energy; and how far below its
/// start the slope must be at a full step.
constexpr double kLeastPart = 1e-10;

/// Steps in a row that end in the states they began with and lessen nothing: what is left is
/// rounding, and the report says whether that is good enough.
constexpr int kIdleSteps = 3;
constexpr double kLessened = 0.9;

/// How much all facets hold where too few do, and how much more where that is too little.
constexpr double kHoldLeast = 1e-7;
constexpr double kHoldMore = 10;

}  // namespace

FrontContact::FrontContact(const ContactSetting& contact, Front& front, std::span<KeptNode> nodes,
                           std::span<double> reals)
    : contact_(contact), front_(front), nodes_(nodes), rows_(6 * nodes.size()) {
  const auto vector = [&](std::size_t i) {
    return reals.subspan(rows_ * rows_ + i * rows_, rows_);
  };
  matrix_ = reals.first(rows_ * rows_);
  d_ = vector(0);
  g_ = vector(1);
  trial_ = vector(2);
  residual_ = vector(3);
}

bool FrontContact::solve() {
  clear(d_);
  bool is_solved = false;
  if (contact_.facet.law == mechanics::ContactLaw::kUnilateral) {
    is_solved = solve_unilateral();
  } else {
    is_solved = solve_regularised(kNewtonMax);
    if (!is_solved) {
      clear(d_);
      for (KeptNode& node : nodes_) {
        visit_facets(node, [](auto& facet, int) { facet.state = mechanics::kStuck; });
      }
      solve_regularised(kFirstSteps);
    }
  }
  take(d_, true);
  return is_solved;
}

bool FrontContact::solve_given() {
  clear(d_);
  find_residual(d_, residual_);
  load_tangent(0);
  const bool is_solved = solve_linear(residual_);
  take(is_solved ? residual_ : d_, false);
  return is_solved;
}

void FrontContact::take_found() {
  for (KeptNode& node : nodes_) {
    visit_facets(node, [](auto& facet, int) { facet.state = facet.found; });
  }
}

bool FrontContact::leads_elsewhere(std::size_t node, int facet) {
  take_found();
  visit_facets(nodes_[node], [facet](auto& tried, int index) {
    tried.state = index == facet ? other_state(tried.found) : tried.state;
  });
  clear(d_);
  bool is_elsewhere = false;
  if (solve_regularised(kNewtonMax)) {
    for (KeptNode& other : nodes_) {
      visit_facets(other, [&](auto& ended, int) {
        is_elsewhere = is_elsewhere || !(ended.state == ended.found);
      });
    }
  }
  take_found();
  return is_elsewhere;
}

void FrontContact::clear(const Vector& vector) {
  for (double& value : vector) {
    value = 0;
  }
}

double FrontContact::stiffness(std::size_t row, std::size_t column) const {
  const int first = front_.complete_rows();
  const int i = first + static_cast<int>(row > column ? row : column);
  const int j = first + static_cast<int>(row > column ? column : row);
  return front_.element(i, j);
}

base::Vec6<double> FrontContact::displacement(std::size_t node, const Vector& d) const {
  base::Vec6<double> u = nodes_[node].u;
  for (std::size_t i = 0; i < 6; ++i) {
    u[i] += d[6 * node + i];
  }
  return u;
}

/// Takes over the states at u + d. False: they are those already in use.
bool FrontContact::follow_states(const Vector& d) {
  bool has_changed = false;
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    has_changed = follow_states_at(nodes_[k], contact_, displacement(k, d)) || has_changed;
  }
  return has_changed;
}

std::uint32_t FrontContact::states_hash() const {
  std::uint32_t hash = 0;
  for (const KeptNode& node : nodes_) {
    visit_facets(node, [&](const auto& facet, int index) {
      hash += hash_of(node.cell, mechanics::ContactState::kCodeCount * index + facet.state.code());
    });
  }
  return hash;
}

/// r + F(u) - S d - F(u + d), in the states in use; F(u) in those that the loads were found in.
void FrontContact::find_residual(const Vector& d, Vector& residual) const {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const base::Vec6<double> force = facet_force(nodes_[k], contact_, displacement(k, d));
    for (std::size_t i = 0; i < 6; ++i) {
      const std::size_t row = 6 * k + i;
      residual[row] =
          static_cast<double>(front_.load(front_.complete_rows() + static_cast<int>(row))) +
          nodes_[k].force[i] - force[i];
      for (std::size_t column = 0; column < rows_; ++column) {
        residual[row] -= stiffness(row, column) * d[column];
      }
    }
  }
}

/// The matrix: S, the facets' tangents and `hold` of that of a facet on the floor that holds all
/// over.
void FrontContact::load_tangent(double hold) {
  for (std::size_t row = 0; row < rows_; ++row) {
    for (std::size_t column = 0; column < rows_; ++column) {
      matrix_[row * rows_ + column] = stiffness(row, column);
    }
  }
  const base::Mat6<double> held =
      mechanics::contact_tangent(contact_.facet, mechanics::kStuck, true);
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    const base::Mat6<double> tangent = facet_tangent(nodes_[k], contact_);
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        matrix_[(6 * k + static_cast<std::size_t>(i)) * rows_ + 6 * k +
                static_cast<std::size_t>(j)] += tangent.at(i, j) + hold * held.at(i, j);
      }
    }
  }
}

/// Gauss's elimination with pivots by rows; b becomes the solution.
bool FrontContact::solve_linear(Vector& b) {
  const auto at = [&](std::size_t row, std::size_t column) -> double& {
    return matrix_[row * rows_ + column];
  };
  for (std::size_t k = 0; k < rows_; ++k) {
    std::size_t pivot = k;
    for (std::size_t row = k + 1; row < rows_; ++row) {
      pivot = absolute(at(row, k)) > absolute(at(pivot, k)) ? row : pivot;
    }
    if (!(absolute(at(pivot, k)) > 0)) {
      return false;
    }
    for (std::size_t column = 0; column < rows_ && pivot != k; ++column) {
      const double value = at(k, column);
      at(k, column) = at(pivot, column);
      at(pivot, column) = value;
    }
    const double value = b[k];
    b[k] = b[pivot];
    b[pivot] = value;
    for (std::size_t row = k + 1; row < rows_; ++row) {
      const double factor = at(row, k) / at(k, k);
      for (std::size_t column = k + 1; column < rows_; ++column) {
        at(row, column) -= factor * at(k, column);
      }
      b[row] -= factor * b[k];
    }
  }
  for (std::size_t row = rows_; row-- > 0;) {
    for (std::size_t column = row + 1; column < rows_; ++column) {
      b[row] -= at(row, column) * b[column];
    }
    b[row] /= at(row, row);
    if (!is_number(b[row])) {
      return false;
    }
  }
  return true;
}

/// Every step solves the linear problem of its states whole, then looks up its states.
bool FrontContact::solve_regularised(int step_count) {
  for (int step = 0; step < step_count; ++step) {
    find_residual(d_, residual_);
    load_tangent(0);
    if (!solve_linear(residual_)) {
      return false;
    }
    for (std::size_t i = 0; i < rows_; ++i) {
      d_[i] += residual_[i];
    }
    if (!follow_states(d_)) {
      return true;
    }
  }
  return false;
}

/// d energy / dt at d + t g.
double FrontContact::slope(const Vector& g, const Vector& d, double t) {
  for (std::size_t i = 0; i < rows_; ++i) {
    trial_[i] = d[i] + t * g[i];
  }
  follow_states(trial_);
  find_residual(trial_, residual_);
  double sum = 0;
  for (std::size_t i = 0; i < rows_; ++i) {
    sum -= residual_[i] * g[i];
  }
  return sum;
}

/// The slope of a convex energy never decreases: where it is zero between 0 and 1, or 1.
double FrontContact::step_length(const Vector& g, const Vector& d) {
  const double start = absolute(slope(g, d, 0));
  if (slope(g, d, 1) <= kLeastPart * start) {
    return 1;
  }
  double low = 0;
  double high = 1;
  for (int i = 0; i < kHalvingMax; ++i) {
    const double middle = (low + high) / 2;
    (slope(g, d, middle) > 0 ? high : low) = middle;
  }
  return low;
}

/// Where too few facets hold, S alone is singular, and what rounding has made of it need not be
/// positive. Then all hold a little: with any positive matrix a step leads down.
bool FrontContact::solve_unilateral() {
  follow_states(d_);
  double first = 0;
  double hold = 0;
  double least = 0;
  int idle_count = 0;
  for (int step = 0; step < kConvexMax; ++step) {
    find_residual(d_, residual_);
    for (std::size_t i = 0; i < rows_; ++i) {
      g_[i] = residual_[i];
    }
    load_tangent(hold);
    const bool is_regular = solve_linear(g_);
    double work = 0;
    for (std::size_t i = 0; i < rows_; ++i) {
      work += residual_[i] * g_[i];
    }
    first = first > 0 ? first : work;
    const bool is_least = absolute(work) <= kLeastPart * kLeastPart * first;
    if (is_regular && (is_least || idle_count == kIdleSteps)) {
      return true;
    }
    if (!is_regular || !(work > 0)) {
      hold = hold > 0 ? kHoldMore * hold : kHoldLeast;
      continue;
    }
    const std::uint32_t states = states_hash();
    const double length = step_length(g_, d_);
    for (std::size_t i = 0; i < rows_; ++i) {
      d_[i] += length * g_[i];
    }
    follow_states(d_);
    const bool is_idle = work > kLessened * least && least > 0 && states_hash() == states;
    idle_count = is_idle ? idle_count + 1 : 0;
    least = is_idle ? least : work;
  }
  return false;
}

/// Takes d as single precision has it, like the module itself, whose facets are in the same states
/// then.
void FrontContact::take(const Vector& d, bool follows) {
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    KeptNode& node = nodes_[k];
    for (std::size_t i = 0; i < 6; ++i) {
      float& shift = front_.shift(front_.complete_rows() + static_cast<int>(6 * k + i));
      shift = static_cast<float>(d[6 * k + i]);
      node.u[i] += static_cast<double>(shift);
    }
    if (follows) {
      follow_states_at(node, contact_, node.u);
    }
    node.force = facet_force(node, contact_, node.u);
  }
}

}  // namespace holdfast::agent
