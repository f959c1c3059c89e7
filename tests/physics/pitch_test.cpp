// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Modules that are not as long as wide. Their robots are compared with beam theory and statics by
// hand, with themselves turned, and with robots of more and smaller modules.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "general_robot.hpp"
#include "holdfast/holdfast.hpp"
#include "holdfast/plan/candidates.hpp"
#include "seeds.hpp"

namespace holdfast {
namespace {

using base::Cell;
using Three = std::array<double, 3>;

constexpr double kModulus = 100;
constexpr double kMass = 0.002;
constexpr double kWeight = kMass * 9.81;

/// A material whose two second moments are different, so that no frame may be mistaken.
model::Material brick(double unit) {
  model::Material material;
  material.pitch_mm = unit;
  material.facet_mm = 7;
  material.section_area_mm2 = 60;
  material.moment_x_mm4 = 300;
  material.moment_y_mm4 = 170;
  material.torsion_mm4 = 400;
  material.mass_kg = kMass;
  return material;
}

/// Modules of these lengths; the least of them is the pitch.
model::RobotSpec with_lengths(model::RobotSpec spec, const Three& lengths_mm) {
  const double unit = std::ranges::min(lengths_mm);
  spec.material.pitch_mm = unit;
  spec.lattice = base::stretched(
      base::kCubic, {lengths_mm[0] / unit, lengths_mm[1] / unit, lengths_mm[2] / unit});
  return spec;
}

model::Robot make(const model::RobotSpec& spec) {
  auto robot = model::Robot::create(spec, 1);
  EXPECT_TRUE(robot) << robot.error().message;
  return std::move(robot).value();
}

/// A row of modules along an axis, whose first is fixed, and gravity along another.
model::RobotSpec cantilever(std::size_t along, std::size_t down, int count) {
  model::RobotSpec spec{.support_z = {}, .material = brick(8)};
  for (int i = 0; i < count; ++i) {
    spec.existing.push_back({along == 0 ? i : 0, along == 1 ? i : 0, along == 2 ? i : 0});
  }
  spec.fixed = {spec.existing.front()};
  Three gravity{};
  gravity[down] = -9.81;
  spec.gravity_m_s2 = gravity;
  return spec;
}

/// The root of a row of n modules of length p carries W p (n - 1)^2 / 2 in its middle, and a weight
/// at x bends the tip, at l, by W x^2 (3 l - x) / (6 E I).
TEST(Pitch, cantilevers_bend_by_the_length_along_them) {
  constexpr int kCount = 9;
  const Three lengths = {8, 13, 9.6};
  for (std::size_t along = 0; along < 3; ++along) {
    for (std::size_t down = 0; down < 3; ++down) {
      if (along == down) {
        continue;
      }
      const model::RobotSpec spec = with_lengths(cantilever(along, down, kCount), lengths);
      const verdict::Assessment found = verdict::assess(make(spec));
      const double p = lengths[along];
      // Ix bends what is level up and down, and what is upright along x.
      const bool is_about_y = along == 2 ? down == 0 : down == 2;
      const double moment = is_about_y ? spec.material.moment_x_mm4 : spec.material.moment_y_mm4;
      double sag = 0;
      const double tip = p * (kCount - 1);
      for (int i = 1; i < kCount; ++i) {
        sag += kWeight * p * p * i * i * (3 * tip - p * i) / (6 * kModulus * moment);
      }
      const double strength =
          along == 2 ? spec.material.strength_vertical_n : spec.material.strength_lateral_n;
      const double root = kWeight * p * (kCount - 1) * (kCount - 1) / 2;
      EXPECT_NEAR(found.equilibrium.displacement.back()[down], -sag, 1e-9 * sag) << along << down;
      EXPECT_NEAR(*found.load_ratio_max, 2 * root / spec.material.facet_mm / strength, 1e-9);
    }
  }
}

/// A post of one with an arm of n modules: the centre of mass lies over the mean of the modules'
/// places, and the polygon's edge half a facet from the post.
TEST(Pitch, arms_tip_by_the_length_along_them) {
  const Three lengths = {25, 11, 40};
  for (const bool is_along_x : {true, false}) {
    for (int n = 1; n < 5; ++n) {
      model::RobotSpec spec{.existing = {{0, 0, 0}, {0, 0, 1}}, .material = brick(11)};
      double moment = 0;
      for (int i = 1; i <= n; ++i) {
        spec.existing.push_back(is_along_x ? Cell{i, 0, 1} : Cell{0, i, 1});
        moment += lengths[is_along_x ? 0 : 1] * i;
      }
      const verdict::RigidBody body = verdict::assess(make(with_lengths(spec, lengths))).simplified;
      EXPECT_NEAR(*body.margin_mm, 3.5 - moment / (n + 2), 1e-10) << n;
      EXPECT_EQ(body.is_stable, 3.5 > moment / (n + 2));
    }
  }
}

/// What holds the robot and turns with it: an answer about it.
struct Answers {
  verdict::Assessment assessment;
  std::optional<limit::LimitLoad> limit;
};

Answers answers(const model::RobotSpec& spec, bool is_whole) {
  const CheckResult result = check(
      make(spec), {.thread_count = 1, .is_buckling_wanted = is_whole, .is_limit_wanted = is_whole});
  return {result.assessment, result.limit};
}

/// A symmetry of the cubic lattice that maps lengths along axes onto lengths along others.
Three turned_lengths(const test::Symmetry& symmetry, const Three& lengths) {
  Three turned{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      turned[i] += std::abs(symmetry.matrix[i][k]) * lengths[k];
    }
  }
  return turned;
}

void expect_close(std::optional<double> a, std::optional<double> b, double tie,
                  const std::string& what) {
  ASSERT_EQ(a.has_value(), b.has_value()) << what;
  if (a) {
    EXPECT_NEAR(*a, *b, tie * std::max(1.0, std::abs(*a))) << what;
  }
}

/// Robots on obstacles, with loads and friction: turned, with their lengths turned, they answer the
/// same. Second moments and strengths are equal, as they know what is up.
TEST(Pitch, turned_robots_answer_the_same) {
  const std::vector<test::Symmetry> symmetries = test::symmetries(base::kCubic);
  const Three lengths = {25, 32, 11};
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < test::campaign(60U); ++seed) {
    model::RobotSpec spec = test::general_robot(base::kCubic, seed);
    spec = seed % 5 == 0 ? test::with_friction(std::move(spec), seed) : spec;
    spec.material.moment_y_mm4 = spec.material.moment_x_mm4;
    spec.material.strength_vertical_n = spec.material.strength_lateral_n;
    spec.material.facet_mm = 11;
    const bool is_whole = seed % 4 == 0;
    const Answers before = answers(with_lengths(spec, lengths), is_whole);
    for (const std::size_t i : {std::size_t{1 + seed % 23}, std::size_t{24 + seed % 24}}) {
      const test::Symmetry& symmetry = symmetries[i];
      if (!test::keeps_frames(base::kCubic, symmetry)) {
        continue;
      }
      const std::string what = "seed " + std::to_string(seed) + ", symmetry " + std::to_string(i);
      const Answers after = answers(
          with_lengths(test::turned(spec, symmetry), turned_lengths(symmetry, lengths)), is_whole);
      ++compared;
      EXPECT_EQ(before.assessment.verdict, after.assessment.verdict) << what;
      if (before.assessment.is_stable &&
          before.assessment.verdict != verdict::Verdict::kUndecided) {
        expect_close(before.assessment.load_ratio_max, after.assessment.load_ratio_max, 1e-6, what);
      }
      if (before.limit) {
        EXPECT_NEAR(before.limit->low, after.limit->low, 2e-2 * std::abs(before.limit->low))
            << what;
      }
      const auto& second = before.assessment.second_order;
      if (second && second->factor < 1e6) {
        EXPECT_NEAR(second->factor, after.assessment.second_order->factor,
                    1e-3 * second->factor + 1e-6)
            << what;
      }
    }
  }
  EXPECT_GE(compared, test::least(std::size_t{60}));
}

