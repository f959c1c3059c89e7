// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The levels of multigrid and the iteration over them: K on the finest level beside the beams one
// by one, in every lattice; conjugate gradients beside the direct solver and the residual made
// anew; which system a robot gets.
#include "../src/multigrid/hierarchy/hierarchy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../src/multigrid/cycle/conjugate_gradients.hpp"
#include "../src/multigrid/kernels/beam_shapes.hpp"
#include "../src/system_choice.hpp"
#include "general_robot.hpp"
#include "holdfast/model/families.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::Direction;
using Vec = base::Vec6<double>;

model::Robot robot_of(model::Family family, std::size_t size) {
  model::RobotSpec spec{.existing = model::family_cells(family, size)};
  spec.lattice = model::family_lattice(family);
  return model::Robot::create(spec).value();
}

/// K u of a network by its beams, those to the ground stuck or as `tangents` say by number.
std::vector<Vec> product(const ReducedNetwork& network, const model::Material& material,
                         const GroundTable& tangents, const std::vector<Vec>& u) {
  std::vector<model::LatticeBeam<double>> beams;
  for (int length = 1; length <= kBeamLengthMax; ++length) {
    beams.push_back(long_beam(material, network.lattice, length));
  }
  const auto count = at(network.lattice.direction_count);
  std::vector<Vec> force(network.node_count, Vec{});
  for (std::size_t node = 0; node < network.node_count; ++node) {
    for (std::size_t d = 0; d < count; ++d) {
      const std::size_t other = at(network.beams.other[count * node + d]);
      const std::uint8_t length = network.beams.lengths[network.beams.kind[node]][d];
      if (length > 0) {
        base::add_to(force[node],
                     beams[length - 1U].end_force(static_cast<Direction>(d), u[node], u[other]));
      }
    }
  }
  for (const GroundBeam& beam : network.ground_beams) {
    const Mat stiffness =
        beam.contact == 0
            ? beam_spring(network.lattice, material, beam.direction, beam.length).stiffness
            : tangents[beam.direction][beam.contact];
    base::add_to(force[at(beam.node)], base::multiply(stiffness, u[at(beam.node)]));
  }
  return force;
}

double largest(const std::vector<Vec>& vectors) {
  double size = 0;
  for (const Vec& vector : vectors) {
    for (const double x : vector) {
      size = std::max(size, std::abs(x));
    }
  }
  return size;
}

double difference(const std::vector<Vec>& a, const std::vector<Vec>& b) {
  double size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      size = std::max(size, std::abs(a[i][k] - b[i][k]));
    }
  }
  return size;
}

/// A robot, its network and its levels.
template <class Real>
class Levels {
 public:
  explicit Levels(model::Robot robot)
      : robot_(std::move(robot)), network_(make_reduced_network(robot_, team_)) {}

  ReducedNetwork& network() { return network_; }

  GroundTable& tangents() { return tangents_; }

  Hierarchy<Real>& hierarchy() {
    if (!hierarchy_) {
      find_order(robot_, network_);
      hierarchy_.emplace(network_, robot_.material(), team_, tangents_,
                         std::span<const std::int32_t>());
    }
    return *hierarchy_;
  }

  /// How far the finest level's K p is from the beams' for a random p, as a share of the largest.
  double error(base::Rng& rng) {
    std::vector<Six<Real>> p(network_.node_count + 1);
    std::vector<Vec> u(network_.node_count);
    for (std::size_t node = 0; node < u.size(); ++node) {
      u[node] = random_six(rng);
      for (std::size_t k = 0; k < 6; ++k) {
        p[node].v[k] = static_cast<Real>(u[node][k]);
        u[node][k] = static_cast<double>(p[node].v[k]);
      }
    }
    std::vector<double> q(6 * network_.node_count);
    const double work = hierarchy().apply(p.data(), q.data(), {0, network_.node_count});
    std::vector<Vec> found(network_.node_count);
    double sum = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
      found[i / 6][i % 6] = q[i];
      sum += u[i / 6][i % 6] * q[i];
    }
    EXPECT_NEAR(work, sum, 1e-10 * std::abs(sum));
    const std::vector<Vec> expected = product(network_, robot_.material(), tangents_, u);
    return difference(found, expected) / largest(expected);
  }

 private:
  model::Robot robot_;
  Team team_{1};
  ReducedNetwork network_;
  GroundTable tangents_{};
  std::optional<Hierarchy<Real>> hierarchy_;
};

