// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "kernels.hpp"

#include "kernel_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const Kernels kKernelsAvx2;
#endif

const Kernels& kernels() {
#ifdef HOLDFAST_HAS_AVX2
  if (__builtin_cpu_supports("avx2") != 0) {
    return kKernelsAvx2;
  }
#endif
  return kAll;
}

}  // namespace holdfast::solver
