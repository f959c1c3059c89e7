// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

#include "holdfast/agent/link.hpp"
#include "holdfast/base/cell.hpp"

/// What goes wrong, or is changed by hand, while a robot computes; as data.
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
  };

  Kind kind = Kind::kKill;
  agent::Time at = 0;
  std::int32_t module = 0;                         ///< Index in the robot; an existing one.
  base::Direction face = base::Direction::kPlusX;  ///< kCut
};

/// A module is told that another one is planned, or not any more. One that is silent or not there
/// hears nothing.
struct Announcement {
  agent::Time at = 0;
  std::int32_t module = 0;  ///< The one that is told.
  base::Cell cell;          ///< Of the planned one; with a withdrawal agent::kEveryCell is all.
  bool is_withdrawal = false;
};

/// "kill", "cut", "detach", "attach".
std::string_view name(Fault::Kind kind);

}  // namespace holdfast::sim
