// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Where bodies get through when they move, beside bodies that are turned by a degree at a time and
// compared with all others: squares that turn about an edge, balls and discs that roll about one or
// two neighbours, prisms that turn about their corners.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <set>
#include <vector>

#include "grown_robot.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "moves.hpp"
#include "seeds.hpp"

namespace holdfast::plan {
namespace {

using base::Cell;
using Place = std::array<double, 3>;
using Point = std::array<double, 2>;

RobotState state_of(const model::RobotSpec& spec) { return RobotState(spec); }

std::set<Cell> arrivals_of(const RobotState& robot, const Cell& from, const MoveRule& rule) {
  std::set<Cell> cells;
  for (const model::Move& move : moves_of(robot, robot.find(from), rule)) {
    cells.insert(move.to);
  }
  return cells;
}

// --- Squares ------------------------------------------------------------------------------------

/// Whether a unit square, turned by an angle about a corner of the one at the origin, overlaps the
/// one at a cell: by the axes that may separate two squares.
bool overlaps(const Point& hinge, double angle, const Point& cell) {
  const auto turned = [&](const Point& p) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    return Point{hinge[0] + c * (p[0] - hinge[0]) - s * (p[1] - hinge[1]),
                 hinge[1] + s * (p[0] - hinge[0]) + c * (p[1] - hinge[1])};
  };
  const Point middle = turned({0, 0});
  const Point way = {cell[0] - middle[0], cell[1] - middle[1]};
  const double half_widths = 0.5 + 0.5 * (std::abs(std::cos(angle)) + std::abs(std::sin(angle)));
  for (const double axis : {0.0, angle}) {
    const double along = way[0] * std::cos(axis) + way[1] * std::sin(axis);
    const double across = -way[0] * std::sin(axis) + way[1] * std::cos(axis);
    if (std::abs(along) > half_widths - 1e-6 || std::abs(across) > half_widths - 1e-6) {
      return false;
    }
  }
  return true;
}

/// Where the square at the origin gets by turning about one of its corners by a quarter, from one
/// module onto the next in a row, or by a half around a module.
std::set<Cell> turned_squares(const std::set<Cell>& taken) {
  std::set<Cell> arrivals;
  for (const double x : {-0.5, 0.5}) {
    for (const double z : {-0.5, 0.5}) {
      for (const int sense : {-1, 1}) {
        for (const int degrees : {90, 180}) {
          const Point hinge = {x, z};
          const auto end_of = [&](int angle) {
            const double c = std::cos(sense * angle * std::numbers::pi / 180);
            const double s = std::sin(sense * angle * std::numbers::pi / 180);
            return Cell{static_cast<std::int32_t>(std::lround(x - c * x + s * z)), 0,
                        static_cast<std::int32_t>(std::lround(z - s * x - c * z))};
          };
          const Cell end = end_of(degrees);
          // It leaves the neighbour that it turns away from, which is where a turn the other way
          // would lead, and ends beside the next around the hinge, or the same.
          const bool is_carried = taken.contains(end_of(-90)) && taken.contains(end_of(-180));
          const bool is_around = taken.contains(end_of(-90));
          bool is_clear = degrees == 90 ? is_carried : is_around;
          for (int angle = 1; angle <= degrees && is_clear; ++angle) {
            for (const Cell& cell : taken) {
              is_clear = is_clear && !overlaps(hinge, sense * angle * std::numbers::pi / 180,
                                               {double(cell.x), double(cell.z)});
            }
          }
          if (is_clear) {
            arrivals.insert(end);
          }
        }
      }
    }
  }
  return arrivals;
}

TEST(Rolling, a_cube_pivots_where_its_turning_square_meets_nobody) {
  // A layer between a plate of modules, which hold those of the layer, and one of obstacles, so
  // that no cube turns out of the layer.
  base::Rng rng(1);
  int move_count = 0;
  for (int round = 0; round < holdfast::test::campaign(400); ++round) {
    model::RobotSpec spec{.support_z = std::nullopt};
    std::set<Cell> taken;
    const std::uint64_t share = 1 + rng.below(7);
    for (std::int32_t x = -3; x <= 3; ++x) {
      for (std::int32_t z = -3; z <= 3; ++z) {
        spec.fixed.push_back({x, -1, z});
        spec.existing.push_back({x, -1, z});
        spec.obstacles.push_back({.from = {x, 1, z}, .to = {x, 1, z}});
        if ((x != 0 || z != 0) && rng.below(8) < share) {
          taken.insert({x, 0, z});
          spec.existing.push_back({x, 0, z});
        }
      }
    }
    spec.existing.push_back({0, 0, 0});
    const std::set<Cell> truth = turned_squares(taken);
    EXPECT_EQ(arrivals_of(state_of(spec), {0, 0, 0}, {.motions = pivoting_cubes()}), truth)
        << round;
    move_count += static_cast<int>(truth.size());
  }
  EXPECT_GE(move_count, holdfast::test::least(100));
}

// --- Balls and discs ----------------------------------------------------------------------------

Place minus(const Place& a, const Place& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

double dot(const Place& a, const Place& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Place cross(const Place& a, const Place& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Whether a ball at `start`, turned about an axis through `centre` in half degrees until it is at
/// `end`, stays a pitch away from all others.
bool gets_there(const Place& centre, Place axis, const Place& start, const Place& end,
                const std::vector<Place>& others) {
  const double length = std::sqrt(dot(axis, axis));
  axis = {axis[0] / length, axis[1] / length, axis[2] / length};
  const Place arm = minus(start, centre);
  const Place across = cross(axis, arm);
  const double along = dot(axis, arm);
  for (int step = 1; step < 720; ++step) {
    const double angle = step * std::numbers::pi / 360;
    Place now{};
    for (std::size_t k = 0; k < 3; ++k) {
      now[k] = centre[k] + arm[k] * std::cos(angle) + across[k] * std::sin(angle) +
               axis[k] * along * (1 - std::cos(angle));
    }
    const Place left = minus(now, end);
    if (dot(left, left) < 1e-4) {
      return true;
    }
    for (const Place& other : others) {
      const Place way = minus(now, other);
      if (dot(way, way) < 1 - 1e-4) {
        return false;
      }
    }
  }
  return false;
}

bool touch(const Place& a, const Place& b) {
  const Place way = minus(a, b);
  return std::abs(dot(way, way) - 1) < 1e-9;
}

/// Whether a ball rolls from one place to another about one of the others or two at once, or a disc
/// in its plane about one.
bool rolls(const Place& start, const Place& end, const std::vector<Place>& others, bool is_disc) {
  std::vector<Place> carriers;
  for (const Place& other : others) {
    if (touch(other, start) && touch(other, end)) {
      carriers.push_back(other);
    }
  }
  for (const Place& one : carriers) {
    const Place normal = cross(minus(start, one), minus(end, one));
    if (gets_there(one, normal, start, end, others)) {
      return true;
    }
    for (const Place& two : carriers) {
      const Place axis = minus(two, one);
      if (!is_disc && dot(axis, axis) > 0.5 && gets_there(one, axis, start, end, others)) {
        return true;
      }
    }
  }
  return false;
}

TEST(Rolling, balls_and_discs_move_where_they_come_nearer_than_a_pitch_to_nobody) {
  base::Rng rng(1);
  int allowed_count = 0;
  int barred_count = 0;
  for (const base::Lattice& lattice : {base::kHexagonal, base::kFaceCentred}) {
    for (int round = 0; round < holdfast::test::campaign(150); ++round) {
      const model::RobotSpec spec = test::grown_robot(lattice, 3 + rng.below(12), rng);
      const RobotState robot = state_of(spec);
      for (const std::int32_t module : loose_modules(robot)) {
        const Cell from = robot.module(module).cell;
        std::vector<Place> others;
        for (const Cell& cell : spec.existing) {
          if (cell != from) {
            others.push_back(base::node_place(lattice, cell));
          }
        }
        const std::set<Cell> arrivals = arrivals_of(robot, from, {});
        for (const Cell& to : arrivals) {
          EXPECT_TRUE(rolls(base::node_place(lattice, from), base::node_place(lattice, to), others,
                            lattice == base::kHexagonal))
              << round;
        }
        for (const model::Step& step : test::moves_of(robot, from)) {
          const Cell& to = step.moves.front().to;
          const bool is_allowed =
              rolls(base::node_place(lattice, from), base::node_place(lattice, to), others,
                    lattice == base::kHexagonal);
          // Around a corner a move also needs a free cell beside it, as in all lattices.
          const bool is_slide =
              touch(base::node_place(lattice, from), base::node_place(lattice, to));
          EXPECT_TRUE(arrivals.contains(to) ? is_allowed : !is_allowed || !is_slide)
              << round << ": " << model::text(from) << " to " << model::text(to);
          (is_allowed ? allowed_count : barred_count) += 1;
        }
      }
    }
  }

  EXPECT_GE(allowed_count, holdfast::test::least(1000));
  EXPECT_GE(barred_count, holdfast::test::least(100));
}

// --- Prisms -------------------------------------------------------------------------------------

using Complex = std::complex<double>;
using Corners = std::array<Complex, 6>;

Complex flat(const Cell& axial) {
  const auto place = base::place_of<double>(base::kHexagonalPrism, axial);
  return {place[0], place[1]};
}

/// The hexagon of the cell at the origin, whose neighbours lie opposite its sides.
Corners hexagon() {
  const Complex corner = (flat({1, 0, 0}) + flat({0, 1, 0})) / 3.0;
  Corners corners;
  for (std::size_t k = 0; k < 6; ++k) {
    corners[k] = corner * std::polar(1.0, static_cast<double>(k) * std::numbers::pi / 3);
  }
  return corners;
}

/// The overlap of two hexagons along the one of their normals along which it is least.
double overlap(const Corners& a, const Corners& b) {
  double least = 1e300;
  for (const Corners& sides : {a, b}) {
    for (std::size_t k = 0; k < 6; ++k) {
      const Complex side = sides[(k + 1) % 6] - sides[k];
      const auto range = [&](const Corners& corners) {
        std::array<double, 6> along{};
        std::ranges::transform(corners, along.begin(), [&](const Complex& c) {
          return (std::conj(side * Complex(0, 1)) * c).real() / std::abs(side);
        });
        return std::ranges::minmax(along);
      };
      const auto [a_low, a_high] = range(a);
      const auto [b_low, b_high] = range(b);
      least = std::min({least, a_high - b_low, b_high - a_low});
    }
  }
  return least;
}

/// Whether a prism, turned by a degree at a time by a third about the corner that its cell, the
/// next and the carrier's share, overlaps nobody.
bool turns_freely(const Cell& from, const Cell& to, const Cell& carrier,
                  const std::set<Cell>& taken) {
  const Complex hinge = (flat(from) + flat(to) + flat(carrier)) / 3.0;
  const double sense = std::arg((flat(to) - hinge) / (flat(from) - hinge)) > 0 ? 1 : -1;
  for (int degrees = 0; degrees <= 120; ++degrees) {
    Corners turned = hexagon();
    for (Complex& corner : turned) {
      corner = hinge + (flat(from) + corner - hinge) *
                           std::polar(1.0, sense * degrees * std::numbers::pi / 180);
    }
    for (const Cell& cell : taken) {
      Corners other = hexagon();
      std::ranges::for_each(other, [&](Complex& corner) { corner += flat(cell); });
      if (overlap(turned, other) > 1e-6) {
        return false;
      }
    }
  }
  return true;
}

/// Where the prism at the origin gets in its layer: by a slide where nobody is beside its way, by a
/// turn about a corner, or by two about the same module.
std::set<Cell> turned_prisms(const std::set<Cell>& taken) {
  const std::array<Cell, 6> round = {
      {{1, 0, 0}, {0, 1, 0}, {-1, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {1, -1, 0}}};
  const auto plus = [](const Cell& a, const Cell& b) { return Cell{a.x + b.x, a.y + b.y, 0}; };
  std::set<Cell> arrivals;
  for (std::size_t k = 0; k < 6; ++k) {
    if (!taken.contains(round[k]) && !taken.contains(round[(k + 1) % 6]) &&
        !taken.contains(round[(k + 5) % 6])) {
      arrivals.insert(round[k]);
    }
    if (!taken.contains(round[k])) {
      continue;
    }
    // The origin lies from the carrier as round[k + 3] does.
    for (const std::size_t way : {1U, 5U}) {
      const Cell next = plus(round[k], round[(k + 3 + way) % 6]);
      const Cell last = plus(round[k], round[(k + 3 + 2 * way) % 6]);
      if (turns_freely({0, 0, 0}, next, round[k], taken)) {
        arrivals.insert(next);
        if (turns_freely(next, last, round[k], taken)) {
          arrivals.insert(last);
        }
      }
    }
  }
  return arrivals;
}

TEST(Rolling, a_prism_turns_where_its_corners_meet_nobody) {
  base::Rng rng(1);
  int move_count = 0;
  for (int round = 0; round < holdfast::test::campaign(100); ++round) {
    model::RobotSpec spec{.support_z = std::nullopt, .lattice = base::kHexagonalPrism};
    std::set<Cell> taken;
    const std::uint64_t share = 1 + rng.below(6);
    for (std::int32_t x = -3; x <= 3; ++x) {
      for (std::int32_t y = -3; y <= 3; ++y) {
        spec.fixed.push_back({x, y, -1});
        spec.existing.push_back({x, y, -1});
        spec.obstacles.push_back({.from = {x, y, 1}, .to = {x, y, 1}});
        if ((x != 0 || y != 0) && rng.below(8) < share) {
          taken.insert({x, y, 0});
          spec.existing.push_back({x, y, 0});
        }
      }
    }
    spec.existing.push_back({0, 0, 0});
    const std::set<Cell> truth = turned_prisms(taken);
    EXPECT_EQ(arrivals_of(state_of(spec), {0, 0, 0}, {}), truth) << round;
    move_count += static_cast<int>(truth.size());
  }
  EXPECT_GE(move_count, holdfast::test::least(30));
}

}  // namespace
}  // namespace holdfast::plan
