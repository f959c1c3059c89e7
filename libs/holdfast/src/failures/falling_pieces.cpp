// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/falling_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "holdfast/model/connected_parts.hpp"

namespace holdfast {
namespace {

using base::at;
using base::Cell;

/// Rounds follow one another so fast that all have begun by then.
constexpr double kRoundSeconds = 0.9;
constexpr double kRoundsSeconds = 8;
/// The last round is followed so long; without a floor nothing ends a fall.
constexpr double kLastSeconds = 2.5;
constexpr double kLastSecondsWithoutFloor = 1.2;
constexpr double kMmPerMetre = 1000;
/// Obstacles are in the way so many cells around the robot.
constexpr std::int32_t kReachCells = 8;

/// Module corners of a lattice whose modules have flat tops are bevelled so far above narrow feet.
constexpr double kBevel = 0.1;
/// A body that has moved less, in pitches, has been in balance on an edge, and is nudged by tilting
/// gravity so far.
constexpr double kUnmoved = 0.1;
constexpr double kNudge = 0.02;

/// The ways to the neighbours beside a module, in pitches.
std::vector<fall::Point> sides_of(const base::Lattice& lattice) {
  std::vector<fall::Point> sides;
  for (const base::Direction direction : base::directions(lattice)) {
    const auto way = base::way_to_neighbour(lattice, direction);
    if (base::heading(lattice, direction)[2] == 0) {
      sides.push_back(way);
    }
  }
  return sides;
}

/// Both corners at the top and bottom of a module, z above and below its centre.
void add_corners(double x, double y, double z, std::vector<fall::Point>& corners) {
  corners.push_back({x, y, z});
  corners.push_back({x, y, -z});
}

/// The corners of a module from its centre, where the planes of two neighbouring sides and of its
/// top or bottom meet, with feet of their own where these are narrower; none for balls and discs.
std::vector<fall::Point> corners_of(const model::Robot& robot) {
  const base::Lattice& lattice = robot.lattice();
  std::vector<fall::Point> corners;
  if (lattice.down >= lattice.direction_count) {
    return corners;
  }
  const double half = robot.material().pitch_mm / 2;
  const double top = robot.step_mm(base::down(lattice)) / 2;
  const double foot = robot.foot_half_width_mm();
  const std::vector<fall::Point> sides = sides_of(lattice);
  const bool has_feet = sides.size() != 4 || foot < half;
  const double angle_cosine = std::cos(2 * std::numbers::pi / static_cast<double>(sides.size()));
  for (std::size_t i = 0; i < sides.size(); ++i) {
    for (std::size_t j = i + 1; j < sides.size(); ++j) {
      const double cosine =
          (sides[i][0] * sides[j][0] + sides[i][1] * sides[j][1]) /
          (std::hypot(sides[i][0], sides[i][1]) * std::hypot(sides[j][0], sides[j][1]));
      if (std::abs(cosine - angle_cosine) < 0.01) {
        const double scale = half / (1 + cosine);
        add_corners(scale * (sides[i][0] + sides[j][0]), scale * (sides[i][1] + sides[j][1]),
                    has_feet ? top * (1 - 2 * kBevel) : top, corners);
      }
    }
  }
  for (const double x : {-foot, foot}) {
    for (const double y : {-foot, foot}) {
      if (has_feet) {
        add_corners(x, y, top, corners);
      }
    }
  }
  return corners;
}

class PieceMaker {
 public:
  /// Keeps references to all of them.
  PieceMaker(const model::RobotSpec& spec, const model::Robot& robot, FallingPieces& pieces)
      : spec_(spec), robot_(robot), pieces_(pieces), index_(robot.modules().size()) {
    pieces_.body_of.assign(robot.modules().size(), FallingPieces::kNone);
    for (std::size_t i = 0; i < robot.modules().size(); ++i) {
      index_.insert(robot.modules()[i].cell, static_cast<std::int32_t>(i));
    }
  }

