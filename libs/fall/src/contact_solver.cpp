// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "contact_solver.hpp"

#include <algorithm>
#include <array>

namespace holdfast::fall {
namespace {

using Eigen::Vector3d;

constexpr int kIterations = 60;
/// Bodies may be so much in each other; of what is more a tenth is taken away in a step.
constexpr double kDepthMm = 0.05;
constexpr double kShare = 0.1;

/// The impulse at one contact, along its normal and two tangents.
class ContactImpulse {
 public:
  ContactImpulse(const Contact& contact, double step_s)
      : contact_(contact), gap_rate_(std::max(contact.gap_mm, 0.0) / step_s) {
    axes_[0] = contact.normal;
    const bool is_upright = std::abs(contact.normal.z()) > 0.7;
    axes_[1] =
        contact.normal.cross(is_upright ? Vector3d::UnitX() : Vector3d::UnitZ()).normalized();
    axes_[2] = axes_[0].cross(axes_[1]);
    for (std::size_t k = 0; k < 3; ++k) {
      compliance_[k] = compliance_of(*contact.body, axes_[k]) +
                       (contact.other ? compliance_of(*contact.other, axes_[k]) : 0.0);
    }
  }

  /// One relaxation.
  void relax(double friction) {
    const double before = impulse_[0];
    impulse_[0] = std::max(before - (speed_along(0) + gap_rate_) / compliance_[0], 0.0);
    apply(axes_[0] * (impulse_[0] - before));
    const double limit = friction * impulse_[0];
    const Vector3d held = tangential();
    impulse_[1] -= speed_along(1) / compliance_[1];
    impulse_[2] -= speed_along(2) / compliance_[2];
    const double size = tangential().norm();
    if (size > limit) {
      impulse_[1] *= limit / size;
      impulse_[2] *= limit / size;
    }
    apply(tangential() - held);
  }

 private:
  double compliance_of(const MovingBody& body, const Vector3d& axis) const {
    const Vector3d turn = (contact_.point - body.centre()).cross(axis);
    return body.inverse_mass() + turn.dot(body.inverse_inertia() * turn);
  }

  double speed_along(std::size_t axis) const {
    Vector3d velocity = contact_.body->velocity_at(contact_.point);
    if (contact_.other != nullptr) {
      velocity -= contact_.other->velocity_at(contact_.point);
    }
    return velocity.dot(axes_[axis]);
  }

  Vector3d tangential() const { return impulse_[1] * axes_[1] + impulse_[2] * axes_[2]; }

  void apply(const Vector3d& impulse) const {
    contact_.body->push(contact_.point, impulse);
    if (contact_.other != nullptr) {
      contact_.other->push(contact_.point, -impulse);
    }
  }

  const Contact& contact_;
  double gap_rate_;  ///< With which the gap would be closed within the step, mm/s.
  std::array<Vector3d, 3> axes_;
  std::array<double, 3> compliance_{};
  std::array<double, 3> impulse_{};
};

}  // namespace

void apply_impulses(const std::vector<Contact>& contacts, double friction, double step_s) {
  std::vector<ContactImpulse> impulses;
  impulses.reserve(contacts.size());
  for (const Contact& contact : contacts) {
    impulses.emplace_back(contact, step_s);
  }
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (ContactImpulse& impulse : impulses) {
      impulse.relax(friction);
    }
  }
}

void push_apart(const std::vector<Contact>& contacts) {
  for (const Contact& contact : contacts) {
    const double depth = -contact.gap_mm - kDepthMm;
    if (depth > 0) {
      const double own = contact.body->inverse_mass();
      const double others = contact.other ? contact.other->inverse_mass() : 0;
      const Vector3d way = kShare * depth / (own + others) * contact.normal;
      contact.body->shift(own * way);
      if (contact.other != nullptr) {
        contact.other->shift(-others * way);
      }
    }
  }
}

}  // namespace holdfast::fall
