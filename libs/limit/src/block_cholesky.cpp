// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "block_cholesky.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nested_dissection.hpp"

namespace holdfast::limit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

/// Of a pivot's first value: less is rounding, and a pivot is never less.
constexpr double kNothing = 1e-15;

/// Factors the first `width` columns of the lower triangle of a symmetric matrix; the rest of it
/// becomes what is left. `first_value` by column, before anything was eliminated.
void eliminate(MatrixXd& dense, Index width, const Eigen::VectorXd& first_value) {
  constexpr Index kPanel = 48;
  const Index height = dense.rows();
  for (Index begin = 0; begin < width; begin += kPanel) {
    const Index count = std::min(kPanel, width - begin);
    for (Index k = begin; k < begin + count; ++k) {
      const double pivot = dense(k, k);
      const double root = std::sqrt(std::max(pivot, kNothing * first_value[k]));
      const Index below = begin + count - k - 1;
      dense(k, k) = root;
      dense.col(k).segment(k + 1, below) /= root;
      for (Index j = k + 1; j < begin + count; ++j) {
        dense.col(j).segment(j, begin + count - j) -=
            dense(j, k) * dense.col(k).segment(j, begin + count - j);
      }
    }
    const Index end = begin + count;
    if (end == height) {
      break;
    }
    auto under = dense.block(end, begin, height - end, count);
    dense.block(begin, begin, count, count)
        .triangularView<Eigen::Lower>()
        .transpose()
        .solveInPlace<Eigen::OnTheRight>(under);
    dense.bottomRightCorner(height - end, height - end)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(under, -1);
  }
}

}  // namespace

BlockCholesky::BlockCholesky(std::span<const Eigen::Vector3d> places, std::span<const Edge> edges)
    : place_(places.size()), node_(nested_dissection(places, edges)) {
  for (std::size_t i = 0; i < node_.size(); ++i) {
    place_[static_cast<std::size_t>(node_[i])] = static_cast<int>(i);
  }
  make_fronts(edges);
}

/// Blocks that are stored as zeros when the next column, with so many rows below, joins.
std::size_t BlockCholesky::Front::zeros_by(std::size_t row_count) const {
  return first == last ? 0 : static_cast<std::size_t>(last - first) * (row_count + 1 - rows.size());
}

bool BlockCholesky::Front::may_join(int column, std::size_t row_count) const {
  if (rows.empty() || rows.front() != column) {
    return false;
  }
  const std::size_t count = static_cast<std::size_t>(last + 1 - first);
  const std::size_t blocks = count * (count + 1) / 2 + count * row_count;
  constexpr std::size_t kZerosShare = 5;  // One in so many.
  return kZerosShare * (zeros + zeros_by(row_count)) <= blocks;
}

/// The rows of a column of L are those of K and of its children in the elimination tree. A column
/// joins the front of the one before it if that is its child and the fronts' zeros are few.
void BlockCholesky::make_fronts(std::span<const Edge> edges) {
  const std::size_t n = node_.size();
  std::vector<std::vector<int>> below(n);
  std::vector<std::vector<int>> edges_of(n);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int a = place_[static_cast<std::size_t>(edges[e].first)];
    const int b = place_[static_cast<std::size_t>(edges[e].second)];
    edges_.emplace_back(a, b);
    below[static_cast<std::size_t>(std::min(a, b))].push_back(std::max(a, b));
    edges_of[static_cast<std::size_t>(std::min(a, b))].push_back(static_cast<int>(e));
  }
  std::vector<int> front_of(n, -1);
  for (std::size_t k = 0; k < n; ++k) {
    std::vector<int>& rows = below[k];
    std::ranges::sort(rows);
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    const int column = static_cast<int>(k);
    if (fronts_.empty() || !fronts_.back().may_join(column, rows.size())) {
      fronts_.push_back({.first = column, .last = column});
    }
    Front& front = fronts_.back();
    front.zeros += front.zeros_by(rows.size());
    front.last = column + 1;
    front.rows = rows;
    front.edges.insert(front.edges.end(), edges_of[k].begin(), edges_of[k].end());
    front_of[k] = static_cast<int>(fronts_.size()) - 1;
    if (!rows.empty()) {
      std::vector<int>& up = below[static_cast<std::size_t>(rows.front())];
      up.insert(up.end(), rows.begin() + 1, rows.end());
    }
  }
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    const Front& front = fronts_[i];
    if (!front.rows.empty()) {
      const int parent = front_of[static_cast<std::size_t>(front.rows.front())];
      fronts_[static_cast<std::size_t>(parent)].children.push_back(static_cast<int>(i));
    }
    work_ += static_cast<double>(front.width()) * front.height() * front.height();
  }
  left_.resize(fronts_.size());
  local_.resize(n);
}

