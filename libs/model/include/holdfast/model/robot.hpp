// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/connections.hpp"
#include "holdfast/model/connector_law.hpp"
#include "holdfast/model/environment.hpp"
#include "holdfast/model/loads.hpp"
#include "holdfast/model/material.hpp"
#include "holdfast/model/robot_part.hpp"

/// A whole robot with the step that is planned for it: modules, connections, supports.
namespace holdfast::model {

/// More modules than this are refused; indices and exact sums stay far from overflow.
inline constexpr std::size_t kModuleCountMax = 20'000'000;

/// The way in which a module is held from outside the robot.
enum class Support : std::uint8_t {
  kNone,
  kGround,  ///< Touches the floor or an obstacle with at least one facet.
  kFixed,   ///< Does not move at all, and touches nothing.
};

struct Module {
  base::Cell cell;
  Support support = Support::kNone;
  bool is_planned = false;
  std::uint16_t kind = 0;  ///< Index in RobotSpec::kinds.
};

/// A facet with which a module touches the environment, its centre half a pitch from the module's
/// node, in the frame that mechanics::frame_along() gives for its direction: one of
/// base::facet_directions().
struct Facet {
  std::int32_t module = 0;  ///< Index.
  base::Direction direction = base::Direction::kMinusZ;
  Touch touch = {};

  bool is_bonded() const { return touch.hold == Hold::kBonded; }
};

/// Two modules in neighbouring cells, in either order.
using CellPair = std::array<base::Cell, 2>;

/// The direction in which cell b lies from cell a; none if they are not neighbours.
std::optional<base::Direction> direction_between(const base::Lattice& lattice, const base::Cell& a,
                                                 const base::Cell& b);

/// Modules that are made alike: mass, and what holds them, by direction of their lattice.
struct ModuleKind {
  std::string name = {};
  double mass_kg = 0;
  std::vector<ConnectorLaw> connectors = {};  ///< As many as the lattice has directions.
};

/// The modules that Material describes, with the connectors of Eq. (17).
ModuleKind default_kind(const Material& material, const base::Lattice& lattice);

/// The mass of a single module that differs from that of its kind.
struct OwnMass {
  base::Cell cell;  ///< Existing or planned.
  double mass_kg = 0;

  friend bool operator==(const OwnMass&, const OwnMass&) = default;
};

struct OwnKind {
  base::Cell cell;         ///< Existing or planned.
  std::uint16_t kind = 0;  ///< Index in RobotSpec::kinds.

  friend bool operator==(const OwnKind&, const OwnKind&) = default;
};

/// The law of a single connection, in place of the weaker of its two modules' connectors.
struct OwnConnector {
  CellPair between;  ///< Modules in neighbouring cells, existing or planned, in either order.
  ConnectorLaw law;
  /// What the caller calls it by; along steps it stays with the connection.
  std::int32_t tag = kNoTag;
  /// The number of the body that both modules are in, if they are: a rigid piece of several
  /// modules, such as a brick. The law limits nothing then, and nothing takes the connection away.
  std::int32_t body = kNoBody;

  static constexpr std::int32_t kNoTag = -1;
  static constexpr std::int32_t kNoBody = -1;

  friend bool operator==(const OwnConnector&, const OwnConnector&) = default;
};

/// A force and a torque at a module's node besides its weight, global frame.
struct Payload {
  base::Cell cell;
  std::array<double, 3> force_n{};
  std::array<double, 3> torque_nmm{};

  friend bool operator==(const Payload&, const Payload&) = default;
};

/// A mass that a module carries, rigidly joined to it: a module on its way from one cell to
/// another.
struct CarriedMass {
  base::Cell carrier;  ///< Existing or planned.
  double mass_kg = 0;
  std::array<double, 3> offset_mm{};  ///< Of its centre from the carrier's node, global frame.

  friend bool operator==(const CarriedMass&, const CarriedMass&) = default;
};

/// A side of a module that would touch the environment, but does not: a foot that is lost.
struct LostFacet {
  base::Cell cell;
  base::Direction direction = base::Direction::kMinusZ;