  /// Makes bodies of what falls in a round, which begin to move at a time.
  void add(const plan::CascadeRound& round, double begin_s, fall::Scene& scene) {
    for (const plan::BrokenConnection& broken : round.broken) {
      broken_.insert(std::minmax({index_.find(broken.between[0]), index_.find(broken.between[1])}));
    }
    std::set<std::int32_t> falling;
    for (const Cell& cell : round.fallen) {
      falling.insert(index_.find(cell));
    }
    const auto is_whole = [&](std::size_t, const model::Connection& pair) {
      return falling.contains(pair.a) && falling.contains(pair.b) &&
             !broken_.contains(std::minmax({pair.a, pair.b}));
    };
    model::ConnectedParts parts =
        model::connected_parts(robot_.connections(), robot_.modules().size(), is_whole);
    for (const std::vector<std::int32_t>& part : parts.lists()) {
      if (falling.contains(part.front())) {
        fall::Body& body = scene.bodies.emplace_back();
        body.begin_s = begin_s;
        for (const std::int32_t module : part) {
          add_module(module, static_cast<std::int32_t>(scene.bodies.size()) - 1, body);
        }
      }
    }
  }

  /// All that no round lets fall, and obstacles near the robot.
  void add_still(fall::Scene& scene) const {
    for (std::size_t i = 0; i < pieces_.body_of.size(); ++i) {
      if (pieces_.body_of[i] == FallingPieces::kNone) {
        scene.still.push_back(node(robot_.modules()[i].cell));
      }
    }
    for (const Cell& cell : obstacle_cells()) {
      scene.still.push_back(node(cell));
    }
  }

 private:
  fall::Point node(const Cell& cell) const {
    fall::Point place = base::node_place(robot_.lattice(), cell);
    for (double& coordinate : place) {
      coordinate *= robot_.material().pitch_mm;
    }
    return place;
  }

  void add_module(std::int32_t module, std::int32_t body_index, fall::Body& body) {
    pieces_.body_of[at(module)] = body_index;
    for (const model::Payload& payload : spec_.payloads) {
      if (payload.cell == robot_.modules()[at(module)].cell) {
        body.pushes.push_back({.node = body.nodes.size(),
                               .force_n = payload.force_n,
                               .torque_nmm = payload.torque_nmm});
      }
    }
    body.nodes.push_back(node(robot_.modules()[at(module)].cell));
    body.masses.push_back(robot_.mass(at(module)));
  }

  static void add_box(const Cell& from, const Cell& to, std::set<Cell>& cells) {
    for (std::int32_t x = from.x; x <= to.x; ++x) {
      for (std::int32_t y = from.y; y <= to.y; ++y) {
        for (std::int32_t z = from.z; z <= to.z; ++z) {
          cells.insert({x, y, z});
        }
      }
    }
  }

  /// The cells of obstacles near the robot, each once.
  std::set<Cell> obstacle_cells() const {
    const auto [low, high] = bounds();
    std::set<Cell> cells;
    for (const model::Obstacle& obstacle : spec_.obstacles) {
      for (const Cell& cell : obstacle.cells) {
        if (low.x <= cell.x && cell.x <= high.x && low.y <= cell.y && cell.y <= high.y &&
            low.z <= cell.z && cell.z <= high.z) {
          cells.insert(cell);
        }
      }
      if (obstacle.cells.empty()) {
        add_box({std::max(low.x, obstacle.from.x), std::max(low.y, obstacle.from.y),
                 std::max(low.z, obstacle.from.z)},
                {std::min(high.x, obstacle.to.x), std::min(high.y, obstacle.to.y),
                 std::min(high.z, obstacle.to.z)},
                cells);
      }
    }
    return cells;
  }

  std::pair<Cell, Cell> bounds() const {
    Cell low = robot_.modules().front().cell;
    Cell high = low;
    for (const model::Module& module : robot_.modules()) {
      const Cell& cell = module.cell;
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y), std::max(high.z, cell.z)};
    }
    const auto reach = std::max({high.x - low.x, high.y - low.y, high.z - low.z}) / 2 + kReachCells;
    return {{low.x - reach, low.y - reach, low.z - reach},
            {high.x + reach, high.y + reach, high.z + reach}};
  }

