// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "algebra/dense_kernels.hpp"

#include "algebra/dense_loops.hpp"

namespace holdfast::limit {

#ifdef HOLDFAST_HAS_AVX2
extern const DenseKernels kDenseKernelsAvx2;

const DenseKernels& dense_kernels() {
  return __builtin_cpu_supports("avx2") != 0 ? kDenseKernelsAvx2 : kDenseKernels;
}
#else
const DenseKernels& dense_kernels() { return kDenseKernels; }
#endif

}  // namespace holdfast::limit
