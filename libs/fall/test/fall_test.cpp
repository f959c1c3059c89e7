// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/fall/fall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace holdfast::fall {
namespace {

constexpr double kPitch = 40;
constexpr double kGravity = 9810;  ///< mm/s^2
constexpr double kMass = 0.06;

std::vector<Point> cube_corners() {
  std::vector<Point> corners;
  for (int i = 0; i < 8; ++i) {
    const auto side = [&](int bit) { return (i >> bit & 1) != 0 ? kPitch / 2 : -kPitch / 2; };
    corners.push_back({side(0), side(1), side(2)});
  }
  return corners;
}

Body body_of(const std::vector<std::array<int, 3>>& cells) {
  Body body;
  for (const auto& [x, y, z] : cells) {
    body.nodes.push_back({kPitch * x, kPitch * y, kPitch * z});
    body.masses.push_back(kMass);
  }
  return body;
}

/// Cubes over a floor below cells of z = 0.
Scene scene_of(std::vector<Body> bodies) {
  Scene scene;
  scene.pitch_mm = kPitch;
  scene.corners = cube_corners();
  scene.gravity_mm_s2 = {0, 0, -kGravity};
  scene.floor_mm = -kPitch / 2;
  scene.bodies = std::move(bodies);
  return scene;
}

Point turned(const Pose& pose, const Point& p) {
  const double w = pose.turn[0];
  const Point axis = {pose.turn[1], pose.turn[2], pose.turn[3]};
  const auto cross = [&](const Point& v) {
    return Point{axis[1] * v[2] - axis[2] * v[1], axis[2] * v[0] - axis[0] * v[2],
                 axis[0] * v[1] - axis[1] * v[0]};
  };
  const Point once = cross(p);
  const Point twice = cross(once);
  Point result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result[k] = p[k] + 2 * (w * once[k] + twice[k]);
  }
  return result;
}

/// The height of the lowest corner of a body in a frame.
double lowest(const Scene& scene, const Fall& fall, std::size_t frame, std::size_t body) {
  const Pose& pose = fall.frames[frame][body];
  double low = 1e9;
  for (const Point& node : scene.bodies[body].nodes) {
    for (const Point& corner : scene.corners) {
      Point own{};
      for (std::size_t k = 0; k < 3; ++k) {
        own[k] = node[k] + corner[k] - fall.centres[body][k];
      }
      low = std::min(low, turned(pose, own)[2] + fall.centres[body][2] + pose.moved[2]);
    }
  }
  return low;
}

void expect_energy_never_grows(const Fall& fall, double scale) {
  for (std::size_t i = 1; i < fall.energy.size(); ++i) {
    EXPECT_LE(fall.energy[i], fall.energy[i - 1] + 1e-4 * scale) << "frame " << i;
  }
}

TEST(Fall, takes_root_of_two_h_over_g_and_ends_on_the_floor) {
  const int height = 10;
  const Scene scene = scene_of({body_of({{0, 0, height}})});
  const Fall fall = simulate(scene, {.seconds = 2, .steps_per_frame = 1});
  const double seconds = std::sqrt(2 * height * kPitch / kGravity);
  for (std::size_t i = 0; i < fall.frames.size(); ++i) {
    const double t = fall.frame_s * static_cast<double>(i);
    const double expected = -std::min(kGravity * t * t / 2, height * kPitch);
    // Impulses at the end of each step of 1 ms: half a step ahead.
    EXPECT_NEAR(fall.frames[i][0].moved[2], expected, 0.5e-3 * kGravity * seconds + 1e-9) << t;
  }
  EXPECT_NEAR(fall.frames.back()[0].moved[2], -height * kPitch, 1e-3);
  EXPECT_LT(fall.frames.size(), 800U) << "it lies still";
  EXPECT_NEAR(fall.energy.back(), -kMass * kGravity * height * kPitch * 1e-3, 1e-3);
}

/// Angular velocity from the turns of two frames.
double turn_rate(const Fall& fall, std::size_t frame) {
  const auto& a = fall.frames[frame][0].turn;
  const auto& b = fall.frames[frame + 1][0].turn;
  double cosine = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    cosine += a[k] * b[k];
  }
  return 2 * std::acos(std::min(cosine, 1.0)) / fall.frame_s;
}

