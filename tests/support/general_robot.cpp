// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "general_robot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>

#include "holdfast/base/rng.hpp"
#include "holdfast/model/lattice_beam.hpp"

namespace holdfast::test {
namespace {

using base::Cell;
using base::Direction;
using Matrix = std::array<std::array<double, 3>, 3>;
using Vector = std::array<double, 3>;

constexpr double kTie = 1e-9;

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector times(const Matrix& matrix, const Vector& vector) {
  return {dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)};
}

Direction any_direction(const base::Lattice& lattice, base::Rng& rng) {
  return static_cast<Direction>(rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
}

double between(double low, double high, base::Rng& rng) {
  return low + (high - low) * static_cast<double>(rng.below(1000)) / 1000;
}

constexpr std::int32_t kNoFloor = std::numeric_limits<std::int32_t>::min();

std::vector<Cell> grown(const base::Lattice& lattice, std::size_t count, base::Rng& rng,
                        std::int32_t lowest = kNoFloor) {
  std::vector<Cell> cells = {{0, 0, 0}};
  std::set<Cell> taken = {cells.front()};
  while (cells.size() < count) {
    const Cell& from = cells[rng.below(cells.size())];
    const Cell next = base::neighbour(lattice, from, any_direction(lattice, rng));
    if (next.z >= lowest && taken.insert(next).second) {
      cells.push_back(next);
    }
  }
  return cells;
}

bool is_fixed(Fixed fixed, bool is_first, bool is_last, base::Rng& rng) {
  switch (fixed) {
    case Fixed::kAll:
      return true;
    case Fixed::kAllButOne:
      return !is_last;
    case Fixed::kSome:
      return rng.below(2) == 0;
    case Fixed::kFirst:
      break;
  }
  return is_first;
}

/// Free cells beside the robot, each an obstacle of its own kind.
std::vector<model::Obstacle> obstacles_beside(const base::Lattice& lattice,
                                              const std::vector<Cell>& cells, base::Rng& rng) {
  const std::set<Cell> taken(cells.begin(), cells.end());
  std::set<Cell> chosen;
  std::vector<model::Obstacle> obstacles;
  const std::size_t count = 1 + rng.below(6);
  const bool may_be_bonded = rng.below(3) == 0;
  for (int attempt = 0; attempt < 100 && obstacles.size() < count; ++attempt) {
    const Cell& from = cells[rng.below(cells.size())];
    const Cell next = base::neighbour(lattice, from, any_direction(lattice, rng));
    if (taken.contains(next) || !chosen.insert(next).second) {
      continue;
    }
    const bool is_bonded = may_be_bonded && rng.below(2) == 0;
    obstacles.push_back(
        {.from = {},
         .to = {},
         .cells = {next},
         .touch = {.hold = is_bonded ? model::Hold::kBonded : model::Hold::kContact}});
  }
  return obstacles;
}

Matrix basis_of(const base::Lattice& lattice) {
  Matrix columns{};
  for (int i = 0; i < 3; ++i) {
    const Cell axial = {i == 0 ? 1 : 0, i == 1 ? 1 : 0, i == 2 ? 1 : 0};
    const auto place = base::place_of(lattice, axial);
    for (std::size_t k = 0; k < 3; ++k) {
      columns[k][static_cast<std::size_t>(i)] = place[k];
    }
  }
  return columns;
}

Matrix product(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k) {
        c[i][j] += a[i][k] * b[k][j];
      }
    }
  }
  return c;
}

double determinant(const Matrix& m) {
  return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) -
         m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
         m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
}

Matrix inverse(const Matrix& m) {
  const double d = determinant(m);
  Matrix result{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t a = (j + 1) % 3;
      const std::size_t b = (j + 2) % 3;
      const std::size_t c = (i + 1) % 3;
      const std::size_t e = (i + 2) % 3;
      result[i][j] = (m[a][c] * m[b][e] - m[a][e] * m[b][c]) / d;
    }
  }
  return result;
}