/// The robot whose modules are split in halves along an axis: every second module of a row is one
/// of the robot, those between weigh nothing and are joined along the row alone. Its beams are half
/// as long, two in a row the same beam as before.
model::RobotSpec split(const model::RobotSpec& spec, std::size_t axis) {
  const auto doubled = [&](Cell cell) {
    (axis == 0 ? cell.x : axis == 1 ? cell.y : cell.z) *= 2;
    return cell;
  };
  const Cell step = {axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0};
  const std::set<Cell> cells(spec.existing.begin(), spec.existing.end());
  model::RobotSpec fine = spec;
  fine.existing.clear();
  std::set<Cell> between;
  for (const Cell& cell : spec.existing) {
    fine.existing.push_back(doubled(cell));
    if (cells.contains({cell.x + step.x, cell.y + step.y, cell.z + step.z})) {
      const Cell at = doubled(cell);
      between.insert({at.x + step.x, at.y + step.y, at.z + step.z});
    }
  }
  for (const Cell& cell : between) {
    fine.existing.push_back(cell);
    fine.own_masses.push_back({cell, 1e-12});
    for (std::size_t other = 0; other < 3; ++other) {
      const Cell next = {cell.x + (other == 0 ? 1 : 0), cell.y + (other == 1 ? 1 : 0),
                         cell.z + (other == 2 ? 1 : 0)};
      if (other != axis && between.contains(next)) {
        fine.released.push_back({cell, next});
      }
    }
  }
  fine.fixed.clear();
  for (const Cell& cell : spec.fixed) {
    fine.fixed.push_back(doubled(cell));
  }
  return fine;
}

