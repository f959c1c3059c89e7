// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "holdfast/model/robot.hpp"

namespace holdfast::verdict {

/// The reason for a verdict. Behind a colon stand the `numbers` of a reason with that code. For
/// several solutions they are: how many were found, the lowest and highest of their largest load
/// ratios, and the lowest and highest of the exact law's, where the lowest is above the highest if
/// it has none.
enum class ReasonCode : std::uint8_t {
  kNothingToSpare,     ///< The mass lies over the edge: x, y of its first end, x, y of its second.
  kTopples,            ///< The same four, and by how much the mass lies beyond the edge, mm.
  kTooManyModules,     ///< They do not fit into the memory allowed: how many there are.
  kNoDigitsLeft,       ///< Rounding leaves no digits of the loads.
  kNoEquilibrium,      ///< None was found: linear solves.
  kSingularStiffness,  ///< None was found, as the matrix became singular: linear solves.
  kLoadNotANumber,     ///< A load ratio is not a number.
  kLimitInRange,       ///< The load ratio at which connections break lies within: low, high.
  kSolutionsDisagree,  ///< Five, see below.
  kConnectionsBreak,   ///< How many, of how many, index of the worst, its load ratio.
  kSingleModule,       ///< It has no connection.
  kNoTension,          ///< No connection is pulled apart.
  kNoKnownTension,     ///< None is known to be: an upper bound of the load ratios.
  kHolds,              ///< Index of the worst connection, its load ratio.
  kUnilateralContact,  ///< The loads come from Eqs. (6)-(8).
  kSolutionsAgree,     ///< Five, see below.
  kAmbiguousFeet,      ///< How many, lowest and highest of the largest load ratio.
  kBonded,             ///< Supports are bonded on request.
  kModelDisagrees,     ///< The model-based check says something else: 1 if it says stable.
  kProvedOneSolution,  ///< Proved for one solution of the paper's contact law.
  kProvedForces,       ///< Proved for the exact contact law, whose forces are unique.
  kProvedUnique,       ///< Proved, and there is no other solution.
  kNotProved,          ///< `quoted` says why.
  kNoVerdictOfTheRobot,  ///< The modules came to none.
  kVerdictOfTheRobot,    ///< `quoted` says why: 1 if every module knows it.
  kFalls,           ///< No contact forces balance the loads; `quoted` says how it begins to fall.
  kBalances,        ///< They do, but with nothing to spare.
  kRigidUndecided,  ///< Whether they do was not found out.
  kModelFalls,      ///< The model lets it fall, though contact forces exist that would hold it.
  kMaySlip,         ///< A facet's friction is exceeded: its module, |ft|/|fn|, the coefficient.
  /// Feet slip until friction holds them: how many, the module whose foot then carries most
  /// sideways, that force in N, and as a share of its pressure.
  kFeetSlip,
  kGapsOpen,       ///< How many, index of the worst, its gap and its limit, mm.
  kLoadsTogether,  ///< Ratios are factors of all loads together, payloads too.
  kCarrierBreaks,  ///< The connection by which a moved module hangs on its carrier: its load ratio.
  kCarrierHolds,   ///< It is the worst of all: its load ratio.
  kInPieces,       ///< The robot is, each of which is judged by itself: how many.
  kStatesDisagree,  ///< It falls in other states that the paper's contact law allows.
  /// Bending takes the centre of mass out of the support polygon: how far it moves, mm, its margin
  /// without that, and how far beyond the edge it is.
  kDisplacedMass,
  kBuckles,    ///< At which factor of its loads, index of a module, the direction x, y, z it sways.
  kCollapses,  ///< The same five, and 1 if facets tilt or are open then.
  kTooSoft,    ///< A strain at a facet's edge is so large that no linear law holds: factor, strain.
  kTouchesFloor,   ///< The factor, index of the module.
  kTouchesItself,  ///< The factor, indices of two modules, or of one and -1: an obstacle.
  kMassMoves,      ///< By much of its margin: how far, mm, the margin, and what is left of it.
  /// Linear theory does not suffice: a SecondOrderDoubt, the buckling factor or 0, the largest load
  /// ratio, and the same to second order.
  kSecondOrder,
  /// Linear theory is not trusted, but the verdict stands: 1 if that is only not certain, the
  /// buckling factor or 0, the largest load ratio, the same to second order; and 0 where the
  /// elastic modulus is stated, else that which would be needed, MPa, or -1 if that is not known.
  kBendingMatters,
  kPartHasCome,    ///< A step in any order, when so many are there: how many, of how many.
  kPartsNotKnown,  ///< A step in any order of so many modules: too many parts to check each.
};

inline constexpr int kReasonCodeCount = static_cast<int>(ReasonCode::kPartsNotKnown) + 1;

/// Why linear theory does not suffice for a verdict.
enum class SecondOrderDoubt : std::uint8_t {
  kNoStiffness,  ///< In their states the facets leave the robot without stiffness.
  kBuckles,      ///< The buckling factor is not above 1.
  kLoads,        ///< Bending moves the largest load ratio to the other side of 1.
  kTilts,        ///< Bent, a foot would tilt, or the centre of mass is over an edge.
};

/// One reason for a verdict, as data. io::reason_text() makes a sentence of it.
struct Reason {
  static constexpr std::size_t kNumberMax = 6;

  ReasonCode code = ReasonCode::kNoEquilibrium;
  std::array<double, kNumberMax> numbers{};
  /// The words of another part of the program: of the checker of certificates, or of the robot.
  /// Empty for all other codes.
  std::string quoted = {};
  /// The cells that indices mean, where these are another rank's; else empty.
  std::vector<base::Cell> cells = {};

  friend bool operator==(const Reason&, const Reason&) = default;
};

/// The cells of a robot that the indices of a reason mean: both ends of a connection, a module, or
/// none.
std::vector<base::Cell> cells_of(const model::Robot& robot, const Reason& reason);

/// A reason of a piece of a robot as one of the whole: indices are the piece's, and these lists say
/// which they are in the whole.
Reason in_whole(Reason reason, std::span<const std::int32_t> modules,
                std::span<const std::size_t> connections);

/// The word for a code in JSON reports, such as "connections_break".
const char* name(ReasonCode code);

}  // namespace holdfast::verdict