  friend bool operator==(const LostFacet&, const LostFacet&) = default;
};

/// The specification that a robot is made from, in any order.
struct RobotSpec {
  std::vector<base::Cell> existing = {};
  std::vector<base::Cell> planned = {};  ///< Attached in the planned step, all at once.
  std::vector<base::Cell> fixed = {};    ///< Those of `existing` that are fixed.
  /// Pairs, existing or planned, that touch without being connected: no force passes. All other
  /// neighbours are connected.
  std::vector<CellPair> released = {};
  /// Modules in this layer rest on a floor with their lower sides; none: there is no floor.
  std::optional<std::int32_t> support_z = 0;
  Material material = {};
  /// Whether somebody says that the elastic modulus is what it is; one that is not the default is
  /// stated anyway.
  bool is_modulus_stated = false;

  base::Lattice lattice = base::kCubic;
  Touch floor = {};
  std::vector<Obstacle> obstacles = {};
  std::optional<std::array<double, 3>> gravity_m_s2 = {};  ///< None: Material's, straight down.
  /// The width of the facets that touch the environment; if none is given, the face of a cube, else
  /// half a pitch. 0 is a point.
  std::optional<double> foot_mm = {};
  std::vector<ModuleKind> kinds = {};    ///< Empty: default_kind() alone, which all modules are of.
  std::vector<OwnKind> own_kinds = {};   ///< All others are of kind 0.
  std::vector<OwnMass> own_masses = {};  ///< All others weigh what their kind does.
  std::vector<OwnConnector> own_connectors = {};  ///< No pair twice. Void where it is released.
  std::vector<Payload> payloads = {};
  std::vector<CarriedMass> carried = {};
  std::vector<LostFacet> lost_facets = {};  ///< Robot::facets() has all but these.
  /// Whether modules may be in several pieces, each of which something holds: Robot::pieces().
  bool may_be_in_pieces = false;
};

/// Takes away what a spec says of modules that it does not have.
void forget_absent(RobotSpec& spec);

/// Takes away what a spec says of pairs of which it does not have both modules.
void forget_absent_pairs(RobotSpec& spec);

struct RobotPiece;

/// A robot that can be computed: connected, supported, no two modules in one cell. Immutable.
class Robot {
 public:
  static constexpr std::int32_t kNoNeighbour = -1;

  /// Checks every rule; the error names the cell, what was found and what is allowed. 0 threads:
  /// as many as the machine has cores.
  static base::Result<Robot> create(const RobotSpec& spec, int thread_count = 0);

  /// Makes the part of a robot that one of several processes has: the first own_count of the
  /// existing modules are its own, the others copies of their neighbours, and none is planned.
  /// Facets are those of its own modules alone, and so are connections() by their first module, so
  /// that all processes together have each once. That the whole robot is connected and held is not
  /// checked here.
  static base::Result<Robot> create_part(const RobotSpec& spec, RobotPart part,
                                         int thread_count = 1);

  /// The part of a robot that this is; all of it, unless create_part() made it.
  const RobotPart& part() const { return part_; }

  /// The ranks that have parts of the robot. All of them call the same functions in the same order.
  host::Ranks& ranks() const { return part_.ranks; }

  /// The number of modules that are no copies of other ranks'.
  std::size_t own_count() const { return part_.own_count; }

  /// The pieces of a robot whose modules are not all connected, each a robot by itself, the largest
  /// first; empty if they are, and always unless the spec allows pieces. Who does not ask must not
  /// be given such a robot: equations and statics of the whole are not those of one body.
  std::span<const RobotPiece> pieces() const;

  /// The existing modules, then the planned ones, each in the order of the spec.
  std::span<const Module> modules() const { return modules_; }

  /// The lattice in which the modules' cells and directions count.
  const base::Lattice& lattice() const { return lattice_; }

  /// The modules in the cells beside each module, connected to it or not: indices by direction,
  /// kNoNeighbour where there is none.
  const NeighbourTable& neighbours() const {
    return neighbours_.empty() ? connected_ : neighbours_;
  }

  /// The modules that each module is connected to: its neighbours() less the released ones.
  const NeighbourTable& connected() const { return connected_; }

  /// Every pair of modules that is connected once, planned modules included.
  Connections connections() const { return {connections_, connected_}; }

  /// The number of pairs of neighbours that are not connected.
  std::size_t released_count() const { return released_count_; }

  /// The facets that touch the environment, by ascending module, then by ascending direction: the
  /// lower sides of all modules on the support level, and all sides that an obstacle lies beside,
  /// of modules that are not fixed. A side has one facet: an obstacle's, where there is a floor
  /// too.
  std::span<const Facet> facets() const { return facets_; }

  const Material& material() const { return material_; }