model::ConnectorLaw any_law(double pitch_mm, base::Rng& rng) {
  const auto has = [&](std::uint64_t one_in) { return rng.below(one_in) == 0; };
  model::ConnectorLaw law;
  // Seldom nothing but shear and torsion is limited.
  if (!has(6)) {
    law.strength_n = between(2, 30, rng);
  }
  law.lever_mm = between(0.2, 0.6, rng) * pitch_mm;
  law.bending = has(2) ? model::BendingLaw::kRound : model::BendingLaw::kSquare;
  if (has(2)) {
    law.shear_strength_n = between(2, 30, rng);
  }
  if (has(2)) {
    law.torsion_strength_nmm = between(20, 600, rng);
  }
  if (has(3)) {
    law.friction = between(0.2, 1.5, rng);
    law.torsion_radius_mm =
        has(3) ? model::ConnectorLaw::kUnlimited : between(0.2, 0.6, rng) * pitch_mm;
  }
  if (has(2)) {
    law.gap_limit_mm = between(0.0001, 0.1, rng);
  }
  return law;
}

/// One law for all directions, one for vertical and one for lateral ones, or one for each.
model::ModuleKind any_kind(const base::Lattice& lattice, double pitch_mm, base::Rng& rng) {
  model::ModuleKind kind{.name = "a kind", .mass_kg = between(0.02, 0.1, rng)};
  const std::uint64_t how = rng.below(3);
  const model::ConnectorLaw vertical = any_law(pitch_mm, rng);
  const model::ConnectorLaw lateral = how == 0 ? vertical : any_law(pitch_mm, rng);
  for (const Direction direction : base::directions(lattice)) {
    const bool is_vertical =
        base::connector_class(lattice, direction) == base::ConnectorClass::kVertical;
    kind.connectors.push_back(how == 2 ? any_law(pitch_mm, rng) : is_vertical ? vertical : lateral);
  }
  return kind;
}

bool is_orthogonal(const Matrix& m) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      if (std::abs(dot(m[i], m[j]) - (i == j ? 1 : 0)) > kTie) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

model::RobotSpec general_robot(const base::Lattice& lattice, std::uint64_t seed) {
  base::Rng rng(seed);
  model::RobotSpec spec;
  spec.lattice = lattice;
  spec.support_z = std::nullopt;
  spec.existing = grown(lattice, 2 + rng.below(23), rng);
  spec.obstacles = obstacles_beside(lattice, spec.existing, rng);
  if (rng.below(5) == 0 || spec.obstacles.empty()) {
    spec.fixed = {spec.existing[rng.below(spec.existing.size())]};
  }
  if (rng.below(2) == 0) {
    spec.gravity_m_s2 = {between(-4, 4, rng), between(-4, 4, rng), between(-12, -8, rng)};
  }
  for (const Cell& cell : spec.existing) {
    if (rng.below(4) == 0) {
      spec.own_masses.push_back({cell, between(0.02, 0.2, rng)});
    }
    if (rng.below(12) == 0) {
      spec.payloads.push_back({cell,
                               {between(-1, 1, rng), between(-1, 1, rng), between(-1, 1, rng)},
                               {between(-9, 9, rng), between(-9, 9, rng), between(-9, 9, rng)}});
    }
  }
  return spec;
}

model::RobotSpec held_robot(const base::Lattice& lattice, std::uint64_t seed, Fixed fixed) {
  base::Rng rng(seed ^ 0x4e1dU);
  const std::size_t existing = 2 + rng.below(6);
  const std::size_t planned = 2 + rng.below(6);
  model::RobotSpec spec;
  spec.lattice = lattice;
  for (const Cell& cell : grown(lattice, existing + planned, rng, 0)) {
    (spec.existing.size() < existing ? spec.existing : spec.planned).push_back(cell);
  }
  for (const Cell& cell : spec.existing) {
    if (is_fixed(fixed, cell == spec.existing.front(), cell == spec.existing.back(), rng)) {
      spec.fixed.push_back(cell);
    }
  }
  if (seed % 2 == 1) {
    spec.material.pitch_mm = 10;
    spec.material.facet_mm = 9;
  }
  return spec;
}

model::RobotSpec with_last_planned(model::RobotSpec spec, std::size_t count) {
  for (std::size_t k = 0; k < count && spec.existing.size() > 2; ++k) {
    if (!spec.fixed.empty() && spec.fixed.front() == spec.existing.back()) {
      break;
    }
    spec.planned.push_back(spec.existing.back());
    spec.existing.pop_back();
  }
  return spec;
}

