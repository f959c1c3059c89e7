// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/body_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "shapes/ball_cover.hpp"

namespace holdfast::io {
namespace {

constexpr int kDiscCorners = 24;

/// The cosine up to which a face's normal is turned so little towards the eye that it is seen
/// edge-on.
constexpr double kEdgeOn = 1e-9;

std::vector<SeenFace> seen(const std::vector<ShapeFace>& faces, const ViewAxes& axes) {
  std::vector<SeenFace> all;
  for (const ShapeFace& face : faces) {
    if (axes.nearness(face.normal) > kEdgeOn) {
      SeenFace seen_face = {.normal = face.normal, .corners = {}, .direction = face.direction};
      std::ranges::transform(face.corners, std::back_inserter(seen_face.corners),
                             [&](const Place& corner) { return axes.seen_at(corner); });
      all.push_back(std::move(seen_face));
    }
  }
  return all;
}

/// The corner `i` of the circle around a disc's face that is at y.
Place disc_corner(double i, double y) {
  const double angle = 2 * std::numbers::pi * i / kDiscCorners;
  return {0.5 * std::cos(angle), y, 0.5 * std::sin(angle)};
}

/// A disc is its rim, all of it that is seen, and the flat side that is. The rim runs from one of
/// that side's two outermost points, at right angles to the disc's axis on the picture, to the
/// other and back along the far side.
std::vector<SeenFace> disc_faces(const ViewAxes& axes) {
  const double side = axes.eye[1] > kEdgeOn ? 1 : -1;
  const double near = side * kDiscDepth / 2;
  std::vector<SeenFace> faces;
  if (std::abs(axes.eye[0]) + std::abs(axes.eye[2]) > kEdgeOn) {
    SeenFace rim = {.normal = {1, 0, 0}, .corners = {}, .direction = {}};
    constexpr int kHalf = kDiscCorners / 2;
    constexpr int kQuarter = kHalf / 2;
    // The eye sees the rim a quarter of the circle on either side of its own direction.
    const double middle = std::atan2(axes.eye[2], axes.eye[0]) * kHalf / std::numbers::pi;
    for (int i = 0; i <= kHalf; ++i) {
      rim.corners.push_back(axes.seen_at(disc_corner(middle + i - kQuarter, near)));
    }
    for (int i = kHalf; i >= 0; --i) {
      rim.corners.push_back(axes.seen_at(disc_corner(middle + i - kQuarter, -near)));
    }
    faces.push_back(std::move(rim));
  }
  if (std::abs(axes.eye[1]) > kEdgeOn) {
    SeenFace front = {.normal = {0, side, 0}, .corners = {}, .direction = {}};
    for (int i = 0; i < kDiscCorners; ++i) {
      front.corners.push_back(axes.seen_at(disc_corner(i, near)));
    }
    faces.push_back(std::move(front));
  }
  return faces;
}

/// The nearest and the furthest module that is seen near each place of the picture.
class Depths {
 public:
  explicit Depths(const ViewAxes& axes) : axes_(axes) {}

  void add(const Place& place) {
    for_squares(place, [&](std::int64_t key) {
      auto [found, is_new] = depths_.try_emplace(key, axes_.nearness(place), axes_.nearness(place));
      auto& [furthest, nearest] = found->second;
      furthest = std::min(furthest, axes_.nearness(place));
      nearest = std::max(nearest, axes_.nearness(place));
    });
  }

  Layer layer_of(const Place& place) const {
    bool is_behind = true;
    bool is_in_front = true;
    for_squares(place, [&](std::int64_t key) {
      if (const auto found = depths_.find(key); found != depths_.end()) {
        is_behind = is_behind && axes_.nearness(place) <= found->second.first;
        is_in_front = is_in_front && axes_.nearness(place) >= found->second.second;
      }
    });
    return is_behind ? Layer::kBehind : is_in_front ? Layer::kInFront : Layer::kAmong;
  }

 private:
  /// Squares of an edge's length that a body may cover: none is further seen from its node.
  template <class Use>
  void for_squares(const Place& place, Use use) const {
    const ScreenPoint at = axes_.seen_at(place);
    for (double y = std::floor(at.y - 1); y <= at.y + 1; ++y) {
      for (double x = std::floor(at.x - 1); x <= at.x + 1; ++x) {
        use(static_cast<std::int64_t>(y) * kRowLength + static_cast<std::int64_t>(x));
      }
    }
  }

  static constexpr std::int64_t kRowLength = std::int64_t{1} << 32U;

