// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "algebra/block_cholesky.hpp"

#include <algorithm>

#include "algebra/for_each.hpp"
#include "algebra/nested_dissection.hpp"
#include "holdfast/host/interruption.hpp"

namespace holdfast::limit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;

}  // namespace

BlockCholesky::BlockCholesky(std::span<const Eigen::Vector3d> places, std::span<const Edge> edges,
                             int thread_count)
    : place_(places.size()),
      node_(nested_dissection(places, edges)),
      team_(thread_count, places.size()) {
  for (std::size_t i = 0; i < node_.size(); ++i) {
    place_[static_cast<std::size_t>(node_[i])] = static_cast<int>(i);
  }
  make_fronts(edges);
}

/// Blocks that are stored as zeros when the next column, with so many rows below, joins.
std::size_t BlockCholesky::Front::zeros_by(std::size_t row_count) const {
  return first == last ? 0 : static_cast<std::size_t>(last - first) * (row_count + 1 - rows.size());
}

int BlockCholesky::Front::seat(int row) const {
  if (row < last) {
    return row - first;
  }
  return last - first + static_cast<int>(std::ranges::lower_bound(rows, row) - rows.begin());
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
  link_fronts(front_of);
  make_branches();
  left_.resize(fronts_.size());
}

void BlockCholesky::link_fronts(const std::vector<int>& front_of) {
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    Front& front = fronts_[i];
    if (!front.rows.empty()) {
      front.parent = front_of[static_cast<std::size_t>(front.rows.front())];
      Front& parent = fronts_[static_cast<std::size_t>(front.parent)];
      parent.children.push_back(static_cast<int>(i));
      for (const int row : front.rows) {
        front.seats.push_back(parent.seat(row));
      }
    }
    work_ += front.work();
  }
}

/// Threads take a branch each, the largest subtrees that are small beside the whole, and then share
/// the fronts of the stem.
void BlockCholesky::make_branches() {
  constexpr double kShareMax = 1.0 / 32;
  std::vector<double> work(fronts_.size(), 0);
  std::vector<std::size_t> branch(fronts_.size());
  for (std::size_t i = 0; i < fronts_.size(); ++i) {
    work[i] += fronts_[i].work();
    if (fronts_[i].parent >= 0) {
      work[static_cast<std::size_t>(fronts_[i].parent)] += work[i];
    }
  }
  for (std::size_t i = fronts_.size(); i-- > 0;) {  // Parents come first.
    const int parent = fronts_[i].parent;
    const bool is_branch = work[i] <= kShareMax * work_;
    const bool is_above =
        is_branch && parent >= 0 && work[static_cast<std::size_t>(parent)] <= kShareMax * work_;
    if (is_above) {
      branch[i] = branch[static_cast<std::size_t>(parent)];
      branches_[branch[i]].push_back(i);
    } else if (is_branch) {
      branch[i] = branches_.size();
      branches_.push_back({i});
    } else {
      stem_.push_back(i);
    }
  }
  std::ranges::reverse(stem_);
  for (std::vector<std::size_t>& fronts : branches_) {
    std::ranges::reverse(fronts);
  }
}

void BlockCholesky::gather(const Front& front, std::span<const Block> diagonal,
                           std::span<const Block> coupling, MatrixXd& dense) {
  dense.setZero(front.height(), front.height());
  for (int column = front.first; column < front.last; ++column) {
    const int at = 6 * (column - front.first);
    dense.block<6, 6>(at, at) =
        diagonal[static_cast<std::size_t>(node_[static_cast<std::size_t>(column)])];
  }
  for (const int e : front.edges) {
    const auto& [a, b] = edges_[static_cast<std::size_t>(e)];
    const int at_a = 6 * front.seat(a);
    const int at_b = 6 * front.seat(b);
    const Block& block = coupling[static_cast<std::size_t>(e)];
    if (a > b) {
      dense.block<6, 6>(at_a, at_b) += block;
    } else {
      dense.block<6, 6>(at_b, at_a) += block.transpose();
    }
  }
  for (const int child : front.children) {
    const std::vector<int>& seats = fronts_[static_cast<std::size_t>(child)].seats;
    MatrixXd& left = left_[static_cast<std::size_t>(child)];
    for (std::size_t j = 0; j < seats.size(); ++j) {
      for (std::size_t i = j; i < seats.size(); ++i) {
        dense.block<6, 6>(6 * seats[i], 6 * seats[j]) +=
            left.block<6, 6>(6 * static_cast<Index>(i), 6 * static_cast<Index>(j));
      }
    }
    left.resize(0, 0);
  }
}

