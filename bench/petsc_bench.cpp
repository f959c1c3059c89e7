// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// PETSc on one structure, bonded supports, residual 1e-6; assembly, set-up, solve.
//   mpirun -n RANKS petsc_bench FAMILY SIZE FILE [PETSc options: -pc_type ...]
// prints: modules seconds-of-the-fastest-of-several MB-of-all-ranks iterations
#include <petscksp.h>

#include <algorithm>
#include <array>
#include <span>

#include "large_robots.hpp"

namespace {

namespace hf = holdfast;
using hf::base::Mat6;

/// The facets of a module.
std::span<const hf::model::Facet> facets_of(const hf::model::Robot& robot, PetscInt module) {
  const auto range =
      std::ranges::equal_range(robot.facets(), module, {}, &hf::model::Facet::module);
  return {range.begin(), range.end()};
}

/// Rows of the modules from `first` to before `last`.
Mat assemble(const hf::model::Robot& robot, PetscInt first, PetscInt last) {
  const hf::model::LatticeBeam<double> beam(hf::model::beam_section(robot.material()),
                                            robot.lattice());
  const auto n = static_cast<PetscInt>(robot.modules().size());
  Mat matrix = nullptr;
  MatCreateAIJ(PETSC_COMM_WORLD, 6 * (last - first), 6 * (last - first), 6 * n, 6 * n,
               6 * (robot.lattice().direction_count + 1), nullptr,
               6 * robot.lattice().direction_count, nullptr, &matrix);
  MatSetBlockSize(matrix, 6);
  // Two thirds of each block of cubes are zero: without them every method here is faster.
  MatSetOption(matrix, MAT_IGNORE_ZERO_ENTRIES, PETSC_TRUE);
  for (PetscInt row = first; row < last; ++row) {
    const auto module = static_cast<std::size_t>(row);
    Mat6<double> diagonal;
    for (const hf::model::Facet& facet : facets_of(robot, row)) {
      hf::base::add_to(diagonal, beam.block_11(facet.direction));
    }
    for (const hf::base::Direction direction : hf::base::directions(robot.lattice())) {
      PetscInt column =
          robot.connected()[module][static_cast<std::size_t>(hf::base::index(direction))];
      if (column >= 0) {
        hf::base::add_to(diagonal, beam.block_11(direction));
        const Mat6<double> block = beam.block_12(direction);
        double by_rows[36];
        for (int i = 0; i < 36; ++i) {
          by_rows[i] = block.at(i / 6, i % 6);
        }
        MatSetValuesBlocked(matrix, 1, &row, 1, &column, by_rows, INSERT_VALUES);
      }
    }
    double by_rows[36];
    for (int i = 0; i < 36; ++i) {
      by_rows[i] = diagonal.at(i / 6, i % 6);
    }
    MatSetValuesBlocked(matrix, 1, &row, 1, &row, by_rows, INSERT_VALUES);
  }
  MatAssemblyBegin(matrix, MAT_FINAL_ASSEMBLY);
  MatAssemblyEnd(matrix, MAT_FINAL_ASSEMBLY);
  MatSetOption(matrix, MAT_SPD, PETSC_TRUE);
  return matrix;
}

/// The six rigid motions, which aggregation needs.
void attach_rigid_motions(const hf::model::Robot& robot, PetscInt first, PetscInt last,
                          Mat matrix) {
  Vec motions[6];
  MatCreateVecs(matrix, &motions[0], nullptr);
  for (int k = 1; k < 6; ++k) {
    VecDuplicate(motions[0], &motions[k]);
  }
  const double pitch = robot.material().pitch_mm;
  for (int k = 0; k < 6; ++k) {
    double* values = nullptr;
    VecGetArray(motions[k], &values);
    for (PetscInt row = first; row < last; ++row) {
      double* u = values + 6 * (row - first);
      const hf::base::Cell& cell = robot.modules()[static_cast<std::size_t>(row)].cell;
      const std::array<double, 3> steps = hf::base::node_place(robot.lattice(), cell);
      const double place[3] = {pitch * steps[0], pitch * steps[1], pitch * steps[2]};
      u[k] = 1;
      if (k >= 3) {
        const int i = k - 3;
        u[(i + 1) % 3] = -place[(i + 2) % 3];
        u[(i + 2) % 3] = place[(i + 1) % 3];
      }
    }
    VecRestoreArray(motions[k], &values);
  }
  for (int k = 0; k < 6; ++k) {
    PetscScalar dots[6];
    VecMDot(motions[k], k, motions, dots);
    for (int i = 0; i < k; ++i) {
      VecAXPY(motions[k], -dots[i], motions[i]);
    }
    VecNormalize(motions[k], nullptr);
  }
  MatNullSpace space = nullptr;
  MatNullSpaceCreate(PETSC_COMM_WORLD, PETSC_FALSE, 6, motions, &space);
  MatSetNearNullSpace(matrix, space);
}

void write(Vec x, std::size_t count, const char* path) {
  VecScatter scatter = nullptr;
  Vec all = nullptr;
  VecScatterCreateToZero(x, &scatter, &all);
  VecScatterBegin(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD);
  VecScatterEnd(scatter, x, all, INSERT_VALUES, SCATTER_FORWARD);
  PetscMPIInt rank = 0;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0) {
    const double* values = nullptr;
    VecGetArrayRead(all, &values);
    hf::bench::Displacement u(count);
    for (std::size_t i = 0; i < 6 * count; ++i) {
      u[i / 6][i % 6] = values[i];
    }
    hf::bench::write_displacement(path, u);
    VecRestoreArrayRead(all, &values);
  }
}

