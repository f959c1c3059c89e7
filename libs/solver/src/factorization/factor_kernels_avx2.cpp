// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops for machines with AVX2; the build compiles this file for them.
#include "factorization/factor_loops.hpp"

namespace holdfast::solver {

extern const FactorKernels kFactorKernelsAvx2;
const FactorKernels kFactorKernelsAvx2 = kFactorKernels;

}  // namespace holdfast::solver
