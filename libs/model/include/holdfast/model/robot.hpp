// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/loads.hpp"
#include "holdfast/model/material.hpp"

/// A whole robot with the step that is planned for it: modules, connections, supports.
namespace holdfast::model {

/// More modules than this are refused; indices and exact sums stay far from overflow.
inline constexpr std::size_t kModuleCountMax = 20'000'000;

/// How a module is held from outside the robot.
enum class Support : std::uint8_t {
  kNone,
  kGround,  ///< Rests on the support level through its bottom face, unilaterally.
  kFixed,   ///< Does not move at all.
};

struct Module {
  base::Cell cell;
  Support support = Support::kNone;
  bool is_planned = false;
};

/// A connection, that is a beam, between two modules in neighbouring cells; `b` is the neighbour of
/// `a` in a direction with an even index.
struct Connection {
  std::int32_t a = 0;  ///< Index of a module.
  std::int32_t b = 0;
  base::Direction direction = base::Direction::kPlusX;
};

/// A facet with which a module touches the environment: unilaterally, its centre half a pitch from
/// the module's node, in the frame that mechanics::frame_along() gives for its direction.
struct Facet {
  std::int32_t module = 0;  ///< Index.
  base::Direction direction = base::Direction::kMinusZ;
};

/// Two modules in neighbouring cells, in either order.
using CellPair = std::array<base::Cell, 2>;

/// What a robot is made from, in any order.
struct RobotSpec {
  std::vector<base::Cell> existing = {};
  std::vector<base::Cell> planned = {};  ///< Attached in the planned step, all at once.
  std::vector<base::Cell> fixed = {};    ///< Those of `existing` that are fixed.
  /// Pairs, existing or planned, that touch without being connected: no force passes. All other
  /// neighbours are connected.
  std::vector<CellPair> released = {};
  std::int32_t support_z = 0;  ///< Modules in this layer rest on the ground.
  Material material = {};
};

/// A robot that can be computed: connected, supported, no two modules in one cell. Immutable.
class Robot {
 public:
  static constexpr std::int32_t kNoNeighbour = -1;
  using Neighbours = std::array<std::int32_t, base::kDirectionCount>;

  /// Checks every rule; the error names the cell, what was found and what is allowed. 0 threads:
  /// as many as the machine has cores.
  static base::Result<Robot> create(const RobotSpec& spec, int thread_count = 0);

  /// Existing modules first, then the planned ones, each in the order of the spec.
  std::span<const Module> modules() const { return modules_; }

  /// The lattice in which the modules' cells and directions count.
  static constexpr const base::Lattice& lattice() { return base::kCubic; }

  /// The modules in the cells beside each module, connected to it or not: indices by direction,
  /// kNoNeighbour where there is none.
  std::span<const Neighbours> neighbours() const {
    return neighbours_.empty() ? connected_ : neighbours_;
  }

  /// The modules that each module is connected to: its neighbours() less the released ones.
  std::span<const Neighbours> connected() const { return connected_; }

  /// Every pair of modules that is connected once, planned modules included.
  std::span<const Connection> connections() const { return connections_; }

  /// How many pairs of neighbours are not connected.
  std::size_t released_count() const { return released_count_; }

  /// What touches the environment, by ascending module: the lower sides of all modules on the
  /// support level that are not fixed.
  std::span<const Facet> facets() const { return facets_; }

  const Material& material() const { return material_; }

  /// What acts on the modules from outside: their weight.
  const Loads& loads() const { return loads_; }

  std::int32_t support_z() const { return support_z_; }

  std::size_t planned_count() const { return planned_count_; }

  std::size_t ground_count() const { return facets_.size(); }

  std::size_t fixed_count() const { return fixed_count_; }

  /// Modules that can move: all that are not fixed.
  std::size_t free_count() const { return modules_.size() - fixed_count_; }

 private:
  explicit Robot(const Material& material) : material_(material), loads_(weight_loads(material)) {}

  /// Finds neighbours, all of them connected, and facets; counts fixed modules.
  void connect(const CellIndex& index, host::Team& team);

  /// Takes these connections away. Returns what is wrong with the first pair that is none.
  std::optional<std::string> release(std::span<const CellPair> pairs, const CellIndex& index);

  std::vector<Module> modules_;
  std::vector<Neighbours> neighbours_;  ///< Empty if all are connected.
  std::vector<Neighbours> connected_;
  std::vector<Connection> connections_;
  std::vector<Facet> facets_;
  Material material_;
  Loads loads_;
  std::int32_t support_z_ = 0;
  std::size_t planned_count_ = 0;
  std::size_t fixed_count_ = 0;
  std::size_t released_count_ = 0;
};

/// The two cells of a connection, given by its index; the first has the smaller coordinate.
std::array<base::Cell, 2> ends(const Robot& robot, std::size_t connection);

/// How messages and reports name a cell, "(2,1,2)", and a connection, "(2,1,2)-(3,1,2)".
std::string text(const base::Cell& cell);
std::string ends_text(const Robot& robot, std::size_t connection);

}  // namespace holdfast::model
