// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "statics/contact_cone.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <limits>

namespace holdfast::limit {
namespace {

/// What is left of a load that can be balanced, as a share of it: rounding of a few thousand sums.
constexpr double kRemainderTie = 1e-10;
/// Generators are added until none is opposed to the remainder by more than this share of it, or by
/// more than the rounding of the load.
constexpr double kOpposedTie = 1e-9;
constexpr double kRounding = 1e-15;
/// What no-slip forces balance leaves rounding of what it was, which points anywhere.
constexpr double kSpannedTie = 1e-10;
/// Newton's iteration has found where a ray leaves if no more than this share of the load remains.
constexpr double kNearTie = 1e-5;
constexpr int kGeneratorMax = 2000;
constexpr int kExitStepMax = 100;

Vector6d wrench_at(const Vector3d& place, const Vector3d& force, double gyration) {
  Vector6d wrench;
  wrench << force, place.cross(force) / gyration;
  return wrench;
}

/// Orthonormal columns across all the given ones.
Eigen::MatrixXd complement(const Eigen::Matrix<double, 6, 6>& gram) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> solver(gram);
  constexpr double kRankTie = 1e-12;  // Of squares: a millionth of the largest.
  const double least = kRankTie * std::max(1.0, solver.eigenvalues()[5]);
  Eigen::Index count = 0;
  while (count < 6 && solver.eigenvalues()[count] <= least) {
    ++count;
  }
  return solver.eigenvectors().leftCols(count);
}

/// The generators in use and their shares, kept as non-negative least squares wants them.
class PassiveSet {
 public:
  explicit PassiveSet(const Eigen::VectorXd& load) : load_(load), remainder_(load) {}

  const Eigen::VectorXd& remainder() const { return remainder_; }

  /// Takes one more generator in and drops those that it makes void. False: it does not help.
  bool add(const Eigen::VectorXd& generator) {
    columns_.conservativeResize(load_.size(), columns_.cols() + 1);
    columns_.rightCols(1) = generator;
    shares_.conservativeResize(columns_.cols());
    shares_[shares_.size() - 1] = 0;
    const double before = remainder_.squaredNorm();
    while (columns_.cols() > 0) {
      const Eigen::VectorXd best = columns_.colPivHouseholderQr().solve(-load_);
      if (best.minCoeff() > 0) {
        shares_ = best;
        break;
      }
      step_towards(best);
    }
    remainder_ = load_ + columns_ * shares_;
    return remainder_.squaredNorm() < before;
  }

 private:
  /// Goes as far as no share becomes negative and drops those that became 0.
  void step_towards(const Eigen::VectorXd& best) {
    double step = 1;
    Eigen::Index first = 0;
    for (Eigen::Index i = 0; i < best.size(); ++i) {
      if (best[i] <= 0) {
        const double part = shares_[i] <= 0 ? 0 : shares_[i] / (shares_[i] - best[i]);
        if (part <= step) {
          step = part;
          first = i;
        }
      }
    }
    shares_ += step * (best - shares_);
    Eigen::Index kept = 0;
    for (Eigen::Index i = 0; i < best.size(); ++i) {
      if (i != first && shares_[i] > 0) {
        columns_.col(kept) = columns_.col(i).eval();
        shares_[kept++] = shares_[i];
      }
    }
    columns_.conservativeResize(load_.size(), kept);
    shares_.conservativeResize(kept);
  }

  Eigen::VectorXd load_;
  Eigen::VectorXd remainder_;
  Eigen::MatrixXd columns_;
  Eigen::VectorXd shares_;
};

}  // namespace

ContactCone::ContactCone(const std::vector<ContactPoint>& points, double gyration_mm) {
  Eigen::Matrix<double, 6, 6> gram = Eigen::Matrix<double, 6, 6>::Zero();
  for (const ContactPoint& point : points) {
    for (const Vector3d& across : point.across) {
      if (!point.friction) {
        const Vector6d wrench = wrench_at(point.place, across, gyration_mm);
        gram += wrench * wrench.transpose();
      }
    }
  }
  basis_ = complement(gram);
  for (const ContactPoint& point : points) {
    Generator generator;
    const auto reduced = [&](const Vector3d& force) -> Reduced {
      const Vector6d wrench = wrench_at(point.place, force, gyration_mm);
      const Reduced part = basis_.transpose() * wrench;
      return part.norm() > kSpannedTie * wrench.norm() ? part : Reduced::Zero(part.size());
    };
    generator.normal = reduced(point.normal);
    if (point.friction.value_or(0) > 0) {
      for (std::size_t i = 0; i < 2; ++i) {
        generator.across[i] = reduced(*point.friction * point.across[i]);
      }
    }
    generators_.push_back(std::move(generator));
  }
}

ContactCone::Reduced ContactCone::most_opposed(const Reduced& remainder, double& product) const {
  Reduced best;
  product = 0;
  for (const Generator& generator : generators_) {
    Reduced push = generator.normal;
    if (generator.across[0].size() > 0) {
      const double x = generator.across[0].dot(remainder);
      const double y = generator.across[1].dot(remainder);
      const double length = std::hypot(x, y);
      if (length > 0) {
        push -= (x * generator.across[0] + y * generator.across[1]) / length;
      }
    }
    const double length = push.norm();
    const double along = length > 0 ? push.dot(remainder) / length : 0;
    if (along < product) {
      product = along;
      best = push / length;
    }
  }
  return best;
}

ContactCone::Remainder ContactCone::remainder(const Vector6d& load) const {
  PassiveSet passive(basis_.transpose() * load);
  for (int i = 0; i < kGeneratorMax; ++i) {
    double product = 0;
    const Reduced push = most_opposed(passive.remainder(), product);
    const double length = passive.remainder().norm();
    const double tie = kOpposedTie * length + kRounding * load.norm();
    if (product >= -tie || !passive.add(push)) {
      return {.wrench = basis_ * passive.remainder(),
              .is_settled = product >= -tie || -product * load.norm() <= length * length};
    }
  }
  return {.wrench = basis_ * passive.remainder(), .is_settled = false};
}

bool ContactCone::is_nothing(const Vector6d& remainder, const Vector6d& load) {
  return remainder.norm() <= kRemainderTie * load.norm();
}

// Newton's iteration from outside: the plane that separates a load from the cone is crossed nearer
// to the exit, or there.
ContactCone::Exit ContactCone::leave(const Vector6d& from, const Vector6d& along) const {
  Exit exit = {.distance = std::numeric_limits<double>::infinity()};
  Vector6d load = along;
  for (int step = 0; step < kExitStepMax; ++step) {
    const Remainder left = remainder(load);
    const double closing = left.wrench.dot(along);
    if (is_nothing(left.wrench, load) || closing <= 0) {
      return exit;
    }
    if (!left.is_settled) {
      exit.is_settled = left.wrench.norm() <= kNearTie * load.norm() && !exit.normal.isZero();
      return exit;
    }
    const double distance = std::max(0.0, -left.wrench.dot(from) / closing);
    const bool is_nearer = distance < exit.distance * (1 - kRemainderTie);
    if (is_nearer || exit.normal.isZero()) {
      exit.distance = std::min(exit.distance, distance);
      exit.normal = left.wrench.normalized();
    }
    if (!is_nearer) {
      return exit;
    }
    load = from + distance * along;
  }
  exit.is_settled = false;
  return exit;
}

}  // namespace holdfast::limit
