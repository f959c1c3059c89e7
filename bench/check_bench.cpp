// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// How long a verdict takes, and the direct solver beside two general ones on the same matrix, in
// one run: Eigen's SimplicialLDLT and CHOLMOD. The matrix is the one of the first Newton step, all
// facets stuck. Times are from block values to displacements: ordering, factorization, solve.
#include <benchmark/benchmark.h>
#include <cholmod.h>

#include <Eigen/SparseCholesky>

#include "holdfast/holdfast.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/families.hpp"
#include "holdfast/solver/block_lu.hpp"

namespace {

namespace hf = holdfast;
using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

hf::Structure load(const char* name) {
  auto structure = hf::load_file(std::string(HOLDFAST_SCENARIO_DIR) + "/" + name + ".json");
  HOLDFAST_CHECK(structure.has_value());
  return std::move(structure).value();
}

hf::model::Robot box(int width, int depth, int height) {
  hf::model::RobotSpec spec;
  for (int z = 0; z < height; ++z) {
    for (int y = 0; y < depth; ++y) {
      for (int x = 0; x < width; ++x) {
        spec.existing.push_back({x, y, z});
      }
    }
  }
  return hf::model::Robot::create(spec).value();
}

/// The stuck robot's stiffness matrix as blocks.
struct Blocks {
  std::vector<hf::solver::Edge> edges;
  std::vector<hf::base::Mat6<double>> coupling;
  std::vector<hf::base::Mat6<double>> diagonal;
};

Blocks assemble(const hf::model::Robot& robot) {
  const auto section = hf::model::beam_section(robot.material());
  const auto beam = hf::mechanics::beam_stiffness(section);
  const auto facet = hf::mechanics::ground_facet(section, robot.material().facet_mm, 1e-4,
                                                 hf::mechanics::ContactLaw::kRegularised);
  Blocks blocks;
  blocks.diagonal.resize(robot.modules().size());
  for (const hf::model::Connection& c : robot.connections()) {
    blocks.edges.push_back({c.a, c.b});
    blocks.coupling.push_back(hf::mechanics::block_12(beam, c.direction));
    hf::base::add_to(blocks.diagonal[static_cast<std::size_t>(c.a)],
                     hf::mechanics::block_11(beam, c.direction));
    hf::base::add_to(blocks.diagonal[static_cast<std::size_t>(c.b)],
                     hf::mechanics::block_11(beam, hf::base::opposite(c.direction)));
  }
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    if (robot.modules()[i].support == hf::model::Support::kGround) {
      hf::base::add_to(blocks.diagonal[i], hf::mechanics::contact_tangent(facet, {}, true));
    }
  }
  return blocks;
}

/// The lower triangle, scalar.
Matrix lower_triangle(const Blocks& blocks) {
  std::vector<Eigen::Triplet<double, int>> entries;
  const auto add = [&](int row, int column, double value) {
    if (row >= column && value != 0) {
      entries.emplace_back(row, column, value);
    }
  };
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      for (int i = 0; i < static_cast<int>(blocks.diagonal.size()); ++i) {
        add(6 * i + row, 6 * i + column,
            blocks.diagonal[static_cast<std::size_t>(i)].at(row, column));
      }
      for (std::size_t e = 0; e < blocks.edges.size(); ++e) {
        const auto [a, b] = blocks.edges[e];
        add(6 * a + row, 6 * b + column, blocks.coupling[e].at(row, column));
        add(6 * b + column, 6 * a + row, blocks.coupling[e].at(row, column));
      }
    }
  }
  const auto size = static_cast<Eigen::Index>(6 * blocks.diagonal.size());
  Matrix matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

hf::model::Robot robot_of(const benchmark::State& state) {
  return state.range(0) == 0
             ? load("angle_breaks_c").robot
             : box(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                   static_cast<int>(state.range(2)));
}

void verdict(benchmark::State& state) {
  const hf::model::Robot robot = robot_of(state);
  for (auto _ : state) {
    benchmark::DoNotOptimize(hf::verdict::assess(robot));
  }
  state.counters["modules"] = static_cast<double>(robot.modules().size());
}