/// Two dozen roundings of the largest term.
constexpr double kRounding = 1e-13;

template <class Real>
void expect_products_of_families() {
  base::Rng rng(3);
  for (const auto& [family, size] : std::initializer_list<std::pair<model::Family, std::size_t>>{
           {model::Family::kCube, 4},
           {model::Family::kScaffold, 9},
           {model::Family::kPortal, 12},
           {model::Family::kBall, 4},
           {model::Family::kSheet, 5},
           {model::Family::kPrismWall, 4},
           {model::Family::kGrowth, 300}}) {
    EXPECT_LT(Levels<Real>(robot_of(family, size)).error(rng), kRounding) << size;
  }
}

TEST(Hierarchy, multiplies_by_what_the_beams_do) { expect_products_of_families<float>(); }

TEST(Hierarchy, multiplies_by_what_the_beams_do_spring_by_spring) {
  expect_products_of_families<double>();
}

/// Facets on walls, slopes and ceilings, fixed modules, long beams between them.
TEST(Hierarchy, multiplies_by_what_beams_do_wherever_supports_are) {
  base::Rng rng(4);
  for (const base::Lattice& lattice : test::kLattices) {
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const auto spec = test::general_robot(lattice, seed);
      EXPECT_LT(Levels<float>(model::Robot::create(spec).value()).error(rng), kRounding) << seed;
      EXPECT_LT(Levels<double>(model::Robot::create(spec).value()).error(rng), kRounding) << seed;
    }
  }
}

/// A facet in another state changes K by its tangent and nothing else; back again, by nothing.
template <class Real>
void expect_changed_contact() {
  base::Rng rng(5);
  Levels<Real> levels(robot_of(model::Family::kTower, 6));
  Mat tangent;
  for (int i = 0; i < 6; ++i) {
    tangent.at(i, i) = 1 + i;
  }
  GroundBeam& beam = levels.network().ground_beams[2];
  ASSERT_NE(beam.facet, GroundBeam::kNoFacet);
  levels.tangents()[beam.direction][3] = tangent;
  for (const int contact : {0, 3, 0}) {
    beam.contact = static_cast<std::uint8_t>(contact);
    levels.hierarchy().update_contact();
    EXPECT_LT(levels.error(rng), kRounding);
    EXPECT_FALSE(levels.hierarchy().is_singular());
  }
}

TEST(Hierarchy, takes_over_changed_contact) {
  expect_changed_contact<float>();
  expect_changed_contact<double>();
}

/// One module on a facet that resists nothing.
TEST(Hierarchy, sees_what_is_held_by_nothing) {
  Levels<float> levels(model::Robot::create({.existing = {{0, 0, 0}}}).value());
  EXPECT_FALSE(levels.hierarchy().is_singular());
  levels.network().ground_beams[0].contact = 1;
  levels.hierarchy().update_contact();
  EXPECT_TRUE(levels.hierarchy().is_singular());
}

/// An iteration over all levels of a robot under its weight.
template <class Real>
class Gradients {
 public:
  explicit Gradients(model::Robot robot)
      : robot_(std::move(robot)),
        network_(make_reduced_network(robot_, team_)),
        iteration_(network_, robot_.material(), team_, tangents_, {}) {
    for (std::size_t node = 0; node < network_.node_count; ++node) {
      load_.push_back(robot_.loads()[at(network_.module[node])]);
      iteration_.set_residual(node, load_.back());
    }
  }

  ConjugateGradients<Real>& iteration() { return iteration_; }

  std::vector<Vec> x() {
    std::vector<Vec> u(network_.node_count);
    for (std::size_t i = 0; i < 6 * u.size(); ++i) {
      u[i / 6][i % 6] = iteration_.x()[i];
    }
    return u;
  }

