// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// The root's part of deflation against a dense model: a stiffness with two slow modes, of which
// three changes of displacement have something in them. The modules' part is simulated as
// minimal_residuals.hpp has it: what they know of a direction is without its part along the
// changes, and numbers go over the wire as binary32.
#include "holdfast/agent/equilibrium/deflation.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "holdfast/base/rng.hpp"

namespace holdfast::agent {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using Energies = std::array<float, wire::kKeptPairs>;

constexpr Eigen::Index kSize = 30;
constexpr Eigen::Index kChanges = 3;

/// More than a slow solve takes.
constexpr std::uint32_t kManyIterations = 9;

double random_real(base::Rng& rng) { return static_cast<double>(rng.below(2'000'001)) / 1e6 - 1; }

MatrixXd random_matrix(base::Rng& rng, Eigen::Index rows, Eigen::Index columns) {
  return MatrixXd::NullaryExpr(rows, columns, [&] { return random_real(rng); });
}

/// K, f, and W, whose numbers are those that modules keep.
struct Model {
  MatrixXd stiffness;
  VectorXd load;
  MatrixXd kept;

  VectorXd diagonal() const { return stiffness.diagonal(); }
};

/// Eigenvalues from 1/2 to 2, and two of some 1e-4. Of each change half of the energy is slow.
Model random_model(std::uint64_t seed) {
  base::Rng rng(seed);
  const MatrixXd modes = random_matrix(rng, kSize, kSize).householderQr().householderQ();
  VectorXd values = VectorXd::LinSpaced(kSize, 0.5, 2);
  values.head<2>() << 1e-4, 3e-4;
  Model model;
  model.stiffness = modes * values.asDiagonal() * modes.transpose();
  model.load = random_matrix(rng, kSize, 1);
  const MatrixXd slow = modes.leftCols<2>() * random_matrix(rng, 2, kChanges);
  const MatrixXd rest = 0.002 * random_matrix(rng, kSize, kChanges);
  model.kept = (slow + rest).cast<float>().cast<double>();
  return model;
}

/// W' r as modules report it; nothing is in the last place.
Along<float> products_with(const Model& model, const VectorXd& residual) {
  Along<float> sums{};
  for (Eigen::Index i = 0; i < kChanges; ++i) {
    sums[static_cast<std::size_t>(i)] = static_cast<float>(model.kept.col(i).dot(residual));
  }
  return sums;
}

Energies energies_of(const Model& model) {
  Energies energies{};
  std::size_t pair = 0;
  for (Eigen::Index i = 0; i < kChanges; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      energies[pair++] =
          static_cast<float>(model.kept.col(i).dot(model.stiffness * model.kept.col(j)));
    }
  }
  return energies;
}

/// E, from what modules report.
MatrixXd energy_matrix(const Energies& energies) {
  MatrixXd matrix(kChanges, kChanges);
  std::size_t pair = 0;
  for (Eigen::Index i = 0; i < kChanges; ++i) {
    for (Eigen::Index j = 0; j <= i; ++j) {
      matrix(i, j) = matrix(j, i) = static_cast<double>(energies[pair++]);
    }
  }
  return matrix;
}

VectorXd vector_of(const Along<float>& along) {
  VectorXd values(kChanges);
  for (Eigen::Index i = 0; i < kChanges; ++i) {
    values(i) = static_cast<double>(along[static_cast<std::size_t>(i)]);
  }
  return values;
}

/// This many solves have ended, and each change was kept.
Deflation deflation_with(int changes) {
  Deflation deflation;
  for (int i = 0; i < changes; ++i) {
    deflation.end(kManyIterations, false);
    EXPECT_EQ(deflation.place(), i);
  }
  return deflation;
}

/// M^-1 = D^-1, with W E^-1 W' or without.
MatrixXd preconditioner(const Model& model, bool deflates) {
  MatrixXd inverse = model.diagonal().cwiseInverse().asDiagonal();
  if (deflates) {
    inverse += model.kept * energy_matrix(energies_of(model)).inverse() * model.kept.transpose();
  }
  return inverse;
}

/// The iterates of plain conjugate gradients from u on.
std::vector<VectorXd> conjugate_gradients(const Model& model, const MatrixXd& inverse, VectorXd u,
                                          int count) {
  std::vector<VectorXd> iterates;
  VectorXd residual = model.load - model.stiffness * u;
  VectorXd z = inverse * residual;
  VectorXd direction = z;
  double product = residual.dot(z);
  for (int i = 0; i < count; ++i) {
    const VectorXd image = model.stiffness * direction;
    const double alpha = product / direction.dot(image);
    u += alpha * direction;
    residual -= alpha * image;
    iterates.push_back(u);
    z = inverse * residual;
    const double next = residual.dot(z);
    direction = z + next / product * direction;
    product = next;
  }
  return iterates;
}

