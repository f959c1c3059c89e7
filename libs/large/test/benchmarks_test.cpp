// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Chains of modules against closed forms and published values: Euler's columns, the column under
// its own weight [Greenhill 1881], the lateral buckling of a cantilever, a ring, and cantilevers
// against the equation of the elastica, solved here by another method. Bars that shall not stretch
// have a large section, planes in which they shall not bend a large moment.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "holdfast/large/follow.hpp"

namespace holdfast::large {
namespace {

constexpr double kPitch = 40;
constexpr double kStiff = 1e6;

/// A fixed module and `count` others beyond it in a direction of cubes, without weight.
model::RobotSpec chain(int count, const base::Cell& step) {
  model::RobotSpec spec;
  for (int i = 0; i <= count; ++i) {
    spec.existing.push_back({i * step.x, i * step.y, i * step.z});
  }
  spec.fixed = {spec.existing.front()};
  spec.support_z = {};
  spec.material.mass_kg = 1e-12;
  spec.material.section_area_mm2 *= 1e4;
  return spec;
}

model::Robot robot_of(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec, 1);
  EXPECT_TRUE(robot) << (robot ? "" : robot.error().message);
  return std::move(robot).value();
}

double bending_stiffness(const model::RobotSpec& spec) {
  return spec.material.elastic_modulus_mpa * spec.material.moment_y_mm4;
}

/// The factor at which a robot buckles, at most 2.
double critical_factor(const model::RobotSpec& spec) {
  const Path path = follow(robot_of(spec), {.thread_count = 1});
  EXPECT_TRUE(path.critical);
  EXPECT_EQ(path.critical ? path.critical->loss : Loss::kLimit, Loss::kBifurcation);
  return path.critical ? path.critical->factor : 0;
}

/// A column with a load on its top, as a share of Euler's.
double euler_factor(int count) {
  model::RobotSpec spec = chain(count, {0, 0, 1});
  const double length = count * kPitch;
  const double load =
      std::numbers::pi * std::numbers::pi / 4 * bending_stiffness(spec) / (length * length);
  spec.payloads = {{.cell = spec.existing.back(), .force_n = {0, 0, -load}}};
  return critical_factor(spec);
}

// Convergence with the fourth power: the errors of Hermite's cubics in a cantilever.
TEST(benchmark, has_eulers_load_with_few_modules) {
  EXPECT_NEAR(euler_factor(1), 1 + 7.5e-3, 1e-4);
  EXPECT_NEAR(euler_factor(2), 1 + 5.1e-4, 1e-5);
  EXPECT_NEAR(euler_factor(4), 1 + 3.3e-5, 2e-6);
  EXPECT_NEAR(euler_factor(16), 1, 2e-6);
}

/// A column under its own weight, half a module's at its top: the factor of EI / (q l^3).
double greenhill_factor(int count) {
  model::RobotSpec spec = chain(count, {0, 0, 1});
  const double length = count * kPitch;
  const double weight = 7 * bending_stiffness(spec) / (length * length);  // All of it, N.
  for (int i = 1; i <= count; ++i) {
    const double share = weight / count / (i == count ? 2 : 1);
    spec.payloads.push_back({.cell = spec.existing[base::at(i)], .force_n = {0, 0, -share}});
  }
  return 7 * critical_factor(spec);
}

TEST(benchmark, has_greenhills_height_of_a_column_under_its_weight) {
  const double coarse = greenhill_factor(16);
  const double fine = greenhill_factor(32);
  EXPECT_NEAR(fine, 7.837347, 5e-3);
  EXPECT_NEAR((4 * fine - coarse) / 3, 7.837347, 1e-4);  // Lumps of weight: second order.
}

/// A cantilever with a load on its end that bends it in its stiff plane: the factor of
/// sqrt(EI GJ) / l^2.
double lateral_factor(int count) {
  model::RobotSpec spec = chain(count, {1, 0, 0});
  spec.material.moment_x_mm4 *= kStiff;
  const double twist = model::beam_section(spec.material).torsion;
  const double length = count * kPitch;
  const double unit =
      std::sqrt(bending_stiffness(spec) * spec.material.elastic_modulus_mpa * twist) /
      (length * length);
  spec.payloads = {{.cell = spec.existing.back(), .force_n = {0, 0, -3 * unit}}};
  return 3 * critical_factor(spec);
}

TEST(benchmark, has_the_lateral_buckling_of_a_cantilever) {
  const double coarse = lateral_factor(16);
  const double fine = lateral_factor(32);
  EXPECT_NEAR(fine, 4.0126, 3e-3);
  EXPECT_NEAR((4 * fine - coarse) / 3, 4.0126, 2e-4);
}

// A moment 2 pi EI / l closes it; planes in which it could escape are stiff.
TEST(benchmark, rolls_a_chain_up_into_a_ring) {
  for (const int count : {4, 10}) {
    model::RobotSpec spec = chain(count, {1, 0, 0});
    spec.material.moment_y_mm4 *= 1e3;
    spec.material.torsion_mm4 *= 1e3;
    const double moment = 2 * std::numbers::pi * spec.material.elastic_modulus_mpa *
                          spec.material.moment_x_mm4 / (count * kPitch);
    spec.payloads = {{.cell = spec.existing.back(), .torque_nmm = {0, moment, 0}}};
    const Path path = follow(robot_of(spec), {.factor_max = 1, .thread_count = 1});
    ASSERT_TRUE(path.loaded) << count;
    const auto& end = path.loaded->poses.back().displacement;
    EXPECT_NEAR(end[0], -count * kPitch, 1e-6);
    EXPECT_NEAR(end[1], 0, 1e-6);
    EXPECT_NEAR(end[2], 0, 1e-6);
  }
}

/// Where the end of an elastica goes, as shares of its length: theta'' = -p s^n cos theta from the
/// free end, theta' = 0 there, the other end clamped at theta = 0. n = 0: a load on the end,
/// p = P l^2 / EI; n = 1: its weight, p = q l^3 / EI. Shooting with Runge and Kutta's method.
std::pair<double, double> elastica(double p, int n) {
  const auto at_clamp = [&](double start, double* x, double* z) {
    constexpr int kSteps = 4000;
    const double h = 1.0 / kSteps;
    const auto bend = [&](double s, double theta) {
      return -p * (n == 0 ? 1 : s) * std::cos(theta);
    };
    double theta = start;
    double slope = 0;
    *x = 0;
    *z = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double s = i * h;
      const double k1 = bend(s, theta);
      const double k2 = bend(s + h / 2, theta + h / 2 * slope);
      const double k3 = bend(s + h / 2, theta + h / 2 * slope + h * h / 4 * k1);
      const double k4 = bend(s + h, theta + h * slope + h * h / 2 * k2);
      const double next = theta + h * slope + h * h / 6 * (k1 + k2 + k3);
      const double middle = theta + h / 2 * slope + h * h / 8 * k1;
      *x += h / 6 * (std::cos(theta) + 4 * std::cos(middle) + std::cos(next));
      *z += h / 6 * (std::sin(theta) + 4 * std::sin(middle) + std::sin(next));
      slope += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
      theta = next;
    }
    return theta;
  };
  double low = 0;
  double high = std::numbers::pi / 2;
  double x = 0;
  double z = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (at_clamp(middle, &x, &z) < 0 ? low : high) = middle;
  }
  return {1 - x, z};
}

