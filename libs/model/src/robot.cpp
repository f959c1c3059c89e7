// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/model/robot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "holdfast/model/cell_index.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "robot_faults.hpp"

namespace holdfast::model {
namespace {

/// The level of a floor that is not there: who compares levels without asking finds nothing on it.
constexpr std::int32_t kBelowAllCells = -2 * base::kCoordinateMax;

using base::Cell;

CellIndex index_of(const RobotSpec& spec) {
  Cell low = spec.existing.front();
  Cell high = low;
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y), std::max(high.z, cell.z)};
    }
  }
  return {spec.existing.size() + spec.planned.size(), low, high};
}

/// Puts all cells into the index; existing cells first.
std::optional<std::string> find_double_cell(const RobotSpec& spec, CellIndex& index) {
  std::int32_t next = 0;
  for (const Cell& cell : spec.existing) {
    if (index.insert(cell, next++) != CellIndex::kNone) {
      return fmt::format("the cell {} is listed twice", text(cell));
    }
  }
  const auto existing_count = static_cast<std::int32_t>(spec.existing.size());
  for (const Cell& cell : spec.planned) {
    const std::int32_t earlier = index.insert(cell, next++);
    if (earlier != CellIndex::kNone) {
      return fmt::format(
          "the planned cell {} is {}, expected free cells, each once", text(cell),
          earlier < existing_count ? "occupied by an existing module" : "planned twice");
    }
  }
  return std::nullopt;
}

std::array<double, 3> gravity_of(const RobotSpec& spec) {
  return spec.gravity_m_s2.value_or(std::array<double, 3>{0, 0, -spec.material.gravity_m_s2});
}

double foot_half_width(const RobotSpec& spec) {
  const Material& material = spec.material;
  if (base::unstretched(spec.lattice) == base::kCubic) {
    return material.facet_mm / 2;
  }
  return spec.foot_mm.value_or(material.pitch_mm / 2) / 2;
}

/// The width of a facet in a direction: where modules are not as long as wide, no more than the
/// shorter side of their faces there.
double width_on_face(double width_mm, const Material& material, const base::Lattice& lattice,
                     base::Direction direction) {
  if (!base::is_stretched(lattice)) {
    return width_mm;
  }
  const std::array<double, 3> along = base::heading(lattice, direction);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (along[axis] == 0) {
      const double side = base::root(base::basis_square(lattice, axis));
      width_mm = std::min(width_mm, material.pitch_mm * side);
    }
  }
  return width_mm;
}

/// The weight of a mass, and its moment about the carrier's node.
Loads::Load carried_load(const CarriedMass& carried, const std::array<double, 3>& gravity) {
  const auto& [x, y, z] = carried.offset_mm;
  const double fx = carried.mass_kg * gravity[0];
  const double fy = carried.mass_kg * gravity[1];
  const double fz = carried.mass_kg * gravity[2];
  return {fx, fy, fz, y * fz - z * fy, z * fx - x * fz, x * fy - y * fx};
}

}  // namespace

std::optional<base::Direction> direction_between(const base::Lattice& lattice, const base::Cell& a,
                                                 const base::Cell& b) {
  for (const base::Direction direction : base::directions(lattice)) {
    if (base::neighbour(lattice, a, direction) == b) {
      return direction;
    }
  }
  return std::nullopt;
}

ModuleKind default_kind(const Material& material, const base::Lattice& lattice) {
  ModuleKind kind{.mass_kg = material.mass_kg};
  for (const base::Direction direction : base::directions(lattice)) {
    const auto connector = model::connector(material, base::connector_class(lattice, direction));
    const double width = width_on_face(connector.width, material, lattice, direction);
    kind.connectors.push_back({.strength_n = connector.strength, .lever_mm = width / 2});
  }
  return kind;
}

