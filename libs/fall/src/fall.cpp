// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/fall/fall.hpp"

#include <algorithm>

#include "contact_solver.hpp"
#include "contacts.hpp"
#include "moving_body.hpp"

namespace holdfast::fall {
namespace {

constexpr double kStepSeconds = 1e-3;
/// Bodies that are slower lie still, if they do so for a while.
constexpr double kStillMmPerSecond = 5;
constexpr int kStillSteps = 400;

void add_frame(const std::vector<MovingBody>& bodies, const Scene& scene, Fall& fall) {
  std::vector<Pose>& poses = fall.frames.emplace_back();
  double energy = 0;
  for (const MovingBody& body : bodies) {
    poses.push_back(body.pose());
    energy += body.energy(vector_of(scene.gravity_mm_s2));
  }
  // kg mm^2/s^2 are 0.001 N mm.
  fall.energy.push_back(energy * 1e-3);
}

/// One step by Moreau's rule: forces, impulses of the contacts as they are, then the way.
void step(std::vector<MovingBody>& bodies, const Scene& scene, const ContactFinder& finder) {
  for (MovingBody& body : bodies) {
    if (body.is_moving()) {
      body.load(vector_of(scene.gravity_mm_s2), kStepSeconds);
    }
  }
  const std::vector<Contact> contacts = finder.find(bodies, kStepSeconds);
  apply_impulses(contacts, scene.friction, kStepSeconds);
  for (MovingBody& body : bodies) {
    body.advance(kStepSeconds);
  }
  push_apart(contacts);
}

}  // namespace

Fall simulate(const Scene& scene, const FallOptions& options) {
  Fall fall{
      .frame_s = kStepSeconds * options.steps_per_frame, .centres = {}, .frames = {}, .energy = {}};
  std::vector<MovingBody> bodies;
  for (const Body& body : scene.bodies) {
    const Eigen::Vector3d& centre = bodies.emplace_back(body, scene).centre();
    fall.centres.push_back({centre.x(), centre.y(), centre.z()});
  }
  const ContactFinder finder(scene);
  add_frame(bodies, scene, fall);
  const auto count = static_cast<int>(options.seconds / kStepSeconds);
  for (int i = 0, still = 0; i < count && still < kStillSteps; ++i) {
    for (MovingBody& body : bodies) {
      body.begin_after(i * kStepSeconds);
    }
    step(bodies, scene, finder);
    if ((i + 1) % options.steps_per_frame == 0) {
      add_frame(bodies, scene, fall);
    }
    const bool is_still = std::ranges::all_of(bodies, [&](const MovingBody& body) {
      return body.is_moving() && body.speed_max() < kStillMmPerSecond;
    });
    still = is_still ? still + 1 : 0;
  }
  return fall;
}

}  // namespace holdfast::fall
