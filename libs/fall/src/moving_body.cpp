// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "moving_body.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace holdfast::fall {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

std::vector<Vector3d> nodes_from(const Body& body, const Vector3d& centre) {
  std::vector<Vector3d> nodes;
  nodes.reserve(body.nodes.size());
  for (const Point& node : body.nodes) {
    nodes.emplace_back(vector_of(node) - centre);
  }
  return nodes;
}

Vector3d centre_of(const Body& body) {
  Vector3d centre = Vector3d::Zero();
  double mass = 0;
  for (std::size_t i = 0; i < body.nodes.size(); ++i) {
    centre += body.masses[i] * vector_of(body.nodes[i]);
    mass += body.masses[i];
  }
  return centre / mass;
}

/// Keeps the two ends of the points on each line along an axis. No other point can touch a plane
/// before them, as it is between two that are left.
std::vector<Vector3d> ends_of_lines(std::vector<Vector3d> points, double unit) {
  const auto key = [unit](const Vector3d& point, int axis) {
    std::array<std::int64_t, 3> line{};
    for (int k = 0; k < 3; ++k) {
      line[static_cast<std::size_t>(k)] = k == axis ? 0 : std::llround(point[k] / unit);
    }
    return line;
  };
  for (int axis = 0; axis < 3; ++axis) {
    std::map<std::array<std::int64_t, 3>, std::array<Vector3d, 2>> ends;
    for (const Vector3d& point : points) {
      auto& [low, high] =
          ends.try_emplace(key(point, axis), std::array{point, point}).first->second;
      low = point[axis] < low[axis] ? point : low;
      high = point[axis] > high[axis] ? point : high;
    }
    points.clear();
    for (const auto& [line, both] : ends) {
      points.push_back(both[0]);
      if (both[1] != both[0]) {
        points.push_back(both[1]);
      }
    }
  }
  return points;
}

/// Lines are told from each other by this share of a pitch.
constexpr double kLineUnit = 1e-3;

}  // namespace

MovingBody::MovingBody(const Body& body, const Scene& scene)
    : centre_at_rest_(centre_of(body)),
      centre_(centre_at_rest_),
      grid_(nodes_from(body, centre_at_rest_), scene.pitch_mm),
      pushes_(body.pushes),
      begin_s_(body.begin_s) {
  const double pitch_mm = scene.pitch_mm;
  const std::vector<Vector3d>& nodes = grid_.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const double mass = body.masses[i];
    mass_ += mass;
    inertia_ += mass * ((nodes[i].squaredNorm() + pitch_mm * pitch_mm / 6) * Matrix3d::Identity() -
                        nodes[i] * nodes[i].transpose());
    radius_mm_ = std::max(radius_mm_, nodes[i].norm() + pitch_mm);
    // Itself as well.
    std::size_t near = 0;
    grid_.for_each_near(nodes[i], 1.01 * pitch_mm, [&](const Vector3d&) { ++near; });
    if (near <= scene.neighbour_count_max) {
      outer_.push_back(nodes[i]);
      for (const Point& corner : scene.corners) {
        feet_.emplace_back(nodes[i] + vector_of(corner));
      }
    }
  }
  feet_ = ends_of_lines(scene.corners.empty() ? outer_ : feet_, kLineUnit * pitch_mm);
  inverse_ = inertia_.inverse();
  turn_by(Vector3d::Zero());
}

Pose MovingBody::pose() const {
  const Vector3d moved = centre_ - centre_at_rest_;
  return {.moved = {moved.x(), moved.y(), moved.z()},
          .turn = {turn_.w(), turn_.x(), turn_.y(), turn_.z()}};
}

double MovingBody::energy(const Vector3d& gravity_mm_s2) const {
  const Vector3d own = rotation_.transpose() * angular_;
  const double motion = 0.5 * (mass_ * velocity_.squaredNorm() + own.dot(inertia_ * own));
  return motion - mass_ * gravity_mm_s2.dot(centre_ - centre_at_rest_);
}

Matrix3d MovingBody::inverse_inertia() const {
  return is_moving_ ? turned_inverse_ : Matrix3d(Matrix3d::Zero());
}

void MovingBody::load(const Vector3d& gravity_mm_s2, double seconds) {
  velocity_ += seconds * gravity_mm_s2;
  for (const Push& push_by : pushes_) {
    // 1 N is 1000 kg mm/s^2.
    push(global(grid_.nodes()[push_by.node]), 1000 * seconds * vector_of(push_by.force_n));
    angular_ += inverse_inertia() * (1000 * seconds * vector_of(push_by.torque_nmm));
  }
}

void MovingBody::push(const Vector3d& point, const Vector3d& impulse) {
  velocity_ += impulse * inverse_mass();
  angular_ += inverse_inertia() * (point - centre_).cross(impulse);
}

void MovingBody::advance(double seconds) {
  const Vector3d momentum = rotation_ * (inertia_ * (rotation_.transpose() * angular_));
  centre_ += seconds * velocity_;
  // By the velocity that it has in the middle of the turn.
  const Quaterniond before = turn_;
  turn_by(0.5 * seconds * angular_);
  angular_ = turned_inverse_ * momentum;
  turn_ = before;
  turn_by(seconds * angular_);
  angular_ = turned_inverse_ * momentum;
}

void MovingBody::turn_by(const Vector3d& angle) {
  // Cayley's map: without sines, whose last bits are a library's.
  turn_ = Quaterniond(1, angle.x() / 2, angle.y() / 2, angle.z() / 2) * turn_;
  turn_.normalize();
  rotation_ = turn_.toRotationMatrix();
  turned_inverse_ = rotation_ * inverse_ * rotation_.transpose();
}

}  // namespace holdfast::fall