/// A block of modules with holes, held at its foot, of some height.
model::RobotSpec held_block(std::uint64_t seed, int size) {
  model::RobotSpec spec{.support_z = {}, .material = brick(8)};
  for (int x = 0; x < size; ++x) {
    for (int y = 0; y < size; ++y) {
      for (int z = 0; z < size; ++z) {
        const bool is_edge =
            (x == 0 && y == 0) || (y == 0 && z == size - 1) || (x == size - 1 && z == size - 1);
        if (is_edge || (static_cast<std::uint64_t>(x * 7 + y * 5 + z * 3) + seed) % 4 != 0) {
          spec.existing.push_back({x, y, z});
        }
      }
    }
  }
  // What hangs together with the first, which is fixed.
  std::set<Cell> left(spec.existing.begin(), spec.existing.end());
  std::vector<Cell> open = {{0, 0, 0}};
  left.erase(open.front());
  for (std::size_t i = 0; i < open.size(); ++i) {
    for (const base::Direction direction : base::directions(base::kCubic)) {
      const Cell next = base::neighbour(base::kCubic, open[i], direction);
      if (left.erase(next) > 0) {
        open.push_back(next);
      }
    }
  }
  spec.existing = open;
  spec.fixed = {open.front()};
  return spec;
}

/// Small robots are solved directly and large ones by multigrid, which goes by other numbers, to an
/// error in the energy norm that leaves displacements five digits.
TEST(Pitch, robots_move_as_those_of_twice_as_many_modules_half_as_long) {
  constexpr double kIterative = 1e-5;
  std::size_t large_count = 0;
  for (const int size : {3, 4, 7, 10}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      model::RobotSpec spec = held_block(axis + static_cast<std::uint64_t>(size), size);
      Three lengths = {8, 8, 8};
      lengths[axis] = 16;
      const model::RobotSpec fine = split(spec, axis);
      for (const solver::Method method : {solver::Method::kDirect, solver::Method::kMultigrid}) {
        const auto coarse =
            verdict::assess(make(with_lengths(spec, lengths)), {.method = method}).equilibrium;
        const auto exact =
            verdict::assess(make(fine), {.method = solver::Method::kDirect}).equilibrium;
        ASSERT_EQ(coarse.outcome, solver::Outcome::kSettled);
        double largest = 0;
        double off = 0;
        for (std::size_t i = 0; i < spec.existing.size(); ++i) {
          for (std::size_t k = 0; k < 3; ++k) {
            largest = std::max(largest, std::abs(exact.displacement[i][k]));
            off = std::max(off, std::abs(exact.displacement[i][k] - coarse.displacement[i][k]));
          }
        }
        EXPECT_LT(off, kIterative * largest)
            << size << ", axis " << axis << ", method " << static_cast<int>(method);
        large_count += spec.existing.size() > 128 ? 1 : 0;
      }
    }
  }
  EXPECT_GE(large_count, 6U);
}

/// A row that a force at its end, across it, turns by more than half a radian: two elements of half
/// the length in a row follow the elastica of one, to the square of what one turns.
TEST(Pitch, rows_bend_far_as_those_of_twice_as_many_modules_half_as_long) {
  constexpr int kCount = 9;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    model::RobotSpec spec = cantilever(axis, (axis + 1) % 3, kCount);
    model::Payload pull{.cell = spec.existing.back()};
    pull.force_n[(axis + 1) % 3] = -6;
    spec.payloads = {pull};
    Three lengths = {8, 8, 8};
    lengths[axis] = 16;
    const auto coarse = large::follow(make(with_lengths(spec, lengths))).loaded;
    model::RobotSpec fine = split(spec, axis);
    fine.payloads.front().cell = fine.existing[kCount - 1];
    const auto exact = large::follow(make(fine)).loaded;
    ASSERT_TRUE(coarse && exact) << axis;
    EXPECT_GT(coarse->rotation_max_rad, 0.5);
    EXPECT_NEAR(coarse->rotation_max_rad, exact->rotation_max_rad, 1e-3);
    for (std::size_t i = 0; i < kCount; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(coarse->poses[i].displacement[k], exact->poses[i].displacement[k],
                    1e-3 * exact->displacement_max_mm)
            << axis << ' ' << i;
      }
    }
  }
}

