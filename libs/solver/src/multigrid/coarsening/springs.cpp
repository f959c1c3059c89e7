// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/springs.hpp"

#include <algorithm>
#include <cmath>

#include "factorization/block_kernels.hpp"
#include "multigrid/kernels/beam_shapes.hpp"

namespace holdfast::solver {
namespace {

using Mat3 = std::array<std::array<double, 3>, 3>;

Mat3 inverse_of_three(const Mat3& m) {
  Mat3 cofactor;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3;
      const std::size_t i2 = (i + 2) % 3;
      const std::size_t j1 = (j + 1) % 3;
      const std::size_t j2 = (j + 2) % 3;
      cofactor[j][i] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  }
  const double determinant =
      m[0][0] * cofactor[0][0] + m[0][1] * cofactor[1][0] + m[0][2] * cofactor[2][0];
  for (auto& row : cofactor) {
    for (double& value : row) {
      value /= determinant;
    }
  }
  return cofactor;
}

/// The rotational compliance of a spring, 3x3: the inverse of what is left of its rotational
/// stiffness when displacements follow freely.
Mat3 rotational_compliance(const Mat& c) {
  Mat3 uu;
  Mat3 ut;
  Mat3 left;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      uu[i][j] = c.values[i + 6 * j];
      ut[i][j] = c.values[i + 6 * (3 + j)];
      left[i][j] = c.values[3 + i + 6 * (3 + j)];
    }
  }
  const Mat3 free = inverse_of_three(uu);
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<double, 3> follows{};
    for (std::size_t k = 0; k < 3; ++k) {
      follows[k] = free[k][0] * ut[0][j] + free[k][1] * ut[1][j] + free[k][2] * ut[2][j];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      left[i][j] -= ut[0][i] * follows[0] + ut[1][i] * follows[1] + ut[2][i] * follows[2];
    }
  }
  return inverse_of_three(left);
}

/// The columns of t gain those of u times -[a]x.
void carry_columns(Mat& s, const Point& a) {
  double* const v = s.values.data();
  // (t x a) = [ty az - tz ay, tz ax - tx az, tx ay - ty ax]
  for (std::size_t row = 0; row < 6; ++row) {
    v[18 + row] += v[12 + row] * a[1] - v[6 + row] * a[2];
    v[24 + row] += v[row] * a[2] - v[12 + row] * a[0];
    v[30 + row] += v[6 + row] * a[0] - v[row] * a[1];
  }
}

/// The columns of t and the rows below: one of four 3x3 blocks times r, and from the left.
Mat turned(const Mat& matrix, const Mat3& r) {
  Mat half;  // matrix r
  for (std::size_t column = 0; column < 6; ++column) {
    const double* const from = matrix.values.data() + 18 * (column / 3);
    for (std::size_t row = 0; row < 6; ++row) {
      half.values[6 * column + row] = from[row] * r[0][column % 3] +
                                      from[6 + row] * r[1][column % 3] +
                                      from[12 + row] * r[2][column % 3];
    }
  }
  Mat result;  // r^T half
  for (std::size_t column = 0; column < 6; ++column) {
    for (std::size_t row = 0; row < 6; ++row) {
      const double* const from = half.values.data() + 6 * column + 3 * (row / 3);
      result.values[6 * column + row] =
          from[0] * r[0][row % 3] + from[1] * r[1][row % 3] + from[2] * r[2][row % 3];
    }
  }
  return result;
}

/// Columns: an orthonormal basis whose first vector is a unit vector.
Mat3 basis_along(const Point& unit) {
  const auto least = std::ranges::min_element(unit, {}, [](double x) { return std::abs(x); });
  Point across{};
  across[static_cast<std::size_t>(least - unit.begin())] = 1;
  const double along = dot(across, unit);
  const double norm = std::sqrt(1 - along * along);
  for (std::size_t i = 0; i < 3; ++i) {
    across[i] = (across[i] - along * unit[i]) / norm;
  }
  Mat3 basis;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const std::size_t k = (i + 2) % 3;
    basis[i] = {unit[i], across[i], unit[j] * across[k] - unit[k] * across[j]};
  }
  return basis;
}

Mat3 transpose(const Mat3& m) {
  Mat3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      result[i][j] = m[j][i];
    }
  }
  return result;
}