model::RobotSpec with_laws(model::RobotSpec spec, std::uint64_t seed) {
  base::Rng rng(seed ^ 0x1a35U);
  const std::uint64_t kinds = 2 + rng.below(2);
  for (std::uint64_t k = 0; k < kinds; ++k) {
    spec.kinds.push_back(any_kind(spec.lattice, spec.material.pitch_mm, rng));
    spec.kinds.back().name += std::to_string(k);
  }
  for (const std::vector<Cell>* cells : {&spec.existing, &spec.planned}) {
    for (const Cell& cell : *cells) {
      const auto kind = static_cast<std::uint16_t>(rng.below(kinds));
      if (kind > 0) {
        spec.own_kinds.push_back({.cell = cell, .kind = kind});
      }
    }
  }
  return spec;
}

model::RobotSpec with_friction(model::RobotSpec spec, std::uint64_t seed) {
  base::Rng rng(seed ^ 0xf21cU);
  for (model::Obstacle& obstacle : spec.obstacles) {
    if (rng.below(4) != 0 && obstacle.touch.hold == model::Hold::kContact) {
      obstacle.touch.friction = between(0.1, 3, rng);
    }
  }
  if (rng.below(4) != 0) {
    spec.floor.friction = between(0.05, 1, rng);
  }
  return spec;
}

model::RobotSpec with_strengths_times(model::RobotSpec spec, double factor) {
  if (spec.kinds.empty()) {
    spec.material.strength_vertical_n *= factor;
    spec.material.strength_lateral_n *= factor;
  }
  const auto scale = [&](model::ConnectorLaw& law) {
    law.strength_n *= factor;
    law.shear_strength_n *= factor;
    law.torsion_strength_nmm *= factor;
  };
  for (model::ModuleKind& kind : spec.kinds) {
    std::ranges::for_each(kind.connectors, scale);
  }
  std::ranges::for_each(spec.own_connectors, scale, &model::OwnConnector::law);
  return spec;
}

model::RobotSpec on_a_floor(model::RobotSpec spec, bool has_loads) {
  std::int32_t lowest = spec.existing.front().z;
  for (const Cell& cell : spec.existing) {
    lowest = std::min(lowest, cell.z);
  }
  spec.support_z = lowest;
  spec.obstacles.clear();
  spec.fixed.clear();
  spec.gravity_m_s2.reset();
  if (!has_loads) {
    spec.payloads.clear();
    spec.own_masses.clear();
  }
  return spec;
}

Cell Symmetry::operator()(const base::Lattice& lattice, const Cell& cell) const {
  const Cell from = base::axial_of(lattice, cell);
  const auto row = [&](std::size_t i) {
    return axial[i][0] * from.x + axial[i][1] * from.y + axial[i][2] * from.z;
  };
  return base::cell_of(lattice, {row(0), row(1), row(2)});
}

base::Vec6<double> Symmetry::operator()(const base::Vec6<double>& vector) const {
  const double sign = is_mirror ? -1 : 1;
  const Vector moved = times(matrix, {vector[0], vector[1], vector[2]});
  const Vector rotated = times(matrix, {vector[3], vector[4], vector[5]});
  return {moved[0], moved[1], moved[2], sign * rotated[0], sign * rotated[1], sign * rotated[2]};
}

