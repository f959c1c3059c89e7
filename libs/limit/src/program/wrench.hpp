// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/base/algebra.hpp"
#include "holdfast/limit/structure.hpp"

/// Forces with their moments, and velocities with angular velocities, at points of rigid bodies.
namespace holdfast::limit {

inline Vector3 difference(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// A force at `from`, with its moment, as the same times `sign` at `to`.
inline base::Vec6<double> moved(const base::Vec6<double>& force, const Vector3& from,
                                const Vector3& to, double sign) {
  const Vector3 turning = cross(difference(from, to), {force[0], force[1], force[2]});
  base::Vec6<double> result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = sign * force[i];
    result[i + 3] = sign * (force[i + 3] + turning[i]);
  }
  return result;
}

/// A force with its moment, global frame, as a joint's with this frame: [fx fy N mx my T].
inline base::Vec6<double> local_force(const std::array<Vector3, 3>& frame,
                                      const base::Vec6<double>& force) {
  const Vector3 along = {force[0], force[1], force[2]};
  const Vector3 about = {force[3], force[4], force[5]};
  return {dot(along, frame[0]), dot(along, frame[1]), -dot(along, frame[2]),
          dot(about, frame[0]), dot(about, frame[1]), dot(about, frame[2])};
}

/// A rigid body's velocity at `to`, given it at `from`.
inline base::Vec6<double> velocity_at(const base::Vec6<double>& velocity, const Vector3& from,
                                      const Vector3& to) {
  const Vector3 by_turning = cross({velocity[3], velocity[4], velocity[5]}, difference(to, from));
  base::Vec6<double> result = velocity;
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] += by_turning[i];
  }
  return result;
}

}  // namespace holdfast::limit
