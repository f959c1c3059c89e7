// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace holdfast::mechanics {

/// A number a + b sqrt(3) with whole a and b: what lengths on a floor of prisms are, whose rows are
/// sqrt(3)/2 of a pitch apart. Exact as long as a and b fit.
class RootThree {
 public:
  // Whole numbers are such numbers. NOLINTNEXTLINE(google-explicit-constructor)
  constexpr RootThree(std::int64_t whole = 0, std::int64_t roots = 0)
      : whole_(whole), roots_(roots) {}

  constexpr std::int64_t whole() const { return whole_; }

  constexpr std::int64_t roots() const { return roots_; }

  constexpr RootThree operator-() const { return {-whole_, -roots_}; }

  friend constexpr RootThree operator+(const RootThree& a, const RootThree& b) {
    return {a.whole_ + b.whole_, a.roots_ + b.roots_};
  }

  friend constexpr RootThree operator-(const RootThree& a, const RootThree& b) {
    return {a.whole_ - b.whole_, a.roots_ - b.roots_};
  }

  friend constexpr RootThree operator*(const RootThree& a, const RootThree& b) {
    return {a.whole_ * b.whole_ + 3 * a.roots_ * b.roots_,
            a.whole_ * b.roots_ + a.roots_ * b.whole_};
  }

  /// sqrt(3) is not rational, so there is one way only to write a number.
  friend constexpr bool operator==(const RootThree&, const RootThree&) = default;

  friend bool operator<(const RootThree& a, const RootThree& b) { return (a - b).sign() < 0; }

  friend bool operator>(const RootThree& a, const RootThree& b) { return b < a; }

  friend bool operator<=(const RootThree& a, const RootThree& b) { return !(b < a); }

  friend bool operator>=(const RootThree& a, const RootThree& b) { return !(a < b); }

  /// The sign of the number, exact for numbers up to 2^62.
  int sign() const;

 private:
  std::int64_t whole_;
  std::int64_t roots_;
};

/// The sign of p q + r s, exact where a and b of all of them are at most kRootThreeMax.
int sign_of_product_sum(const RootThree& p, const RootThree& q, const RootThree& r,
                        const RootThree& s);

inline constexpr std::int64_t kRootThreeMax = std::int64_t{1} << 59U;

}  // namespace holdfast::mechanics