TEST(Fall, over_an_edge_turns_by_the_energy_that_gravity_gives) {
  // A hook whose centre of mass is a quarter of a cube beyond the edge of its foot at x = 20.
  const std::vector<std::array<int, 3>> cells = {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
  Scene scene = scene_of({body_of(cells)});
  scene.friction = 10;
  const Fall fall = simulate(scene, {.seconds = 1, .steps_per_frame = 2});
  const double edge_x = kPitch / 2;
  const double edge_z = -kPitch / 2;
  double inertia = 0;
  for (const auto& [x, y, z] : cells) {
    const double distance_x = kPitch * x - edge_x;
    const double distance_z = kPitch * z - edge_z;
    inertia += kMass * (distance_x * distance_x + distance_z * distance_z + kPitch * kPitch / 6);
  }
  const double x = fall.centres[0][0] - edge_x;
  const double z = fall.centres[0][2] - edge_z;
  const double distance = std::hypot(x, z);
  const double mass = 4 * kMass;
  int compared = 0;
  for (std::size_t i = 0; i + 1 < fall.frames.size(); ++i) {
    const double turn = 2 * std::acos(std::min(fall.frames[i][0].turn[0], 1.0));
    const double rate = turn_rate(fall, i);
    const double middle = std::atan2(x, z) + turn + rate * fall.frame_s / 2;
    // The lower side of its end comes down to the floor.
    const double landing = std::atan2(kPitch, 2 * kPitch);
    if (turn > 0.05 && turn < landing - 0.05) {
      const double square = 2 * mass * kGravity * distance *
                            (std::cos(std::atan2(x, z)) - std::cos(middle)) / inertia;
      EXPECT_NEAR(rate * rate, square, 0.01 * square) << turn;
      ++compared;
    }
  }
  EXPECT_GT(compared, 10);
  const double rests = 2 * std::acos(fall.frames.back()[0].turn[0]);
  EXPECT_NEAR(rests, std::atan2(kPitch, 2 * kPitch), 0.01);
  expect_energy_never_grows(fall, mass * kGravity * distance * 1e-3);
}

TEST(Fall, down_a_slope_slides_by_coulomb) {
  for (const double slope : {0.3, 0.6, 0.9}) {
    Scene scene = scene_of({body_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}})});
    scene.friction = 0.5;
    const double norm = std::hypot(1, slope);
    scene.gravity_mm_s2 = {kGravity * slope / norm, 0, -kGravity / norm};
    const Fall fall = simulate(scene, {.seconds = 0.5, .steps_per_frame = 10});
    const double seconds = fall.frame_s * static_cast<double>(fall.frames.size() - 1);
    const double pull = std::max(slope - scene.friction, 0.0) * kGravity / norm;
    EXPECT_NEAR(fall.frames.back()[0].moved[0], pull * seconds * seconds / 2,
                0.01 * pull * seconds * seconds / 2 + 0.05)
        << slope;
  }
}

TEST(Fall, is_driven_by_forces_and_torques_as_well) {
  Scene scene = scene_of({body_of({{0, 0, 0}, {1, 0, 0}})});
  scene.floor_mm = {};
  scene.gravity_mm_s2 = {};
  // Two opposite forces at the ends along y turn it about z as a torque of their moment does.
  scene.bodies[0].pushes = {{.node = 0, .force_n = {0.1, -0.001, 0}},
                            {.node = 1, .force_n = {0.1, 0.001, 0}},
                            {.node = 0, .torque_nmm = {0, 0, 0.04}}};
  const Fall fall = simulate(scene, {.seconds = 0.3, .steps_per_frame = 10});
  const double seconds = fall.frame_s * static_cast<double>(fall.frames.size() - 1);
  EXPECT_NEAR(fall.frames.back()[0].moved[0], 0.2e3 / (2 * kMass) * seconds * seconds / 2, 1);
  EXPECT_NEAR(fall.frames.back()[0].moved[1], 0, 1e-9);
  const double half = kPitch / 2;
  const double inertia = 2 * kMass * (half * half + kPitch * kPitch / 6);
  const double angle = 1e3 * (2 * half * 0.001 + 0.04) / inertia * seconds * seconds / 2;
  EXPECT_NEAR(2 * std::asin(fall.frames.back()[0].turn[3]), angle, 0.01 * angle);
}