Robot::Robot(const RobotSpec& spec)
    : lattice_(spec.lattice),
      neighbours_(lattice_count()),
      connected_(lattice_count()),
      material_(spec.material),
      is_modulus_stated_(spec.is_modulus_stated ||
                         spec.material.elastic_modulus_mpa != Material{}.elastic_modulus_mpa),
      foot_half_width_mm_(foot_half_width(spec)),
      gravity_(gravity_of(spec)),
      loads_(weight_loads(spec.material)),
      has_floor_(spec.support_z.has_value()),
      support_z_(spec.support_z.value_or(kBelowAllCells)),
      planned_count_(spec.planned.size()) {}

base::Result<Robot> Robot::create(const RobotSpec& spec, int thread_count) {
  if (auto fault = find_number_fault(spec)) {
    return base::bad_input(*fault);
  }
  Robot robot(spec);
  auto fault = robot.take(spec, thread_count, Extent::kWhole);
  fault = fault ? fault : find_support_fault(robot, spec);
  fault = fault || !spec.may_be_in_pieces ? fault : robot.take_pieces(spec, thread_count);
  if (fault) {
    return base::bad_input(*fault);
  }
  return robot;
}

base::Result<Robot> Robot::create_part(const RobotSpec& spec, RobotPart part, int thread_count) {
  if (auto fault = find_number_fault(spec)) {
    return base::bad_input(*fault);
  }
  Robot robot(spec);
  if (auto fault = robot.take(spec, thread_count, Extent::kPart)) {
    return base::bad_input(*fault);
  }
  robot.part_ = std::move(part);
  if (base::is_stretched(robot.lattice_)) {
    robot.foot_half_width_mm_ = -host::max(robot.ranks(), -robot.foot_half_width_mm_);
  }
  const std::size_t own_count = robot.own_count();
  std::erase_if(robot.facets_,
                [&](const Facet& facet) { return base::at(facet.module) >= own_count; });
  host::Team team(thread_count, own_count);
  robot.connections_ = ConnectionIndex(robot.connected_, own_count, team);
  robot.has_bonded_facets_ = std::ranges::any_of(robot.facets_, &Facet::is_bonded);
  return robot;
}

std::optional<std::string> Robot::take(const RobotSpec& spec, int thread_count, Extent extent) {
  CellIndex index = index_of(spec);
  if (auto fault = find_double_cell(spec, index)) {
    return fault;
  }
  add_modules(spec);
  auto fault = fix(spec.fixed, index);
  if (!fault) {
    host::Team team(thread_count, modules_.size());
    connect(index, team);
    fault = spec.released.empty() ? std::nullopt : release(spec.released, index, team);
  }
  if (!fault && extent == Extent::kWhole && !spec.may_be_in_pieces) {
    fault = find_connection_fault(connections(), modules_, spec.existing.size());
    if (fault && released_count_ > 0) {
      *fault += fmt::format("; the faces of {} open pairs do not count", released_count_);
    }
  }
  fault = fault ? fault : touch(spec);
  fault = fault ? fault : take_kinds(spec, index);
  fault = fault ? fault : take_own_connectors(spec, index);
  return fault ? fault : take_loads(spec, index);
}

std::optional<std::string> Robot::take_pieces(const RobotSpec& spec, int thread_count) {
  auto apart = find_connection_fault(connections(), modules_, spec.existing.size());
  if (!apart) {
    return std::nullopt;
  }
  const std::vector<std::vector<std::int32_t>> lists = pieces_of(connections(), modules_.size());
  if (lists.size() < 2) {
    return apart;
  }
  if (auto fault = find_loose_fault(lists, modules_)) {
    return fault;
  }
  std::vector<RobotPiece> pieces;
  for (const std::vector<std::int32_t>& list : lists) {
    RobotSpec part = spec;
    part.may_be_in_pieces = false;
    part.existing.clear();
    part.planned.clear();
    for (const std::int32_t i : list) {
      const Module& module = modules_[base::at(i)];
      (module.is_planned ? part.planned : part.existing).push_back(module.cell);
    }
    forget_absent(part);
    auto piece = Robot::create(part, thread_count);
    if (!piece) {
      return piece.error().message;
    }
    pieces.push_back({.robot = std::move(piece).value(), .modules = list});
  }
  pieces_ = std::make_shared<const std::vector<RobotPiece>>(std::move(pieces));
  return std::nullopt;
}