void BlockCholesky::factor(std::span<const Block> diagonal, std::span<const Block> coupling) {
  for_each(team_, branches_.size(), [&](std::size_t branch) {
    Workspace work;
    host::Team alone(1);
    for (const std::size_t front : branches_[branch]) {
      factor(front, diagonal, coupling, work, alone);
    }
  });
  Workspace work;
  for (const std::size_t front : stem_) {
    factor(front, diagonal, coupling, work, team_);
  }
}

void BlockCholesky::factor(std::size_t index, std::span<const Block> diagonal,
                           std::span<const Block> coupling, Workspace& work, host::Team& team) {
  host::ask_whether_to_go_on();
  Front& front = fronts_[index];
  gather(front, diagonal, coupling, work.dense);
  const Index width = front.width();
  work.first_value.resize(width);
  for (int column = front.first; column < front.last; ++column) {
    work.first_value.segment<6>(6 * (column - front.first)) =
        diagonal[static_cast<std::size_t>(node_[static_cast<std::size_t>(column)])].diagonal();
  }
  work.elimination.run(work.dense, width, work.first_value, team);
  front.columns = work.dense.leftCols(width);
  const Index rest = work.dense.rows() - width;
  left_[index] = work.dense.bottomRightCorner(rest, rest);
}

void BlockCholesky::solve(Eigen::VectorXd& x) {
  Eigen::VectorXd ordered(x.size());
  for (std::size_t i = 0; i < node_.size(); ++i) {
    ordered.segment<6>(6 * static_cast<Index>(i)) = x.segment<6>(6 * node_[i]);
  }
  for_each(team_, branches_.size(), [&](std::size_t branch) {
    for (const std::size_t front : branches_[branch]) {
      substitute_forward(fronts_[front], ordered);
    }
  });
  for (const std::size_t front : stem_) {
    substitute_forward(fronts_[front], ordered);
  }
  for (auto front = stem_.rbegin(); front != stem_.rend(); ++front) {
    substitute_back(fronts_[*front], ordered);
  }
  for_each(team_, branches_.size(), [&](std::size_t branch) {
    const std::vector<std::size_t>& fronts = branches_[branch];
    for (auto front = fronts.rbegin(); front != fronts.rend(); ++front) {
      substitute_back(fronts_[*front], ordered);
    }
  });
  for (std::size_t i = 0; i < node_.size(); ++i) {
    x.segment<6>(6 * node_[i]) = ordered.segment<6>(6 * static_cast<Index>(i));
  }
}

/// Rows of its own in x, and what is handed to its parent's, by way of those of its children.
void BlockCholesky::substitute_forward(Front& front, Eigen::VectorXd& x) {
  const Index width = front.width();
  auto top = x.segment(6 * front.first, width);
  front.handed.setZero(front.height() - width);
  for (const int child_index : front.children) {
    const Front& child = fronts_[static_cast<std::size_t>(child_index)];
    for (std::size_t i = 0; i < child.seats.size(); ++i) {
      const Index seat = 6 * child.seats[i];
      const auto part = child.handed.segment<6>(6 * static_cast<Index>(i));
      if (seat < width) {
        top.segment<6>(seat) += part;
      } else {
        front.handed.segment<6>(seat - width) += part;
      }
    }
  }
  front.columns.topRows(width).triangularView<Eigen::Lower>().solveInPlace(top);
  front.handed.noalias() -= front.columns.bottomRows(front.handed.size()) * top;
}

void BlockCholesky::substitute_back(const Front& front, Eigen::VectorXd& x) const {
  const Index width = front.width();
  Eigen::VectorXd below(front.height() - width);
  for (std::size_t i = 0; i < front.rows.size(); ++i) {
    below.segment<6>(6 * static_cast<Index>(i)) = x.segment<6>(6 * front.rows[i]);
  }
  auto top = x.segment(6 * front.first, width);
  top.noalias() -= front.columns.bottomRows(below.size()).transpose() * below;
  front.columns.topRows(width).triangularView<Eigen::Lower>().transpose().solveInPlace(top);
}

}  // namespace holdfast::limit
