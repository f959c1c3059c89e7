// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "touching.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace holdfast::large {
namespace {

using mechanics::Pose;
using mechanics::Vector3;

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Distances above this share of the pitch are not told.
constexpr double kNear = 0.1;

/// Bodies that do not touch at rest are at least so many pitches apart (second neighbours of a
/// face-centred lattice: 0.41).
constexpr double kApartAtRest = 0.4;

/// Bodies that are nearer than this share of the pitch touch at rest.
constexpr double kTouching = 1e-6;

/// The radius of the ball around any of the bodies, in pitches, that of a cube; of the longest
/// pitch where they differ.
constexpr double kRadius = 0.8661;

double dot(const Vector3& a, const Vector3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vector3 difference(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A vector in the body of a module that is turned.
Vector3 in_body(const Pose& pose, const Vector3& vector) {
  const auto& q = pose.rotation;
  return mechanics::rotated({q[0], -q[1], -q[2], -q[3]}, vector);
}

/// The modules by the cells of a grid in which they are now.
class Grid {
 public:
  Grid(std::span<const Vector3> centres, double width) : width_(width) {
    for (std::size_t i = 0; i < centres.size(); ++i) {
      entries_.emplace_back(key(centres[i], {0, 0, 0}), i);
    }
    std::ranges::sort(entries_);
  }

  /// Calls take(index) for all in the 27 cells around a centre.
  template <class Take>
  void for_each_near(const Vector3& centre, const Take& take) const {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        for (int z = -1; z <= 1; ++z) {
          const Key here = key(centre, {x, y, z});
          auto entry = std::ranges::lower_bound(entries_, std::pair(here, std::size_t{0}));
          for (; entry != entries_.end() && entry->first == here; ++entry) {
            take(entry->second);
          }
        }
      }
    }
  }

 private:
  using Key = std::array<std::int64_t, 3>;

  Key key(const Vector3& centre, const std::array<int, 3>& shift) const {
    Key key{};
    for (std::size_t i = 0; i < 3; ++i) {
      key[i] = static_cast<std::int64_t>(std::floor(centre[i] / width_)) + shift[i];
    }
    return key;
  }

  double width_;
  std::vector<std::pair<Key, std::size_t>> entries_;
};

}  // namespace

Bodies::Bodies(const model::Robot& robot, std::span<const model::Obstacle> obstacles)
    : robot_(robot),
      pitch_(robot.material().pitch_mm),
      obstacles_(obstacles.begin(), obstacles.end()),
      obstacle_index_(obstacles_) {
  const base::Lattice shape = base::unstretched(robot.lattice());
  if (shape == base::kFaceCentred) {
    shape_ = Shape::kSphere;
  } else if (shape == base::kHexagonal) {
    shape_ = Shape::kDisc;
  } else if (shape == base::kHexagonalPrism) {
    shape_ = Shape::kPrism;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const base::Cell one = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
    sides_[axis] = base::can_stretch(shape, axis) ? base::place_of(robot.lattice(), one)[axis] : 1;
  }
  radius_ = kRadius * pitch_ * *std::ranges::max_element(sides_);
  const base::NodePlaces place(robot.lattice(), pitch_);
  for (const model::Module& module : robot.modules()) {
    places_.push_back(place(module.cell));
  }
}

Vector3 Bodies::centre(std::size_t module, const Pose& pose) const {
  Vector3 centre = places_[module];
  for (std::size_t i = 0; i < 3; ++i) {
    centre[i] += pose.displacement[i];
  }
  return centre;
}

/// Half the extent of a module along a direction of length 1, mm.
double Bodies::half_width(const Pose& pose, const Vector3& direction) const {
  const Vector3 d = in_body(pose, direction);
  double extent = 1;  // Of a sphere, in half pitches.
  if (shape_ == Shape::kCube) {
    extent = sides_[0] * std::abs(d[0]) + sides_[1] * std::abs(d[1]) + sides_[2] * std::abs(d[2]);
  } else if (shape_ == Shape::kDisc) {
    extent = std::sqrt(d[0] * d[0] + d[2] * d[2]) + std::abs(d[1]);
  } else if (shape_ == Shape::kPrism) {  // A hexagon with corners at 30 degrees, and its height.
    const double side = std::numbers::sqrt3 / 2 * std::abs(d[0]) + std::abs(d[1]) / 2;
    extent = 2 / std::numbers::sqrt3 * std::max(side, std::abs(d[1])) + sides_[2] * std::abs(d[2]);
  }
  return pitch_ / 2 * extent;
}

Gap Bodies::above_floor(std::span<const Pose> poses) const {
  Gap least{.mm = kInfinite};
  if (!robot_.has_floor()) {
    return least;
  }
  const base::NodePlaces place(robot_.lattice(), pitch_);
  const double floor =
      place({0, 0, robot_.support_z()})[2] - robot_.step_mm(base::down(robot_.lattice())) / 2;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (robot_.modules()[i].cell.z <= robot_.support_z()) {
      continue;
    }
    const double height =
        places_[i][2] + poses[i].displacement[2] - half_width(poses[i], {0, 0, 1}) - floor;
    if (height < least.mm) {
      least = {.mm = height, .modules = {i}};
    }
  }
  return least;
}