  /// The largest difference between the residual that the iteration has and f - K x made anew.
  double drift() {
    const std::vector<Vec> image = product(network_, robot_.material(), tangents_, x());
    std::vector<Vec> left;
    std::vector<Vec> known;
    for (std::size_t node = 0; node < image.size(); ++node) {
      left.push_back(base::sum_of(load_[node], -1.0, image[node]));
      known.push_back(iteration_.residual(node));
    }
    return difference(left, known);
  }

  /// How far x is from the direct solver's, as a share of the largest.
  double error() {
    const auto system = make_linear_system(robot_, {.method = Method::kDirect});
    system->set_law({});
    EXPECT_EQ(system->solve(0), LinearOutcome::kSolved);
    const std::vector<Vec> by_module = system->displacement();
    std::vector<Vec> exact;
    for (std::size_t node = 0; node < network_.node_count; ++node) {
      exact.push_back(by_module[at(network_.module[node])]);
    }
    return difference(x(), exact) / largest(exact);
  }

 private:
  model::Robot robot_;
  Team team_{1};
  ReducedNetwork network_;
  GroundTable tangents_{};
  ConjugateGradients<Real> iteration_;
  std::vector<Vec> load_;
};

Iteration::Goal goal(double error) { return {.error = error, .iteration_count_max = 100}; }

template <class Real>
void expect_solution(model::Family family, std::size_t size, int iteration_count_max) {
  Gradients<Real> gradients(robot_of(family, size));
  Iteration& iteration = gradients.iteration();
  const double first = iteration.begin();
  // A millionth of the first error.
  EXPECT_EQ(iteration.run(goal(1e-12 * first)), Iteration::End::kConverged);
  EXPECT_LE(iteration.iteration_count(), iteration_count_max);
  EXPECT_LT(gradients.error(), 1e-4);
  // 39 bits of forces that are weights on the way.
  const double drift_max = std::is_same_v<Real, float> ? 1e-7 : 1e-9;
  EXPECT_LT(gradients.drift(), drift_max);
  iteration.rest();
  EXPECT_LE(iteration.begin(), 4e-12 * first);
}

// Twice the iterations that they take.
TEST(ConjugateGradients, come_to_the_direct_solution) {
  expect_solution<float>(model::Family::kCube, 6, 24);
  expect_solution<float>(model::Family::kBall, 5, 24);
  expect_solution<float>(model::Family::kPrismWall, 6, 40);
  expect_solution<double>(model::Family::kCube, 6, 24);
  expect_solution<double>(model::Family::kSheet, 9, 60);
}

TEST(ConjugateGradients, a_step_lessens_the_error) {
  Gradients<float> gradients(robot_of(model::Family::kCube, 5));
  Iteration& iteration = gradients.iteration();
  double error = iteration.begin();
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(iteration.step());
    const double next = iteration.begin();
    EXPECT_LT(next, 0.5 * error);
    error = next;
  }
  EXPECT_EQ(iteration.iteration_count(), 3);
}

/// The second answer is what x was, however many iterations followed.
TEST(ConjugateGradients, remember_what_was_marked) {
  for (const double further : {0.1, 1e-4}) {
    Gradients<float> gradients(robot_of(model::Family::kCube, 5));
    Iteration& iteration = gradients.iteration();
    const double first = iteration.begin();
    EXPECT_EQ(iteration.run(goal(1e-4 * first)), Iteration::End::kConverged);
    const std::vector<double> before = iteration.x();
    iteration.mark();
    EXPECT_EQ(iteration.run(goal(1e-4 * further * first)), Iteration::End::kConverged);
    iteration.rest();
    const std::vector<double> marked = iteration.marked();
    const double size = std::abs(
        *std::ranges::max_element(before, {}, [](double value) { return std::abs(value); }));
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_NEAR(marked[i], before[i], 1e-11 * size);
    }
  }
}

