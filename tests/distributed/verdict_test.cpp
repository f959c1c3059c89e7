// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The robot's own verdict against the exact solver, which shares only the formulas of one beam and
// one facet with it. `./dev bench` runs the same with ten times as many robots.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "campaign.hpp"
#include "expectations.hpp"
#include "holdfast/holdfast.hpp"
#include "random_robot.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

std::vector<std::filesystem::path> scenario_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(HOLDFAST_SCENARIO_DIR)) {
    if (entry.path().extension() == ".json") {
      files.push_back(entry.path());
    }
  }
  std::ranges::sort(files);
  return files;
}

TEST(Distributed, every_scenario_is_decided_like_the_exact_answer) {
  const auto files = scenario_files();
  ASSERT_GE(files.size(), 20U);
  for (const auto& file : files) {
    SCOPED_TRACE(file.filename());
    const auto structure = load_file(file);
    ASSERT_TRUE(structure);
    test::expect_right(test::compare(structure.value().robot, {}));
  }
}

TEST(Distributed, random_robots_are_decided_like_the_exact_answer) {
  for (std::uint64_t seed = 0; seed < test::campaign(60U, 12U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot);
    test::expect_right(test::compare(robot.value(), {.seed = seed}));
  }
}

/// A portal with one module missing in the lower edge of its beam, which is to be put back.
TEST(Distributed, a_planned_module_between_others_costs_some_steps_more_and_no_other_method) {
  model::RobotSpec spec;
  const base::Cell gap{4, 0, 4};
  for (std::int32_t x = 0; x < 9; ++x) {
    for (std::int32_t z = 0; z < 6; ++z) {
      for (std::int32_t y = 0; y < 2; ++y) {
        const base::Cell cell{x, y, z};
        if ((x < 2 || x > 6 || z > 3) && cell != gap) {
          spec.existing.push_back(cell);
        }
      }
    }
  }
  const auto whole = model::Robot::create(spec);
  spec.planned = {gap};
  const auto planned = model::Robot::create(spec);
  ASSERT_TRUE(whole && planned);
  const auto without = test::compare(whole.value(), {});
  const auto with = test::compare(planned.value(), {});
  test::expect_right(without);
  test::expect_right(with);
  EXPECT_EQ(with.result.effort.method, agent::Method::kPolynomial);
  EXPECT_LT(with.result.effort.iterations, 4 * without.result.effort.iterations);
}

/// Where such modules join parts that bend freely and contact changes on the way, a step that is
/// too long once changed contact states for nothing: these five were left to Newton's method.
TEST(Distributed, planned_modules_between_others_let_no_step_go_too_far) {
  for (const std::uint64_t seed : {3U, 32U, 46U, 48U, 59U}) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot);
    const auto comparison = test::compare(robot.value(), {.seed = seed});
    test::expect_right(comparison);
    EXPECT_EQ(comparison.result.effort.method, agent::Method::kPolynomial);
  }
}

/// A frame two modules thick.
model::RobotSpec slender_frame(std::int32_t width, std::int32_t height) {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x < width; ++x) {
    for (std::int32_t z = 0; z < height; ++z) {
      for (std::int32_t y = 0; y < 2; ++y) {
        if (x < 2 || x >= width - 2 || z >= height - 2) {
          spec.existing.push_back({x, y, z});
        }
      }
    }
  }
  return spec;
}

/// A cantilever, fixed at one end, with too many loops for elimination.
model::RobotSpec thick_cantilever(std::int32_t length) {
  model::RobotSpec spec;
  for (std::int32_t x = 0; x < length; ++x) {
    for (std::int32_t y = 0; y < 3; ++y) {
      for (const std::int32_t z : {1, 2}) {
        spec.existing.push_back({x, y, z});
        if (x == 0) {
          spec.fixed.push_back({x, y, z});
        }
      }
    }
  }
  return spec;
}

/// Bending of long robots is what rigid clusters are for. Without them the cantilever takes 40
/// steps and the frame 89.
TEST(Distributed, long_thick_robots_are_decided_in_few_steps) {
  constexpr std::int32_t kWidth = test::kIsShort ? 56 : 70;
  constexpr std::int32_t kHeight = kWidth - 10;
  model::RobotSpec planned = slender_frame(kWidth, kHeight);
  planned.planned = {{30, 0, kHeight}, {31, 0, kHeight}};
  model::RobotSpec between = slender_frame(kWidth, kHeight);
  const base::Cell gap{kWidth / 2, 0, kHeight - 2};
  std::erase(between.existing, gap);
  between.planned = {gap};
  std::vector<model::RobotSpec> specs{between, thick_cantilever(140),
                                      slender_frame(kWidth + 1, kHeight + 1), planned};
  specs.resize(test::campaign(specs.size()));
  for (const model::RobotSpec& spec : specs) {
    SCOPED_TRACE(spec.existing.size());
    const auto robot = model::Robot::create(spec);
    ASSERT_TRUE(robot);
    const auto comparison = test::compare(robot.value(), {});
    test::expect_right(comparison);
    EXPECT_GE(comparison.depth, 64);
    EXPECT_EQ(comparison.result.effort.method, agent::Method::kPolynomial);
    EXPECT_LE(comparison.result.effort.iterations, 40U);
  }
}

TEST(Distributed, loss_duplication_reordering_and_bit_errors_change_no_verdict) {
  for (std::uint64_t seed = 0; seed < test::campaign(20U); ++seed) {
    SCOPED_TRACE(::testing::Message() << "random_robot(" << seed << ")");
    const auto robot = model::Robot::create(test::random_robot(seed));
    ASSERT_TRUE(robot);
    test::expect_right(
        test::compare(robot.value(), {.link = test::noisy_rounds(), .seed = seed + 1}));
  }
}

/// Another seed gives another timing, another tree, another root.
TEST(Distributed, the_verdict_does_not_depend_on_the_seed_or_the_link) {
  const auto robot = model::Robot::create(test::random_robot(7));
  ASSERT_TRUE(robot);
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    sim::SimulationOptions options{.link = sim::blinky_blocks_v1(), .seed = seed};
    options.link.jitter = 20'000;
    options.link.clock_drift = 0.01;
    options.link.compute_time = 300;
    options.anchor = static_cast<std::int32_t>(seed % 3);
    test::expect_right(test::compare(robot.value(), options));
  }
}

}  // namespace
}  // namespace holdfast