TEST(Fall, in_flight_keeps_its_momentum) {
  // It falls on a still module at its edge, which makes it turn and throws it aside.
  Scene scene = scene_of({body_of({{0, 0, 40}, {1, 0, 40}, {2, 0, 40}, {2, 1, 40}})});
  scene.still = {{10, 3, 30 * kPitch}};
  scene.floor_mm = {};
  const Fall fall = simulate(scene, {.seconds = 1, .steps_per_frame = 10});
  const std::size_t after = 60;
  ASSERT_GT(fall.frames.size(), after + 20);
  EXPECT_GT(turn_rate(fall, after), 1);
  const auto way = [&](std::size_t frame, std::size_t axis) {
    return fall.frames[frame + 1][0].moved[axis] - fall.frames[frame][0].moved[axis];
  };
  EXPECT_GT(std::abs(way(after, 0)), 0.1);
  for (std::size_t i = after; i < after + 20; ++i) {
    for (const std::size_t axis : {0U, 1U}) {
      EXPECT_NEAR(way(i, axis), way(after, axis), 1e-9);
    }
    EXPECT_NEAR(way(i + 1, 2) - way(i, 2), -kGravity * fall.frame_s * fall.frame_s, 1e-6);
    // Impulses at the end of each step of 1 ms take m g^2 / 2 times 1 ms in a second.
    const double seconds = fall.frame_s * static_cast<double>(i - after);
    const double lost = 4 * kMass * kGravity * kGravity / 2 * 1e-3 * seconds * 1e-3;
    EXPECT_NEAR(fall.energy[i], fall.energy[after] - lost, 0.1);
  }
}

TEST(Fall, begins_when_it_is_told_to_and_lies_on_what_has_not_begun) {
  Body late = body_of({{0, 0, 3}});
  late.begin_s = 0.2;
  Scene scene = scene_of({late, body_of({{0, 0, 5}})});
  scene.still = {{0, 0, 0}};
  const Fall fall = simulate(scene, {.seconds = 1, .steps_per_frame = 10});
  EXPECT_EQ(fall.frames[20][0].moved, (Point{0, 0, 0}));
  EXPECT_NEAR(fall.frames[20][1].moved[2], -kPitch, 1e-3);
  // One on the other on what stays.
  EXPECT_NEAR(fall.frames.back()[0].moved[2], -2 * kPitch, 0.5);
  EXPECT_NEAR(fall.frames.back()[1].moved[2], -3 * kPitch, 1);
}

Body random_body(std::mt19937& random, int size, int height) {
  std::set<std::array<int, 3>> cells = {{0, 0, height}};
  const auto draw = [&](int count) {
    return static_cast<int>(random() % static_cast<unsigned>(count));
  };
  while (static_cast<int>(cells.size()) < size) {
    auto cell = *std::next(cells.begin(), draw(static_cast<int>(cells.size())));
    cell[static_cast<std::size_t>(draw(3))] += draw(2) == 0 ? 1 : -1;
    cell[2] = std::max(cell[2], height);
    cells.insert(cell);
  }
  return body_of({cells.begin(), cells.end()});
}

TEST(Fall, of_any_pieces_loses_energy_and_stays_above_the_floor) {
  std::mt19937 random(7);
  for (int i = 0; i < 8; ++i) {
    const Scene scene =
        scene_of({random_body(random, 1 + i, 0), random_body(random, 2 + i, 12 + i)});
    const Fall fall = simulate(scene, {.seconds = 2, .steps_per_frame = 4});
    expect_energy_never_grows(fall, kMass * kGravity * kPitch * 1e-3 * (3 + 2 * i));
    for (std::size_t frame = 0; frame < fall.frames.size(); ++frame) {
      for (std::size_t body = 0; body < 2; ++body) {
        ASSERT_GT(lowest(scene, fall, frame, body), *scene.floor_mm - 0.5) << frame;
      }
    }
    const Fall again = simulate(scene, {.seconds = 2, .steps_per_frame = 4});
    EXPECT_EQ(again.energy, fall.energy);
  }
}

}  // namespace
}  // namespace holdfast::fall
