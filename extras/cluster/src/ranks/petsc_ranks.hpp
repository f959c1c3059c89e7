// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mpi.h>
#include <petscksp.h>

#include <array>
#include <cstdint>
#include <map>

#include "holdfast/host/ranks.hpp"

namespace holdfast::cluster {

/// The amount that a rank has exchanged with others so far.
struct Traffic {
  std::size_t halo_count = 0;  ///< Updates of copies.
  std::size_t halo_bytes = 0;  ///< Received in them.
  std::size_t sum_count = 0;   ///< Reductions, of one number or a few each.
  std::size_t gather_count = 0;
  std::size_t gather_bytes = 0;  ///< Received in them.
};

/// The ranks of a communicator of MPI. Copies are updated by PetscSF; linear systems are solved by
/// KSP, whose type is the task's own flexible CG, with the task's cycle as a PCSHELL, as far as
/// PETSc's options say nothing else. An error of MPI or PETSc ends all ranks (program.cpp).
class PetscRanks final : public host::Ranks {
 public:
  explicit PetscRanks(MPI_Comm comm);
  ~PetscRanks() override;

  MPI_Comm comm() const { return comm_; }

  const Traffic& traffic() const { return traffic_; }

  int rank() const override { return rank_; }

  int count() const override { return count_; }

  double sum(double mine) override;
  double max(double mine) override;
  void sum(std::span<double> mine) override;
  std::vector<std::byte> gather(std::span<const std::byte> mine) override;
  std::unique_ptr<host::Halo> make_halo(std::size_t own_count,
                                        std::span<const host::Copy> copies) override;
  void log(host::Work work, bool is_begin) override;
  bool is_own_method(const host::KrylovTask& task) override;
  void watch(const host::KrylovTask& task) override;
  bool solve(const host::KrylovTask& task, std::span<const double> b, std::span<double> x) override;

  /// Sends each rank its bytes; returns what each has for this one.
  std::vector<std::vector<std::byte>> exchange(const std::vector<std::vector<std::byte>>& to);

 private:
  friend class PetscHalo;

  MPI_Datatype unit(std::size_t size);
  void make_solver(std::size_t count);
  void set_method();
  void run_solver(const host::KrylovTask& task, std::span<const double> b, std::span<double> x);

  MPI_Comm comm_;
  int rank_ = 0;
  int count_ = 1;
  Traffic traffic_;
  std::map<std::size_t, MPI_Datatype> units_;  ///< Size in bytes -> type
  const host::KrylovTask* task_ = nullptr;     ///< That KSP works on.
  PetscInt solver_count_ = -1;                 ///< Numbers of this rank that it is made for.
  KSP solver_ = nullptr;
  Mat matrix_ = nullptr;
  std::array<PetscLogEvent, 2> events_{};  ///< By host::Work.
};

}  // namespace holdfast::cluster