/// Where the end of a chain of modules goes, which bends in its plane only.
std::pair<double, double> bent_chain(double p, int n, int count) {
  model::RobotSpec spec = chain(count, {1, 0, 0});
  const double length = count * kPitch;
  const double load = p * bending_stiffness(spec) / (length * length);
  spec.material.moment_y_mm4 *= 1e3;
  spec.material.torsion_mm4 *= 1e3;
  for (int i = 1; i <= count; ++i) {
    const double share = n == 0 ? (i == count ? 1.0 : 0.0) : (i == count ? 0.5 : 1.0) / count;
    spec.payloads.push_back({.cell = spec.existing[base::at(i)], .force_n = {0, 0, -share * load}});
  }
  const Path path = follow(robot_of(spec), {.factor_max = 1, .thread_count = 1});
  EXPECT_TRUE(path.loaded) << p << static_cast<int>(path.outcome) << path.last.factor;
  const auto end = path.loaded ? path.loaded->poses.back().displacement : mechanics::Vector3{};
  return {-end[0] / length, -end[2] / length};
}

TEST(benchmark, bends_as_the_elastica) {
  for (const double p : {1.0, 2.0, 5.0, 10.0}) {
    const auto [shortening, sag] = elastica(p, 0);
    const auto [u, w] = bent_chain(p, 0, 16);
    EXPECT_NEAR(u, shortening, 2e-5) << p;
    EXPECT_NEAR(w, sag, 2e-5) << p;
  }
}

// Bars a million times as stiff lengthwise as sideways: pivots keep their signs in rounding.
TEST(benchmark, is_not_taken_for_unstable_where_scales_are_far_apart) {
  model::RobotSpec spec = chain(16, {1, 0, 0});
  spec.material.section_area_mm2 *= 100;
  const double length = 16 * kPitch;
  const double load = 10 * bending_stiffness(spec) / (length * length);
  spec.payloads = {{.cell = spec.existing.back(), .force_n = {0, 0, -load}}};
  const Path path = follow(robot_of(spec), {.factor_max = 1, .thread_count = 1});
  EXPECT_EQ(path.outcome, Outcome::kReached);
}

TEST(benchmark, hangs_under_its_weight_as_the_elastica) {
  for (const double p : {5.0, 20.0}) {
    const auto [shortening, sag] = elastica(p, 1);
    const auto [coarse_u, coarse_w] = bent_chain(p, 1, 16);
    const auto [u, w] = bent_chain(p, 1, 32);
    EXPECT_NEAR((4 * u - coarse_u) / 3, shortening, 3e-5) << p;
    EXPECT_NEAR((4 * w - coarse_w) / 3, sag, 3e-5) << p;
  }
}

// Inextensible chains do not see the axial stiffness: a bar that hangs is stretched by N L / (E A).
TEST(benchmark, stretches_as_a_bar) {
  model::RobotSpec spec = chain(10, {0, 0, -1});
  spec.material.section_area_mm2 /= 1e4;
  spec.material.elastic_modulus_mpa = 0.1;
  spec.payloads = {{.cell = spec.existing.back(), .force_n = {0, 0, -10}}};
  const Path path = follow(robot_of(spec), {.thread_count = 1});
  ASSERT_TRUE(path.loaded);
  const double stretch = 10 * 10 * kPitch / (0.1 * spec.material.section_area_mm2);
  EXPECT_NEAR(path.loaded->poses.back().displacement[2], -stretch, 1e-9 * stretch);
  EXPECT_NEAR(path.loaded->middle_force.front()[2], 10, 1e-9);
}

}  // namespace
}  // namespace holdfast::large