/// The normals of the faces of a body.
std::vector<Vector3> Bodies::own_axes(const Pose& pose) const {
  constexpr double kHalf = 0.5;
  constexpr double kRoot = std::numbers::sqrt3 / 2;
  std::vector<Vector3> axes;
  if (shape_ == Shape::kCube) {
    axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  } else if (shape_ == Shape::kDisc) {
    axes = {{0, 1, 0}};
  } else if (shape_ == Shape::kPrism) {
    axes = {{1, 0, 0}, {kHalf, kRoot, 0}, {-kHalf, kRoot, 0}, {0, 0, 1}};
  }
  for (Vector3& axis : axes) {
    axis = mechanics::rotated(pose.rotation, axis);
  }
  return axes;
}

/// The largest distance between planes across one of the directions that separate two bodies.
double Bodies::separation(const Pose& a, const Vector3& at_a, const Pose& b,
                          const Vector3& at_b) const {
  const Vector3 between = difference(at_b, at_a);
  std::vector<Vector3> axes = own_axes(a);
  const std::vector<Vector3> others = own_axes(b);
  const std::size_t count = axes.size();
  axes.insert(axes.end(), others.begin(), others.end());
  for (std::size_t i = 0; i < count; ++i) {
    for (const Vector3& other : others) {
      axes.push_back(cross(axes[i], other));
    }
  }
  axes.push_back(between);
  double widest = -kInfinite;
  for (const Vector3& axis : axes) {
    const double length = std::sqrt(dot(axis, axis));
    if (length < 1e-6) {  // Parallel edges have no common normal.
      continue;
    }
    const Vector3 d = {axis[0] / length, axis[1] / length, axis[2] / length};
    widest = std::max(widest, std::abs(dot(d, between)) - half_width(a, d) - half_width(b, d));
  }
  return widest;
}

Gap Bodies::between_bodies(std::span<const Pose> poses) const {
  Gap least{.mm = kInfinite};
  double way = 0;
  for (const Pose& pose : poses) {
    const Vector3 turn = mechanics::rotation_vector(pose.rotation);
    way = std::max(way, std::sqrt(dot(pose.displacement, pose.displacement)) +
                            radius_ * std::sqrt(dot(turn, turn)));
  }
  if (2 * way < (kApartAtRest - kNear) * pitch_) {
    return least;
  }
  std::vector<Vector3> centres;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    centres.push_back(centre(i, poses[i]));
  }
  add_modules(poses, centres, least);
  if (!obstacles_.empty()) {
    add_obstacles(poses, centres, least);
  }
  return least;
}

void Bodies::add_modules(std::span<const Pose> poses, std::span<const Vector3> centres,
                         Gap& least) const {
  const double reach = 2 * radius_ + kNear * pitch_;
  const Grid grid(centres, reach);
  const Pose rest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    grid.for_each_near(centres[i], [&](std::size_t k) {
      const Vector3 between = difference(centres[k], centres[i]);
      if (k <= i || dot(between, between) > reach * reach ||
          separation(rest, places_[i], rest, places_[k]) < kTouching * pitch_) {
        return;
      }
      const double mm = separation(poses[i], centres[i], poses[k], centres[k]);
      if (mm < kNear * pitch_ && mm < least.mm) {
        least = {.mm = mm, .modules = {i, k}};
      }
    });
  }
}

/// The cell whose node is near a place, mm: b1 lies along x, b2 is level.
base::Cell Bodies::cell_at(const Vector3& place) const {
  const base::Lattice& lattice = robot_.lattice();
  const auto basis = [&](std::size_t i, std::size_t k) {
    return pitch_ * base::root(lattice.basis_squares[i][k]);
  };
  const double z = place[2] / basis(2, 2);
  const double y = (place[1] - z * basis(2, 1)) / basis(1, 1);
  const double x = (place[0] - z * basis(2, 0) - y * basis(1, 0)) / basis(0, 0);
  return {static_cast<std::int32_t>(std::lround(x)), static_cast<std::int32_t>(std::lround(y)),
          static_cast<std::int32_t>(std::lround(z))};
}

void Bodies::add_obstacles(std::span<const Pose> poses, std::span<const Vector3> centres,
                           Gap& least) const {
  constexpr std::int32_t kAround = 2;
  const base::NodePlaces place(robot_.lattice(), pitch_);
  const Pose rest;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const base::Cell middle = cell_at(centres[i]);  // Axial.
    for (std::int32_t x = -kAround; x <= kAround; ++x) {
      for (std::int32_t y = -kAround; y <= kAround; ++y) {
        for (std::int32_t z = -kAround; z <= kAround; ++z) {
          const base::Cell cell =
              base::cell_of(robot_.lattice(), {middle.x + x, middle.y + y, middle.z + z});
          if (obstacle_index_.find(cell) == model::CellIndex::kNone ||
              separation(rest, places_[i], rest, place(cell)) < kTouching * pitch_) {
            continue;
          }
          const double mm = separation(poses[i], centres[i], rest, place(cell));
          if (mm < kNear * pitch_ && mm < least.mm) {
            least = {.mm = mm, .modules = {i}};
          }
        }
      }
    }
  }
}

}  // namespace holdfast::large