  const model::RobotSpec& spec_;
  const model::Robot& robot_;
  FallingPieces& pieces_;
  model::CellIndex index_;
  std::set<std::pair<std::int32_t, std::int32_t>> broken_;
};

fall::Scene empty_scene(const model::RobotSpec& spec, const model::Robot& robot) {
  const double pitch = robot.material().pitch_mm;
  fall::Scene scene;
  scene.pitch_mm = pitch;
  scene.corners = corners_of(robot);
  scene.friction = spec.floor.friction.value_or(scene.friction);
  scene.neighbour_count_max = static_cast<std::size_t>(robot.lattice().direction_count);
  for (std::size_t k = 0; k < 3; ++k) {
    scene.gravity_mm_s2[k] = kMmPerMetre * robot.gravity()[k];
  }
  if (robot.has_floor()) {
    const auto level = base::node_place(robot.lattice(), {0, 0, robot.support_z()})[2];
    scene.floor_mm = level * pitch - robot.step_mm(base::down(robot.lattice())) / 2;
  }
  return scene;
}

/// The first body that has not moved, if any.
std::optional<std::size_t> find_unmoved(const fall::Fall& fall, double pitch_mm) {
  for (std::size_t i = 0; i < fall.centres.size(); ++i) {
    const auto& [moved, turn] = fall.frames.back()[i];
    const double turned = std::hypot(turn[1], turn[2], turn[3]);
    if (std::hypot(moved[0], moved[1], moved[2]) < kUnmoved * pitch_mm && turned < kUnmoved) {
      return i;
    }
  }
  return std::nullopt;
}

/// Tilts gravity from the middle of a body's lowest modules towards its centre of mass.
void nudge(const fall::Body& body, const fall::Point& centre, fall::Scene& scene) {
  double low = body.nodes.front()[2];
  for (const fall::Point& node : body.nodes) {
    low = std::min(low, node[2]);
  }
  fall::Point feet{};
  double count = 0;
  for (const fall::Point& node : body.nodes) {
    if (node[2] < low + scene.pitch_mm / 2) {
      feet = {feet[0] + node[0], feet[1] + node[1], 0};
      ++count;
    }
  }
  const double x = centre[0] - feet[0] / count;
  const double y = centre[1] - feet[1] / count;
  const double size = std::hypot(x, y);
  const double tilt = kNudge * std::abs(scene.gravity_mm_s2[2]) / (size > 0 ? size : 1);
  scene.gravity_mm_s2[0] += tilt * (size > 0 ? x : 1);
  scene.gravity_mm_s2[1] += tilt * y;
}

}  // namespace

FallingPieces simulate_fall(const model::RobotSpec& spec, const model::Robot& robot,
                            const plan::Cascade& cascade) {
  FallingPieces pieces;
  fall::Scene scene = empty_scene(spec, robot);
  PieceMaker maker(spec, robot, pieces);
  const double between =
      std::min(kRoundSeconds, kRoundsSeconds / static_cast<double>(cascade.rounds.size() + 1));
  for (const plan::CascadeRound& round : cascade.rounds) {
    pieces.round_s.push_back(between * static_cast<double>(pieces.round_s.size()));
    maker.add(round, pieces.round_s.back(), scene);
  }
  maker.add_still(scene);
  const double last = robot.has_floor() ? kLastSeconds : kLastSecondsWithoutFloor;
  const fall::FallOptions options{.seconds =
                                      last + (pieces.round_s.empty() ? 0 : pieces.round_s.back())};
  pieces.fall = fall::simulate(scene, options);
  if (const auto unmoved = find_unmoved(pieces.fall, scene.pitch_mm)) {
    nudge(scene.bodies[*unmoved], pieces.fall.centres[*unmoved], scene);
    pieces.fall = fall::simulate(scene, options);
  }
  return pieces;
}

}  // namespace holdfast