std::span<const RobotPiece> Robot::pieces() const {
  return pieces_ ? std::span<const RobotPiece>(*pieces_) : std::span<const RobotPiece>();
}

void Robot::add_modules(const RobotSpec& spec) {
  modules_.reserve(spec.existing.size() + spec.planned.size());
  for (const auto* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      modules_.push_back({.cell = cell, .is_planned = cells == &spec.planned});
    }
  }
  part_.own_count = modules_.size();
}

std::optional<std::string> Robot::fix(std::span<const Cell> cells, const CellIndex& index) {
  for (const Cell& cell : cells) {
    const std::int32_t found = index.find(cell);
    if (found == CellIndex::kNone || modules_[base::at(found)].is_planned) {
      return fmt::format("the fixed cell {} holds no existing module", text(cell));
    }
    Module& module = modules_[base::at(found)];
    fixed_count_ += module.support == Support::kFixed ? 0 : 1;
    module.support = Support::kFixed;
  }
  return std::nullopt;
}

void Robot::connect(const CellIndex& index, host::Team& team) {
  connected_.resize(modules_.size(), kNoNeighbour);
  team.share(0, modules_.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (const base::Direction direction : base::directions(lattice_)) {
        connected_[i][static_cast<std::size_t>(base::index(direction))] =
            index.find(base::neighbour(lattice_, modules_[i].cell, direction));
      }
    }
  });
  connections_ = ConnectionIndex(connected_, modules_.size(), team);
}

std::optional<std::string> Robot::release(std::span<const CellPair> pairs, const CellIndex& index,
                                          host::Team& team) {
  neighbours_ = connected_;
  for (const CellPair& pair : pairs) {
    const auto direction = direction_between(lattice_, pair[0], pair[1]);
    const std::int32_t a = index.find(pair[0]);
    const std::int32_t b = index.find(pair[1]);
    if (!direction || a == CellIndex::kNone || b == CellIndex::kNone) {
      return fmt::format(
          "the released pair {}-{} is no connection, expected two modules in neighbouring cells",
          text(pair[0]), text(pair[1]));
    }
    std::int32_t& there = connected_[base::at(a)][base::at(base::index(*direction))];
    if (there == kNoNeighbour) {
      return fmt::format("the pair {}-{} is released twice, expected once", text(pair[0]),
                         text(pair[1]));
    }
    there = kNoNeighbour;
    connected_[base::at(b)][base::at(base::index(base::opposite(*direction)))] = kNoNeighbour;
  }
  connections_ = ConnectionIndex(connected_, modules_.size(), team);
  released_count_ = pairs.size();
  return std::nullopt;
}

/// All sides of a module that are not fixed, but those that another module is beside.
std::optional<std::string> Robot::touch(const RobotSpec& spec) {
  const ObstacleIndex obstacles(spec.obstacles);
  const auto floor = base::index(base::down(lattice_));
  std::size_t lost_count = 0;
  for (std::size_t i = 0; i < modules_.size(); ++i) {
    Module& module = modules_[i];
    if (!spec.obstacles.empty() && obstacles.find(module.cell) != CellIndex::kNone) {
      return fmt::format("the module {} is where an obstacle is", text(module.cell));
    }
    const bool is_on_floor = has_floor_ && module.cell.z == support_z_;
    if (module.support == Support::kFixed || (!is_on_floor && spec.obstacles.empty())) {
      continue;
    }
    for (const base::Direction direction : base::facet_directions(lattice_)) {
      const bool is_floor = is_on_floor && base::index(direction) == floor;
      const bool is_neighbour = base::index(direction) < lattice_.direction_count;
      const std::int32_t obstacle =
          is_neighbour && !spec.obstacles.empty()
              ? obstacles.find(base::neighbour(lattice_, module.cell, direction))
              : CellIndex::kNone;
      const bool is_free =
          !is_neighbour || neighbours()[i][base::at(base::index(direction))] == kNoNeighbour;
      if (!is_floor && (obstacle == CellIndex::kNone || !is_free)) {
        continue;
      }
      if (std::ranges::find(spec.lost_facets, LostFacet{module.cell, direction}) !=
          spec.lost_facets.end()) {
        ++lost_count;
        continue;
      }
      facets_.push_back({.module = static_cast<std::int32_t>(i),
                         .direction = direction,
                         .touch = obstacle == CellIndex::kNone
                                      ? spec.floor
                                      : spec.obstacles[base::at(obstacle)].touch});
      module.support = Support::kGround;
    }
  }
  has_bonded_facets_ = std::ranges::any_of(facets_, &Facet::is_bonded);
  if (base::is_stretched(lattice_)) {  // All facets are as wide as the narrowest.
    double width = 2 * foot_half_width_mm_;
    for (const Facet& facet : facets_) {
      width = width_on_face(width, material_, lattice_, facet.direction);
    }
    foot_half_width_mm_ = width / 2;
  }
  if (lost_count != spec.lost_facets.size()) {
    return fmt::format("{} facets are lost, but {} of them touch something",
                       spec.lost_facets.size(), lost_count);
  }
  return std::nullopt;
}

