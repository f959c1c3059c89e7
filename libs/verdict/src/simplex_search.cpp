// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "simplex_search.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::verdict {
namespace {

/// Edges of the first simplex, and values and steps that are as good as equal.
constexpr double kFirstStep = 0.1;
constexpr double kValueDigits = 1e-8;
constexpr double kStepDigits = 1e-7;
constexpr int kStepsMax = 600;

struct Corner {
  std::vector<double> numbers;
  double value = 0;
};

/// a + factor (b - a)
std::vector<double> along(const std::vector<double>& a, const std::vector<double>& b,
                          double factor) {
  std::vector<double> point = a;
  for (std::size_t i = 0; i < point.size(); ++i) {
    point[i] += factor * (b[i] - a[i]);
  }
  return point;
}

class Simplex {
 public:
  Simplex(const std::function<double(std::span<const double>)>& function,
          const std::vector<double>& start)
      : function_(function) {
    add(start);
    for (std::size_t i = 0; i < start.size(); ++i) {
      std::vector<double> corner = start;
      corner[i] += kFirstStep;
      add(corner);
    }
    sort();
  }

  bool is_small() const {
    const Corner& best = corners_.front();
    const Corner& worst = corners_.back();
    double size = 0;
    for (std::size_t i = 0; i < best.numbers.size(); ++i) {
      size = std::max(size, std::abs(worst.numbers[i] - best.numbers[i]));
    }
    return size < kStepDigits || (worst.value - best.value < kValueDigits && size < 1e-3);
  }

  void step() {
    const std::vector<double> middle = middle_of_others();
    Corner& worst = corners_.back();
    const Corner reflected = at(along(middle, worst.numbers, -1));
    if (reflected.value < corners_.front().value) {
      const Corner further = at(along(middle, worst.numbers, -2));
      worst = further.value < reflected.value ? further : reflected;
    } else if (reflected.value < corners_[corners_.size() - 2].value) {
      worst = reflected;
    } else {
      const bool is_outside = reflected.value < worst.value;
      const Corner nearer = at(along(middle, worst.numbers, is_outside ? -0.5 : 0.5));
      if (nearer.value < std::min(reflected.value, worst.value)) {
        worst = nearer;
      } else {
        shrink();
      }
    }
    sort();
  }

  const Corner& best() const { return corners_.front(); }

 private:
  Corner at(std::vector<double> numbers) const {
    const double value = function_(numbers);
    return {std::move(numbers), value};
  }

  void add(const std::vector<double>& numbers) { corners_.push_back(at(numbers)); }

  void sort() { std::ranges::stable_sort(corners_, {}, &Corner::value); }

  std::vector<double> middle_of_others() const {
    std::vector<double> sum(corners_.front().numbers.size(), 0);
    for (std::size_t c = 0; c + 1 < corners_.size(); ++c) {
      for (std::size_t i = 0; i < sum.size(); ++i) {
        sum[i] += corners_[c].numbers[i] / static_cast<double>(corners_.size() - 1);
      }
    }
    return sum;
  }

  void shrink() {
    for (std::size_t c = 1; c < corners_.size(); ++c) {
      corners_[c] = at(along(corners_.front().numbers, corners_[c].numbers, 0.5));
    }
  }

  const std::function<double(std::span<const double>)>& function_;
  std::vector<Corner> corners_;
};

}  // namespace

double minimise(const std::function<double(std::span<const double>)>& function,
                std::vector<double>& numbers) {
  if (numbers.empty()) {
    return function(numbers);
  }
  Simplex simplex(function, numbers);
  for (int i = 0; i < kStepsMax && !simplex.is_small(); ++i) {
    simplex.step();
  }
  numbers = simplex.best().numbers;
  return simplex.best().value;
}

}  // namespace holdfast::verdict
