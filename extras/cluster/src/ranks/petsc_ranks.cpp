// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/petsc_ranks.hpp"

#include <petscsf.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "ranks/task_method.hpp"

namespace holdfast::cluster {

/// A star forest: originals are its roots, copies its leaves.
class PetscHalo final : public host::Halo {
 public:
  PetscHalo(PetscRanks& ranks, std::size_t own_count, std::span<const host::Copy> copies)
      : ranks_(ranks), copy_count_(copies.size()) {
    std::vector<PetscInt> places;
    std::vector<PetscSFNode> originals;
    for (const host::Copy& copy : copies) {
      places.push_back(copy.place);
      originals.push_back({copy.original.rank, copy.original.index});
    }
    PetscSFCreate(ranks.comm(), &forest_);
    PetscSFSetGraph(forest_, static_cast<PetscInt>(own_count), static_cast<PetscInt>(copies.size()),
                    places.data(), PETSC_COPY_VALUES, originals.data(), PETSC_COPY_VALUES);
    PetscSFSetUp(forest_);
  }

  ~PetscHalo() override { PetscSFDestroy(&forest_); }

  void update(void* items, std::size_t size) override {
    MPI_Datatype unit = ranks_.unit(size);
    PetscSFBcastBegin(forest_, unit, items, items, MPI_REPLACE);
    PetscSFBcastEnd(forest_, unit, items, items, MPI_REPLACE);
    ++ranks_.traffic_.halo_count;
    ranks_.traffic_.halo_bytes += copy_count_ * size;
  }

 private:
  PetscRanks& ranks_;
  std::size_t copy_count_;
  PetscSF forest_ = nullptr;
};

namespace {

/// Counts of MPI are ints.
int int_count(std::size_t count) {
  if (count > std::size_t{std::numeric_limits<int>::max()}) {
    throw std::length_error("a message of more than 2 GB: use more ranks");
  }
  return static_cast<int>(count);
}

/// The places where the ranks' parts begin, and at the end the size of all.
std::vector<int> starts_of(const std::vector<int>& counts) {
  std::vector<int> start = {0};
  std::size_t sum = 0;
  for (const int count : counts) {
    sum += static_cast<std::size_t>(count);
    start.push_back(int_count(sum));
  }
  return start;
}

/// Calls f(task, from, to) with the numbers of two vectors.
template <class F>
void with_arrays(const host::KrylovTask* task, Vec from, Vec to, const F& f) {
  const PetscScalar* read = nullptr;
  PetscScalar* written = nullptr;
  VecGetArrayRead(from, &read);
  VecGetArrayWrite(to, &written);
  f(*task, read, written);
  VecRestoreArrayWrite(to, &written);
  VecRestoreArrayRead(from, &read);
}

const host::KrylovTask* task_of(void* context) {
  return *static_cast<const host::KrylovTask**>(context);
}

PetscErrorCode multiply(Mat matrix, Vec p, Vec q) {
  void* context = nullptr;
  MatShellGetContext(matrix, &context);
  with_arrays(task_of(context), p, q,
              [](const auto& task, const double* from, double* to) { task.multiply(from, to); });
  return 0;
}

PetscErrorCode precondition(PC preconditioner, Vec r, Vec z) {
  void* context = nullptr;
  PCShellGetContext(preconditioner, &context);
  with_arrays(task_of(context), r, z, [](const auto& task, const double* from, double* to) {
    task.precondition(from, to);
  });
  return 0;
}

/// The natural norm is the root of r . M^-1 r.
PetscErrorCode test_convergence(KSP, PetscInt iteration, PetscReal norm, KSPConvergedReason* reason,
                                void* context) {
  const bool is_over = task_of(context)->is_over(static_cast<int>(iteration), norm * norm);
  *reason = is_over ? KSP_CONVERGED_ATOL : KSP_CONVERGED_ITERATING;
  return 0;
}

template <class Object>
bool has_type(Object object, const char* type) {
  PetscBool is_that = PETSC_FALSE;
  PetscObjectTypeCompare(reinterpret_cast<PetscObject>(object), type, &is_that);
  return is_that == PETSC_TRUE;
}

}  // namespace

PetscRanks::PetscRanks(MPI_Comm comm) : comm_(comm) {
  MPI_Comm_rank(comm, &rank_);
  MPI_Comm_size(comm, &count_);
  register_task_method();
  PetscClassId id = 0;
  PetscClassIdRegister("holdfast", &id);
  PetscLogEventRegister("holdfast K p", id,
                        &events_[static_cast<std::size_t>(host::Work::kProduct)]);
  PetscLogEventRegister("holdfast cycle", id,
                        &events_[static_cast<std::size_t>(host::Work::kCycle)]);
}

PetscRanks::~PetscRanks() {
  KSPDestroy(&solver_);
  MatDestroy(&matrix_);
  for (auto& [size, type] : units_) {
    MPI_Type_free(&type);
  }
}

MPI_Datatype PetscRanks::unit(std::size_t size) {
  const auto [found, is_new] = units_.try_emplace(size, MPI_DATATYPE_NULL);
  if (is_new) {
    // PETSc packs what consists of its integers faster than bytes.
    constexpr std::size_t kWord = sizeof(PetscInt);
    if (size % kWord == 0) {
      MPI_Type_contiguous(int_count(size / kWord), MPIU_INT, &found->second);
    } else {
      MPI_Type_contiguous(int_count(size), MPI_BYTE, &found->second);
    }
    MPI_Type_commit(&found->second);
  }
  return found->second;
}

double PetscRanks::sum(double mine) {
  double all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, comm_);
  ++traffic_.sum_count;
  return all;
}

