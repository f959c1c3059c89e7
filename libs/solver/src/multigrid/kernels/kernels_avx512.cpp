// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The kernels for machines with AVX-512, which shuffle two vectors of AVX2's width at once; the
// build compiles this file for them.
#include "multigrid/kernels/kernel_loops.hpp"

namespace holdfast::solver {

extern const Sweeps kSweepsAvx512;
extern const Rounding kRoundingAvx512;
extern const Kernels<float> kKernelsAvx512;
extern const Kernels<double> kPreciseKernelsAvx512;
const Sweeps kSweepsAvx512 = kSweeps;
const Rounding kRoundingAvx512 = kRounding;
const Kernels<float> kKernelsAvx512 = kAll<float>;
const Kernels<double> kPreciseKernelsAvx512 = kAll<double>;

}  // namespace holdfast::solver
