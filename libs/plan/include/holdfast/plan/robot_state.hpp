// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "holdfast/model/environment.hpp"
#include "holdfast/model/robot.hpp"

/// A robot between two steps.
namespace holdfast::plan {

/// A module with all that goes with it when it moves.
struct ModuleState {
  base::Cell cell;
  std::uint16_t kind = 0;  ///< Index in RobotSpec::kinds.
  bool is_there = true;    ///< False: a place that the next new module takes.
  bool is_fixed = false;
  bool is_kept = false;  ///< No plan may move it.
  std::optional<double> own_mass_kg = {};
  std::optional<model::Payload> payload = {};  ///< Its cell is void.

  /// Whether moves leave it where it is.
  bool stays() const { return is_fixed || is_kept; }

  friend bool operator==(const ModuleState&, const ModuleState&) = default;
};

/// Adds a load to those on a module.
void add_payload(const model::Payload& payload, ModuleState& module);

/// The modules of a robot, their cells, and which neighbours are not connected: a value, changed
/// module by module in constant time. Modules keep their index as long as they are there.
class RobotState {
 public:
  static constexpr std::int32_t kNone = -1;

  /// The robot that the spec describes, which model::Robot::create() must accept, its planned
  /// modules attached. A released pair is kept as long as both modules stay.
  explicit RobotState(const model::RobotSpec& spec);

  /// The index of the module in a cell, or kNone.
  std::int32_t find(const base::Cell& cell) const {
    const auto found = index_.find(cell);
    return found == index_.end() ? kNone : found->second;
  }

  const ModuleState& module(std::int32_t index) const {
    return modules_[static_cast<std::size_t>(index)];
  }

  /// The modules by index; some are not there.
  std::span<const ModuleState> modules() const { return modules_; }

  std::size_t module_count() const { return index_.size(); }

  double mass_kg(std::int32_t index) const {
    const ModuleState& found = module(index);
    return found.own_mass_kg.value_or(kind(index).mass_kg);
  }

  const base::Lattice& lattice() const { return surroundings().lattice; }

  const model::ModuleKind& kind(std::int32_t index) const {
    return around_->kinds[module(index).kind];
  }

  std::size_t kind_count() const { return around_->kinds.size(); }

  /// Everything but the modules and what belongs to them.
  const model::RobotSpec& surroundings() const { return around_->spec; }

  /// The index of obstacles by cell.
  const model::ObstacleIndex& obstacles() const { return around_->obstacles; }

  /// m/s^2, global frame.
  std::array<double, 3> gravity() const;

  /// Neighbours that are not connected, each pair in ascending order.
  const std::set<model::CellPair>& released() const { return released_; }

  /// The law that a connection has of its own; null if it has none.
  const model::ConnectorLaw* own_connector(const base::Cell& a, const base::Cell& b) const;

  /// Whether two cells are neighbours with modules that are connected.
  bool are_connected(const base::Cell& a, const base::Cell& b) const;

  /// The caller sees to it that cells are free, or hold a module, as it must be.
  void add(const ModuleState& added);
  void remove(const base::Cell& cell);
  void keep(const base::Cell& cell);  ///< Marks its module as kept.
  void release(const model::CellPair& pair);
  void connect(const model::CellPair& pair);

  /// Several modules at once, which may follow one another; all their neighbours are connected to
  /// them when they arrive, and those that they move with as they were.
  void move(std::span<const base::Cell> from, std::span<const base::Cell> to);

  /// What model::Robot::create() makes the robot of these modules from, with the pairs released
  /// that are among them, and with `more` released.
  model::RobotSpec spec(std::span<const std::int32_t> modules,
                        std::span<const model::CellPair> more = {}) const;

  /// The description of all modules.
  model::RobotSpec spec() const;

 private:
  /// A hash of cells, for containers that are asked and never walked through.
  struct CellHash {
    std::size_t operator()(const base::Cell& cell) const;
  };

  /// What no step changes.
  struct Surroundings {
    explicit Surroundings(const model::RobotSpec& whole);

    model::RobotSpec spec;
    std::vector<model::ModuleKind> kinds;  ///< Never empty.
    model::ObstacleIndex obstacles;
  };

  /// Shared, as many states of one robot are kept at a time.
  std::shared_ptr<const Surroundings> around_;
  std::vector<ModuleState> modules_;
  std::vector<std::int32_t> free_;  ///< Indices of modules that are not there.
  std::unordered_map<base::Cell, std::int32_t, CellHash> index_;
  std::set<model::CellPair> released_;
  std::map<model::CellPair, model::OwnConnector> own_connectors_;
};

/// What differs between two robots besides their modules, as holdfast JSON names it.
std::vector<std::string_view> differences_of_surroundings(const model::RobotSpec& a,
                                                          const model::RobotSpec& b);

/// Names what differs between modules that both robots have in the same cells.
std::vector<std::string_view> differences_of_modules(const RobotState& a, const RobotState& b);

/// Names what differs between two robots: their surroundings, and modules that both have in the
/// same cells, as far as both are robots.
std::vector<std::string_view> differences(const model::RobotSpec& a, const model::RobotSpec& b);

/// Names these differences, and those of the cells that modules are in.
std::vector<std::string_view> differences_of_targets(const model::RobotSpec& a,
                                                     const model::RobotSpec& b);

/// A pair of cells in ascending order.
model::CellPair ordered(const model::CellPair& pair);

}  // namespace holdfast::plan
