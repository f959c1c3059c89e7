// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/algebra/branch.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/wire/link.hpp"
#include "holdfast/agent/wire/round.hpp"
#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/lattice.hpp"

namespace holdfast::agent {

/// What a module that is no cube is lent: which lattice it is of, and what it keeps for the faces
/// that cubes do not have, each part under the name that it has for the others.
struct MoreFaces {
  const base::Lattice* lattice = nullptr;  ///< Not owned; not null.
  ByFace<Link> links{};
  ByFace<Time> deadline{};
  std::array<ByFace<base::Vec6<float>>, 2> vectors{};
  ByFace<std::array<std::uint8_t, wire::kMessageBytesMax>> messages{};
  ByFace<Round> heard{};
  /// Faces by child, for all faces.
  std::array<std::array<Faces, kPlannedMax>, kFaceCountMax> below{};
  ByFace<MiddleLoad> middle{};
  ByFace<std::array<Cut, kLoopsMax>> child_cuts{};
  ByFace<std::array<std::uint8_t, kLoopsMax>> slot_of{};
  ByFace<std::uint8_t> child_cut_count{};
  ByFace<std::uint8_t> columns_here{};
};

/// The element of a face: from `own` or, of a face that cubes do not have, from what is lent.
template <class T>
constexpr T& at_face(ByFace<T>& own, MoreFaces* more, ByFace<T> MoreFaces::*lent,
                     base::Direction face) {
  const auto i = static_cast<std::size_t>(face);
  return !kIsGeneral || i < own.size() ? own[i] : (more->*lent)[i - own.size()];
}

template <class T>
constexpr const T& at_face(const ByFace<T>& own, const MoreFaces* more, ByFace<T> MoreFaces::*lent,
                           base::Direction face) {
  const auto i = static_cast<std::size_t>(face);
  return !kIsGeneral || i < own.size() ? own[i] : (more->*lent)[i - own.size()];
}

/// The cell next to `cell` at a face, in the lattice of `more`; without, in that of cubes.
constexpr base::Cell neighbour(const MoreFaces* more, const base::Cell& cell,
                               base::Direction face) {
  return !kIsGeneral || more == nullptr ? base::neighbour(cell, face)
                                        : base::neighbour(*more->lattice, cell, face);
}

/// How many faces a module has.
constexpr int face_count(const MoreFaces* more) {
  return !kIsGeneral || more == nullptr ? kOwnFaceCount : more->lattice->direction_count;
}

/// The directions of all faces of a module.
constexpr base::DirectionRange directions(const MoreFaces* more) {
  return base::DirectionRange(face_count(more));
}

/// All faces of a module.
constexpr Faces all_faces(const MoreFaces* more) { return Faces::all(face_count(more)); }

}  // namespace holdfast::agent