/// Integer matrices with small entries that are orthogonal in the global frame and take neighbours
/// to neighbours.
std::vector<Symmetry> symmetries(const base::Lattice& lattice) {
  const Matrix basis = basis_of(lattice);
  const Matrix back = inverse(basis);
  std::set<Cell> steps;
  for (const Direction direction : base::directions(lattice)) {
    steps.insert(lattice.steps[static_cast<std::size_t>(base::index(direction))]);
  }
  std::vector<Symmetry> found;
  for (int code = 0; code < 19683; ++code) {  // 3^9
    Symmetry symmetry;
    Matrix axial{};
    int rest = code;
    for (std::size_t i = 0; i < 9; ++i, rest /= 3) {
      symmetry.axial[i / 3][i % 3] = rest % 3 - 1;
      axial[i / 3][i % 3] = rest % 3 - 1;
    }
    symmetry.matrix = product(product(basis, axial), back);
    const auto is_step = [&](const Cell& step) {
      const auto row = [&](std::size_t i) {
        return symmetry.axial[i][0] * step.x + symmetry.axial[i][1] * step.y +
               symmetry.axial[i][2] * step.z;
      };
      return steps.contains({row(0), row(1), row(2)});
    };
    if (!is_orthogonal(symmetry.matrix) || !std::ranges::all_of(steps, is_step)) {
      continue;
    }
    symmetry.is_mirror = determinant(symmetry.matrix) < 0;
    const bool is_identity =
        std::abs(symmetry.matrix[0][0] + symmetry.matrix[1][1] + symmetry.matrix[2][2] - 3) < kTie;
    found.insert(is_identity ? found.begin() : found.end(), symmetry);
  }
  return found;
}

namespace {

/// The direction to which a symmetry turns a direction.
Direction turned(const base::Lattice& lattice, const Symmetry& symmetry, Direction direction) {
  const Cell image = symmetry(lattice, base::neighbour(lattice, {0, 0, 0}, direction));
  for (const Direction other : base::directions(lattice)) {
    if (base::neighbour(lattice, {0, 0, 0}, other) == image) {
      return other;
    }
  }
  std::abort();
}

}  // namespace

namespace {

/// Whether the first `count` cells hang together without the released pairs.
bool is_in_one_piece(const model::RobotSpec& spec, const std::vector<Cell>& cells) {
  std::set<Cell> left(cells.begin(), cells.end());
  std::vector<Cell> reached = {cells.front()};
  left.erase(cells.front());
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const Direction direction : base::directions(spec.lattice)) {
      const Cell next = base::neighbour(spec.lattice, reached[i], direction);
      const auto is_pair = [&](const model::CellPair& pair) {
        return pair == model::CellPair{reached[i], next} ||
               pair == model::CellPair{next, reached[i]};
      };
      if (left.contains(next) && std::ranges::none_of(spec.released, is_pair)) {
        left.erase(next);
        reached.push_back(next);
      }
    }
  }
  return left.empty();
}

}  // namespace

model::RobotSpec with_open_faces(model::RobotSpec spec, std::uint64_t seed) {
  base::Rng rng(seed ^ 0x0fe4U);
  std::vector<Cell> all = spec.existing;
  all.insert(all.end(), spec.planned.begin(), spec.planned.end());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      for (const Direction direction : base::directions(spec.lattice)) {
        if (base::neighbour(spec.lattice, all[i], direction) != all[k]) {
          continue;
        }
        const std::uint64_t choice = rng.below(3);
        if (choice == 0) {
          spec.released.push_back({all[i], all[k]});
          if (!is_in_one_piece(spec, spec.existing) || !is_in_one_piece(spec, all)) {
            spec.released.pop_back();
          }
        } else if (choice == 1) {
          const auto d = static_cast<std::size_t>(base::index(direction));
          model::ConnectorLaw law =
              spec.kinds.empty() ? model::default_kind(spec.material, spec.lattice).connectors[d]
                                 : spec.kinds.front().connectors[d];
          law.strength_n *= between(0.3, 3, rng);
          spec.own_connectors.push_back({{all[i], all[k]}, law});
        }
      }
    }
  }
  return spec;
}

namespace {

/// Grows a body from one of these cells over others of them.
std::vector<Cell> grown_body(const base::Lattice& lattice, const std::set<Cell>& free,
                             std::size_t count, base::Rng& rng) {
  std::vector<Cell> body = {
      *std::next(free.begin(), static_cast<std::ptrdiff_t>(rng.below(free.size())))};
  for (std::size_t tries = 0; tries < 8 * count && body.size() < count; ++tries) {
    const auto direction =
        static_cast<Direction>(rng.below(static_cast<std::uint64_t>(lattice.direction_count)));
    const Cell next = base::neighbour(lattice, body[rng.below(body.size())], direction);
    if (free.contains(next) && std::ranges::find(body, next) == body.end()) {
      body.push_back(next);
    }
  }
  return body;
}

}  // namespace