TEST(ConjugateGradients, without_loads_are_there_at_once) {
  Gradients<float> gradients(robot_of(model::Family::kCube, 3));
  for (std::size_t node = 0; node < 27; ++node) {
    gradients.iteration().set_residual(node, Vec{});
  }
  EXPECT_EQ(gradients.iteration().begin(), 0);
  EXPECT_EQ(gradients.iteration().run(goal(0)), Iteration::End::kConverged);
  EXPECT_EQ(gradients.iteration().iteration_count(), 0);
}

LinearReport report_of(SystemChoice& choice) { return choice.system()->report(); }

TEST(SystemChoice, small_robots_are_factorized_and_large_ones_iterated) {
  const model::Robot small = robot_of(model::Family::kCube, 5);  // 125, of at most 128.
  const model::Robot large = robot_of(model::Family::kCube, 6);
  SystemChoice of_small(small, {});
  SystemChoice of_large(large, {});
  EXPECT_EQ(report_of(of_small).method, Method::kDirect);
  EXPECT_EQ(report_of(of_large).method, Method::kMultigrid);
  EXPECT_EQ(report_of(of_large).precision, Precision::kSingle);
}

TEST(SystemChoice, does_what_it_is_told) {
  const model::Robot robot = robot_of(model::Family::kCube, 6);
  SystemChoice direct(robot, {.method = Method::kDirect});
  EXPECT_EQ(report_of(direct).method, Method::kDirect);
  EXPECT_FALSE(direct.try_next());
  SystemChoice multigrid(robot, {.method = Method::kMultigrid});
  EXPECT_TRUE(multigrid.try_next());
  EXPECT_EQ(report_of(multigrid).precision, Precision::kDouble);
  EXPECT_FALSE(multigrid.try_next());
}

/// Robots of a few thousand are factorized before they are iterated in double precision, larger
/// ones the other way round; each is tried once.
TEST(SystemChoice, tries_each_system_once) {
  const model::Robot few = robot_of(model::Family::kTower, 40);
  SystemChoice of_few(few, {});
  EXPECT_TRUE(of_few.try_next());
  EXPECT_EQ(report_of(of_few).method, Method::kDirect);
  EXPECT_TRUE(of_few.try_next());
  EXPECT_EQ(report_of(of_few).method, Method::kMultigrid);
  EXPECT_EQ(report_of(of_few).precision, Precision::kDouble);
  EXPECT_FALSE(of_few.try_next());
  const model::Robot many = robot_of(model::Family::kTower, 700);
  SystemChoice of_many(many, {});
  EXPECT_TRUE(of_many.try_next());
  EXPECT_EQ(report_of(of_many).precision, Precision::kDouble);
  EXPECT_TRUE(of_many.try_next());
  EXPECT_EQ(report_of(of_many).method, Method::kDirect);
  EXPECT_FALSE(of_many.try_next());
}

TEST(SystemChoice, the_exact_law_is_solved_directly_where_little_fills_in) {
  const model::Robot tower = robot_of(model::Family::kTower, 40);
  SystemChoice choice(tower, {});
  choice.prepare(mechanics::ContactLaw::kRegularised);
  EXPECT_EQ(report_of(choice).method, Method::kMultigrid);
  choice.prepare(mechanics::ContactLaw::kUnilateral);
  EXPECT_EQ(report_of(choice).method, Method::kDirect);
  const model::Robot solid = robot_of(model::Family::kCube, 12);
  SystemChoice of_solid(solid, {});
  of_solid.prepare(mechanics::ContactLaw::kUnilateral);
  EXPECT_EQ(report_of(of_solid).method, Method::kMultigrid);
}

TEST(SystemChoice, has_none_that_does_not_fit_into_memory) {
  const model::Robot robot = robot_of(model::Family::kCube, 6);
  for (const Method method : {Method::kAutomatic, Method::kDirect, Method::kMultigrid}) {
    SystemChoice choice(robot, {.memory_bytes_max = 1000, .method = method});
    EXPECT_EQ(choice.system(), nullptr);
    EXPECT_EQ(make_linear_system(robot, {.memory_bytes_max = 1000, .method = method}), nullptr);
  }
}

}  // namespace
}  // namespace holdfast::solver