/// Every free cell is judged as a check of the robot with a module there.
TEST(Pitch, candidates_are_judged_as_checks) {
  for (std::uint64_t seed = 0; seed < test::campaign(6U); ++seed) {
    model::RobotSpec spec =
        with_lengths(test::held_robot(base::kCubic, seed, test::Fixed::kFirst), {25, 32, 11});
    spec.planned.clear();
    plan::CandidateOptions by_checks;
    by_checks.is_by_checks = true;
    const auto cells = plan::free_cells(spec);
    const auto fast = plan::judge_candidates(spec, cells, {}).candidates;
    const auto slow = plan::judge_candidates(spec, cells, by_checks).candidates;
    ASSERT_EQ(fast.size(), slow.size());
    ASSERT_FALSE(fast.empty());
    for (std::size_t i = 0; i < fast.size(); ++i) {
      const plan::Candidate& a = fast[i];
      const plan::Candidate& b = slow[i];
      EXPECT_EQ(a.cell, b.cell);
      EXPECT_EQ(a.judgement.verdict, b.judgement.verdict);
      EXPECT_EQ(a.judgement.load_ratio_max, b.judgement.load_ratio_max);
    }
  }
}

std::string file_of(std::string_view pitch, std::string_view lattice = "cubic") {
  return R"({"format": "holdfast-structure", "version": 2, "lattice": ")" + std::string(lattice) +
         R"(", "material": {"facet_mm": 7, "mass_kg": 0.002, "pitch_mm": )" + std::string(pitch) +
         R"(}, "modules": [[0,0,0], [1,0,0], [2,0,0], [2,1,0], [0,0,1], [1,0,1]]})";
}

/// Three equal numbers are one, to the last bit.
TEST(Pitch, equal_lengths_are_one_number) {
  const auto one = load_text(file_of("9.6"));
  const auto three = load_text(file_of("[9.6, 9.6, 9.6]"));
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one.value().document, three.value().document);
  EXPECT_EQ(check(one.value()).assessment.equilibrium.displacement,
            check(three.value()).assessment.equilibrium.displacement);
}

TEST(Pitch, is_read_and_written_by_direction) {
  for (const auto* const lattice : {"cubic", "hexagonal-prism"}) {
    const std::string pitch = std::string_view(lattice) == "cubic" ? "[8, 7, 9.6]" : "[8, 8, 3]";
    const auto read = load_text(file_of(pitch, lattice));
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_NEAR(read.value().robot.step_mm(base::down(read.value().robot.lattice())),
                pitch.find("9.6") != std::string::npos ? 9.6 : 3, 1e-14);
    for (const std::string& text :
         {io::write_json(read.value().document), io::write_visiblesim(read.value().document)}) {
      const auto again = load_text(text);
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(again.value().document.extension.pitch_mm,
                read.value().document.extension.pitch_mm);
      EXPECT_EQ(again.value().robot.lattice(), read.value().robot.lattice());
    }
  }
}

TEST(Pitch, says_what_is_wrong_with_it) {
  const std::pair<std::string, std::string> faults[] = {
      {file_of("[8, 8]"), "expected three numbers, found an array of 2"},
      {file_of("[8, 8, 8, 8]"), "expected three numbers, found an array of 4"},
      {file_of("[8, 0, 8]"), "pitch_mm is 0"},
      {file_of("[8, 8, -9.6]"), "pitch_mm is -9.6"},
      {file_of("[1, 8, 100]"), "expected up to 16"},
      {file_of("[8, 8, \"a\"]"), "expected a number"},
      {file_of("[8, 8, 9.6]", "face-centred"), "expected one number in the lattice face-centred"},
      {file_of("[8, 9, 9.6]", "hexagonal-prism"), "the same along x and y"}};
  for (const auto& [text, expected] : faults) {
    const auto read = load_text(text);
    ASSERT_FALSE(read) << expected;
    EXPECT_NE(read.error().message.find(expected), std::string::npos) << read.error().message;
    EXPECT_NE(read.error().where.find("/material/pitch_mm"), std::string::npos);
  }
}

}  // namespace
}  // namespace holdfast
