// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/mechanics/connector.hpp"

namespace holdfast::mechanics {
namespace {

using base::absolute;

template <class Real>
Real larger(Real a, Real b) {
  if (a < b) {
    return b;
  }
  return b <= a ? a : a + b;  // One is a NaN, so the sum is: it must not hide.
}

}  // namespace

template <class Real>
ConnectionLoad<Real> connection_load(const base::Vec6<Real>& middle_force) {
  const Real mx = absolute(middle_force[3]);
  const Real my = absolute(middle_force[4]);
  return {.axial = middle_force[2], .bending = larger(mx, my)};
}

template <class Real>
Real load_ratio(const ConnectionLoad<Real>& load, Real width, Real strength) {
  return (2 * load.bending / width + load.axial) / strength;
}

template ConnectionLoad<float> connection_load(const base::Vec6<float>&);
template ConnectionLoad<double> connection_load(const base::Vec6<double>&);
template float load_ratio(const ConnectionLoad<float>&, float, float);
template double load_ratio(const ConnectionLoad<double>&, double, double);

}  // namespace holdfast::mechanics
