// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "methods/condensed_group.hpp"

namespace holdfast::agent {

namespace {

constexpr std::size_t kUnknowns = 6;

std::size_t first_row(int node) { return kUnknowns * static_cast<std::size_t>(node - 1); }

/// The square matrix of a group, by rows.
class Matrix {
 public:
  explicit Matrix(const Workspace& ws)
      : rows_(first_row(ws.node_count())), reals_(ws.planned.more_planned()->group) {}

  std::size_t rows() const { return rows_; }

  double& at(std::size_t row, std::size_t column) const { return reals_[rows_ * row + column]; }

 private:
  std::size_t rows_;
  std::span<double> reals_;
};

/// A column of the planned module `node`: its own block, and what its neighbours feel of it.
void put_column(const Workspace& ws, const Matrix& matrix, int node, std::size_t column) {
  const std::size_t into = first_row(node) + column;
  const auto put = [&](int other, const base::Vec6<double>& image) {
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      matrix.at(first_row(other) + i, into) = image[i];
    }
  };
  for (std::size_t row = 0; row < matrix.rows(); ++row) {
    matrix.at(row, into) = 0;
  }
  put(node, diagonal_column(ws.node(node), ws.setup, ws.contact, ws.faces_of(node),
                            static_cast<int>(column)));
  base::Vec6<double> unit{};
  unit[column] = 1;
  for (const Direction direction : ws.planned.directions()) {
    const int other = ws.planned.neighbour_of(ws.planned.hosted(node - 1), direction);
    if (other >= 0) {
      put(ws.planned.node_of(other),
          end_force(ws.setup.beams(), base::opposite(direction), base::Vec6<double>{}, unit));
    }
  }
}

/// L and U in its place.
void eliminate(const Matrix& matrix) {
  for (std::size_t k = 0; k < matrix.rows(); ++k) {
    for (std::size_t row = k + 1; row < matrix.rows(); ++row) {
      double& factor = matrix.at(row, k);
      if (factor == 0) {
        continue;
      }
      factor /= matrix.at(k, k);
      for (std::size_t column = k + 1; column < matrix.rows(); ++column) {
        matrix.at(row, column) -= factor * matrix.at(k, column);
      }
    }
  }
}

/// Are the factors of these contact states here? Notes that they will be.
bool is_made(const Workspace& ws) {
  MorePlanned& more = *ws.planned.more_planned();
  // Around planned modules there is more than a floor: their facets have states of their own.
  bool is_same = more.group_count == ws.planned.hosted_count() && ws.environment() == nullptr;
  more.group_count = static_cast<std::uint8_t>(ws.planned.hosted_count());
  for (int i = 1; i < ws.node_count(); ++i) {
    mechanics::ContactState& state = more.group_states[static_cast<std::size_t>(i - 1)];
    is_same = is_same && state == ws.node(i).state;
    state = ws.node(i).state;
  }
  return is_same;
}

}  // namespace

bool is_group(const Workspace& ws) {
  const MorePlanned* more = ws.planned.more_planned();
  return ws.planned.hosted_count() > kPlannedMax && more != nullptr && !more->group.empty();
}

void factor_group(Workspace& ws) {
  if (!is_group(ws) || is_made(ws)) {
    return;
  }
  const Matrix matrix(ws);
  for (int node = 1; node < ws.node_count(); ++node) {
    for (std::size_t column = 0; column < kUnknowns; ++column) {
      put_column(ws, matrix, node, column);
    }
  }
  eliminate(matrix);
}

void solve_group(Workspace& ws) {
  if (!is_group(ws)) {
    return;
  }
  const Matrix matrix(ws);
  const auto value = [&ws](std::size_t row) -> double& {
    return ws.node(1 + static_cast<int>(row / kUnknowns)).force[row % kUnknowns];
  };
  for (std::size_t row = 0; row < matrix.rows(); ++row) {
    for (std::size_t k = 0; k < row; ++k) {
      value(row) -= matrix.at(row, k) * value(k);
    }
  }
  for (std::size_t row = matrix.rows(); row-- > 0;) {
    for (std::size_t k = row + 1; k < matrix.rows(); ++k) {
      value(row) -= matrix.at(row, k) * value(k);
    }
    value(row) /= matrix.at(row, row);
  }
}

}  // namespace holdfast::agent
