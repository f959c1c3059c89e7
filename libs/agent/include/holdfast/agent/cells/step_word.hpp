// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

/// A step of a reconfiguration as modules are told of it, word by word (docs/distributed.md).
namespace holdfast::agent {

/// Words that a plan may have, in a program that knows any; one has a place for names' sake.
inline constexpr std::uint8_t kWordCountMax = kKeepsAnswers ? 16 : 1;

/// Groups that move at once.
inline constexpr std::uint8_t kGroupCount = 4;

/// Equilibria that one shift may have.
inline constexpr int kSceneMax = 200;

/// Between the cells of a way and half way between two of them: of a turn; a slide has three.
inline constexpr int kWaypointMax = 5;

/// Stands in place of a direction: there is none.
inline constexpr std::uint8_t kNoDirection = 15;

/// One word of the plan of a step.
struct StepWord {
  enum class Kind : std::uint8_t {
    /// The connection of `cell` at `face` is off in the stages of `mask` (bit 0: release).
    kOff,
    /// The module of `cell` is taken off. Until then it keeps the link at `face` alone.
    kDetach,
    /// The module of `cell` goes with its `group` a cell in direction `first`, and if it turns
    /// a corner one more in direction `second`. On the way it keeps the link at `face` alone.
    kMove,
    /// The module of `cell` carries `group` at the waypoints of `mask` (bit 0: the start).
    kCarry,
    /// A module is attached at `cell`.
    kAttach,
  };

  Kind kind = Kind::kOff;
  std::uint8_t group = 0;
  std::uint8_t face = kNoDirection;
  std::uint8_t first = kNoDirection;
  std::uint8_t second = kNoDirection;
  std::uint8_t mask = 0;
  base::Cell cell = {};

  friend constexpr bool operator==(const StepWord&, const StepWord&) = default;
};

/// All of a word but its cell.
constexpr std::uint32_t bits_of(const StepWord& word) {
  return static_cast<std::uint32_t>(word.kind) | std::uint32_t{word.group} << 3U |
         std::uint32_t{word.face} << 6U | std::uint32_t{word.first} << 10U |
         std::uint32_t{word.second} << 14U | std::uint32_t{word.mask} << 18U;
}

constexpr StepWord word_of(std::uint32_t bits, const base::Cell& cell) {
  const auto part = [bits](unsigned at, unsigned most) {
    return static_cast<std::uint8_t>(bits >> at & most);
  };
  return {.kind = static_cast<StepWord::Kind>(part(0, 7)),
          .group = part(3, 7),
          .face = part(6, 15),
          .first = part(10, 15),
          .second = part(14, 15),
          .mask = part(18, 31),
          .cell = cell};
}

/// Are these the bits of a word to modules with so many faces? What a kind has no use for is as in
/// a word that was just made.
constexpr bool is_word(std::uint32_t bits, int face_count = kFaceCountMax) {
  const StepWord word = word_of(bits, {});
  const auto is_direction = [face_count](std::uint8_t value) { return value < face_count; };
  const bool is_plain = word.first == kNoDirection && word.second == kNoDirection;
  const bool is_ungrouped = word.group == 0;
  if (bits != bits_of(word)) {
    return false;
  }
  switch (word.kind) {
    case StepWord::Kind::kOff:
      return is_plain && is_ungrouped && is_direction(word.face) && word.mask != 0 && word.mask < 8;
    case StepWord::Kind::kDetach:
      return is_plain && is_ungrouped && is_direction(word.face) && word.mask == 0;
    case StepWord::Kind::kMove:
      return word.group < kGroupCount && is_direction(word.face) && is_direction(word.first) &&
             (is_direction(word.second) || word.second == kNoDirection) && word.mask == 0;
    case StepWord::Kind::kCarry:
      return is_plain && word.group < kGroupCount && word.face == kNoDirection && word.mask != 0;
    case StepWord::Kind::kAttach:
      return is_plain && is_ungrouped && word.face == kNoDirection && word.mask == 0;
  }
  return false;
}

/// Where a moved module goes to.
constexpr base::Cell target_of(const base::Lattice& lattice, const StepWord& move) {
  const base::Cell next =
      base::neighbour(lattice, move.cell, static_cast<base::Direction>(move.first));
  return move.second == kNoDirection
             ? next
             : base::neighbour(lattice, next, static_cast<base::Direction>(move.second));
}

/// Waypoints of a move: start, middle, end of each of its cells.
constexpr int waypoint_count(const StepWord& move) {
  return move.second == kNoDirection ? 3 : kWaypointMax;
}

/// Twice the way that a moved module has gone at a waypoint, in axial coordinates; behind its last
/// one it waits.
constexpr base::Cell doubled_way(const base::Lattice& lattice, const StepWord& move, int waypoint) {
  base::Cell way;
  for (int half = 0; half < waypoint && half < waypoint_count(move) - 1; ++half) {
    const base::Cell& step = lattice.steps[half < 2 ? move.first : move.second];
    way = {way.x + step.x, way.y + step.y, way.z + step.z};
  }
  return way;
}

/// A stage of a step ([Piranda 2021] Sec. II-B).
enum class Stage : std::uint8_t {
  kNone,
  kRelease,  ///< What lets go is off; all modules are there.
  kShift,    ///< What leaves is gone, and hangs on its carriers if it comes again.
  kConnect,  ///< All is where it is to be.
};

inline constexpr int kStageCount = 3;

/// Stages::words() of a robot that was told nothing.
inline constexpr std::uint8_t kNoWord = 0xff;

}  // namespace holdfast::agent