  ViewAxes axes_;
  std::unordered_map<std::int64_t, std::pair<double, double>> depths_;  ///< Only ever asked.
};

/// An index of the modules that hide what is behind them: planned ones are glass.
model::CellIndex existing_cells(const model::Robot& robot) {
  const std::size_t count = robot.modules().size() - robot.planned_count();
  model::CellIndex cells(count);
  for (std::size_t i = 0; i < count; ++i) {
    cells.insert(robot.modules()[i].cell, static_cast<std::int32_t>(i));
  }
  return cells;
}

std::uint16_t all_faces(std::span<const SeenFace> faces) {
  return static_cast<std::uint16_t>((1U << faces.size()) - 1);
}

std::uint16_t bit(std::size_t face) { return static_cast<std::uint16_t>(1U << face); }

}  // namespace

std::vector<SeenFace> seen_faces(const base::Lattice& lattice, const ViewAxes& axes) {
  switch (body_of(lattice)) {
    case Body::kBall:
      return {};
    case Body::kDisc:
      return disc_faces(axes);
    case Body::kCell:
      break;
  }
  return seen_cell_faces(lattice, axes);
}

std::vector<SeenFace> seen_cell_faces(const base::Lattice& lattice, const ViewAxes& axes) {
  return seen(cell_faces(lattice), axes);
}

BodyView::BodyView(const model::Robot& robot, NearObstacles obstacles, const ViewAxes& axes)
    : robot_(robot),
      obstacles_(std::move(obstacles)),
      axes_(axes),
      body_(body_of(robot.lattice())),
      module_faces_(seen_faces(robot.lattice(), axes)),
      obstacle_faces_(seen_cell_faces(robot.lattice(), axes)) {
  add_modules();
  add_obstacles();
  sort_obstacles_into_layers();
  std::ranges::sort(items_, {}, [](const BodyItem& item) {
    return std::tuple(item.layer, item.nearness, item.is_obstacle, item.index);
  });
}

/// Finds the hidden faces of a module that fills its cell. A face between two existing modules, or
/// between two planned ones, is not drawn; where one of each kind meet, the existing module's face
/// is.
std::uint16_t BodyView::faces_hidden_by_neighbours(std::size_t module) const {
  std::uint16_t hidden = 0;
  for (std::size_t face = 0; face < module_faces_.size(); ++face) {
    const auto direction = module_faces_[face].direction;
    const std::int32_t neighbour =
        direction ? robot_.neighbours()[module][static_cast<std::size_t>(base::index(*direction))]
                  : model::Robot::kNoNeighbour;
    if (neighbour != model::Robot::kNoNeighbour &&
        (robot_.modules()[module].is_planned ||
         !robot_.modules()[static_cast<std::size_t>(neighbour)].is_planned)) {
      hidden |= bit(face);
    }
  }
  return hidden;
}

void BodyView::add_modules() {
  const auto add = [&](std::size_t module, std::uint16_t hidden_faces) {
    BodyItem item = {.index = static_cast<std::uint32_t>(module), .hidden_faces = hidden_faces};
    item.nearness = axes_.nearness(place_of(item));
    items_.push_back(item);
  };
  if (body_ == Body::kBall) {
    const BallCover cover(robot_.lattice(), axes_);
    const model::CellIndex existing = existing_cells(robot_);
    for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
      if (!cover.hides(existing, robot_.modules()[i].cell)) {
        add(i, 0);
      }
    }
    return;
  }
  for (std::size_t i = 0; i < robot_.modules().size(); ++i) {
    const std::uint16_t hidden =
        body_ == Body::kCell ? faces_hidden_by_neighbours(i) : std::uint16_t{0};
    if (hidden != all_faces(module_faces_)) {
      add(i, hidden);
    }
  }
}

void BodyView::add_obstacles() {
  model::CellIndex cells(obstacles_.cells.size());
  for (const ObstacleCell& obstacle : obstacles_.cells) {
    cells.insert(obstacle.cell, 0);
  }
  for (std::size_t i = 0; i < obstacles_.cells.size(); ++i) {
    BodyItem item = {.index = static_cast<std::uint32_t>(i), .is_obstacle = true};
    for (std::size_t face = 0; face < obstacle_faces_.size(); ++face) {
      const auto direction = obstacle_faces_[face].direction;
      if (direction && cells.find(base::neighbour(robot_.lattice(), obstacles_.cells[i].cell,
                                                  *direction)) != model::CellIndex::kNone) {
        item.hidden_faces |= bit(face);
      }
    }
    if (item.hidden_faces != all_faces(obstacle_faces_)) {
      item.nearness = axes_.nearness(place_of(item));
      items_.push_back(item);
    }
  }
}

void BodyView::sort_obstacles_into_layers() {
  if (obstacles_.cells.empty()) {
    return;
  }
  Depths depths(axes_);
  for (const BodyItem& item : items_) {
    if (!item.is_obstacle) {
      depths.add(place_of(item));
    }
  }
  for (BodyItem& item : items_) {
    if (item.is_obstacle) {
      item.layer = depths.layer_of(place_of(item));
    }
  }
}

base::Cell BodyView::cell_of(const BodyItem& item) const {
  return item.is_obstacle ? obstacles_.cells[item.index].cell : robot_.modules()[item.index].cell;
}

Place BodyView::place_of(const BodyItem& item) const {
  return base::node_place(robot_.lattice(), cell_of(item));
}

}  // namespace holdfast::io
