// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/root_three.hpp"

#include "wide.hpp"

namespace holdfast::mechanics {
namespace {

Wide negative(const Wide& value) {
  const std::uint64_t low = 0 - value.low;
  return {~value.high + (low == 0 ? 1U : 0U), low};
}

Wide twice(const Wide& value) { return sum(value, value); }

Wide thrice(const Wide& value) { return sum(twice(value), value); }

/// The sign of a + b sqrt(3). Where a and b have different signs it is that of
///   v = p - q sqrt(3), or of -v, with positive p and q, and w = p + q sqrt(3).
/// v times the positive number 2 + sqrt(3) is (2 p - 3 q) - (2 q - p) sqrt(3); with these as p and
/// q w has been multiplied by 2 - sqrt(3). So v grows and w shrinks until one of p and q is not
/// positive. v is not zero, as v w is a whole number other than zero; with w < 2^123 that takes 65
/// steps at most, and no number becomes larger than 4 w.
int sign_of(const Wide& a, const Wide& b) {
  const int sign_a = sign(a);
  const int sign_b = sign(b);
  if (sign_a * sign_b >= 0) {
    return sign_a != 0 ? sign_a : sign_b;
  }
  Wide p = sign_a > 0 ? a : negative(a);
  Wide q = sign_b > 0 ? b : negative(b);
  while (sign(p) > 0 && sign(q) > 0) {
    const Wide next = sum(twice(p), negative(thrice(q)));
    q = sum(twice(q), negative(p));
    p = next;
  }
  return sign(p) > 0 ? sign_a : sign_b;
}

}  // namespace

int RootThree::sign() const { return sign_of(product(whole_, 1), product(roots_, 1)); }

int sign_of_product_sum(const RootThree& p, const RootThree& q, const RootThree& r,
                        const RootThree& s) {
  const Wide whole = sum(product(p.whole(), q.whole()), product(r.whole(), s.whole()));
  const Wide roots = sum(product(p.roots(), q.roots()), product(r.roots(), s.roots()));
  const Wide mixed = sum(sum(product(p.whole(), q.roots()), product(p.roots(), q.whole())),
                         sum(product(r.whole(), s.roots()), product(r.roots(), s.whole())));
  return sign_of(sum(whole, thrice(roots)), mixed);
}

}  // namespace holdfast::mechanics
