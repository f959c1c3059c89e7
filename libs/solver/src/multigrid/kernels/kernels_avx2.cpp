// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The kernels for machines with AVX2; the build compiles this file for them.
#include "multigrid/kernels/kernel_loops.hpp"

namespace holdfast::solver {

extern const Sweeps kSweepsAvx2;
extern const Rounding kRoundingAvx2;
extern const Kernels<float> kKernelsAvx2;
extern const Kernels<double> kPreciseKernelsAvx2;
const Sweeps kSweepsAvx2 = kSweeps;
const Rounding kRoundingAvx2 = kRounding;
const Kernels<float> kKernelsAvx2 = kAll<float>;
const Kernels<double> kPreciseKernelsAvx2 = kAll<double>;

}  // namespace holdfast::solver
