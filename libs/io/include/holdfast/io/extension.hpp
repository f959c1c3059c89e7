// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/io/element.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/model/step.hpp"
#include "holdfast/verdict/scatter.hpp"

/// Stores what a structure can say from version 2 of the JSON format on: other lattices than the
/// cubic one, other environments than a floor, other loads than weight, several kinds of modules,
/// plans of steps.
namespace holdfast::io {

/// The reach of one value of a connector parameter.
enum class Spread : std::uint8_t {
  kAll,      ///< One value for all directions.
  kClasses,  ///< Two: for vertical, then for lateral connections.
  kPairs,    ///< One for each pair of opposite directions of the lattice, in its order.
};

/// A parameter of connections by its key in holdfast JSON. A value is as in model::ConnectorLaw,
/// unlimited where the file says null; none where the file says nothing, as if the key were absent.
struct ConnectorParameter {
  std::string key;  ///< Such as shear_strength_n.
  Spread spread = Spread::kAll;
  std::vector<std::optional<double>> values;

  friend bool operator==(const ConnectorParameter&, const ConnectorParameter&) = default;
};

/// The parameters of connections in a file, beyond Table I of [Piranda 2021].
struct Connectors {
  std::vector<ConnectorParameter> parameters;  ///< In the order of the file.
  std::optional<model::BendingLaw> bending;    ///< None: as in the paper, kSquare.

  friend bool operator==(const Connectors&, const Connectors&) = default;
};

/// What a file says of how strengths and masses scatter: standard deviation over mean, from
/// verdict::kCvMin to verdict::kCvMax, or to verdict::kMassCvMax. None where it says nothing.
struct Scatter {
  std::optional<double> strength_cv;
  std::optional<double> mass_cv;
  /// The law of all strengths of a file, or of one connection's; kinds have none of their own.
  std::optional<verdict::StrengthDistribution> distribution;

  friend bool operator==(const Scatter&, const Scatter&) = default;
};

/// A kind of modules, by what makes it differ from the material.
struct KindEntry {
  std::string name;
  std::optional<double> mass_kg;
  Connectors connectors;
  Scatter scatter = {};

  friend bool operator==(const KindEntry&, const KindEntry&) = default;
};

/// A connection that a file names, with what it says of it.
struct ConnectionEntry {
  model::CellPair between;
  Connectors connectors;  ///< What differs from the weaker of its two modules' connectors.
  Scatter scatter = {};   ///< How its strength scatters, without masses.

  friend bool operator==(const ConnectionEntry&, const ConnectionEntry&) = default;
};

/// The parameters that an existing or planned module has of its own. They are kept apart from the
/// modules, as most have none.
struct OwnParameters {
  std::size_t step = 0;    ///< 0: one of Document::modules; else one of Document::steps[step - 1].
  std::size_t module = 0;  ///< Index there.
  std::string kind;        ///< Name of one of Extension::kinds; may be empty.
  std::optional<double> mass_kg;

  friend bool operator==(const OwnParameters&, const OwnParameters&) = default;
};

/// No file or option divides strengths by more.
inline constexpr double kSafetyFactorMax = 1000;

/// The members of a document that only version 2 has; as it is by default, version 1 says it all.
struct Extension {
  std::string
      robot;  ///< One of model::robot_catalogue(), whose figures are the defaults, or empty.
  /// What every strength is divided by in robots that are made of the document, from 1 to
  /// kSafetyFactorMax.
  double safety_factor = 1;
  base::Lattice lattice = base::kCubic;  ///< One of kNamedLattices.
  /// The pitch along the global axes, where it is not the same along all; Material::pitch_mm is
  /// then the least of them.
  std::optional<std::array<double, 3>> pitch_mm = {};
  bool has_floor = true;                              ///< Else Document::support_z means nothing.
  std::optional<double> floor_friction;               ///< None: no slip.
  std::optional<std::array<double, 3>> gravity_m_s2;  ///< None: Material::gravity_m_s2, downwards.
  Connectors connectors;                              ///< Of all modules.
  Scatter scatter;                                    ///< Of all modules.
  std::optional<double> foot_mm;  ///< Width of the facets of modules that are no cubes.
  std::vector<KindEntry> kinds;
  std::vector<OwnParameters> own;     ///< By ascending step, then module.
  std::vector<model::CellPair> open;  ///< Neighbours whose faces touch without being joined.
  std::vector<ConnectionEntry> connections;
  bool joins_listed =
      false;  ///< Whether `connections` are all that there are of the file's modules.
  /// Rigid pieces, such as bricks, by their cells: connections inside never part. All cells of a
  /// body come in one step, and leave in one.
  std::vector<std::vector<base::Cell>> bodies;
  std::vector<model::Obstacle> obstacles;
  std::vector<std::optional<Color>> obstacle_colors;  ///< By obstacle; empty if none has one.
  Attributes obstacle_list;                           ///< Of VisibleSim's <obstacleList>.
  std::vector<model::Payload> payloads;
  std::vector<model::Step> plan;

  friend bool operator==(const Extension&, const Extension&) = default;
};

}  // namespace holdfast::io
