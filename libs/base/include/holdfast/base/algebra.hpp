// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// Vectors of six and 6x6 matrices: displacement and force of one module, and one stiffness block.
namespace holdfast::base {

/// A displacement [ux uy uz tx ty tz] (mm, rad) or a force [fx fy fz mx my mz] (N, N mm).
template <class Real>
using Vec6 = std::array<Real, 6>;

/// A dense 6x6 matrix, stored by columns.
template <class Real>
struct Mat6 {
  std::array<Real, 36> values{};

  constexpr Real& at(int row, int column) {
    return values[static_cast<std::size_t>(row + 6 * column)];
  }

  constexpr Real at(int row, int column) const {
    return values[static_cast<std::size_t>(row + 6 * column)];
  }
};

/// An index that counts modules, nodes or rows, as the standard containers want it. Not negative.
constexpr std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

/// The magnitude; NaN of NaN. For any scalar, on a module too.
template <class Real>
constexpr Real absolute(Real value) {
  return value < 0 ? -value : value;
}

/// The vector with 1 as its component `i`.
template <class Real>
constexpr Vec6<Real> unit(int i) {
  Vec6<Real> vector{};
  vector[static_cast<std::size_t>(i)] = 1;
  return vector;
}

template <class Real>
constexpr void add_to(Vec6<Real>& sum, const Vec6<Real>& term) {
  for (std::size_t i = 0; i < 6; ++i) {
    sum[i] += term[i];
  }
}

template <class Real>
constexpr void add_to(Mat6<Real>& sum, const Mat6<Real>& term) {
  for (std::size_t i = 0; i < 36; ++i) {
    sum.values[i] += term.values[i];
  }
}

/// sum += factor term
template <class Real>
constexpr void add_times(Vec6<Real>& sum, std::type_identity_t<Real> factor,
                         const Vec6<Real>& term) {
  for (std::size_t i = 0; i < 6; ++i) {
    sum[i] += factor * term[i];
  }
}

/// a + factor b
template <class Real>
constexpr Vec6<Real> sum_of(const Vec6<Real>& a, Real factor, const Vec6<Real>& b) {
  Vec6<Real> sum{};
  for (std::size_t i = 0; i < 6; ++i) {
    sum[i] = a[i] + factor * b[i];
  }
  return sum;
}

/// share_a a + share_b b
template <class Real>
constexpr Vec6<Real> combination(Real share_a, const Vec6<Real>& a, Real share_b,
                                 const Vec6<Real>& b) {
  Vec6<Real> sum{};
  for (std::size_t i = 0; i < 6; ++i) {
    sum[i] = share_a * a[i] + share_b * b[i];
  }
  return sum;
}

/// The vector with its numbers in another type, rounded if need be.
template <class To, class From>
constexpr Vec6<To> converted(const Vec6<From>& vector) {
  Vec6<To> result{};
  for (std::size_t i = 0; i < 6; ++i) {
    result[i] = static_cast<To>(vector[i]);
  }
  return result;
}

template <class Real>
constexpr Real dot(const Vec6<Real>& a, const Vec6<Real>& b) {
  Real sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

template <class Real>
constexpr Vec6<Real> multiply(const Mat6<Real>& matrix, const Vec6<Real>& vector) {
  Vec6<Real> product{};
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      product[static_cast<std::size_t>(row)] +=
          matrix.at(row, column) * vector[static_cast<std::size_t>(column)];
    }
  }
  return product;
}

/// The matrix of a linear map: column by column its image of a unit vector.
template <class Real, class Map>
constexpr Mat6<Real> matrix_of(Map&& map) {
  Mat6<Real> matrix;
  for (int column = 0; column < 6; ++column) {
    const Vec6<Real> image = map(unit<Real>(column));
    for (int row = 0; row < 6; ++row) {
      matrix.at(row, column) = image[static_cast<std::size_t>(row)];
    }
  }
  return matrix;
}

}  // namespace holdfast::base
