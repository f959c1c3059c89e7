// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/base/cell.hpp"

/// What a structure can say from version 2 of the JSON format on: other lattices than the cubic
/// one, other environments than a floor, other loads than weight, several kinds of modules, plans
/// of steps. It is read, kept and written; find_unsupported() in document.hpp says what of it
/// cannot be computed with yet.
namespace holdfast::io {

enum class LatticeName : std::uint8_t { kCubic, kFaceCentred, kHexagonal, kHexagonalPrism };

/// Names and numbers, in the order of the file.
using NamedNumbers = std::vector<std::pair<std::string, double>>;

/// A kind of modules that differs from the material in some parameters.
struct ModuleKind {
  std::string name;
  NamedNumbers parameters;  ///< Keys of the material, such as mass_kg.

  friend bool operator==(const ModuleKind&, const ModuleKind&) = default;
};

/// What an existing module has of its own. Kept apart from the modules, as most have nothing.
struct OwnParameters {
  std::size_t module = 0;  ///< Index in Document::modules.
  std::string kind;        ///< Name of one of Extension::kinds; may be empty.
  std::optional<double> mass_kg;

  friend bool operator==(const OwnParameters&, const OwnParameters&) = default;
};

/// How an obstacle holds a facet that touches it.
enum class Hold : std::uint8_t {
  kContact,  ///< Unilaterally, as a floor does.
  kBonded,   ///< As a module with connectors would that does not move.
};

/// Cells that the environment occupies: a box, or a list.
struct Obstacle {
  base::Cell from;                     ///< The box with these two corners, if `cells` is empty;
  base::Cell to;                       ///< no coordinate below that of `from`.
  std::vector<base::Cell> cells = {};  ///< Else these cells.
  Hold hold = Hold::kContact;
  std::optional<double> friction = {};  ///< None: no slip.

  friend bool operator==(const Obstacle&, const Obstacle&) = default;
};

/// A force and a torque at a module's node, besides its weight.
struct Payload {
  base::Cell cell;
  std::array<double, 3> force_n{};     ///< Global frame.
  std::array<double, 3> torque_nmm{};  ///< Global frame.

  friend bool operator==(const Payload&, const Payload&) = default;
};

/// A module that goes from one cell to another.
struct Move {
  base::Cell from;
  base::Cell to;
  std::optional<base::Cell> carrier;  ///< The module that carries it on its way.

  friend bool operator==(const Move&, const Move&) = default;
};

/// Two cells whose modules are, or are no more, connected.
using CellPair = std::array<base::Cell, 2>;

/// A step of a plan: all of it happens together.
struct PlanStep {
  std::vector<base::Cell> attach;
  std::vector<base::Cell> detach;
  std::vector<Move> moves;
  std::vector<CellPair> release;
  std::vector<CellPair> connect;

  friend bool operator==(const PlanStep&, const PlanStep&) = default;
};

/// The members of a document that only version 2 has; as it is by default, version 1 says it all.
struct Extension {
  LatticeName lattice = LatticeName::kCubic;
  bool has_floor = true;                              ///< Else Document::support_z means nothing.
  std::optional<double> floor_friction;               ///< None: no slip.
  std::optional<std::array<double, 3>> gravity_m_s2;  ///< None: Material::gravity_m_s2, downwards.
  NamedNumbers connectors;                            ///< Further parameters of the material.
  std::vector<ModuleKind> kinds;
  std::vector<OwnParameters> own;  ///< By ascending module.
  std::vector<Obstacle> obstacles;
  std::vector<Payload> payloads;
  std::vector<PlanStep> plan;

  friend bool operator==(const Extension&, const Extension&) = default;
};

}  // namespace holdfast::io