model::RobotSpec with_bodies(model::RobotSpec spec, std::uint64_t seed, std::size_t most) {
  base::Rng rng(seed ^ 0xb0d7U);
  std::int32_t number = 0;
  for (const auto* const list : {&spec.existing, &spec.planned}) {
    std::set<Cell> free(list->begin(), list->end());
    while (!free.empty()) {
      const std::vector<Cell> body = grown_body(spec.lattice, free, 1 + rng.below(most), rng);
      const auto is_in = [&](const Cell& cell) {
        return std::ranges::find(body, cell) != body.end();
      };
      const auto is_inside = [&](const model::CellPair& pair) {
        return is_in(pair[0]) && is_in(pair[1]);
      };
      std::erase_if(spec.released, is_inside);
      std::erase_if(spec.own_connectors, [&](const auto& own) { return is_inside(own.between); });
      for (std::size_t i = 0; i < body.size(); ++i) {
        free.erase(body[i]);
        for (std::size_t k = 0; k < i; ++k) {
          if (model::direction_between(spec.lattice, body[i], body[k])) {
            spec.own_connectors.push_back(
                {.between = {body[i], body[k]}, .law = {}, .body = number});
          }
        }
      }
      ++number;
    }
  }
  return spec;
}

model::RobotSpec with_strong_bodies(model::RobotSpec spec, double strength_n) {
  for (model::OwnConnector& own : spec.own_connectors) {
    if (own.body != model::OwnConnector::kNoBody) {
      own.body = model::OwnConnector::kNoBody;
      own.law.strength_n = strength_n;
    }
  }
  return spec;
}

model::RobotSpec turned(const model::RobotSpec& spec, const Symmetry& symmetry) {
  model::RobotSpec result = spec;
  const auto turn = [&](Cell& cell) { cell = symmetry(spec.lattice, cell); };
  for (auto* cells : {&result.existing, &result.planned, &result.fixed}) {
    std::ranges::for_each(*cells, turn);
  }
  for (model::Obstacle& obstacle : result.obstacles) {
    std::ranges::for_each(obstacle.cells, turn);
  }
  for (model::OwnMass& own : result.own_masses) {
    turn(own.cell);
  }
  for (model::OwnKind& own : result.own_kinds) {
    turn(own.cell);
  }
  for (model::CellPair& pair : result.released) {
    std::ranges::for_each(pair, turn);
  }
  for (model::OwnConnector& own : result.own_connectors) {
    std::ranges::for_each(own.between, turn);
  }
  for (std::size_t k = 0; k < spec.kinds.size(); ++k) {
    for (const Direction direction : base::directions(spec.lattice)) {
      result.kinds[k]
          .connectors[static_cast<std::size_t>(turned(spec.lattice, symmetry, direction))] =
          spec.kinds[k].connectors[static_cast<std::size_t>(direction)];
    }
  }
  const Vector gravity = spec.gravity_m_s2.value_or(Vector{0, 0, -spec.material.gravity_m_s2});
  result.gravity_m_s2 = times(symmetry.matrix, gravity);
  for (model::Payload& payload : result.payloads) {
    turn(payload.cell);
    payload.force_n = times(symmetry.matrix, payload.force_n);
    payload.torque_nmm = times(symmetry.matrix, payload.torque_nmm);
    if (symmetry.is_mirror) {
      std::ranges::for_each(payload.torque_nmm, [](double& component) { component = -component; });
    }
  }
  return result;
}

bool keeps_frames(const base::Lattice& lattice, const Symmetry& symmetry) {
  for (const Direction direction : base::directions(lattice)) {
    const auto frame = model::rotation_along<double>(lattice, direction);
    const Cell step = lattice.steps[static_cast<std::size_t>(base::index(direction))];
    const Cell image = base::axial_of(lattice, symmetry(lattice, base::cell_of(lattice, step)));
    for (const Direction other : base::directions(lattice)) {
      if (lattice.steps[static_cast<std::size_t>(base::index(other))] != image) {
        continue;
      }
      const auto there = model::rotation_along<double>(lattice, other);
      const Vector x = times(symmetry.matrix, frame[0]);
      if (std::abs(dot(x, there[0])) > kTie && std::abs(dot(x, there[1])) > kTie) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace holdfast::test
