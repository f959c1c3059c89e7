// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels.hpp"

#include "kernel_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const Kernels<float> kKernelsAvx2;
extern const Kernels<double> kPreciseKernelsAvx2;

namespace {

template <class Real>
const Kernels<Real>& choose(const Kernels<Real>& with_avx2) {
  return __builtin_cpu_supports("avx2") != 0 ? with_avx2 : kAll<Real>;
}

}  // namespace

template <>
const Kernels<float>& kernels<float>() {
  return choose(kKernelsAvx2);
}

template <>
const Kernels<double>& kernels<double>() {
  return choose(kPreciseKernelsAvx2);
}
#else
template <>
const Kernels<float>& kernels<float>() {
  return kAll<float>;
}

template <>
const Kernels<double>& kernels<double>() {
  return kAll<double>;
}
#endif

}  // namespace holdfast::solver
