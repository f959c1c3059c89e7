// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops that the library chose for this machine beside the same code compiled here, for any
// machine of its kind: the same bits. On a machine without AVX2 both are the same code.
#include "../src/multigrid/kernels/kernels.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "../src/multigrid/kernels/kernel_loops.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

constexpr std::size_t kCount = 97;
constexpr Range kEvery = {0, kCount};

template <class Real>
void fill(base::Rng& rng, Real* lanes) {
  for (int i = 0; i < 6; ++i) {
    lanes[i] = static_cast<Real>(random_number(rng));
  }
}

template <class Real>
std::vector<Six<Real>> random_vector(base::Rng& rng) {
  std::vector<Six<Real>> vector(kCount + 1);
  for (std::size_t i = 0; i < kCount; ++i) {
    fill(rng, vector[i].v);
  }
  return vector;
}

template <class Real>
Block<Real> random_block(base::Rng& rng) {
  Block<Real> block;
  for (int column = 0; column < 6; ++column) {
    fill(rng, block.column(column));
  }
  return block;
}

template <class T>
bool is_same(const std::vector<T>& a, const std::vector<T>& b) {
  return std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

bool is_same(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Nodes in a row, each with up to four others, of three types.
struct Clusters {
  explicit Clusters(base::Rng& rng) {
    for (std::size_t p = 0; p < kCount; ++p) {
      start.push_back(static_cast<std::int32_t>(other.size()));
      for (const std::size_t step : {1U, 7U}) {
        if (p >= step) {
          other.push_back(static_cast<std::int32_t>(p - step));
        }
        if (p + step < kCount) {
          other.push_back(static_cast<std::int32_t>(p + step));
        }
      }
      type.push_back(static_cast<std::uint32_t>(p % 3));
      seat.push_back({.offset = {static_cast<float>(p % 5), 2, -1},
                      .cluster = static_cast<std::int32_t>(p / 8)});
      member.push_back(static_cast<std::int32_t>(p));
      if (p % 8 == 0) {
        member_start.push_back(static_cast<std::int32_t>(p));
      }
    }
    start.push_back(static_cast<std::int32_t>(other.size()));
    member_start.push_back(static_cast<std::int32_t>(kCount));
    block.resize(other.size());
    for (std::size_t e = 0; e < other.size(); ++e) {
      block[e] = static_cast<std::uint32_t>(e % 4);
    }
    for (int i = 0; i < 4; ++i) {
      blocks.push_back(random_block<float>(rng));
      inverse.push_back(random_block<float>(rng));
      diagonal.push_back(random_block<float>(rng));
    }
  }

  ClusterView<float> view() const {
    return {.start = start.data(),
            .other = other.data(),
            .type = type.data(),
            .inverse = inverse.data(),
            .block = block.data(),
            .blocks = blocks.data(),
            .diagonal = diagonal.data()};
  }

  TransferView<float> transfer() const {
    return {.seat = seat.codes(),
            .offset = seat.offsets(),
            .start = member_start.data(),
            .member = member.data()};
  }

  std::size_t cluster_count() const { return member_start.size() - 1; }

  std::vector<std::int32_t> start;
  std::vector<std::int32_t> other;
  std::vector<std::uint32_t> type;
  std::vector<std::uint32_t> block;
  std::vector<Block<float>> blocks;
  std::vector<Block<float>> inverse;
  std::vector<Block<float>> diagonal;
  Seats<float> seat;
  std::vector<std::int32_t> member_start;
  std::vector<std::int32_t> member;
};

TEST(Kernels, sweeps_have_the_same_bits_on_every_machine) {
  base::Rng rng(5);
  const Clusters clusters(rng);
  const auto r = random_vector<float>(rng);
  auto z = random_vector<float>(rng);
  auto here = z;
  sweeps().relax(clusters.view(), r.data(), z.data(), kEvery);
  kSweeps.relax(clusters.view(), r.data(), here.data(), kEvery);
  EXPECT_TRUE(is_same(z, here));
  EXPECT_FALSE(is_same(z, r));
  sweeps().relax_first(clusters.type.data(), clusters.inverse.data(), r.data(), z.data(), kEvery);
  kSweeps.relax_first(clusters.type.data(), clusters.inverse.data(), r.data(), here.data(), kEvery);
  EXPECT_TRUE(is_same(z, here));
}

/// Half a unit of low parts, as a share of the number.
constexpr double kSplitError = 0x1p-39;

/// Rounded and low parts are the number to 39 bits (split_numbers.hpp), from the least that a float
/// holds as a normal number to the most, and split again what is joined does not change.
TEST(SplitNumbers, are_the_numbers_to_half_a_unit) {
  base::Rng rng(8);
  std::vector<double> numbers = {1.0, std::nextafter(2.0, 0.0), -std::nextafter(4.0, 5.0),
                                 1 + 0x1p-24};
  for (int exponent = -124; exponent < 126; ++exponent) {
    for (int i = 0; i < 40; ++i) {
      numbers.push_back(std::ldexp(random_number(rng), exponent));
    }
  }
  for (const double x : numbers) {
    if (std::abs(x) >= std::numeric_limits<float>::min()) {
      const auto near = static_cast<float>(x);
      const double kept = joined(near, low_part(x, near));
      const auto again = static_cast<float>(kept);
      EXPECT_LE(std::abs(kept - x), kSplitError * std::abs(x)) << x;
      EXPECT_TRUE(is_same(joined(again, low_part(kept, again)), kept)) << x;
    }
  }
  EXPECT_EQ(joined(0, low_part(0, 0)), 0);
  EXPECT_EQ(joined(static_cast<float>(1e-60), low_part(1e-60, static_cast<float>(1e-60))), 0);
}

/// The loops' own way of splitting is that of single numbers, and x and r go along p and q.
TEST(SplitNumbers, advance_by_steps_in_double_precision) {
  base::Rng rng(9);
  const auto p = random_vector<float>(rng);
  std::vector<double> q(6 * kCount);
  std::vector<double> x(6 * kCount);
  std::vector<double> r(6 * kCount);
  std::vector<Six<float>> rounded(kCount + 1);
  std::vector<std::int16_t> low(6 * kCount);
  const SplitView<float> split = {.rounded = rounded.data(), .low = low.data()};
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = random_number(rng);
    x[i] = random_number(rng);
    split.set(i, random_number(rng));
    r[i] = split.get(i);
  }
  const double step = random_number(rng);
  auto x_there = x;
  kernels<float>().advance(step, p.data(), q.data(), x_there.data(), split, kEvery);
  double work = 0;
  for (std::size_t i = 0; i < q.size(); ++i) {
    EXPECT_TRUE(is_same(x_there[i], x[i] + step * static_cast<double>(p[i / 6].v[i % 6])));
    const double left = r[i] - step * q[i];
    const auto near = static_cast<float>(left);
    EXPECT_TRUE(is_same(split.get(i), joined(near, low_part(left, near))));
    EXPECT_LE(std::abs(split.get(i) - left), kSplitError * std::abs(left));
    work += split.get(i) * static_cast<double>(p[i / 6].v[i % 6]);
  }
  // Sums in another order: 600 roundings of terms of about 1.
  EXPECT_NEAR(kernels<float>().dot_split(split, p.data(), kEvery), work, 1e-12);
}

TEST(Kernels, products_and_transfers_have_the_same_bits_on_every_machine) {
  base::Rng rng(6);
  const Clusters clusters(rng);
  const auto r = random_vector<float>(rng);
  const auto z = random_vector<float>(rng);
  std::vector<Six<float>> q(kCount + 1);
  auto here = q;
  const Kernels<float>& chosen = kernels<float>();
  const Kernels<float>& plain = kAll<float>;
  EXPECT_TRUE(is_same(chosen.apply_cluster(clusters.view(), z.data(), q.data(), kEvery),
                      plain.apply_cluster(clusters.view(), z.data(), here.data(), kEvery)));
  EXPECT_TRUE(is_same(q, here));
  EXPECT_TRUE(is_same(chosen.dot_same(r.data(), z.data(), kEvery),
                      plain.dot_same(r.data(), z.data(), kEvery)));
  std::vector<Six<float>> coarse(clusters.cluster_count() + 1);
  auto coarse_here = coarse;
  const Range every = {0, clusters.cluster_count()};
  chosen.restrict_to(clusters.view(), clusters.transfer(), kCount, r.data(), z.data(),
                     coarse.data(), every);
  plain.restrict_to(clusters.view(), clusters.transfer(), kCount, r.data(), z.data(),
                    coarse_here.data(), every);
  EXPECT_TRUE(is_same(coarse, coarse_here));
  chosen.prolong(clusters.transfer(), coarse.data(), q.data(), kEvery);
  plain.prolong(clusters.transfer(), coarse.data(), here.data(), kEvery);
  EXPECT_TRUE(is_same(q, here));
  chosen.combine(0.3F, r.data(), -1.7F, q.data(), kEvery);
  plain.combine(0.3F, r.data(), -1.7F, here.data(), kEvery);
  EXPECT_TRUE(is_same(q, here));
}

/// Forces gathered at clusters and motions handed out are each other's transpose: the work that
/// forces f do on the motion that c hands out is that of what is gathered of f on c.
TEST(Kernels, restriction_is_the_transpose_of_prolongation) {
  base::Rng rng(7);
  const Clusters clusters(rng);
  const auto f = random_vector<float>(rng);
  const std::vector<Six<float>> zero(kCount + 1);
  std::vector<Six<float>> c(clusters.cluster_count() + 1);
  for (std::size_t i = 0; i < clusters.cluster_count(); ++i) {
    fill(rng, c[i].v);
  }
  std::vector<Six<float>> gathered(c.size());
  auto moved = zero;
  const Kernels<float>& all = kernels<float>();
  all.restrict_to(clusters.view(), clusters.transfer(), kCount, f.data(), zero.data(),
                  gathered.data(), {0, clusters.cluster_count()});
  all.prolong(clusters.transfer(), c.data(), moved.data(), kEvery);
  const double work = all.dot_same(f.data(), moved.data(), kEvery);
  const double coarse_work = all.dot_same(gathered.data(), c.data(), {0, clusters.cluster_count()});
  EXPECT_GT(std::abs(work), 1);
  // Sums of 600 products of numbers below 3 in single precision.
  EXPECT_NEAR(work, coarse_work, 1e-4);
}

}  // namespace
}  // namespace holdfast::solver