std::optional<std::string> Robot::take_kinds(const RobotSpec& spec, const CellIndex& index) {
  kinds_ = spec.kinds;
  has_default_connectors_ = kinds_.empty();
  if (kinds_.empty()) {
    kinds_.push_back(default_kind(material_, lattice_));
  }
  mass_ = kinds_.front().mass_kg;
  for (const OwnKind& own : spec.own_kinds) {
    const std::int32_t module = index.find(own.cell);
    if (module == CellIndex::kNone || own.kind >= kinds_.size()) {
      return fmt::format("the kind {} of {}: there are {} kinds, and {} there", own.kind,
                         text(own.cell), kinds_.size(),
                         module == CellIndex::kNone ? "no module" : "a module");
    }
    modules_[base::at(module)].kind = own.kind;
  }
  for (const ModuleKind& a : kinds_) {
    for (const ModuleKind& b : kinds_) {
      for (std::size_t d = 0; d < lattice_count(); ++d) {
        connectors_.push_back(weaker(a.connectors[d], b.connectors[d ^ 1U]));
      }
    }
  }
  return std::nullopt;
}

std::optional<std::string> Robot::take_own_connectors(const RobotSpec& spec,
                                                      const CellIndex& index) {
  for (const OwnConnector& own : spec.own_connectors) {
    const auto direction = direction_between(lattice_, own.between[0], own.between[1]);
    const std::int32_t a = index.find(own.between[0]);
    const std::int32_t b = index.find(own.between[1]);
    if (!direction || a == CellIndex::kNone || b == CellIndex::kNone) {
      return fmt::format("the pair {}-{} has a law of its own, but is no pair of neighbours",
                         text(own.between[0]), text(own.between[1]));
    }
    const bool is_first = base::index(*direction) % 2 == 0;
    const auto along = base::at(base::index(is_first ? *direction : base::opposite(*direction)));
    own_connectors_.emplace_back(base::at(is_first ? a : b) * lattice_count() + along,
                                 connectors_.size());
    const bool is_of_kinds =
        own.law == connector(modules_[base::at(is_first ? a : b)].kind,
                             modules_[base::at(is_first ? b : a)].kind,
                             is_first ? *direction : base::opposite(*direction));
    has_default_connectors_ = has_default_connectors_ && is_of_kinds;
    connectors_.push_back(own.law);
    own_names_.push_back(own);
  }
  std::ranges::sort(own_connectors_);
  const auto twice =
      std::ranges::adjacent_find(own_connectors_, {}, [](const auto& own) { return own.first; });
  if (twice != own_connectors_.end()) {
    const CellPair& pair =
        spec.own_connectors[twice->second + spec.own_connectors.size() - connectors_.size()]
            .between;
    return fmt::format("the pair {}-{} has two laws of its own, expected one", text(pair[0]),
                       text(pair[1]));
  }
  return std::nullopt;
}

