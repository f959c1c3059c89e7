// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>

#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/solver/contact_journal.hpp"
#include "holdfast/solver/precision.hpp"

/// What a caller may ask of the solvers.
namespace holdfast::solver {

/// How linear systems are solved.
enum class Method : std::uint8_t {
  kAutomatic,  ///< By size and shape.
  kDirect,
  kMultigrid,
};

/// What verdict::assess() finds out about how far linear theory goes.
enum class SecondOrderWish : std::uint8_t {
  kNothing,
  kBesideFactors,  ///< As kCheck, where a factorization is at hand that makes it cheap.
  kCheck,          ///< Whether it suffices: the buckling factor where it is below 10.
  kFactor,         ///< The same, and the buckling factor whatever it is.
};

/// What holds for all equilibria that are sought of one robot.
struct EquilibriumOptions {
  /// Memory for the solver; a robot that needs more gets the outcome kTooLarge.
  /// Half of the address space where that is less than 4 GiB.
  std::size_t memory_bytes_max =
      std::min(std::uint64_t{4} << 30U, std::uint64_t{std::numeric_limits<std::size_t>::max() / 2});
  /// Newton steps per contact problem.
  int step_count_max = 100;
  /// Parts of a robot are solved by multigrid alone, which their processes must say here.
  Method method = Method::kAutomatic;
  /// The precision that multigrid begins with. Where single is not enough it takes double.
  Precision precision = Precision::kSingle;
  /// Supports neither lift nor tilt: the ground holds like a module below would. A linear problem.
  bool is_bonded = false;
  /// The number of threads of multigrid; 0: as many as the machine has cores. The result does not
  /// depend on it.
  int thread_count = 0;
  /// Multigrid's error in the energy norm, as a share of that of no displacements at all.
  /// Load ratios are then within 1e-4 of the largest one or of 1 (docs/solver.md).
  double tolerance = 1e-5;
  /// The direct solver finds displacements in 106 bits, so that load ratios have twelve digits and
  /// more however slender or soft the robot is, and leaves out the weak springs beside the
  /// unilateral law where it needs none. Otherwise it does so only where double precision does not
  /// suffice.
  bool is_precise = false;
  /// Makes verdict::assess() find how far gravity may turn and which friction would do where
  /// supports are anywhere. Only reports need them.
  bool has_rigid_figures = true;
  /// Makes verdict::assess() do the second-order check of whole robots. Planners, which ask very
  /// often, go without.
  SecondOrderWish second_order = SecondOrderWish::kNothing;
  /// The direct solver gives up (kTooLarge) where more blocks than this fill in per node.
  std::size_t fill_max = std::numeric_limits<std::size_t>::max();
  /// Called after every iteration of multigrid with the error that is left, as a share of the
  /// first.
  std::function<void(int iteration, double error)> progress = {};
  /// Remembers contact states beyond this run; null: nobody does.
  ContactJournal* journal = nullptr;
};

/// The law of contact with the ground.
struct ContactOptions {
  mechanics::ContactLaw law = mechanics::ContactLaw::kRegularised;
  /// The weak spring that stays where the contact yields, as a fraction of the full stiffness.
  /// Part of the regularised law; the unilateral law needs it only for robots that topple.
  double gamma = 1e-4;
};

}  // namespace holdfast::solver
