// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The factorization that follows its terms, against Eigen's dense Cholesky of their sum after every
// change: random graphs, terms that come and go in random orders. Terms are symmetric and positive
// within a factor of some hundred, so that both agree to 1e-9 with room to spare.
#include "holdfast/frames/growing_factor.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <set>

#include "holdfast/base/rng.hpp"
#include "random_signed.hpp"
#include "seeds.hpp"

namespace holdfast::frames {
namespace {

using base::Mat6;
using base::Vec6;
using test::random_signed;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kFactorTolerance = 1e-9;

Matrix6 random_matrix(base::Rng& rng) {
  return Matrix6::NullaryExpr([&] { return random_signed(rng); });
}

Mat6<double> block(const Matrix6& matrix) {
  Mat6<double> result;
  Eigen::Map<Matrix6>(result.values.data()) = matrix;
  return result;
}

Matrix6 matrix(const Mat6<double>& block) { return Eigen::Map<const Matrix6>(block.values.data()); }

LowRankTerm random_term(base::Rng& rng, std::int32_t a, std::int32_t b) {
  const Matrix6 root = random_matrix(rng);
  return {.a = a,
          .b = b,
          .lever = block(-Matrix6::Identity() + 0.3 * random_matrix(rng)),
          .stiffness = block(root * root.transpose() + 0.5 * Matrix6::Identity())};
}

/// A connected graph: each node is joined to an earlier one or the ground, then pairs at random.
std::vector<LowRankTerm> random_terms(base::Rng& rng, std::int32_t node_count, int more) {
  std::vector<LowRankTerm> terms;
  for (std::int32_t node = 0; node < node_count; ++node) {
    const auto other =
        static_cast<std::int32_t>(rng.below(static_cast<std::uint64_t>(node) + 1)) - 1;
    terms.push_back(rng.below(2) == 0 || other < 0 ? random_term(rng, other, node)
                                                   : random_term(rng, node, other));
  }
  const auto count = static_cast<std::uint64_t>(node_count);
  for (int i = 0; i < more; ++i) {
    const auto a = static_cast<std::int32_t>(rng.below(count));
    const auto b = static_cast<std::int32_t>(rng.below(count));
    terms.push_back(random_term(rng, a == b ? -1 : a, b));
  }
  return terms;
}

std::vector<solver::Edge> edges(const std::vector<LowRankTerm>& terms) {
  std::vector<solver::Edge> list;
  for (const LowRankTerm& term : terms) {
    if (term.a >= 0) {
      list.push_back({term.a, term.b});
    }
  }
  return list;
}

struct Case {
  explicit Case(std::uint64_t seed, std::int32_t node_count_ = 14, int more = 16)
      : rng(seed),
        node_count(node_count_),
        terms(random_terms(rng, node_count, more)),
        factor(static_cast<std::size_t>(node_count), edges(terms)) {}

  bool has_node(std::int32_t node) const {
    return node < 0 || std::ranges::any_of(present, [&](std::size_t t) {
             return terms[t].a == node || terms[t].b == node;
           });
  }

  bool can_add(std::size_t t) const {
    return !present.contains(t) && (has_node(terms[t].a) || has_node(terms[t].b));
  }

  /// Whether every node with a term is connected to the ground by terms.
  bool is_held_without(std::size_t left) const {
    std::set<std::int32_t> held = {-1};
    for (bool has_grown = true; has_grown;) {
      has_grown = false;
      for (const std::size_t t : present) {
        if (t != left && held.contains(terms[t].a) != held.contains(terms[t].b)) {
          held.insert({terms[t].a, terms[t].b});
          has_grown = true;
        }
      }
    }
    return std::ranges::all_of(
        present, [&](std::size_t t) { return t == left || held.contains(terms[t].b); });
  }

  /// The solution by Eigen, from the sum of all terms that are present; zero at nodes that are not.
  Eigen::VectorXd dense_solution(const Eigen::VectorXd& load) const {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(6 * node_count, 6 * node_count);
    for (const std::size_t t : present) {
      const Matrix6 s = matrix(terms[t].stiffness);
      const Matrix6 l = matrix(terms[t].lever);
      const int a = 6 * terms[t].a;
      const int b = 6 * terms[t].b;
      sum.block<6, 6>(b, b) += s;
      if (a >= 0) {
        sum.block<6, 6>(a, a) += l * s * l.transpose();
        sum.block<6, 6>(a, b) += l * s;
        sum.block<6, 6>(b, a) += s * l.transpose();
      }
    }
    Eigen::VectorXd right = load;
    for (std::int32_t node = 0; node < node_count; ++node) {
      if (!has_node(node)) {
        sum.block<6, 6>(6 * node, 6 * node).setIdentity();
        right.segment<6>(6 * node).setZero();
      }
    }
    return sum.llt().solve(right);
  }

