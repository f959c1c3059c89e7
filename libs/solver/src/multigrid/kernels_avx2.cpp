// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The kernels for machines with AVX2; the build compiles this file for them.
#include "kernel_loops.hpp"

namespace holdfast::solver {

extern const Kernels kKernelsAvx2;
const Kernels kKernelsAvx2 = kAll;

}  // namespace holdfast::solver
