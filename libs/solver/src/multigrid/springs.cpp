// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "springs.hpp"

#include <algorithm>

#include "../block_kernels.hpp"
#include "beam_shapes.hpp"

namespace holdfast::solver {
namespace {

using Mat3 = std::array<std::array<double, 3>, 3>;

Mat3 inverse_of(const Mat3& m) {
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
  const Mat3 free = inverse_of(uu);
  for (std::size_t j = 0; j < 3; ++j) {
    std::array<double, 3> follows{};
    for (std::size_t k = 0; k < 3; ++k) {
      follows[k] = free[k][0] * ut[0][j] + free[k][1] * ut[1][j] + free[k][2] * ut[2][j];
    }
    for (std::size_t i = 0; i < 3; ++i) {
      left[i][j] -= ut[0][i] * follows[0] + ut[1][i] * follows[1] + ut[2][i] * follows[2];
    }
  }
  return inverse_of(left);
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

Point along(std::size_t direction, double length) {
  Point point{};
  point[direction / 2] = direction % 2 == 0 ? length : -length;
  return point;
}

}  // namespace

Spring beam_spring(const model::Material& material, std::size_t direction, std::size_t length) {
  const double mm = material.pitch_mm * static_cast<double>(length);
  return {.direction = static_cast<std::uint8_t>(direction),
          .length = mm,
          .middle = along(direction, mm / 2),
          .partner = along(direction, mm),
          .stiffness = mechanics::block_11(long_beam(material, static_cast<int>(length)),
                                           static_cast<base::Direction>(direction))};
}

double behind(const Point& offset, std::size_t direction) {
  const double step = offset[direction / 2];
  return std::max(0.0, direction % 2 == 0 ? step : -step);
}

Mat scaled(Mat matrix, double factor) {
  for (double& value : matrix.values) {
    value *= factor;
  }
  return matrix;
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

Mat stretched(const Mat& stiffness, const Point& arm, std::size_t axis, double length,
              double reach) {
  const Mat c = carried(stiffness, {-arm[0], -arm[1], -arm[2]});
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
  return carried(scaled(reduced, kCorrection * length / reach), arm);
}

}  // namespace holdfast::solver
