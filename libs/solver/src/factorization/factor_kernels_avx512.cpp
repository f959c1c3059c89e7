// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The loops for machines with AVX-512; the build compiles this file for them.
#include "factorization/factor_loops.hpp"

namespace holdfast::solver {

extern const FactorKernels kFactorKernelsAvx512;
const FactorKernels kFactorKernelsAvx512 = kFactorKernels;

}  // namespace holdfast::solver