void verdict_from_cells(benchmark::State& state) {
  const hf::Structure structure = load("angle_breaks_c");
  for (auto _ : state) {
    const auto robot = hf::io::make_robot(structure.document);
    benchmark::DoNotOptimize(hf::verdict::assess(robot.value()));
  }
}

/// A full check from cells on one thread, as a library: robots of about a hundred modules.
void check_of_family(benchmark::State& state, const char* name) {
  const auto family = hf::model::find_family(name);
  const hf::model::RobotSpec spec{
      .existing = hf::model::family_cells(*family, static_cast<std::size_t>(state.range(0))),
      .lattice = hf::model::family_lattice(*family)};
  for (auto _ : state) {
    const auto robot = hf::model::Robot::create(spec, 1);
    benchmark::DoNotOptimize(hf::verdict::assess(robot.value(), {.thread_count = 1}));
  }
  state.counters["modules"] = static_cast<double>(spec.existing.size());
}

void linear_holdfast(benchmark::State& state) {
  const Blocks blocks = assemble(robot_of(state));
  for (auto _ : state) {
    hf::solver::BlockLu lu(blocks.diagonal.size(), blocks.edges, std::size_t{1} << 30U);
    for (std::size_t e = 0; e < blocks.edges.size(); ++e) {
      lu.set_edge(e, blocks.coupling[e]);
    }
    for (std::size_t i = 0; i < blocks.diagonal.size(); ++i) {
      lu.set_diagonal(i, blocks.diagonal[i]);
    }
    HOLDFAST_CHECK(lu.factor());
    std::vector<hf::base::Vec6<double>> x(blocks.diagonal.size(), {0, 0, -0.6, 0, 0, 0});
    lu.solve(x);
    benchmark::DoNotOptimize(x);
  }
}

void linear_eigen(benchmark::State& state) {
  const Matrix matrix = lower_triangle(assemble(robot_of(state)));
  const Eigen::VectorXd load = Eigen::VectorXd::Constant(matrix.rows(), -0.6);
  for (auto _ : state) {
    const Eigen::SimplicialLDLT<Matrix> ldlt(matrix);
    const Eigen::VectorXd x = ldlt.solve(load);
    benchmark::DoNotOptimize(x.data());
  }
}

void linear_cholmod(benchmark::State& state) {
  Matrix matrix = lower_triangle(assemble(robot_of(state)));
  cholmod_common common;
  cholmod_start(&common);
  cholmod_sparse a{};
  a.nrow = a.ncol = static_cast<std::size_t>(matrix.rows());
  a.nzmax = static_cast<std::size_t>(matrix.nonZeros());
  a.p = matrix.outerIndexPtr();
  a.i = matrix.innerIndexPtr();
  a.x = matrix.valuePtr();
  a.stype = -1;
  a.itype = CHOLMOD_INT;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  cholmod_dense* load = cholmod_ones(a.nrow, 1, CHOLMOD_REAL, &common);
  for (auto _ : state) {
    cholmod_factor* factor = cholmod_analyze(&a, &common);
    cholmod_factorize(&a, factor, &common);
    cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor, load, &common);
    benchmark::DoNotOptimize(x->x);
    cholmod_free_dense(&x, &common);
    cholmod_free_factor(&factor, &common);
  }
  cholmod_free_dense(&load, &common);
  cholmod_finish(&common);
}

/// angle_breaks_c (29 modules), a 3x3 tower of 270, a cube of 512.
void shapes(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"x", "y", "z"})->Unit(benchmark::kMicrosecond);
  bench->Args({0, 0, 0})->Args({3, 3, 30})->Args({8, 8, 8});
}

BENCHMARK(verdict_from_cells)->Unit(benchmark::kMicrosecond);
BENCHMARK(verdict)->Apply(shapes);
BENCHMARK_CAPTURE(check_of_family, tower, "tower")->Arg(11)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(check_of_family, cube, "cube")->Arg(5)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(check_of_family, growth, "growth")->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(check_of_family, portal, "portal")->Arg(7)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(check_of_family, arm, "arm")->Arg(100)->Unit(benchmark::kMicrosecond);
BENCHMARK(linear_holdfast)->Apply(shapes);
BENCHMARK(linear_eigen)->Apply(shapes);
BENCHMARK(linear_cholmod)->Apply(shapes);

}  // namespace