/// Lengthens a spring at its middle along an axis, as stretched() says but for the factor.
Mat spread_along_axis(const Mat& c, std::size_t axis, double length, double reach) {
  const Mat3 rotation = rotational_compliance(c);
  const std::size_t i = (axis + 1) % 3;
  const std::size_t j = (axis + 2) % 3;
  // A turn about axis i shifts along j by -s, one about j shifts along i by +s, s along the axis.
  const double spread = kBendShare * (reach * reach - length * length) / 12;
  const double m_ii = spread * rotation[j][j];
  const double m_jj = spread * rotation[i][i];
  const double m_ij = -spread * rotation[i][j];
  // (C^-1 + E M E^T)^-1 = C - C E (1 + M E^T C E)^-1 M E^T C, E picks the two shear directions.
  const int r0 = static_cast<int>(i);
  const int r1 = static_cast<int>(j);
  const double s00 = c.at(r0, r0);
  const double s01 = c.at(r0, r1);
  const double s11 = c.at(r1, r1);
  const double a00 = 1 + m_ii * s00 + m_ij * s01;
  const double a01 = m_ii * s01 + m_ij * s11;
  const double a10 = m_ij * s00 + m_jj * s01;
  const double a11 = 1 + m_ij * s01 + m_jj * s11;
  const double determinant = a00 * a11 - a01 * a10;
  const double w00 = (a11 * m_ii - a01 * m_ij) / determinant;
  const double w01 = (a11 * m_ij - a01 * m_jj) / determinant;
  const double w11 = (-a10 * m_ij + a00 * m_jj) / determinant;
  Mat reduced = c;
  const double* const column_0 = c.values.data() + 6 * i;
  const double* const column_1 = c.values.data() + 6 * j;
  for (std::size_t column = 0; column < 6; ++column) {
    const double t0 = w00 * column_0[column] + w01 * column_1[column];
    const double t1 = w01 * column_0[column] + w11 * column_1[column];
    double* const target = reduced.values.data() + 6 * column;
    for (std::size_t row = 0; row < 6; ++row) {
      target[row] -= column_0[row] * t0 + column_1[row] * t1;
    }
  }
  return reduced;
}

}  // namespace

Spring beam_spring(const base::Lattice& lattice, const model::Material& material,
                   std::size_t direction, std::size_t length) {
  const auto way = static_cast<base::Direction>(direction);
  const double mm =
      material.pitch_mm * static_cast<double>(length) * base::step_length(lattice, way);
  const Point unit = base::heading(lattice, way);
  return {.direction = unit,
          .length = mm,
          .middle = scaled(unit, mm / 2),
          .partner = scaled(unit, mm),
          .stiffness = long_beam(material, lattice, static_cast<int>(length)).block_11(way)};
}

double behind(const Point& offset, const Point& direction) {
  return std::max(0.0, dot(offset, direction));
}

Point scaled(const Point& point, double factor) {
  return {factor * point[0], factor * point[1], factor * point[2]};
}

/// S T(a): the columns of t gain those of u times -[a]x.
Mat times_carry(Mat s, const Point& a) {
  carry_columns(s, a);
  return s;
}

/// The right half is that of S T(a) first; the rows of t follow from it, as S is symmetric.
Mat carried(const Mat& s, const Point& a) {
  Mat result = s;
  carry_columns(result, a);
  double* const v = result.values.data();
  for (std::size_t i = 18; i < 36; i += 6) {
    v[i + 3] += v[i + 2] * a[1] - v[i + 1] * a[2];
    v[i + 4] += v[i] * a[2] - v[i + 2] * a[0];
    v[i + 5] += v[i + 1] * a[0] - v[i] * a[1];
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      v[6 * i + 3 + j] = v[6 * (3 + j) + i];
    }
  }
  return result;
}

/// Along an axis of the global frame nothing is turned.
PackedSpring::PackedSpring(const Spring& spring)
    : direction(spring.direction),
      length(spring.length),
      middle(spring.middle),
      partner(spring.partner) {
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      half[next++] = spring.stiffness.at(row, column);
    }
  }
}

Mat PackedSpring::stiffness() const {
  Mat all;
  std::size_t next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) {
      all.at(row, column) = half[next];
      all.at(column, row) = half[next++];
    }
  }
  return all;
}

Spring PackedSpring::unpacked() const {
  return {.direction = direction,
          .length = length,
          .middle = middle,
          .partner = partner,
          .stiffness = stiffness()};
}

Mat stretched(const Mat& stiffness, const Point& arm, const Point& direction, double length,
              double reach) {
  const Mat c = carried(stiffness, {-arm[0], -arm[1], -arm[2]});
  const auto along = std::ranges::find_if(direction, [](double x) { return std::abs(x) == 1; });
  Mat spread;
  if (along != direction.end()) {
    spread =
        spread_along_axis(c, static_cast<std::size_t>(along - direction.begin()), length, reach);
  } else {
    const Mat3 basis = basis_along(direction);
    spread = turned(spread_along_axis(turned(c, basis), 0, length, reach), transpose(basis));
  }
  return carried(scaled(spread, kCorrection * length / reach), arm);
}

}  // namespace holdfast::solver
