// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// One structure by CHOLMOD: assembly, factorization, solution. A program of its own because the
// BLAS below CHOLMOD starts threads that spin, beside whatever else a program does.
//   cholmod_bench FAMILY SIZE FILE
// Prints: modules seconds-of-the-fastest-of-several MB iterations
#include <cholmod.h>

#include <cstdlib>
#include <cstring>
#include <optional>

#include "holdfast/holdfast.hpp"
#include "large_robots.hpp"

namespace holdfast::bench {
namespace {

/// The lower triangle of the bonded stiffness matrix in CHOLMOD's triplet form.
cholmod_triplet* assemble(const model::Robot& robot, cholmod_common& common) {
  const auto beam = mechanics::beam_stiffness(model::beam_section(robot.material()));
  const std::size_t n = robot.modules().size();
  cholmod_triplet* matrix = cholmod_l_allocate_triplet(
      6 * n, 6 * n, 21 * n + 20 * robot.connections().size(), -1, CHOLMOD_REAL, &common);
  auto* rows = static_cast<SuiteSparse_long*>(matrix->i);
  auto* columns = static_cast<SuiteSparse_long*>(matrix->j);
  auto* values = static_cast<double*>(matrix->x);
  const auto add = [&](std::size_t a, std::size_t b, const base::Mat6<double>& block) {
    for (int row = 0; row < 6; ++row) {
      for (int column = 0; column < 6; ++column) {
        const double value = block.at(row, column);
        if (value != 0 && (a > b || row >= column)) {
          rows[matrix->nnz] = static_cast<SuiteSparse_long>(6 * a) + row;
          columns[matrix->nnz] = static_cast<SuiteSparse_long>(6 * b) + column;
          values[matrix->nnz++] = value;
        }
      }
    }
  };
  std::vector<base::Mat6<double>> diagonal(n);
  for (const model::Connection& pair : robot.connections()) {
    const auto a = static_cast<std::size_t>(pair.a);
    const auto b = static_cast<std::size_t>(pair.b);
    const base::Direction back = base::opposite(pair.direction);
    base::add_to(diagonal[a], mechanics::block_11(beam, pair.direction));
    base::add_to(diagonal[b], mechanics::block_11(beam, back));
    if (a > b) {
      add(a, b, mechanics::block_12(beam, pair.direction));
    } else {
      add(b, a, mechanics::block_12(beam, back));
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (robot.modules()[i].support == model::Support::kGround) {
      base::add_to(diagonal[i], mechanics::block_11(beam, base::Direction::kMinusZ));
    }
    add(i, i, diagonal[i]);
  }
  return matrix;
}

/// Solves into `u`; the seconds that took, or nothing.
std::optional<double> solve(const model::Robot& robot, cholmod_common& common, Displacement& u) {
  const auto start = Clock::now();
  cholmod_triplet* triplet = assemble(robot, common);
  cholmod_sparse* matrix = cholmod_l_triplet_to_sparse(triplet, 0, &common);
  cholmod_factor* factor = cholmod_l_analyze(matrix, &common);
  if (cholmod_l_factorize(matrix, factor, &common) == 0 || common.status != CHOLMOD_OK) {
    return {};
  }
  const std::size_t n = robot.modules().size();
  cholmod_dense* right = cholmod_l_zeros(6 * n, 1, CHOLMOD_REAL, &common);
  for (std::size_t i = 0; i < n; ++i) {
    static_cast<double*>(right->x)[6 * i + 2] = -model::module_weight_n(robot.material());
  }
  cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor, right, &common);
  const double seconds = seconds_since(start);
  std::memcpy(u.data(), x->x, n * sizeof u[0]);
  cholmod_l_free_dense(&x, &common);
  cholmod_l_free_dense(&right, &common);
  cholmod_l_free_factor(&factor, &common);
  cholmod_l_free_sparse(&matrix, &common);
  cholmod_l_free_triplet(&triplet, &common);
  return seconds;
}

int run_cholmod(const std::string& family, std::size_t size, const char* path) {
  const auto robot = model::Robot::create(spec_of(family, size)).value();
  cholmod_common common;
  cholmod_l_start(&common);
  Displacement u(robot.modules().size());
  bool is_solved = true;
  const Timing timing = fastest([&] {
    const std::optional<double> run = solve(robot, common, u);
    is_solved = is_solved && run.has_value();
    return run.value_or(1e30);
  });
  if (!is_solved) {
    return 1;
  }
  print_run(u.size(), timing, 0);
  write_displacement(path, u);
  return 0;
}

}  // namespace
}  // namespace holdfast::bench

int main(int argc, char** argv) {
  return argc != 4 ? 64
                   : holdfast::bench::run_cholmod(
                         argv[1], static_cast<std::size_t>(std::atoll(argv[2])), argv[3]);
}