void PetscRanks::sum(std::span<double> mine) {
  MPI_Allreduce(MPI_IN_PLACE, mine.data(), int_count(mine.size()), MPI_DOUBLE, MPI_SUM, comm_);
  ++traffic_.sum_count;
}

double PetscRanks::max(double mine) {
  double all = 0;
  MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_MAX, comm_);
  ++traffic_.sum_count;
  return all;
}

std::vector<std::byte> PetscRanks::gather(std::span<const std::byte> mine) {
  const int count = int_count(mine.size());
  std::vector<int> counts(static_cast<std::size_t>(count_));
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, comm_);
  const std::vector<int> start = starts_of(counts);
  std::vector<std::byte> all(static_cast<std::size_t>(start.back()));
  MPI_Allgatherv(mine.data(), count, MPI_BYTE, all.data(), counts.data(), start.data(), MPI_BYTE,
                 comm_);
  ++traffic_.gather_count;
  traffic_.gather_bytes += all.size();
  return all;
}

std::vector<std::vector<std::byte>> PetscRanks::exchange(
    const std::vector<std::vector<std::byte>>& to) {
  std::vector<int> counts_to;
  std::vector<std::byte> all_to;
  for (const std::vector<std::byte>& part : to) {
    counts_to.push_back(int_count(part.size()));
    all_to.insert(all_to.end(), part.begin(), part.end());
  }
  std::vector<int> counts_from(counts_to.size());
  MPI_Alltoall(counts_to.data(), 1, MPI_INT, counts_from.data(), 1, MPI_INT, comm_);
  const std::vector<int> start_to = starts_of(counts_to);
  const std::vector<int> start_from = starts_of(counts_from);
  std::vector<std::byte> all_from(static_cast<std::size_t>(start_from.back()));
  MPI_Alltoallv(all_to.data(), counts_to.data(), start_to.data(), MPI_BYTE, all_from.data(),
                counts_from.data(), start_from.data(), MPI_BYTE, comm_);
  std::vector<std::vector<std::byte>> from;
  for (std::size_t rank = 0; rank < counts_from.size(); ++rank) {
    from.emplace_back(all_from.begin() + start_from[rank], all_from.begin() + start_from[rank + 1]);
  }
  return from;
}

std::unique_ptr<host::Halo> PetscRanks::make_halo(std::size_t own_count,
                                                  std::span<const host::Copy> copies) {
  return std::make_unique<PetscHalo>(*this, own_count, copies);
}