const ConnectorLaw* Robot::find_own_connector(const Connection& connection) const {
  const bool is_first = base::index(connection.direction) % 2 == 0;
  const auto along =
      base::at(base::index(is_first ? connection.direction : base::opposite(connection.direction)));
  const std::size_t place =
      base::at(is_first ? connection.a : connection.b) * lattice_count() + along;
  const auto found = std::ranges::lower_bound(own_connectors_, place, {},
                                              [](const auto& own) { return own.first; });
  return found != own_connectors_.end() && found->first == place ? &connectors_[found->second]
                                                                 : nullptr;
}

const OwnConnector* Robot::find_own_name(const Connection& connection) const {
  const ConnectorLaw* const own =
      own_connectors_.empty() ? nullptr : find_own_connector(connection);
  const std::size_t first = connectors_.size() - own_names_.size();
  return own == nullptr ? nullptr
                        : &own_names_[static_cast<std::size_t>(own - connectors_.data()) - first];
}

std::int32_t Robot::connector_tag(const Connection& connection) const {
  const OwnConnector* const own = find_own_name(connection);
  return own == nullptr ? OwnConnector::kNoTag : own->tag;
}

std::int32_t Robot::body(const Connection& connection) const {
  const OwnConnector* const own = find_own_name(connection);
  return own == nullptr ? OwnConnector::kNoBody : own->body;
}

bool Robot::has_bodies() const {
  return std::ranges::any_of(
      own_names_, [](const OwnConnector& own) { return own.body != OwnConnector::kNoBody; });
}

std::vector<std::int32_t> Robot::bodies() const {
  std::vector<std::int32_t> by_module(modules_.size(), OwnConnector::kNoBody);
  if (!has_bodies()) {
    return by_module;
  }
  for (const Connection& pair : connections()) {
    if (const std::int32_t number = body(pair); number != OwnConnector::kNoBody) {
      by_module[base::at(pair.a)] = number;
      by_module[base::at(pair.b)] = number;
    }
  }
  return by_module;
}

std::map<std::int32_t, std::vector<std::int32_t>> Robot::modules_by_body() const {
  std::map<std::int32_t, std::vector<std::int32_t>> modules;
  if (has_bodies()) {
    const std::vector<std::int32_t> by_module = bodies();
    for (std::size_t i = 0; i < by_module.size(); ++i) {
      if (by_module[i] != OwnConnector::kNoBody) {
        modules[by_module[i]].push_back(static_cast<std::int32_t>(i));
      }
    }
  }
  return modules;
}

std::optional<std::string> Robot::take_loads(const RobotSpec& spec, const CellIndex& index) {
  const auto weight = [&](double mass) {
    return Loads::Load{mass * gravity_[0], mass * gravity_[1], mass * gravity_[2], 0, 0, 0};
  };
  has_payloads_ = !spec.payloads.empty();
  carried_ = spec.carried;
  const bool is_weight_alone = !has_payloads_ && carried_.empty();
  loads_ = Loads(weight(mass_));
  if (kinds_.size() == 1 && spec.own_masses.empty() && is_weight_alone) {
    return std::nullopt;
  }
  std::vector<double> masses(modules_.size());
  std::ranges::transform(modules_, masses.begin(),
                         [&](const Module& module) { return kinds_[module.kind].mass_kg; });
  for (const OwnMass& own : spec.own_masses) {
    const std::int32_t module = index.find(own.cell);
    if (module == CellIndex::kNone) {
      return fmt::format("a mass of {} kg in {}: there is no module", own.mass_kg, text(own.cell));
    }
    masses[base::at(module)] = own.mass_kg;
  }
  mass_ = masses.front();
  if (std::ranges::all_of(masses, [&](double mass) { return mass == mass_; })) {
    loads_ = Loads(weight(mass_));
  } else {
    masses_ = masses;
  }
  if (is_uniform() && is_weight_alone) {
    return std::nullopt;
  }
  std::vector<Loads::Load> loads(masses.size());
  std::ranges::transform(masses, loads.begin(), weight);
  for (const Payload& payload : spec.payloads) {
    const std::int32_t module = index.find(payload.cell);
    if (module == CellIndex::kNone) {
      return fmt::format("a load on {}: there is no module", text(payload.cell));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      loads[base::at(module)][k] += payload.force_n[k];
      loads[base::at(module)][k + 3] += payload.torque_nmm[k];
    }
  }
  for (const CarriedMass& carried : carried_) {
    const std::int32_t module = index.find(carried.carrier);
    if (module == CellIndex::kNone) {
      return fmt::format("a carried mass on {}: there is no module", text(carried.carrier));
    }
    base::add_to(loads[base::at(module)], carried_load(carried, gravity_));
  }
  loads_ = Loads(std::move(loads));
  return std::nullopt;
}

