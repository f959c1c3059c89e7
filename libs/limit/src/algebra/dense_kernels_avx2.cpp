// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops for machines with AVX2; the build compiles this file for them.
#include "algebra/dense_loops.hpp"

namespace holdfast::limit {

extern const DenseKernels kDenseKernelsAvx2;
const DenseKernels kDenseKernelsAvx2 = kDenseKernels;

}  // namespace holdfast::limit
