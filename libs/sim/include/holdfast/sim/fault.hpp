// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "holdfast/agent/wire/link.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

/// Describes what goes wrong, or is changed by hand, while a robot computes; as data.
namespace holdfast::sim {

/// Something that happens to one module at a time. Faults of the same time happen in the order of
/// their list, before anything else at that time.
struct Fault {
  enum class Kind : std::uint8_t {
    kKill,    ///< The module falls silent for ever. It is still there; nobody is told.
    kCut,     ///< The link at `face` drops everything, both ways. Nobody is told.
    kDetach,  ///< The module is taken off; its neighbours sense it.
    kAttach,  ///< The module is put on, with a new agent. A module whose first change is this one
              ///< is not there before.
    kReset,   ///< The module starts again, with a new agent, also one that was silent. Nobody is
              ///< told.
    kMend,    ///< The link at `face` that was cut carries again. Nobody is told.
    kUnplug,  ///< The connection at `face` is opened; both sides sense it.
    kPlug,    ///< It is closed again; both sides sense it.
  };

  Kind kind = Kind::kKill;
  agent::Time at = 0;
  std::int32_t module = 0;                         ///< Index in the robot; an existing one.
  base::Direction face = base::Direction::kPlusX;  ///< Of what concerns a link.
};

/// Whether a fault happens to a link, not to a module.
constexpr bool is_of_link(Fault::Kind kind) {
  return kind == Fault::Kind::kCut || kind == Fault::Kind::kMend || kind == Fault::Kind::kUnplug ||
         kind == Fault::Kind::kPlug;
}

/// A module that was put on turned, or with its cables crossed: it senses by another face than the
/// one that looks at a neighbour, until it is taken off.
struct Misplaced {
  std::int32_t module = 0;
  /// The face that the module takes each direction in the robot for; each face once.
  std::array<base::Direction, base::Lattice::kDirectionCountMax> faces = {};
};

/// A module that was told its cell, right or wrong.
struct ToldCell {
  std::int32_t module = 0;
  base::Cell cell;
};

/// A module is told that another one is planned, or not any more. One that is silent or not there
/// hears nothing.
struct Announcement {
  agent::Time at = 0;
  std::int32_t module = 0;  ///< The one that is told.
  base::Cell cell;          ///< Of the planned one; with a withdrawal agent::kEveryCell is all.
  bool is_withdrawal = false;
};

/// Returns "kill", "cut", "detach", "attach", "reset", "mend", "unplug" or "plug".
std::string_view name(Fault::Kind kind);

}  // namespace holdfast::sim
