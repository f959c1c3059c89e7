// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The direct solver of limit loads: solutions beside what they are to solve, the same bits with any
// number of threads and with either set of kernels, separators that know layers.
#include "../src/algebra/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "../src/algebra/dense_kernels.hpp"
#include "../src/algebra/dense_loops.hpp"
#include "../src/algebra/nested_dissection.hpp"

namespace holdfast::limit {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

struct Frame {
  std::vector<Eigen::Vector3d> places;
  std::vector<BlockCholesky::Edge> edges;
  std::vector<Block> diagonal;
  std::vector<Block> coupling;

  VectorXd times(const VectorXd& x) const {
    VectorXd result(x.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto at = 6 * static_cast<Index>(i);
      result.segment<6>(at) = diagonal[i] * x.segment<6>(at);
    }
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Index a = 6 * edges[e].first;
      const Index b = 6 * edges[e].second;
      result.segment<6>(a) += coupling[e] * x.segment<6>(b);
      result.segment<6>(b) += coupling[e].transpose() * x.segment<6>(a);
    }
    return result;
  }
};

/// A cube of side^3 nodes with random couplings, made regular by its diagonal.
Frame random_frame(int side) {
  Frame frame;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> between(-1, 1);
  const auto index = [side](int x, int y, int z) { return (z * side + y) * side + x; };
  for (int z = 0; z < side; ++z) {
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        frame.places.emplace_back(x, y, z);
        frame.diagonal.emplace_back(40 * Block::Identity());
        for (const auto& [other, is_there] : {std::pair{index(x + 1, y, z), x + 1 < side},
                                              {index(x, y + 1, z), y + 1 < side},
                                              {index(x, y, z + 1), z + 1 < side}}) {
          if (is_there) {
            frame.edges.emplace_back(index(x, y, z), other);
            frame.coupling.push_back(Block::NullaryExpr([&] { return between(random); }));
          }
        }
      }
    }
  }
  return frame;
}

VectorXd solved(const Frame& frame, const VectorXd& b, int thread_count) {
  BlockCholesky cholesky(frame.places, frame.edges, thread_count);
  cholesky.factor(frame.diagonal, frame.coupling);
  VectorXd x = b;
  cholesky.solve(x);
  return x;
}

// Side 9: 729 nodes are enough for threads, for panels of 192 columns and for rows beyond a strip.
TEST(BlockCholesky, solves_what_it_factored_with_the_same_bits_on_all_threads) {
  const Frame frame = random_frame(9);
  const VectorXd b = VectorXd::LinSpaced(6 * 729, -1, 2);
  const VectorXd x = solved(frame, b, 1);
  EXPECT_LT((frame.times(x) - b).lpNorm<Eigen::Infinity>(), 1e-12);
  EXPECT_EQ(x, solved(frame, b, 4));
}

TEST(DenseKernels, have_the_same_bits_on_every_machine) {
  constexpr std::size_t kDepth = 50;
  constexpr std::size_t kStride = 23;
  const auto numbers = [](std::size_t count, double seed) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
      values[i] = std::sin(seed + static_cast<double>(i * i));
    }
    return values;
  };
  const auto rows = numbers(kTileRows * kDepth, 1);
  const auto columns = numbers(kTileColumns * kDepth, 2);
  for (const std::size_t row_count : {kTileRows, std::size_t{5}}) {
    auto plain = numbers(kStride * kTileColumns, 3);
    auto chosen = plain;
    kDenseKernels.subtract_tile(plain.data(), kStride, rows.data(), columns.data(), kDepth,
                                row_count, 4);
    dense_kernels().subtract_tile(chosen.data(), kStride, rows.data(), columns.data(), kDepth,
                                  row_count, 4);
    EXPECT_EQ(plain, chosen);
  }
  auto plain = numbers(kStride * 10, 4);
  auto chosen = plain;
  auto triangle = numbers(100, 5);
  for (std::size_t i = 0; i < 10; ++i) {
    triangle[11 * i] += 3;
  }
  kDenseKernels.divide(plain.data(), kStride, kStride, triangle.data(), 10, 10);
  dense_kernels().divide(chosen.data(), kStride, kStride, triangle.data(), 10, 10);
  EXPECT_EQ(plain, chosen);
}

// A face-centred bar along its cubic axis (1, 1, 0), across which its layers lie: one layer of 6 x
// 6 half pitches, 18 nodes, parts it; across (1, 0, 0) it would take twice as many.
TEST(NestedDissection, cuts_between_layers) {
  constexpr std::size_t kLayer = 18;
  std::vector<Eigen::Vector3d> places;
  std::vector<std::pair<int, int>> edges;
  for (int u = 0; u < 24; ++u) {
    for (int v = 0; v < 6; ++v) {
      for (int w = (u + v) % 2; w < 6; w += 2) {
        places.emplace_back((u + v) / 2.0, (u - v) / 2.0, w * std::sqrt(0.5));
      }
    }
  }
  for (std::size_t a = 0; a < places.size(); ++a) {
    for (std::size_t b = a + 1; b < places.size(); ++b) {
      if ((places[a] - places[b]).norm() < 1.1) {
        edges.emplace_back(static_cast<int>(a), static_cast<int>(b));
      }
    }
  }
  const std::vector<int> order = nested_dissection(places, edges);
  std::vector<int> sorted = order;
  std::ranges::sort(sorted);
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    ASSERT_EQ(sorted[i], static_cast<int>(i));
  }
  // Without the last seam it is in pieces.
  std::vector<char> is_left(places.size(), 1);
  for (std::size_t i = order.size() - kLayer; i < order.size(); ++i) {
    is_left[static_cast<std::size_t>(order[i])] = 0;
  }
  std::vector<int> reached = {order.front()};
  is_left[static_cast<std::size_t>(order.front())] = 0;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const auto& [a, b] : edges) {
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        if (from == reached[i] && is_left[static_cast<std::size_t>(to)] != 0) {
          is_left[static_cast<std::size_t>(to)] = 0;
          reached.push_back(to);
        }
      }
    }
  }
  EXPECT_LT(reached.size(), places.size() - kLayer);
}

}  // namespace
}  // namespace holdfast::limit