  /// The distance of a node from its neighbour in a direction, and twice that from its facet there,
  /// in mm: the pitch, unless the lattice is stretched.
  double step_mm(base::Direction direction) const {
    return material_.pitch_mm * base::step_length(lattice_, direction);
  }

  /// Whether the elastic modulus is known, and not Table I's, which is arbitrary.
  bool is_modulus_stated() const { return is_modulus_stated_; }

  /// Half the width of every facet, mm; 0 is a point.
  double foot_half_width_mm() const { return foot_half_width_mm_; }

  /// The loads that act on the modules from outside: their weight, what they carry, and payloads.
  const Loads& loads() const { return loads_; }

  /// The gravity in m/s^2, global frame.
  const std::array<double, 3>& gravity() const { return gravity_; }

  /// The mass of a module in kg.
  double mass(std::size_t module) const { return masses_.empty() ? mass_ : masses_[module]; }

  /// Whether all modules weigh the same.
  bool is_uniform() const { return masses_.empty(); }

  bool has_payloads() const { return has_payloads_; }

  /// Masses besides the modules' own.
  std::span<const CarriedMass> carried() const { return carried_; }

  std::span<const ModuleKind> kinds() const { return kinds_; }

  /// The law of a connection: its own, or the weaker of its two modules' connectors.
  const ConnectorLaw& connector(const Connection& connection) const {
    if (!own_connectors_.empty()) {
      if (const ConnectorLaw* const own = find_own_connector(connection)) {
        return *own;
      }
    }
    return connector(modules_[static_cast<std::size_t>(connection.a)].kind,
                     modules_[static_cast<std::size_t>(connection.b)].kind, connection.direction);
  }

  /// The law between modules of two kinds, given by index, the second beside the first in
  /// `direction`.
  const ConnectorLaw& connector(std::size_t kind_a, std::size_t kind_b,
                                base::Direction direction) const {
    return connectors_[(kind_a * kinds_.size() + kind_b) * lattice_count() +
                       static_cast<std::size_t>(base::index(direction))];
  }

  /// The tag of a connection that has a law of its own; else OwnConnector::kNoTag.
  std::int32_t connector_tag(const Connection& connection) const;

  /// The number of the body that a connection is inside of; else OwnConnector::kNoBody.
  std::int32_t body(const Connection& connection) const;

  /// Whether there are bodies of several modules.
  bool has_bodies() const;

  /// The number of the body that each module is in, or OwnConnector::kNoBody; by module.
  std::vector<std::int32_t> bodies() const;

  /// The indices of the modules of each body, ascending, by the body's number.
  std::map<std::int32_t, std::vector<std::int32_t>> modules_by_body() const;

  /// The laws of all connections that there can be.
  std::span<const ConnectorLaw> connectors() const { return connectors_; }

  /// Whether connections have laws of their own.
  bool has_own_connectors() const { return !own_connectors_.empty(); }

  /// Whether Eq. (17) of the material is the law of every connection.
  bool has_default_connectors() const { return has_default_connectors_; }

  bool has_floor() const { return has_floor_; }

  /// The level of the support; void without a floor.
  std::int32_t support_z() const { return support_z_; }

  /// The floor's level, below which no module may be, as one rests on the floor; none where none
  /// does: fixed modules may be in its layer and beside its end.
  std::optional<std::int32_t> barring_level() const;

  std::size_t planned_count() const { return planned_count_; }

  std::size_t ground_count() const { return facets_.size(); }

  std::size_t fixed_count() const { return fixed_count_; }

  /// Modules that can move: all that are not fixed.
  std::size_t free_count() const { return modules_.size() - fixed_count_; }

  /// Whether there are bonded facets.
  bool has_bonded_facets() const { return has_bonded_facets_; }

 private:
  explicit Robot(const RobotSpec& spec);

  std::size_t lattice_count() const { return static_cast<std::size_t>(lattice_.direction_count); }

  /// Whether a spec says all of a robot, so that it must be connected.
  enum class Extent : std::uint8_t { kWhole, kPart };

  /// Takes everything from the spec. Returns the first fault.
  std::optional<std::string> take(const RobotSpec& spec, int thread_count, Extent extent);

  void add_modules(const RobotSpec& spec);

  /// Makes a robot of each of these modules, by index. Returns the first fault.
  std::optional<std::string> take_pieces(const RobotSpec& spec, int thread_count);
  std::optional<std::string> fix(std::span<const base::Cell> cells, const CellIndex& index);