/// The modules, and what a root does with their reports (conductor/iterations.cpp).
class Robot {
 public:
  /// A solve begins from `u`; null: without changes.
  Robot(const Model& model, const VectorXd& u, Deflation* deflation)
      : model_(model), deflation_(deflation), u_(u) {
    residual_ = model_.load - model_.stiffness * u_;
    if (deflation_ != nullptr) {
      deflation_->begin(products_with(model_, residual_), energies_of(model_));
    }
    forget_directions();
  }

  /// Contact states have changed; the changes' energies stay as they were.
  void stiffen(const MatrixXd& stiffness) {
    model_.stiffness = stiffness;
    residual_ = model_.load - model_.stiffness * u_;
    if (deflation_ != nullptr) {
      std::array<double, 3> unused{};
      deflation_->complete(products_with(model_, residual_), unused);
    }
    forget_directions();
  }

  /// One order and its report. What the energy is least at, as the next order will have it.
  VectorXd iterate() {
    const VectorXd before = u_;
    move();
    residual_ = model_.load - model_.stiffness * u_;
    newer_.q -= residual_;
    newer_.z -= diagonal_inverse(residual_);
    newer_.all = u_ - before;
    if (!is_first_) {
      newer_.all -= a() * older_.all + b() * older_of_older_;
    }
    is_first_ = false;
    minimise();
    return u_ + least_a_ * (newer_.all - least_c_ * older_.all) + least_b_ * older_.all;
  }

  const VectorXd& displacement() const { return u_; }

 private:
  struct Direction {
    VectorXd p = VectorXd::Zero(kSize);    ///< As modules know it.
    VectorXd q = VectorXd::Zero(kSize);    ///< Of all of it.
    VectorXd z = VectorXd::Zero(kSize);    ///< D^-1 q
    VectorXd all = VectorXd::Zero(kSize);  ///< With its part along W, which nobody knows.
  };

  VectorXd diagonal_inverse(const VectorXd& residual) const {
    return model_.diagonal().cwiseInverse().cwiseProduct(residual);
  }

  double c() const { return static_cast<double>(static_cast<float>(least_c_)); }

  double a() const { return static_cast<double>(static_cast<float>(least_a_)); }

  double b() const { return static_cast<double>(static_cast<float>(least_b_)); }

  void forget_directions() {
    is_first_ = true;
    has_older_ = false;
    newer_ = older_ = {};
    newer_.p = diagonal_inverse(residual_);
  }

  void move() {
    VectorXd correction = newer_.p - newer_.z;
    VectorXd rest = residual_;
    VectorXd move = correction;
    Along<float> along{};
    if (is_first_) {
      along = deflation_ == nullptr ? along : deflation_->restart();
      older_ = {};
    } else {
      along = deflation_ == nullptr ? along : deflation_->minimise(c(), a(), b());
      newer_.p -= c() * older_.p;
      newer_.q -= c() * older_.q;
      newer_.z -= c() * older_.z;
      newer_.all -= c() * older_.all;
      correction -= a() * newer_.z + b() * older_.z;
      rest -= a() * newer_.q + b() * older_.q;
      move = a() * newer_.p + b() * older_.p + correction;
      older_of_older_ = older_.all;
      older_ = newer_;
    }
    u_ += move + model_.kept * vector_of(along);
    newer_ = {.p = correction, .q = rest, .z = correction};
  }

  /// Conductor::minimum().
  void minimise() {
    std::array<double, 3> products = {residual_.dot(newer_.p), newer_.q.dot(newer_.p),
                                      older_.q.dot(newer_.p)};
    if (deflation_ != nullptr) {
      deflation_->complete(products_with(model_, residual_), products);
    }
    const auto [along, square, mixed] = products;
    least_c_ = has_older_ ? mixed / older_square_ : 0;
    least_b_ = -least_c_;
    older_square_ = square - least_c_ * mixed;
    least_a_ = (along + least_c_ * mixed) / older_square_;
    has_older_ = true;
  }

  Model model_;
  Deflation* deflation_ = nullptr;
  VectorXd u_;
  VectorXd residual_;
  Direction newer_;
  Direction older_;
  VectorXd older_of_older_ = VectorXd::Zero(kSize);
  double least_c_ = 0;
  double least_a_ = 0;
  double least_b_ = 0;
  double older_square_ = 0;
  bool is_first_ = true;
  bool has_older_ = false;
};

double energy_of(const Model& model, const VectorXd& error) {
  return error.dot(model.stiffness * error);
}

