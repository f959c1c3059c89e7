// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "holdfast/base/faces.hpp"
#include "holdfast/base/lattice.hpp"

/// How many faces a module may have.
///
/// Cubes have six, modules of other lattices up to twelve. What a module keeps for each face is
/// there for six; what the others take is memory that is lent (more_faces.hpp), so that cubes are
/// as small as ever. Programs with HOLDFAST_AGENT_FLOOR_ONLY know cubes alone.
namespace holdfast::agent {

#ifdef HOLDFAST_AGENT_FLOOR_ONLY
inline constexpr bool kKnowsLattices = false;
using Faces = base::Faces;
using Directions = const std::array<base::Direction, base::kDirectionCount>&;
#else
inline constexpr bool kKnowsLattices = true;
using Faces = base::WideFaces;
using Directions = base::DirectionRange;
#endif

/// Is there anything but a floor? Left out of programs with HOLDFAST_AGENT_FLOOR_ONLY, which have
/// no flash for it.
#ifdef HOLDFAST_AGENT_FLOOR_ONLY
inline constexpr bool kHasSurroundings = false;
#else
inline constexpr bool kHasSurroundings = true;
#endif

/// The bits of a set of faces.
using FaceMask = decltype(Faces().mask());

/// Faces that every module has room for itself.
inline constexpr int kOwnFaceCount = base::kDirectionCount;

inline constexpr int kFaceCountMax =
    kKnowsLattices ? base::Lattice::kDirectionCountMax : kOwnFaceCount;

/// What is kept for each face: six here, the others in memory that is lent.
template <class T>
using ByFace = std::array<T, static_cast<std::size_t>(kOwnFaceCount)>;

}  // namespace holdfast::agent
