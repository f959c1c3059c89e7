// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/mechanics/beam.hpp"
#include "random_signed.hpp"

/// Second methods for the tests of this room: Eqs. (1)-(2) of [Piranda 2021] written out densely,
/// in double, and whatever else is needed to compare with them.
namespace holdfast::test {

using Dense = std::array<std::array<double, 6>, 6>;

/// No two parameters alike and Ix != Iy, so that no two entries can be mistaken for each other.
template <class Real>
constexpr mechanics::BeamSection<Real> lopsided_section() {
  return {.elastic_modulus = 100,
          .length = 40,
          .area = 1500,
          .moment_x = 200'000,
          .moment_y = 310'000,
          .torsion = 130'000};
}

/// Eq. (1), all of E/L^3 taken inside.
inline Dense paper_k11(const mechanics::BeamSection<double>& s) {
  const double e = s.elastic_modulus / (s.length * s.length * s.length);
  const double l = s.length;
  const double x = e * s.moment_x;
  const double y = e * s.moment_y;
  return {{{12 * x, 0, 0, 0, -6 * x * l, 0},
           {0, 12 * y, 0, 6 * y * l, 0, 0},
           {0, 0, e * s.area * l * l, 0, 0, 0},
           {0, 6 * y * l, 0, 4 * y * l * l, 0, 0},
           {-6 * x * l, 0, 0, 0, 4 * x * l * l, 0},
           {0, 0, 0, 0, 0, e * s.torsion * l * l}}};
}

/// Eq. (2).
inline Dense paper_k12(const mechanics::BeamSection<double>& s) {
  const double e = s.elastic_modulus / (s.length * s.length * s.length);
  const double l = s.length;
  const double x = e * s.moment_x;
  const double y = e * s.moment_y;
  return {{{-12 * x, 0, 0, 0, -6 * x * l, 0},
           {0, -12 * y, 0, 6 * y * l, 0, 0},
           {0, 0, -e * s.area * l * l, 0, 0, 0},
           {0, -6 * y * l, 0, 2 * y * l * l, 0, 0},
           {6 * x * l, 0, 0, 0, 2 * x * l * l, 0},
           {0, 0, 0, 0, 0, -e * s.torsion * l * l}}};
}

inline base::Vec6<double> image_of(const Dense& matrix, const base::Vec6<double>& vector) {
  base::Vec6<double> image{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      image[row] += matrix[row][column] * vector[column];
    }
  }
  return image;
}

using Axis = std::array<double, 3>;

inline Axis cross(const Axis& a, const Axis& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const Axis& a, const Axis& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Unit vector from p to its neighbour q.
inline Axis step(base::Direction direction) {
  const base::Cell cell = base::neighbour({}, direction);
  return {static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)};
}

/// The local axes in global coordinates, the columns of R in Eq. (4): z from q to p; x is global x
/// on a vertical beam and up on a lateral one.
inline std::array<Axis, 3> local_axes(base::Direction direction) {
  const Axis q = step(direction);
  const Axis z = {-q[0], -q[1], -q[2]};
  const Axis x = q[2] != 0 ? Axis{1, 0, 0} : Axis{0, 0, 1};
  return {x, cross(z, x), z};
}

/// R^ K R^T of Eq. (3).
inline Dense rotated(const Dense& local, base::Direction direction) {
  const auto axes = local_axes(direction);
  const auto r = [&](std::size_t row, std::size_t column) {
    return row / 3 == column / 3 ? axes[column % 3][row % 3] : 0.0;
  };
  Dense global{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      for (std::size_t i = 0; i < 36; ++i) {
        global[row][column] += r(row, i / 6) * local[i / 6][i % 6] * r(column, i % 6);
      }
    }
  }
  return global;
}

/// R^T v.
inline base::Vec6<double> in_local_axes(const base::Vec6<double>& v, base::Direction direction) {
  const auto axes = local_axes(direction);
  base::Vec6<double> local{};
  for (std::size_t i = 0; i < 3; ++i) {
    local[i] = dot(axes[i], {v[0], v[1], v[2]});
    local[i + 3] = dot(axes[i], {v[3], v[4], v[5]});
  }
  return local;
}

/// The sum of the magnitudes of all terms: what rounding errors of a product are relative to.
inline base::Vec6<double> term_magnitudes(const Dense& matrix, const base::Vec6<double>& vector) {
  base::Vec6<double> sum{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      sum[row] += std::abs(matrix[row][column] * vector[column]);
    }
  }
  return sum;
}

/// Rounding of a few dozen operations on terms of magnitude one.
template <class Real>
constexpr double kRounding = 32 * static_cast<double>(std::numeric_limits<Real>::epsilon());

/// A displacement of both scalars: as large in mm as its turns are at the end of a lever of 20 mm.
inline base::Vec6<double> random_displacement(base::Rng& rng) {
  base::Vec6<double> u{};
  for (std::size_t i = 0; i < 6; ++i) {
    u[i] = static_cast<double>(static_cast<float>(random_signed(rng) * (i < 3 ? 1 : 0.05)));
  }
  return u;
}

template <class To, class From>
base::Vec6<To> converted(const base::Vec6<From>& vector) {
  base::Vec6<To> result{};
  for (std::size_t i = 0; i < 6; ++i) {
    result[i] = static_cast<To>(vector[i]);
  }
  return result;
}

}  // namespace holdfast::test