struct Run {
  Vec x = nullptr;
  double seconds = 0;
  PetscInt iterations = 0;
  bool is_converged = false;
};

/// Assembly, set-up and solution. The seconds are those of the slowest rank.
Run solve(const hf::model::Robot& robot, PetscInt first, PetscInt last) {
  Run run;
  MPI_Barrier(PETSC_COMM_WORLD);
  const auto start = hf::bench::Clock::now();
  Mat matrix = assemble(robot, first, last);
  attach_rigid_motions(robot, first, last, matrix);
  Vec b = nullptr;
  MatCreateVecs(matrix, &run.x, &b);
  for (PetscInt row = first; row < last; ++row) {
    VecSetValue(b, 6 * row + 2, -hf::model::module_weight_n(robot.material()), INSERT_VALUES);
  }
  VecAssemblyBegin(b);
  VecAssemblyEnd(b);
  KSP solver = nullptr;
  KSPCreate(PETSC_COMM_WORLD, &solver);
  KSPSetOperators(solver, matrix, matrix);
  KSPSetType(solver, KSPCG);
  KSPSetTolerances(solver, 1e-6, PETSC_DEFAULT, PETSC_DEFAULT, 20000);
  KSPSetFromOptions(solver);
  KSPSolve(solver, b, run.x);
  run.seconds = hf::bench::seconds_since(start);
  MPI_Allreduce(MPI_IN_PLACE, &run.seconds, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD);
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  KSPGetConvergedReason(solver, &reason);
  run.is_converged = reason > 0;
  KSPGetIterationNumber(solver, &run.iterations);
  KSPDestroy(&solver);
  VecDestroy(&b);
  MatDestroy(&matrix);
  return run;
}

int run(const char* family, std::size_t size, const char* path) {
  const auto robot = hf::model::Robot::create(hf::bench::spec_of(family, size)).value();
  PetscMPIInt rank = 0;
  PetscMPIInt ranks = 1;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  const auto n = static_cast<PetscInt>(robot.modules().size());
  Run last;
  const hf::bench::Timing timing = hf::bench::fastest([&] {
    VecDestroy(&last.x);
    last = solve(robot, n * rank / ranks, n * (rank + 1) / ranks);
    return last.seconds;
  });
  double mb = timing.mb;
  MPI_Allreduce(MPI_IN_PLACE, &mb, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD);
  if (rank == 0) {
    std::printf("%d %.6f %.1f %d\n", n, timing.seconds, mb, last.iterations);
  }
  write(last.x, robot.modules().size(), path);
  return last.is_converged ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    return 64;
  }
  PetscInitialize(&argc, &argv, nullptr, nullptr);
  const int code = run(argv[1], static_cast<std::size_t>(std::atoll(argv[2])), argv[3]);
  PetscFinalize();
  return code;
}