void BlockCholesky::gather(Front& front, std::span<const Block> diagonal,
                           std::span<const Block> coupling, MatrixXd& dense) {
  dense.setZero(front.height(), front.height());
  for (int column = front.first; column < front.last; ++column) {
    local_[static_cast<std::size_t>(column)] = 6 * (column - front.first);
  }
  for (std::size_t i = 0; i < front.rows.size(); ++i) {
    local_[static_cast<std::size_t>(front.rows[i])] = front.width() + 6 * static_cast<int>(i);
  }
  for (int column = front.first; column < front.last; ++column) {
    const int at = local_[static_cast<std::size_t>(column)];
    dense.block<6, 6>(at, at) =
        diagonal[static_cast<std::size_t>(node_[static_cast<std::size_t>(column)])];
  }
  for (const int e : front.edges) {
    const auto& [a, b] = edges_[static_cast<std::size_t>(e)];
    const int at_a = local_[static_cast<std::size_t>(a)];
    const int at_b = local_[static_cast<std::size_t>(b)];
    const Block& block = coupling[static_cast<std::size_t>(e)];
    if (a > b) {
      dense.block<6, 6>(at_a, at_b) += block;
    } else {
      dense.block<6, 6>(at_b, at_a) += block.transpose();
    }
  }
  for (const int child : front.children) {
    const std::vector<int>& rows = fronts_[static_cast<std::size_t>(child)].rows;
    MatrixXd& left = left_[static_cast<std::size_t>(child)];
    for (std::size_t j = 0; j < rows.size(); ++j) {
      for (std::size_t i = j; i < rows.size(); ++i) {
        dense.block<6, 6>(local_[static_cast<std::size_t>(rows[i])],
                          local_[static_cast<std::size_t>(rows[j])]) +=
            left.block<6, 6>(6 * static_cast<Index>(i), 6 * static_cast<Index>(j));
      }
    }
    left.resize(0, 0);
  }
}

void BlockCholesky::factor(std::span<const Block> diagonal, std::span<const Block> coupling) {
  MatrixXd dense;
  Eigen::VectorXd first_value;
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    gather(front, diagonal, coupling, dense);
    const Index width = front.width();
    first_value.resize(width);
    for (int column = front.first; column < front.last; ++column) {
      first_value.segment<6>(6 * (column - front.first)) =
          diagonal[static_cast<std::size_t>(node_[static_cast<std::size_t>(column)])].diagonal();
    }
    eliminate(dense, width, first_value);
    front.columns = dense.leftCols(width);
    const Index rest = dense.rows() - width;
    left_[i] = dense.bottomRightCorner(rest, rest);
  }
}

void BlockCholesky::solve(Eigen::Ref<MatrixXd> x) const {
  MatrixXd ordered(x.rows(), x.cols());
  for (std::size_t i = 0; i < node_.size(); ++i) {
    ordered.middleRows<6>(6 * static_cast<Index>(i)) = x.middleRows<6>(6 * node_[i]);
  }
  MatrixXd below;
  for (const Front& front : fronts_) {
    const Index width = front.width();
    auto top = ordered.middleRows(6 * front.first, width);
    front.columns.topRows(width).triangularView<Eigen::Lower>().solveInPlace(top);
    below.noalias() = front.columns.bottomRows(front.columns.rows() - width) * top;
    for (std::size_t i = 0; i < front.rows.size(); ++i) {
      ordered.middleRows<6>(6 * front.rows[i]) -= below.middleRows<6>(6 * static_cast<Index>(i));
    }
  }
  for (auto at = fronts_.rbegin(); at != fronts_.rend(); ++at) {
    const Front& front = *at;
    const Index width = front.width();
    below.resize(front.columns.rows() - width, x.cols());
    for (std::size_t i = 0; i < front.rows.size(); ++i) {
      below.middleRows<6>(6 * static_cast<Index>(i)) = ordered.middleRows<6>(6 * front.rows[i]);
    }
    auto top = ordered.middleRows(6 * front.first, width);
    top.noalias() -= front.columns.bottomRows(below.rows()).transpose() * below;
    front.columns.topRows(width).triangularView<Eigen::Lower>().transpose().solveInPlace(top);
  }
  for (std::size_t i = 0; i < node_.size(); ++i) {
    x.middleRows<6>(6 * node_[i]) = ordered.middleRows<6>(6 * static_cast<Index>(i));
  }
}

}  // namespace holdfast::limit