std::optional<std::int32_t> Robot::barring_level() const {
  const base::Direction down = base::down(lattice_);
  const bool does_any_rest =
      has_floor_ && std::ranges::any_of(facets_, [&](const Facet& facet) {
        return facet.direction == down && modules_[base::at(facet.module)].cell.z == support_z_;
      });
  return does_any_rest ? std::optional(support_z_) : std::nullopt;
}

FloorRule::FloorRule(const Robot& robot) : level_(robot.barring_level()) {
  const auto is_below = [&](const Module& module) { return module.cell.z < robot.support_z(); };
  if (robot.has_floor() && std::ranges::any_of(robot.modules(), is_below)) {
    level_of_none_ = robot.support_z();
  }
}

double load_ratio_per_energy_norm(const Robot& robot) {
  const LatticeBeam<double> beams(beam_section(robot.material()), robot.lattice());
  double axial = 0;
  double bend = 0;
  double shear = 0;
  double twist = 0;
  for (const base::Direction direction : base::facet_directions(robot.lattice())) {
    const auto& beam = beams.stiffness(direction);
    axial = std::max(axial, beam.axial);
    bend = std::max({bend, beam.bend_x / 4, beam.bend_y / 4});
    shear = std::max({shear, beam.shear_x, beam.shear_y});
    twist = std::max(twist, beam.twist);
  }
  const auto squared = [](double value) { return value * value; };
  double largest = 0;
  for (const ConnectorLaw& law : robot.connectors()) {
    const double opens = (axial + bend / squared(law.lever_mm)) / squared(law.strength_n);
    const double mu = law.friction.value_or(ConnectorLaw::kUnlimited);
    const double slips =
        (axial + shear / squared(mu) + twist / squared(mu * law.torsion_radius_mm)) /
        squared(law.strength_n);
    largest = std::max({largest, opens, slips, shear / squared(law.shear_strength_n),
                        twist / squared(law.torsion_strength_nmm)});
  }
  return std::sqrt(largest);
}

std::optional<std::string> find_beyond_paper(const Robot& robot) {
  const auto& [x, y, z] = robot.gravity();
  if (base::is_stretched(robot.lattice())) {
    return "a pitch by direction";
  }
  if (robot.lattice() != base::kCubic) {
    return "a lattice other than the cubic one";
  }
  if (x != 0 || y != 0 || z >= 0) {
    return "gravity that is not straight down";
  }
  if (!robot.is_uniform() || !robot.carried().empty()) {
    return "modules of different masses";
  }
  if (robot.has_payloads()) {
    return "loads besides weight";
  }
  if (!robot.has_default_connectors()) {
    return "connectors with other limits than Eq. (17)";
  }
  for (const Facet& facet : robot.facets()) {
    const std::int32_t level = robot.modules()[base::at(facet.module)].cell.z;
    if (facet.touch != Touch{} || facet.direction != base::down(robot.lattice()) ||
        !robot.has_floor() || level != robot.support_z()) {
      return "supports other than a floor without slip";
    }
  }
  return std::nullopt;
}

std::array<base::Cell, 2> ends(const Robot& robot, std::size_t connection) {
  const Connection pair = robot.connections()[connection];
  return {robot.modules()[static_cast<std::size_t>(pair.a)].cell,
          robot.modules()[static_cast<std::size_t>(pair.b)].cell};
}

std::string text(const Cell& cell) { return fmt::format("({},{},{})", cell.x, cell.y, cell.z); }

std::string ends_text(const Robot& robot, std::size_t connection) {
  const auto [a, b] = ends(robot, connection);
  return text(a) + "-" + text(b);
}

}  // namespace holdfast::model
