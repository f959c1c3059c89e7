// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Single-precision vectors and blocks of the preconditioner, laid out for 8-lane arithmetic: one
/// node is one register, of which two lanes stay zero.
namespace holdfast::solver {

struct alignas(32) Six {
  float v[8] = {};
};

/// A 6x6 block by columns.
struct alignas(32) Block {
  float column[6][8] = {};
};

struct alignas(32) BlockDouble {
  double column[6][8] = {};
};

/// K12 of a beam along an axis has ten nonzeros: a diagonal, and one number in four rows at a place
/// that depends on the axis only. So K12 u = direct * u + crossed * swap(u), lane by lane.
struct BeamRow {
  Six direct;
  Six crossed;
};

struct alignas(32) BeamRowDouble {
  double direct[8] = {};
  double crossed[8] = {};
};

/// Where a node sits in its cluster: u = [u_c + t_c x offset, t_c].
struct Seat {
  float offset[3] = {};  ///< mm, from the cluster's centre to the node.
  std::int32_t cluster = 0;
};

/// Direction -> node; the node one past the last stands for "none" and for the immobile ground.
using Others = std::array<std::int32_t, 6>;

/// Direction -> pitches that the beam there is long, 0 for none; then, in kContactByte, what the
/// ground does that is no such beam, 0 for nothing.
using Kind = std::array<std::uint8_t, 8>;
inline constexpr std::size_t kContactByte = 6;

}  // namespace holdfast::solver
