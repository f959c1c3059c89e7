// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/factor_kernels.hpp"

#include "factorization/factor_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const FactorKernels kFactorKernelsAvx2;
extern const FactorKernels kFactorKernelsAvx512;

const FactorKernels& factor_kernels() {
  if (__builtin_cpu_supports("avx512f") != 0) {
    return kFactorKernelsAvx512;
  }
  return __builtin_cpu_supports("avx2") != 0 ? kFactorKernelsAvx2 : kFactorKernels;
}
#else
const FactorKernels& factor_kernels() { return kFactorKernels; }
#endif

}  // namespace holdfast::solver
