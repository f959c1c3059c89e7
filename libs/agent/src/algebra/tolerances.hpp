// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// When the conductor is content.
namespace holdfast::agent {

/// Load ratios are to be this good: absolute, and relative to the largest. Less than half of what
/// is promised (0.01 + 1 %), as the bound is not rigorous for statically indeterminate robots.
inline constexpr double kRatioTolerance = 4e-3;

/// Contact states are told at this accuracy while they still change.
inline constexpr double kStateTolerance = 2e-2;

/// Where supports are anywhere, facets that carry by shear alone do not press but for rounding, and
/// whether they do decides what carries: contact states are told at this accuracy.
inline constexpr double kUnevenTolerance = 1e-7;

/// Elimination ends at this share of it, of which two steps leave a residual of some 1e-11. Then
/// smaller pressures can be told from none, as the exact solver tells them down to 1e-9.
inline constexpr double kEliminatedShare = 0.1;

/// Iterations halt at so many times of it where that is not reached: displacements of a robot that
/// hangs on weak springs are so large that their last digits are forces.
inline constexpr double kHalting = 10;

/// A verdict needs the largest ratio this many times its error bound away from 1: in indeterminate
/// robots the bound is an estimate, of which 4 in 1,844 were too small, by 14 times at most.
inline constexpr double kDoubt = 20;

/// The best bound that is tried for: below, the arithmetic itself is in doubt.
inline constexpr double kErrorLeast = 2e-8;

/// What the load ratio of a candidate at a free face has to be away from 1, besides the error bound
/// of the robot's own: single precision of what a way of a thousand modules carries.
inline constexpr double kFaceTolerance = 1e-5;

/// How much smaller the error bound becomes in one linear problem of Newton's method, at most: a
/// tilting facet's stand-in tangent deserves no better.
inline constexpr double kReductionTilting = 1e-3;

inline constexpr std::uint32_t kContactIterationsMax = 100;

/// The weak springs of the unilateral law, as in the exact solver (verdict/assessment.cpp).
inline constexpr double kUnilateralGamma = 1e-9;

/// Where those are lost in single precision away from a level floor, as multigrid has it in the
/// exact solver.
inline constexpr double kStifferGamma = 1e-6;

/// How much weak springs may move load ratios, for their share of the contact's stiffness: an arm
/// of twenty modules with a lifted foot at its tip bears 2e-5 less by springs of 1e-9, one of
/// sixty, which lifts it by metres, 3e-4. (The exact solver takes them back.)
inline constexpr double kRatioPerGamma = 1e5;

/// Weak springs of a robot that seems to hang on them, as in the exact solver; it is never `safe`
/// by these.
inline constexpr double kTopplingGamma = 1e-4;

}  // namespace holdfast::agent
