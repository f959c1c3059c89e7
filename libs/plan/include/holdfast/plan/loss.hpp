// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/robot.hpp"

/// A single part of a robot that may be lost.
namespace holdfast::plan {

enum class LossKind : std::uint8_t {
  kConnection,  ///< Two modules touch without being connected.
  kModule,      ///< A module, or a whole body, is not there, nor what it carries.
  kFoot,        ///< A facet does not touch the environment, or a module is no longer fixed.
};

inline constexpr std::size_t kLossKindCount = 3;

/// "connection", "module", "foot".
std::string_view name(LossKind kind);

/// One part that is lost.
struct Loss {
  LossKind kind = LossKind::kConnection;
  std::array<base::Cell, 2> cells = {};  ///< Of a connection; else the first is the module's.
  /// The direction of a foot from the module; none if that was fixed.
  std::optional<base::Direction> direction = {};
  /// The number of the body that is lost as a whole, of which the first cell is one; else none.
  std::int32_t body = model::OwnConnector::kNoBody;

  friend bool operator==(const Loss&, const Loss&) = default;
};

}  // namespace holdfast::plan
