// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstring>

#include "lane_substitution.hpp"

/// The loops of lane_substitution.hpp. Included once per instruction set, in a namespace of its
/// own; the order of operations of every lane is that of BlockLu::solve(), without fused
/// multiply-add, so the bits are the same everywhere.
namespace holdfast::solver {
namespace {

using FourLanes = double __attribute__((vector_size(32)));

inline FourLanes load_four(const double* from) {
  FourLanes value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

inline void store_four(double* to, const FourLanes& value) {
  std::memcpy(to, &value, sizeof value);
}

inline FourLanes all_four(double value) { return FourLanes{value, value, value, value}; }

/// y -= A x, lane by lane.
inline void subtract(LaneBlock& y, const base::Mat6<double>& a, const LaneBlock& x) {
  for (std::size_t half = 0; half < kLaneCount; half += 4) {
    FourLanes sum[6];
    for (std::size_t i = 0; i < 6; ++i) {
      sum[i] = load_four(y.values[i] + half);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const FourLanes factor = load_four(x.values[k] + half);
      for (std::size_t i = 0; i < 6; ++i) {
        sum[i] -= all_four(a.values[6 * k + i]) * factor;
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      store_four(y.values[i] + half, sum[i]);
    }
  }
}

/// y = A y, lane by lane.
inline void multiply_by(const base::Mat6<double>& a, LaneBlock& y) {
  for (std::size_t half = 0; half < kLaneCount; half += 4) {
    FourLanes sum[6];
    for (FourLanes& part : sum) {
      part = all_four(0);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      const FourLanes factor = load_four(y.values[k] + half);
      for (std::size_t i = 0; i < 6; ++i) {
        sum[i] += all_four(a.values[6 * k + i]) * factor;
      }
    }
    for (std::size_t i = 0; i < 6; ++i) {
      store_four(y.values[i] + half, sum[i]);
    }
  }
}

inline bool is_zero(const LaneBlock& block) {
  for (const auto& row : block.values) {
    for (const double value : row) {
      if (value != 0) {
        return false;
      }
    }
  }
  return true;
}

void substitute_lanes(const FactorView& factors, LaneBlock* y) {
  const std::size_t n = factors.place_count;
  for (std::size_t k = 0; k < n; ++k) {
    if (is_zero(y[k])) {
      continue;  // Loads on a few nodes reach only the ancestors of these.
    }
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      subtract(y[factors.rows[slot]], factors.lower[slot], y[k]);
    }
  }
  for (std::size_t k = n; k-- > 0;) {
    for (std::size_t slot = factors.column_start[k]; slot < factors.column_start[k + 1]; ++slot) {
      subtract(y[k], factors.upper[slot], y[factors.rows[slot]]);
    }
    multiply_by(factors.inverse[k], y[k]);
  }
}

}  // namespace
}  // namespace holdfast::solver