/// The distance in the energy's norm, of the first error.
double distance(const Model& model, const VectorXd& a, const VectorXd& b) {
  const VectorXd solution = model.stiffness.llt().solve(model.load);
  return std::sqrt(energy_of(model, a - b) / energy_of(model, solution));
}

/// Iterations until the error is 1e-4 of the first one.
int iterations_needed(const Model& model, Deflation* deflation) {
  const VectorXd solution = model.stiffness.llt().solve(model.load);
  Robot robot(model, VectorXd::Zero(kSize), deflation);
  for (int i = 1; i <= 100; ++i) {
    if (distance(model, robot.iterate(), solution) < 1e-4) {
      return i;
    }
  }
  return 101;
}

constexpr std::uint64_t kSeeds = 20;

TEST(Deflation, begins_with_what_is_least_along_the_changes) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Model model = random_model(seed);
    Deflation deflation = deflation_with(kChanges);
    const Along<float> sums = products_with(model, model.load);
    deflation.begin(sums, energies_of(model));
    const Along<float> along = deflation.restart();
    const VectorXd expected = energy_matrix(energies_of(model)).ldlt().solve(vector_of(sums));
    EXPECT_LT((vector_of(along) - expected).norm(), 1e-6 * expected.norm()) << seed;
    EXPECT_EQ(along.back(), 0.0F);
  }
}

TEST(Deflation, has_the_iterates_of_conjugate_gradients) {
  constexpr int kCount = 12;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Model model = random_model(seed);
    for (const bool deflates : {false, true}) {
      Deflation deflation = deflation_with(kChanges);
      Robot robot(model, VectorXd::Zero(kSize), deflates ? &deflation : nullptr);
      const auto iterates = conjugate_gradients(model, preconditioner(model, deflates),
                                                VectorXd::Zero(kSize), kCount);
      for (int i = 0; i < kCount; ++i) {
        EXPECT_LT(distance(model, robot.iterate(), iterates[static_cast<std::size_t>(i)]), 1e-6)
            << seed << ' ' << deflates << ' ' << i;
      }
    }
  }
}

TEST(Deflation, needs_fewer_iterations) {
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Model model = random_model(seed);
    Deflation deflation = deflation_with(kChanges);
    const int plain = iterations_needed(model, nullptr);
    const int deflated = iterations_needed(model, &deflation);
    EXPECT_LT(deflated, plain) << seed;
  }
}

/// Energies are those of the stiffness before: with M^-1 of another stiffness, iterations are those
/// of conjugate gradients still.
TEST(Deflation, begins_anew_when_the_stiffness_changes) {
  constexpr int kBefore = 3;
  constexpr int kAfter = 8;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const Model model = random_model(seed);
    Deflation deflation = deflation_with(kChanges);
    Robot robot(model, VectorXd::Zero(kSize), &deflation);
    for (int i = 0; i < kBefore; ++i) {
      robot.iterate();
    }
    Model other = model;
    base::Rng rng(seed);
    const VectorXd facet = random_matrix(rng, kSize, 1);
    other.stiffness += 1e-5 * facet * facet.transpose();
    robot.stiffen(other.stiffness);
    MatrixXd inverse = preconditioner(model, true);
    const VectorXd diagonal = other.diagonal().cwiseInverse() - model.diagonal().cwiseInverse();
    inverse.diagonal() += diagonal;
    const auto iterates = conjugate_gradients(other, inverse, robot.displacement(), kAfter);
    for (int i = 0; i < kAfter; ++i) {
      EXPECT_LT(distance(other, robot.iterate(), iterates[static_cast<std::size_t>(i)]), 1e-6)
          << seed << ' ' << i;
    }
  }
}

/// Energies of four changes of which those with equal numbers are the same, the others orthogonal.
Energies energies_where(const std::array<int, wire::kKeptMax>& numbers) {
  Energies energies{};
  std::size_t pair = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      energies[pair++] = numbers[i] == numbers[j] ? 2.0F : 0.0F;
    }
  }
  return energies;
}

TEST(Deflation, replaces_the_oldest_change) {
  Deflation deflation = deflation_with(wire::kKeptMax);
  for (const int expected : {0, 1, 2, 3, 0}) {
    deflation.begin({4, 4, 4, 4}, energies_where({0, 1, 2, 3}));
    EXPECT_EQ(deflation.restart(), (Along<float>{2, 2, 2, 2}));
    deflation.end(kManyIterations, true);
    EXPECT_EQ(deflation.place(), expected);
  }
}

