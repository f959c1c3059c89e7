// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contacts.hpp"

#include <algorithm>

namespace holdfast::fall {
namespace {

using Eigen::Vector3d;

std::vector<Vector3d> vectors_of(const std::vector<Point>& points) {
  std::vector<Vector3d> vectors;
  vectors.reserve(points.size());
  for (const Point& point : points) {
    vectors.push_back(vector_of(point));
  }
  return vectors;
}

/// Bodies that come this near, beside what they move in a step, have a contact.
constexpr double kNearMm = 0.01;

}  // namespace

ContactFinder::ContactFinder(const Scene& scene)
    : scene_(scene),
      foot_radius_mm_(scene.corners.empty() ? scene.pitch_mm / 2 : 0),
      still_(vectors_of(scene.still), scene.pitch_mm) {}

std::vector<Contact> ContactFinder::find(std::vector<MovingBody>& bodies, double step_s) const {
  std::vector<Contact> found;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    MovingBody& body = bodies[i];
    // No further than a grid of boxes finds.
    const auto margin = [&](double speed) {
      return std::min(2 * step_s * speed + kNearMm, scene_.pitch_mm / 2);
    };
    if (body.is_moving()) {
      meet_floor(body, margin(body.speed_max()), found);
      meet_still(body, margin(body.speed_max()), found);
    }
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      if (body.is_moving() || bodies[j].is_moving()) {
        meet(body, bodies[j], margin(body.speed_max() + bodies[j].speed_max()), found);
      }
    }
  }
  return found;
}

void ContactFinder::meet_floor(MovingBody& body, double margin, std::vector<Contact>& found) const {
  if (!scene_.floor_mm || body.centre().z() - body.radius_mm() > *scene_.floor_mm + margin) {
    return;
  }
  for (const Vector3d& foot : body.feet()) {
    const Vector3d lowest = body.global(foot) - foot_radius_mm_ * Vector3d::UnitZ();
    const double gap = lowest.z() - *scene_.floor_mm;
    if (gap < margin) {
      found.push_back({&body, nullptr, lowest, Vector3d::UnitZ(), gap});
    }
  }
}

void ContactFinder::meet_still(MovingBody& body, double margin, std::vector<Contact>& found) const {
  if (still_.nodes().empty()) {
    return;
  }
  for (const Vector3d& own : body.outer_nodes()) {
    const Vector3d node = body.global(own);
    still_.for_each_near(node, scene_.pitch_mm + margin, [&](const Vector3d& still) {
      const Vector3d between = node - still;
      found.push_back({&body, nullptr, still + between / 2, between.normalized(),
                       between.norm() - scene_.pitch_mm});
    });
  }
}

void ContactFinder::meet(MovingBody& body, MovingBody& other, double margin,
                         std::vector<Contact>& found) const {
  if ((body.centre() - other.centre()).norm() > body.radius_mm() + other.radius_mm() + margin) {
    return;
  }
  for (const Vector3d& own : body.outer_nodes()) {
    const Vector3d node = body.global(own);
    other.grid().for_each_near(
        other.own(node), scene_.pitch_mm + margin, [&](const Vector3d& others) {
          const Vector3d between = node - other.global(others);
          found.push_back({&body, &other, node - between / 2, between.normalized(),
                           between.norm() - scene_.pitch_mm});
        });
  }
}

}  // namespace holdfast::fall