  double error() {
    const Eigen::VectorXd load =
        Eigen::VectorXd::NullaryExpr(6 * node_count, [&] { return random_signed(rng); });
    std::vector<Vec6<double>> x(static_cast<std::size_t>(node_count));
    for (int i = 0; i < 6 * node_count; ++i) {
      x[static_cast<std::size_t>(i / 6)][static_cast<std::size_t>(i % 6)] = load[i];
    }
    factor.solve(x);
    const Eigen::VectorXd expected = dense_solution(load);
    double largest = 0;
    for (int i = 0; i < 6 * node_count; ++i) {
      const double value = x[static_cast<std::size_t>(i / 6)][static_cast<std::size_t>(i % 6)];
      largest = std::max(largest, std::abs(value - expected[i]));
    }
    return largest / (1 + expected.cwiseAbs().maxCoeff());
  }

  base::Rng rng;
  std::int32_t node_count;
  std::vector<LowRankTerm> terms;
  GrowingFactor factor;
  std::set<std::size_t> present;
};

std::size_t random_index(Case& c) { return c.rng.below(c.terms.size()); }

/// Adds or removes a random term if that is possible.
bool change(Case& c) {
  const std::size_t t = random_index(c);
  if (c.can_add(t)) {
    EXPECT_TRUE(c.factor.add(c.terms[t]));
    c.present.insert(t);
    return true;
  }
  if (c.present.contains(t) && c.is_held_without(t)) {
    EXPECT_TRUE(c.factor.remove(c.terms[t]));
    c.present.erase(t);
    return true;
  }
  return false;
}

TEST(GrowingFactor, is_right_after_every_change) {
  for (std::uint64_t seed = 1; seed <= test::campaign(12U); ++seed) {
    Case c(seed);
    for (int step = 0; step < 150; ++step) {
      if (change(c)) {
        ASSERT_LT(c.error(), kFactorTolerance) << "seed " << seed << " step " << step;
      }
    }
  }
}

TEST(GrowingFactor, takes_back_a_change_to_the_same_bits) {
  Case c(3);
  while (c.present.size() < c.terms.size() / 2) {
    change(c);
  }
  std::vector<Vec6<double>> before(static_cast<std::size_t>(c.node_count), {1, 2, 3, 4, 5, 6});
  const std::vector<Vec6<double>> load = before;
  c.factor.solve(before);
  int undone_count = 0;
  for (int step = 0; step < 200; ++step) {
    const std::set<std::size_t> present = c.present;
    if (change(c)) {
      c.factor.undo();
      c.present = present;
      std::vector<Vec6<double>> after = load;
      c.factor.solve(after);
      ASSERT_EQ(after, before) << step;
      ++undone_count;
    }
  }
  EXPECT_GT(undone_count, 50);
}

TEST(GrowingFactor, goes_on_from_a_factorization_anew) {
  Case c(4);
  std::vector<const LowRankTerm*> terms;
  for (std::size_t t = 0; t < c.terms.size(); ++t) {
    c.present.insert(t);
    terms.push_back(&c.terms[t]);
  }
  ASSERT_TRUE(c.factor.factor(terms));
  EXPECT_LT(c.error(), kFactorTolerance);
  for (int step = 0; step < 100; ++step) {
    change(c);
  }
  EXPECT_LT(c.error(), kFactorTolerance);
}

TEST(GrowingFactor, refuses_what_hangs_on_nothing) {
  base::Rng rng(5);
  const std::vector<LowRankTerm> terms = {random_term(rng, -1, 0), random_term(rng, 0, 1),
                                          random_term(rng, 1, 2)};
  GrowingFactor factor(3, edges(terms));
  EXPECT_FALSE(factor.add(terms[2]));
  EXPECT_TRUE(factor.add(terms[0]));
  EXPECT_TRUE(factor.is_present(0));
  EXPECT_FALSE(factor.is_present(1));
  EXPECT_FALSE(factor.add(terms[2]));
  EXPECT_TRUE(factor.add(terms[1]));
  EXPECT_TRUE(factor.add(terms[2]));
  // Without the second the third would float.
  EXPECT_FALSE(factor.remove(terms[1]));
  EXPECT_TRUE(factor.remove(terms[2]));
  EXPECT_FALSE(factor.is_present(2));
  const LowRankTerm* const floating[] = {&terms[1]};
  EXPECT_FALSE(factor.factor(floating));
}

TEST(GrowingFactor, of_a_chain_has_no_fill) {
  base::Rng rng(6);
  std::vector<LowRankTerm> terms = {random_term(rng, -1, 0)};
  for (std::int32_t node = 1; node < 40; ++node) {
    terms.push_back(random_term(rng, node - 1, node));
  }
  EXPECT_EQ(GrowingFactor(40, edges(terms)).lower_block_count(), 39);
}

}  // namespace
}  // namespace holdfast::frames
