// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/kernels/kernels.hpp"

#include "multigrid/kernels/kernel_loops.hpp"

namespace holdfast::solver {

#ifdef HOLDFAST_HAS_AVX2
extern const Sweeps kSweepsAvx2;
extern const Sweeps kSweepsAvx512;
extern const Rounding kRoundingAvx2;
extern const Rounding kRoundingAvx512;
extern const Kernels<float> kKernelsAvx2;
extern const Kernels<float> kKernelsAvx512;
extern const Kernels<double> kPreciseKernelsAvx2;
extern const Kernels<double> kPreciseKernelsAvx512;

namespace {

template <class Table>
const Table& choose(const Table& with_avx512, const Table& with_avx2, const Table& without) {
  if (__builtin_cpu_supports("avx512vl") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
      __builtin_cpu_supports("avx512bw") != 0) {
    return with_avx512;
  }
  return __builtin_cpu_supports("avx2") != 0 ? with_avx2 : without;
}

}  // namespace

const Sweeps& sweeps() { return choose(kSweepsAvx512, kSweepsAvx2, kSweeps); }

const Rounding& rounding() { return choose(kRoundingAvx512, kRoundingAvx2, kRounding); }

template <>
const Kernels<float>& kernels<float>() {
  return choose(kKernelsAvx512, kKernelsAvx2, kAll<float>);
}

template <>
const Kernels<double>& kernels<double>() {
  return choose(kPreciseKernelsAvx512, kPreciseKernelsAvx2, kAll<double>);
}
#else
const Sweeps& sweeps() { return kSweeps; }

const Rounding& rounding() { return kRounding; }

template <>
const Kernels<float>& kernels<float>() {
  return kAll<float>;
}

template <>
const Kernels<double>& kernels<double>() {
  return kAll<double>;
}
#endif

}  // namespace holdfast::solver
