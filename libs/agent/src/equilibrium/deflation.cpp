// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/equilibrium/deflation.hpp"

#include "algebra/scalar.hpp"

namespace holdfast::agent {
namespace {

/// A change is used if so much of its energy is none of those used before: what is less is an
/// error of E as well.
constexpr double kNewShare = 0.001;

/// A solve without what is kept is slow if it takes so many iterations.
constexpr std::uint32_t kSlow = 7;

double dot(const Along<double>& a, const Along<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += a[i] * b[i];
  }
  return sum;
}

void add_times(Along<double>& sum, double factor, const Along<double>& term) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] += factor * term[i];
  }
}

Along<float> rounded(const Along<double>& along) {
  Along<float> values{};
  for (std::size_t i = 0; i < along.size(); ++i) {
    values[i] = static_cast<float>(along[i]);
  }
  return values;
}

Along<double> widened(const Along<float>& sums) {
  Along<double> values{};
  for (std::size_t i = 0; i < sums.size(); ++i) {
    values[i] = static_cast<double>(sums[i]);
  }
  return values;
}

}  // namespace

std::uint8_t Deflation::place() {
  if (!has_new_) {
    return wire::kKeptMax;
  }
  const auto worth = [&](std::size_t i) { return uses(i) ? time_[i] + now_ : time_[i]; };
  std::uint8_t least = 0;
  for (std::uint8_t i = 1; i < wire::kKeptMax; ++i) {
    least = worth(i) < worth(least) ? i : least;
  }
  time_[least] = ++now_;
  has_new_ = false;
  return least;
}

int Deflation::kept_count() const {
  int count = 0;
  for (const std::uint32_t time : time_) {
    count += time > 0 ? 1 : 0;
  }
  return count;
}

bool Deflation::uses(std::size_t change) const {
  for (std::size_t k = 0; k < count_; ++k) {
    if (used_[k] == change) {
      return true;
    }
  }
  return false;
}

/// Takes the changes that are kept, newest first, so that the oldest are left out where they say
/// the same.
void Deflation::factor() {
  count_ = 0;
  std::uint32_t before = now_ + 1;
  for (int n = kept_count(); n > 0; --n) {
    std::size_t next = time_.size();
    for (std::size_t i = 0; i < time_.size(); ++i) {
      const bool is_later = next == time_.size() || time_[i] > time_[next];
      next = time_[i] < before && is_later ? i : next;
    }
    before = time_[next];
    use(static_cast<std::uint8_t>(next));
  }
}

/// One row more of the factor, if the change has something of its own.
void Deflation::use(std::uint8_t change) {
  Along<double> row{};
  double pivot = energy_[change][change];
  for (std::size_t k = 0; k < count_; ++k) {
    row[k] = (energy_[change][used_[k]] - dot(row, factor_[k])) / factor_[k][k];
    pivot -= row[k] * row[k];
  }
  if (pivot > kNewShare * energy_[change][change]) {
    row[count_] = square_root(pivot);
    factor_[count_] = row;
    used_[count_++] = change;
  }
}

Along<double> Deflation::solve(const Along<double>& sums) const {
  Along<double> half{};
  for (std::size_t k = 0; k < count_; ++k) {
    half[k] = (sums[used_[k]] - dot(half, factor_[k])) / factor_[k][k];
  }
  Along<double> result{};
  for (std::size_t k = count_; k-- > 0;) {
    for (std::size_t m = k + 1; m < count_; ++m) {
      half[k] -= factor_[m][k] * half[m];
    }
    half[k] /= factor_[k][k];
    result[used_[k]] = half[k];
  }
  return result;
}

void Deflation::begin(const Along<float>& residual, const Energies& energies) {
  std::size_t pair = 0;
  for (std::size_t i = 0; i < energy_.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      energy_[i][j] = energy_[j][i] = static_cast<double>(energies[pair++]);
    }
  }
  residual_ = widened(residual);
  newer_ = older_ = {};
  factor();
}

/// What is kept is used after two slow plain solves in a row, until one is no better than these.
void Deflation::end(std::uint32_t iterations, bool is_resumed) {
  has_new_ = iterations > 0;
  if (!has_new_ || !is_resumed) {
    return;
  }
  if (is_used_) {
    is_used_ = iterations <= plain_;
    plain_ = is_used_ ? plain_ : 0;
  } else {
    is_used_ = iterations >= kSlow && plain_ >= kSlow;
    plain_ = is_used_ && plain_ < iterations ? plain_ : iterations;
  }
}

void Deflation::complete(const Along<float>& residual, std::array<double, 3>& products) {
  residual_ = widened(residual);
  newer_.q = reduced_;
  add_times(newer_.q, -1, residual_);
  products[0] += dot(newer_.h, residual_);
  products[1] += dot(newer_.h, newer_.q);
  products[2] += dot(newer_.h, older_.q);
}

Along<float> Deflation::restart() {
  older_ = {};
  reduced_ = residual_;
  newer_.h = solve(reduced_);
  return rounded(newer_.h);
}

Along<float> Deflation::minimise(double c, double a, double b) {
  add_times(newer_.h, -c, older_.h);
  add_times(newer_.q, -c, older_.q);
  reduced_ = residual_;
  add_times(reduced_, -a, newer_.q);
  add_times(reduced_, -b, older_.q);
  const Along<double> along = solve(reduced_);
  Along<double> move = along;
  add_times(move, a, newer_.h);
  add_times(move, b, older_.h);
  older_ = newer_;
  newer_.h = along;
  return rounded(move);
}

}  // namespace holdfast::agent