void PetscRanks::log(host::Work work, bool is_begin) {
  const PetscLogEvent event = events_[static_cast<std::size_t>(work)];
  if (is_begin) {
    PetscLogEventBegin(event, 0, 0, 0, 0);
  } else {
    PetscLogEventEnd(event, 0, 0, 0, 0);
  }
}

/// All ranks or none make a solver anew.
void PetscRanks::make_solver(std::size_t own_count) {
  const auto count = static_cast<PetscInt>(own_count);
  if (max(solver_count_ == count ? 0 : 1) == 0) {
    return;
  }
  solver_count_ = count;
  KSPDestroy(&solver_);
  MatDestroy(&matrix_);
  MatCreateShell(comm_, count, count, PETSC_DETERMINE, PETSC_DETERMINE, &task_, &matrix_);
  MatShellSetOperation(matrix_, MATOP_MULT, reinterpret_cast<void (*)()>(multiply));
  MatSetOption(matrix_, MAT_SPD, PETSC_TRUE);
  KSPCreate(comm_, &solver_);
  KSPSetOperators(solver_, matrix_, matrix_);
  set_method();
  // What is asked of the method is an error in the energy norm, whatever the options say.
  KSPSetNormType(solver_, KSP_NORM_NATURAL);
  KSPSetConvergenceTest(solver_, test_convergence, &task_, nullptr);
}

/// The task's own method, unless options name a method or a preconditioner: PETSc's flexible CG is
/// what goes with any.
void PetscRanks::set_method() {
  KSPSetType(solver_, KSPFCG);
  KSPFCGSetMmax(solver_, 1);  // As one machine has: it keeps the memory of a rank small.
  KSPFCGSetNprealloc(solver_, 1);
  PC preconditioner = nullptr;
  KSPGetPC(solver_, &preconditioner);
  PCSetType(preconditioner, PCSHELL);
  PCShellSetContext(preconditioner, &task_);
  PCShellSetApply(preconditioner, precondition);
  PCShellSetName(preconditioner, "holdfast: one K-cycle");
  KSPSetFromOptions(solver_);
  if (has_absent_monitor(solver_)) {
    throw std::invalid_argument("a monitor of PETSc's in a format that it does not have");
  }
  PetscBool is_named = PETSC_FALSE;
  PetscOptionsHasName(nullptr, nullptr, "-ksp_type", &is_named);
  if (is_named == PETSC_FALSE && has_type(preconditioner, PCSHELL)) {
    KSPSetType(solver_, kTaskMethod);
  }
}

bool PetscRanks::is_own_method(const host::KrylovTask& task) {
  make_solver(task.x.size());
  return has_type(solver_, kTaskMethod);
}

void PetscRanks::run_solver(const host::KrylovTask& task, std::span<const double> b,
                            std::span<double> x) {
  task_ = &task;
  Vec right = nullptr;
  Vec solution = nullptr;
  const auto count = static_cast<PetscInt>(b.size());
  VecCreateMPIWithArray(comm_, 1, count, PETSC_DETERMINE, b.data(), &right);
  VecCreateMPIWithArray(comm_, 1, count, PETSC_DETERMINE, x.data(), &solution);
  KSPSolve(solver_, right, solution);
  VecDestroy(&right);
  VecDestroy(&solution);
  task_ = nullptr;
}

/// Runs the method under PETSc's monitors; b is the residual with which it begins.
void PetscRanks::watch(const host::KrylovTask& task) {
  KSPSetInitialGuessNonzero(solver_, PETSC_TRUE);
  std::vector<double> b(task.x.size());
  task.residual(b.data());
  run_solver(task, b, task.x);
}

bool PetscRanks::solve(const host::KrylovTask& task, std::span<const double> b,
                       std::span<double> x) {
  make_solver(b.size());
  run_solver(task, b, x);
  PC preconditioner = nullptr;
  KSPGetPC(solver_, &preconditioner);
  return has_type(preconditioner, PCSHELL);
}

}  // namespace holdfast::cluster
