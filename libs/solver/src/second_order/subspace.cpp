// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "second_order/subspace.hpp"

#include <cmath>
#include <utility>

#include "factorization/beam_forces.hpp"

namespace holdfast::solver {
namespace {

using Rows = std::vector<std::vector<double>>;

void add_times(Subspace::Vecs& total, double factor, const Subspace::Vecs& term) {
  for (std::size_t i = 0; i < total.size(); ++i) {
    base::add_times(total[i], factor, term[i]);
  }
}

void scale(Subspace::Vecs& vectors, double factor) {
  for (auto& vector : vectors) {
    for (double& component : vector) {
      component *= factor;
    }
  }
}

/// Turns rows and columns p and q of a symmetric matrix so that their common element vanishes, and
/// the columns of the eigenvectors with them.
void rotate(Rows& a, Rows& vectors, std::size_t p, std::size_t q) {
  const double half = (a[q][q] - a[p][p]) / (2 * a[p][q]);
  const double tangent = (half < 0 ? -1 : 1) / (std::abs(half) + std::sqrt(1 + half * half));
  const double c = 1 / std::sqrt(1 + tangent * tangent);
  const double s = tangent * c;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double first = a[k][p];
    a[k][p] = c * first - s * a[k][q];
    a[k][q] = s * first + c * a[k][q];
  }
  for (std::size_t k = 0; k < a.size(); ++k) {
    const double first = a[p][k];
    a[p][k] = c * first - s * a[q][k];
    a[q][k] = s * first + c * a[q][k];
    const double vector = vectors[k][p];
    vectors[k][p] = c * vector - s * vectors[k][q];
    vectors[k][q] = s * vector + c * vectors[k][q];
  }
}

}  // namespace

Eigenpair largest_eigenpair(const Rows& lower_rows) {
  constexpr int kSweepMax = 30;  // Eight or so do.
  const std::size_t n = lower_rows.size();
  Rows a(n, std::vector<double>(n));
  Rows vectors(n, std::vector<double>(n));
  double largest = 0;
  for (std::size_t i = 0; i < n; ++i) {
    vectors[i][i] = 1;
    for (std::size_t k = 0; k <= i; ++k) {
      a[i][k] = a[k][i] = lower_rows[i][k];
      largest = std::max(largest, std::abs(a[i][k]));
    }
  }
  bool is_over = false;
  for (int sweep = 0; sweep < kSweepMax && !is_over; ++sweep) {
    is_over = true;
    for (std::size_t p = 0; p + 1 < n; ++p) {
      for (std::size_t q = p + 1; q < n; ++q) {
        if (std::abs(a[p][q]) > 1e-17 * largest) {
          rotate(a, vectors, p, q);
          is_over = false;
        }
      }
    }
  }
  std::size_t best = 0;
  for (std::size_t i = 1; i < n; ++i) {
    best = a[i][i] > a[best][best] ? i : best;
  }
  Eigenpair pair{.value = a[best][best], .vector = std::vector<double>(n)};
  for (std::size_t i = 0; i < n; ++i) {
    pair.vector[i] = vectors[i][best];
  }
  return pair;
}

/// Orthogonalized twice, as once leaves rounding that grows.
bool Subspace::reduce(Vecs& x, Vecs& forces) const {
  constexpr double kNothing = 1e-20;  // Of the energy.
  const double before = dot_all(x, forces);
  for (int pass = 0; pass < 2; ++pass) {
    for (const Motion& other : motions_) {
      const double share = dot_all(other.x, forces);
      add_times(x, -share, other.x);
      add_times(forces, -share, other.forces);
    }
  }
  const double energy = dot_all(x, forces);
  if (!(energy > kNothing * before) || !std::isfinite(energy)) {
    return false;
  }
  scale(x, 1 / std::sqrt(energy));
  scale(forces, 1 / std::sqrt(energy));
  return true;
}

void Subspace::take(Motion motion) {
  std::vector<double>& row = products_.emplace_back();
  for (const Motion& other : motions_) {
    row.push_back(dot_all(other.x, motion.softening));
  }
  row.push_back(dot_all(motion.x, motion.softening));
  motions_.push_back(std::move(motion));
}

Eigenpair Subspace::best() const { return largest_eigenpair(products_); }

Subspace::Vecs Subspace::combination(const Eigenpair& shares, Vecs Motion::*part) const {
  Vecs sum(motions_.front().x.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    add_times(sum, shares.vector[i], motions_[i].*part);
  }
  return sum;
}

void Subspace::restart() {
  const Eigenpair shares = best();
  Motion motion = {.x = combination(shares, &Motion::x),
                   .forces = combination(shares, &Motion::forces),
                   .softening = combination(shares, &Motion::softening)};
  motions_.clear();
  products_.clear();
  take(std::move(motion));
}

}  // namespace holdfast::solver