  /// Finds neighbours, all of them connected.
  void connect(const CellIndex& index, host::Team& team);

  /// Takes these connections away. Returns what is wrong with the first pair that is none.
  std::optional<std::string> release(std::span<const CellPair> pairs, const CellIndex& index,
                                     host::Team& team);

  /// Finds facets. Returns what is wrong with the first obstacle that is where a module is.
  std::optional<std::string> touch(const RobotSpec& spec);

  std::optional<std::string> take_kinds(const RobotSpec& spec, const CellIndex& index);
  std::optional<std::string> take_own_connectors(const RobotSpec& spec, const CellIndex& index);
  const ConnectorLaw* find_own_connector(const Connection& connection) const;
  const OwnConnector* find_own_name(const Connection& connection) const;
  std::optional<std::string> take_loads(const RobotSpec& spec, const CellIndex& index);

  std::vector<Module> modules_;
  base::Lattice lattice_;
  NeighbourTable neighbours_;  ///< Empty if all are connected.
  NeighbourTable connected_;
  ConnectionIndex connections_;
  std::vector<Facet> facets_;
  Material material_;
  bool is_modulus_stated_ = false;
  double foot_half_width_mm_ = 0;
  std::array<double, 3> gravity_{};
  Loads loads_;
  double mass_ = 0;             ///< If all weigh the same.
  std::vector<double> masses_;  ///< By module; empty if all weigh the same.
  bool has_payloads_ = false;
  std::vector<CarriedMass> carried_;
  std::vector<ModuleKind> kinds_;
  /// The laws by kind of a, kind of b, direction; then those that connections have of their own.
  std::vector<ConnectorLaw> connectors_;
  /// The places in the table of neighbours of connections that have a law of their own, ascending,
  /// with the index of the law.
  std::vector<std::pair<std::size_t, std::size_t>> own_connectors_;
  std::vector<OwnConnector> own_names_;  ///< What these laws are of, in their order.
  bool has_default_connectors_ = true;
  bool has_floor_ = false;
  std::int32_t support_z_ = 0;
  std::size_t planned_count_ = 0;
  std::size_t fixed_count_ = 0;
  std::size_t released_count_ = 0;
  bool has_bonded_facets_ = false;
  RobotPart part_;
  /// All copies of a robot, which is immutable, have the same.
  std::shared_ptr<const std::vector<RobotPiece>> pieces_;
};

/// A piece of a robot that is in several.
struct RobotPiece {
  Robot robot;
  std::vector<std::int32_t> modules;  ///< The index of each of its modules in the whole.
};

/// The number of modules of the whole robot, of all ranks.
inline std::size_t whole_module_count(const Robot& robot) {
  return host::total(robot.ranks(), robot.own_count());
}

/// Knows the cells in which the floor lets no further module be: Robot::create() refuses one below
/// a floor that another rests on, and one on a floor that another is below.
class FloorRule {
 public:
  explicit FloorRule(const Robot& robot);

  bool bars(const base::Cell& cell) const {
    return (level_ && cell.z < *level_) || (level_of_none_ && cell.z == *level_of_none_);
  }

 private:
  std::optional<std::int32_t> level_;          ///< None may be below.
  std::optional<std::int32_t> level_of_none_;  ///< None may be there.
};

/// The most by which an error e of the displacements can change any load ratio, as a share of its
/// energy norm (e . K e)^(1/2); in (N mm)^(-1/2). The forces in the middle of a beam do not couple,
/// so by Cauchy and Schwarz the square of the share is the sum of stiffness times factor^2 over the
/// forces that a ratio is made of.
double load_ratio_per_energy_norm(const Robot& robot);

/// Says what of a robot goes beyond [Piranda 2021], that is cubes of one kind on a floor without
/// slip under their own weight, for parts of the program that know nothing else; none if nothing
/// does.
std::optional<std::string> find_beyond_paper(const Robot& robot);

/// The two cells of a connection, given by its index; the first has the smaller coordinate.
std::array<base::Cell, 2> ends(const Robot& robot, std::size_t connection);

/// Names a cell, "(2,1,2)", or a connection, "(2,1,2)-(3,1,2)", in messages and reports.
std::string text(const base::Cell& cell);
std::string ends_text(const Robot& robot, std::size_t connection);

}  // namespace holdfast::model
