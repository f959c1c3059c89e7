// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/base/cell.hpp"

/// A step of a reconfiguration as modules are told of it, word by word (docs/distributed.md).
namespace holdfast::agent {

/// Can the program judge the stages of a step? It is left out of programs for modules with little
/// flash, with what renews verdicts.
#ifdef HOLDFAST_AGENT_STARTS_AFRESH
inline constexpr bool kJudgesStages = false;
#else
inline constexpr bool kJudgesStages = true;
#endif

/// Words that a plan may have, in a program that knows any; one has a place for names' sake.
inline constexpr std::uint8_t kWordCountMax = kJudgesStages ? 16 : 1;

/// Groups that move at once.
inline constexpr std::uint8_t kGroupCount = 4;

/// Equilibria that one shift may have.
inline constexpr int kSceneMax = 200;

/// Between the cells of a way and half way between two of them: of a turn; a slide has three.
inline constexpr int kWaypointMax = 5;

/// In place of a direction: none.
inline constexpr std::uint8_t kNoDirection = 7;

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
         std::uint32_t{word.face} << 6U | std::uint32_t{word.first} << 9U |
         std::uint32_t{word.second} << 12U | std::uint32_t{word.mask} << 15U;
}

constexpr StepWord word_of(std::uint32_t bits, const base::Cell& cell) {
  const auto three = [bits](unsigned at) { return static_cast<std::uint8_t>(bits >> at & 7U); };
  return {.kind = static_cast<StepWord::Kind>(bits & 7U),
          .group = three(3),
          .face = three(6),
          .first = three(9),
          .second = three(12),
          .mask = static_cast<std::uint8_t>(bits >> 15U & 31U),
          .cell = cell};
}

/// Are these the bits of a word? What a kind has no use for is as in a word that was just made.
constexpr bool is_word(std::uint32_t bits) {
  const StepWord word = word_of(bits, {});
  const auto is_direction = [](std::uint8_t value) { return value < base::kDirectionCount; };
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
constexpr base::Cell target_of(const StepWord& move) {
  const base::Cell next = base::neighbour(move.cell, static_cast<base::Direction>(move.first));
  return move.second == kNoDirection
             ? next
             : base::neighbour(next, static_cast<base::Direction>(move.second));
}

/// Waypoints of a move: start, middle, end of each of its cells.
constexpr int waypoint_count(const StepWord& move) {
  return move.second == kNoDirection ? 3 : kWaypointMax;
}

/// Twice the way that a moved module has gone at a waypoint; behind its last one it waits.
constexpr base::Cell doubled_way(const StepWord& move, int waypoint) {
  base::Cell way;
  for (int half = 0; half < waypoint && half < waypoint_count(move) - 1; ++half) {
    way = base::neighbour(way, static_cast<base::Direction>(half < 2 ? move.first : move.second));
  }
  return way;
}

}  // namespace holdfast::agent
