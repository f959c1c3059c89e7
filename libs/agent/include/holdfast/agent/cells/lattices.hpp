// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "holdfast/agent/features.hpp"
#include "holdfast/base/faces.hpp"
#include "holdfast/base/lattice.hpp"

/// How many faces a module may have.
///
/// Cubes have six, modules of other lattices up to twelve. What a module keeps for each face is
/// there for six; what the others take is memory that is lent (more_faces.hpp), so that cubes are
/// as small as ever.
namespace holdfast::agent {

using Faces = std::conditional_t<kIsGeneral, base::WideFaces, base::Faces>;

/// The bits of a set of faces.
using FaceMask = decltype(Faces().mask());

/// Faces that every module has room for itself.
inline constexpr int kOwnFaceCount = base::kDirectionCount;

inline constexpr int kFaceCountMax = kIsGeneral ? base::Lattice::kDirectionCountMax : kOwnFaceCount;

/// What is kept for each face: six here, the others in memory that is lent.
template <class T>
using ByFace = std::array<T, static_cast<std::size_t>(kOwnFaceCount)>;

}  // namespace holdfast::agent
