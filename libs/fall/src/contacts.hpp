// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "holdfast/fall/fall.hpp"
#include "moving_body.hpp"

namespace holdfast::fall {

/// A place where a body meets another one, or what does not move.
struct Contact {
  MovingBody* body = nullptr;
  MovingBody* other = nullptr;  ///< Null: the floor, or what does not move.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< Unit, towards `body`.
  double gap_mm = 0;                                 ///< Below 0: they are in each other.
};

/// Finds where moving bodies meet something, or come near enough to do so within a step.
class ContactFinder {
 public:
  /// Keeps a reference to the scene.
  explicit ContactFinder(const Scene& scene);

  std::vector<Contact> find(std::vector<MovingBody>& bodies, double step_s) const;

 private:
  void meet_floor(MovingBody& body, double margin, std::vector<Contact>& found) const;
  void meet_still(MovingBody& body, double margin, std::vector<Contact>& found) const;
  void meet(MovingBody& body, MovingBody& other, double margin, std::vector<Contact>& found) const;

  const Scene& scene_;
  double foot_radius_mm_;  ///< Of balls; corners have none.
  NodeGrid still_;
};

}  // namespace holdfast::fall
