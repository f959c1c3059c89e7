// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "holdfast/mechanics/large_beam.hpp"

/// Vectors of three and 3x3 matrices, as large_beam.cpp needs them.
namespace holdfast::mechanics {

/// A matrix, by rows.
using Matrix3 = std::array<Vector3, 3>;

constexpr Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

constexpr double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

constexpr Vector3 sum_of(const Vector3& a, double factor, const Vector3& b) {
  return {a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]};
}

constexpr Vector3 scaled(double factor, const Vector3& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

/// [a]x b = a x b
constexpr Matrix3 cross_matrix(const Vector3& a) {
  return {{{0, -a[2], a[1]}, {a[2], 0, -a[0]}, {-a[1], a[0], 0}}};
}

constexpr Matrix3 diagonal(const Vector3& a) {
  return {{{a[0], 0, 0}, {0, a[1], 0}, {0, 0, a[2]}}};
}

constexpr Matrix3 diagonal(double a) { return diagonal(Vector3{a, a, a}); }

constexpr Matrix3 transpose(const Matrix3& a) {
  return {{{a[0][0], a[1][0], a[2][0]}, {a[0][1], a[1][1], a[2][1]}, {a[0][2], a[1][2], a[2][2]}}};
}

/// sum += factor a b^T
constexpr void add_outer(Matrix3& sum, double factor, const Vector3& a, const Vector3& b) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[i][k] += factor * a[i] * b[k];
    }
  }
}

/// sum += factor term
constexpr void add_times(Matrix3& sum, double factor, const Matrix3& term) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum[i][k] += factor * term[i][k];
    }
  }
}

constexpr Matrix3 difference(Matrix3 a, const Matrix3& b) {
  add_times(a, -1, b);
  return a;
}

constexpr Matrix3 product(const Matrix3& a, const Matrix3& b) {
  Matrix3 c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      c[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
    }
  }
  return c;
}

constexpr Vector3 product(const Matrix3& a, const Vector3& b) {
  return {dot(a[0], b), dot(a[1], b), dot(a[2], b)};
}

}  // namespace holdfast::mechanics
