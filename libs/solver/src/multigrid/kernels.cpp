// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels.hpp"

#include "kernel_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const Kernels<float> kKernelsAvx2;
extern const Kernels<double> kPreciseKernelsAvx2;
#endif

template <>
const Kernels<float>& kernels<float>() {
#ifdef HOLDFAST_HAS_AVX2
  if (__builtin_cpu_supports("avx2") != 0) {
    return kKernelsAvx2;
  }
#endif
  return kAll<float>;
}

template <>
const Kernels<double>& kernels<double>() {
#ifdef HOLDFAST_HAS_AVX2
  if (__builtin_cpu_supports("avx2") != 0) {
    return kPreciseKernelsAvx2;
  }
#endif
  return kAll<double>;
}

}  // namespace holdfast::solver