TEST(Deflation, replaces_first_what_says_the_same_as_a_newer_change) {
  Deflation deflation = deflation_with(wire::kKeptMax);
  deflation.begin({4, 4, 4, 4}, energies_where({0, 1, 2, 1}));
  EXPECT_EQ(deflation.restart(), (Along<float>{2, 0, 2, 2}));
  deflation.end(kManyIterations, true);
  EXPECT_EQ(deflation.place(), 1);
  // The first one is the oldest, and now the newest is in the second place.
  deflation.begin({4, 4, 4, 4}, energies_where({0, 1, 1, 1}));
  EXPECT_EQ(deflation.restart(), (Along<float>{2, 2, 0, 0}));
  deflation.end(kManyIterations, true);
  EXPECT_EQ(deflation.place(), 2);
}

/// A thousandth of its energy is all that a change has of its own: so much is an error.
TEST(Deflation, uses_a_change_only_if_it_says_something_new) {
  for (const auto& [own, is_used] : {std::pair{0.01F, true}, {0.0005F, false}, {-0.1F, false}}) {
    Deflation deflation = deflation_with(2);
    Energies energies{};
    energies[0] = 1 + own;
    energies[1] = energies[2] = 1;
    deflation.begin({2, 1, 0, 0}, energies);
    EXPECT_EQ(deflation.restart()[0] != 0, is_used) << own;
  }
}

/// Modules that have not moved, or have been there for no solve.
TEST(Deflation, does_not_use_what_is_nothing_or_not_a_number) {
  constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
  for (const float energy : {0.0F, -1.0F, kNothing}) {
    Deflation deflation = deflation_with(wire::kKeptMax);
    Energies energies = energies_where({0, 1, 2, 3});
    energies[5] = energy;  // (2, 2)
    deflation.begin({4, 4, 4, 4}, energies);
    EXPECT_EQ(deflation.restart(), (Along<float>{2, 2, 0, 2})) << energy;
    deflation.end(kManyIterations, true);
    EXPECT_EQ(deflation.place(), 2) << energy;
  }
}

TEST(Deflation, uses_no_place_that_nothing_was_put_into) {
  Deflation deflation = deflation_with(1);
  deflation.begin({4, 4, 4, 4}, energies_where({0, 1, 2, 3}));
  EXPECT_EQ(deflation.restart(), (Along<float>{2, 0, 0, 0}));
}

TEST(Deflation, keeps_each_change_once_and_none_of_no_use) {
  Deflation deflation;
  EXPECT_EQ(deflation.place(), wire::kKeptMax);
  deflation.end(kManyIterations, false);
  EXPECT_EQ(deflation.place(), 0);
  EXPECT_EQ(deflation.place(), wire::kKeptMax);
  deflation.end(0, true);
  EXPECT_EQ(deflation.place(), wire::kKeptMax);
  // One of no use takes back the one before it, whose change is no more.
  deflation.end(kManyIterations, true);
  deflation.end(0, true);
  EXPECT_EQ(deflation.place(), wire::kKeptMax);
  deflation.end(1, true);
  EXPECT_EQ(deflation.place(), 1);
}

TEST(Deflation, begins_after_two_slow_solves) {
  Deflation deflation;
  const auto is_used_after = [&](std::uint32_t iterations, bool is_resumed = true) {
    deflation.end(iterations, is_resumed);
    return deflation.is_used();
  };
  EXPECT_FALSE(is_used_after(40, false));  // The first of a round, ...
  EXPECT_FALSE(is_used_after(9));
  EXPECT_FALSE(is_used_after(6));  // ... one that is not slow, ...
  EXPECT_FALSE(is_used_after(7));
  EXPECT_FALSE(is_used_after(0));  // ... and what is no solve of one stiffness say nothing.
  EXPECT_FALSE(is_used_after(40, false));
  EXPECT_TRUE(is_used_after(7));
}

TEST(Deflation, ends_when_it_is_no_better_than_without) {
  Deflation deflation;
  const auto is_used_after = [&](std::uint32_t iterations, bool is_resumed = true) {
    deflation.end(iterations, is_resumed);
    return deflation.is_used();
  };
  for (const auto& [first, second] : {std::pair{9U, 8U}, {8U, 9U}, {8U, 8U}}) {
    EXPECT_FALSE(is_used_after(first));
    EXPECT_TRUE(is_used_after(second));
    EXPECT_TRUE(is_used_after(3));
    EXPECT_TRUE(is_used_after(8));  // As many as the quicker of the two.
    EXPECT_TRUE(is_used_after(0));
    EXPECT_TRUE(is_used_after(40, false));
    EXPECT_FALSE(is_used_after(9));
  }
  EXPECT_FALSE(is_used_after(9));
  EXPECT_TRUE(is_used_after(9));
  deflation.forget();
  EXPECT_FALSE(deflation.is_used());
  EXPECT_EQ(deflation.place(), wire::kKeptMax);
  EXPECT_FALSE(is_used_after(9));
}

}  // namespace
}  // namespace holdfast::agent
