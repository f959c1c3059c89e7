// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "holdfast/limit/rigid_stability.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/equilibrium.hpp"
#include "holdfast/verdict/reason.hpp"
#include "holdfast/verdict/rigid_body.hpp"
#include "holdfast/verdict/second_order.hpp"

/// Gives the verdict on a robot with its planned step, and everything that it rests on.
namespace holdfast::verdict {

enum class Verdict : std::uint8_t {
  kSafe,       ///< Stable, and every connection carries less than its strength.
  kOverload,   ///< Stable, but at least one connection carries its strength or more.
  kUnstable,   ///< Topples, or has nothing to spare against toppling.
  kUndecided,  ///< Not certain; the reasons say why.
};

/// The contact model that the forces come from.
enum class ContactModel : std::uint8_t {
  kNone,         ///< Every support is fixed.
  kBonded,       ///< Supports hold like a module below would, on request.
  kRegularised,  ///< Eqs. (9)-(12), the paper's.
  kUnilateral,   ///< Eqs. (6)-(8), exact; used where (9)-(12) have no usable answer.
};

/// The rule that decides whether a robot keeps standing where it is.
enum class StabilityRule : std::uint8_t {
  kHeld,           ///< A fixed module or a bonded facet holds it.
  kPolygon,        ///< All facets lie in a level plane: the support polygon.
  kContactForces,  ///< Supports anywhere: contact forces of a rigid body, and the model.
};

/// The load of one connection, in its middle (Eqs. 16-17).
struct ConnectionResult {
  /// The largest ratio of its limits, see model::ConnectorLaw; Eq. (17) is (2 bending / a + axial)
  /// / Fmax. Breaks at 1 or more.
  double load_ratio = 0;
  double axial_n = 0;  ///< Tension is positive.
  double bending_nmm = 0;
  double shear_n = 0;      ///< Not part of Eq. (17).
  double torsion_nmm = 0;  ///< Not part of Eq. (17).
};

/// The gaps by which connections open at the edge of the facet beyond what contacts of power and
/// data tolerate: no verdict, but a warning.
struct OpenGaps {
  std::size_t count = 0;  ///< Connections beyond their limit.
  std::size_t worst = 0;  ///< The index of the one with the largest share of its limit.
  double gap_mm = 0;      ///< Its opening,
  double limit_mm = 0;    ///< and its limit.
  std::array<base::Cell, 2> ends = {};  ///< Of that connection.
};

/// The place in plan to which bending takes the centre of mass, by the displacements of the
/// equilibrium.
struct Lean {
  double shift_mm = 0;   ///< By how far it moves.
  double margin_mm = 0;  ///< Its least distance to an edge's line then, inside, less its error.
};

/// The share of the margin above which bending is worth a warning.
inline constexpr double kLeanShare = 0.1;

/// The loads of all ranks' connections together, of a robot of which this is a part.
struct WholeLoads {
  std::size_t connection_count = 0;
  std::size_t broken_count = 0;
  std::array<base::Cell, 2> worst = {};  ///< The ends of the one with the largest load ratio.
};

/// The range in which the largest load ratio lies: its ends are apart by the solver's error, with a
/// margin, or by feet whose hold on the ground is ambiguous. A verdict needs both on the same side
/// of 1.
struct LoadRange {
  double low = 0;
  double high = 0;
};

/// The largest load ratios of several solutions: of the paper's contact law, where it has more than
/// one or where open facets may pull, and of the exact law beside it. A verdict needs all of them
/// on one side of 1.
struct SeveralSolutions {
  std::size_t found_count = 0;          ///< At least so many; 1 where open facets may pull.
  LoadRange regularised;                ///< Over all solutions found.
  std::optional<LoadRange> unilateral;  ///< None if no equilibrium was found.
  double error = 0;                     ///< By which each of these may be off.
};

/// A pressed facet that carries more sideways than its friction.
struct Slip {
  std::size_t module = 0;  ///< Index, at `rank`.
  int rank = 0;
  double friction = 0;  ///< The coefficient.
  double ratio = 0;     ///< |ft| / |fn|.
};

struct ModelStability {
  bool is_stable = false;
  bool is_settled = false;  ///< False: no consistent contact state was found, is_stable is void.
  /// Whether another solution of the paper's contact law, or the exact law's, has states in which
  /// the robot falls.
  bool falls_otherwise = false;
  std::optional<Slip> slip_otherwise = {};  ///< By the exact law, asked beside the paper's.
};

/// What is known of one piece of a robot that is in several.
struct PieceAnswer {
  std::size_t module_count = 0;
  base::Cell first;  ///< Its first module, by which it is named.
  Verdict verdict = Verdict::kUndecided;
  std::optional<double> load_ratio_max;
  std::optional<double> margin_mm;
};

struct Assessment {
  Verdict verdict = Verdict::kUndecided;
  std::vector<Reason> reasons;  ///< One or more; the first decides.

