// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/conductor/energy_bound.hpp"

#include "algebra/scalar.hpp"

namespace holdfast::agent {

double EnergyBound::add(double rho, double alpha) {
  if (is_first_) {
    phi_ = 1;
    inverse_ = last_ = mixed_ = alpha;
  } else {
    const double beta = rho / rho_;
    phi_ /= phi_ + beta;
    // L grows by a row. In the plane of x and the new unit vector, |L^-t .|^2 is the form
    // [inverse, mixed; mixed, last], whose greatest value is taken.
    const double carry = beta * alpha / alpha_;
    const double mixed = -square_root(carry) * mixed_;
    last_ = carry * last_ + alpha;
    const double difference = inverse_ - last_;
    const double root = square_root(difference * difference + 4 * mixed * mixed);
    const double share = root > 0 ? (1 - difference / root) / 2 : 1;
    inverse_ += root * share;
    const double sine = square_root(share < 1 ? 1 - share : 0);
    const double cosine = square_root(share) * (mixed < 0 ? -1 : 1);
    mixed_ = sine * mixed + cosine * last_;
  }
  is_first_ = false;
  rho_ = rho;
  alpha_ = alpha;
  return phi_ * rho * inverse_;
}

}  // namespace holdfast::agent