  StabilityRule stability_rule = StabilityRule::kPolygon;
  RigidBody simplified;         ///< Sec. III-B.
  limit::RigidStability rigid;  ///< The same with supports anywhere, and how it would fall.
  ModelStability model;         ///< Sec. III-C.
  /// Whether the robot is stable: on a flat floor by the rigid body; with supports elsewhere only
  /// if the rigid body holds and the model does not say otherwise. Bonded supports hold always.
  bool is_stable = false;

  /// The loads of the whole robot if this is a part of it; none for a robot that is whole.
  /// `connections` and `broken` of a part are this rank's, and `worst` is an index at the rank that
  /// has it; all else is of the whole robot.
  std::optional<WholeLoads> whole;

  /// One result per connection of the robot; empty if no equilibrium was found, or sought: a large
  /// robot that topples is known to topple by the rigid body. Not meaningful if unstable.
  std::vector<ConnectionResult> connections;
  std::optional<double> load_ratio_max;  ///< None without connections or if one is not a number.
  /// The index of the connection with load_ratio_max; none if that is below kLoadRatioTie, which is
  /// rounding or compression, or below the width of load_ratio_range, its own uncertainty: no
  /// connection is known to be pulled apart.
  std::optional<std::size_t> worst;
  std::vector<std::size_t> broken;  ///< Indices of connections at 1 or more, worst first.
  /// The gap of every connection, mm, where displacements are too large for those of linear theory;
  /// else empty.
  std::vector<double> gaps_mm;
  std::optional<OpenGaps> gaps;  ///< None if no gap is too wide.
  /// Whether linear theory suffices; none if that was not asked, or nothing holds the robot.
  std::optional<SecondOrder> second_order;
  std::optional<Lean> lean;  ///< None where the polygon does not decide, or nothing holds.
  /// All loads could grow by this factor before the first connection breaks; none without `worst`.
  std::optional<double> weight_factor;
  LoadRange load_ratio_range;  ///< Void where load_ratio_max is.
  /// The most by which any load ratio changed between the last two solutions of the linear system.
  double load_ratio_change = 0;

  ContactModel contact_model = ContactModel::kNone;
  /// Further solutions; none if the law that the forces come from has one, as far as was found.
  std::optional<SeveralSolutions> several;
  solver::Equilibrium equilibrium;  ///< Displacements, contact states, ground forces.
  /// The pieces of a robot that is in several, the worst first; else empty. Each is judged by
  /// itself. The verdict is then the worst one's, with its reason; stability is that of the piece
  /// with the least margin, what linear theory leaves out that of the one where it is trusted
  /// least, and loads are those of all.
  std::vector<PieceAnswer> pieces;
};

/// A load ratio this close below 1 counts as 1: the margin is rounding, not strength. One below
/// this counts as no load. Rounding moves ratios by about 1e-13.
inline constexpr double kLoadRatioTie = 1e-9;

/// The estimate of an error's energy norm, Equilibrium::energy_error, counts so many times.
inline constexpr double kEnergyFactor = 3;

/// Whether a connection with this load ratio breaks.
inline bool breaks(double load_ratio) { return load_ratio >= 1 - kLoadRatioTie; }

/// Whether weak springs of open or tilted facets, part of the paper's law, may carry part of the
/// load in the assessment's equilibrium, as supports are anywhere: on a floor all that they can do
/// is pull down. Then the exact law is asked as well.
bool has_pulling_facets(const model::Robot& robot, const Assessment& assessment);

/// Whether the robot stays where it is, as far as that is known: none where the verdict depends on
/// it.
inline std::optional<bool> known_stability(const Assessment& assessment) {
  const bool is_open = !assessment.is_stable && assessment.verdict == Verdict::kUndecided;
  return is_open ? std::nullopt : std::optional(assessment.is_stable);
}

/// Assesses a robot by the rigid body alone: no verdict, no reasons. With supports anywhere, tilt
/// and friction are found only if `has_figures` asks for them.
Assessment assess_rigidly(const model::Robot& robot, bool has_figures = true);

/// Seeks the equilibrium of a robot and says what follows from it.
Assessment assess(const model::Robot& robot, const solver::EquilibriumOptions& options = {});

/// Says what follows from an equilibrium that is already there, whoever found it, on so many
/// threads; 0: as many as the machine has cores.
Assessment assess_equilibrium(const model::Robot& robot, solver::Equilibrium equilibrium,
                              int thread_count = 0);

/// Why a robot that linear theory calls safe, or overloaded, may be neither: the reason of an
/// undecided verdict. None where linear theory is trusted or its trust not known, where nobody said
/// what the elastic modulus is, or where all that bending does leaves the verdict as it is.
std::optional<Reason> second_order_doubt(const Assessment& assessment);

/// How bad a verdict is: safe 0, undecided 1, overload 2, unstable 3.
int severity(Verdict verdict);

/// Returns "safe", "overload", "unstable" or "undecided".
const char* name(Verdict verdict);

/// Returns "none", "bonded", "regularised" or "unilateral".
const char* name(ContactModel model);

}  // namespace holdfast::verdict
