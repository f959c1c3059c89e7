// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "holdfast/agent/cells/feet.hpp"
#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "holdfast/agent/wire/wire.hpp"
#include "holdfast/base/cell.hpp"
#include "holdfast/mechanics/support_corners.hpp"

/// What the root asks for and what comes back, as values; encode() and decode() turn them into
/// messages, merge() adds up what several modules report.
namespace holdfast::agent {

enum class Verdict : std::uint8_t { kNone, kSafe, kOverload, kUnstable, kUndecided };

/// Why; for kUndecided, what stood in the way.
enum class Reason : std::uint8_t {
  kNone,
  kHolds,
  kBreaks,
  kTopples,
  kNeighbourSilent,  ///< A module that is there did not take part.
  kPlannedTooMany,   ///< More planned modules than there is memory for.
  kPlanDisputed,     ///< A plan and its withdrawal, which came first is not known.
  kPlannedDetached,  ///< A planned module touches nothing.
  kTooLarge,         ///< Too many modules, or too far apart, to be counted (feet.hpp).
  kNotConverged,     ///< No method settled within the limit of iterations.
  kTooClose,         ///< The largest load ratio cannot be told from 1.
  kAmbiguousFeet,  ///< The verdict depends on feet that are neither held nor free, or may be both.
  kNoAnswer,       ///< The computation has stopped, or the root is no longer heard.
  kNoAnchor,       ///< Nobody has said where this module is.
  kInPieces,       ///< In a stage of a step the robot would be in pieces.
  kStepUnclear,    ///< The words of a step are missing, contradict each other, or do not fit.
  kMaySlip,        ///< A facet is pulled sideways by more than its friction.
  kCellsContradict,  ///< A module would sit in two cells, or an anchor in another than it was told.
  kFacesMismatch,    ///< Two faces are connected that do not look at each other.
  kSecondOrder,      ///< Linear theory says that it holds, but bending may change that.
};
inline constexpr int kReasonCount = 20;

/// What there is to say of connections besides how much they carry, where they have laws of their
/// own: which limit it is (mechanics::Limit) that the worst one is nearest to, ...
inline constexpr std::uint8_t kLimitBits = 3;
/// ... whether the edge of some facet opens by more than its contacts of power and data bear, ...
inline constexpr std::uint8_t kGapOpens = 4;
/// ... and, in reports only, whether a facet that touches something may slip.
inline constexpr std::uint8_t kFacetSlips = 8;

const char* name(Verdict verdict);
const char* name(Reason reason);

/// What every module knows in the end.
/// A connection's remarks, where connections have laws of their own.
using Remarks = PresentIf<kIsGeneral, std::uint8_t>;

/// A real for each change of displacement that is kept (deflation.hpp).
template <class Real>
using Along = std::array<Real, wire::kKeptMax>;

/// Products of each two of them in the energy.
using Energies = std::array<float, wire::kKeptPairs>;

struct Answer {
  Verdict verdict = Verdict::kNone;
  Reason reason = Reason::kNone;
  float load_ratio_max = 0;    ///< Not meaningful if unstable or undecided.
  base::Cell worst_cell = {};  ///< The worst connection: this cell and its neighbour ...
  base::Direction worst_direction = base::Direction::kPlusX;  ///< ... in this direction.
  [[no_unique_address]] Remarks remarks = {};                 ///< kLimitBits, kGapOpens

  friend constexpr bool operator==(const Answer&, const Answer&) = default;
};

/// Does the reason belong to the verdict? One changed byte of an answer makes it another one that
/// does not.
constexpr bool is_reasoned(const Answer& answer) {
  switch (answer.verdict) {
    case Verdict::kSafe:
      return answer.reason == Reason::kHolds;
    case Verdict::kOverload:
      return answer.reason == Reason::kBreaks;
    case Verdict::kUnstable:
      return answer.reason == Reason::kTopples;
    default:
      return answer.reason >= Reason::kNeighbourSilent;
  }
}

/// The index in a kPlan while no planned module is learned yet.
inline constexpr std::uint8_t kNoPlanned = 0xff;

/// Exchanges that one order may ask for: the degree of a polynomial.
inline constexpr std::uint16_t kDegreeMax = 4000;

/// What the root asks for. Operations share the fields; what the reals are has a name for each
/// operation. See docs/wire.md.
struct Order {
  wire::Operation operation{};
  /// kPlan: planned index learned, one too many, or 0xff. kHosts: the part of the masks. kWord: of
  /// the word learned, or kNoWord. kStage: the stage that is judged next, or 0.
  std::uint8_t index = 0;
  std::uint8_t flags = 0;
  /// kBegin, kIterate: degree; kWord: words; kStage: scene.
  std::uint16_t count = 0;
  PlannedMasks masks{};   ///< kHosts, kResume
  base::Cell cell = {};   ///< kPlan, kForget, kRenew, kWord: of that module; kMass: of the root.
  std::int32_t mass = 0;  ///< kAngles, kResume: of all modules, in units; kWord: bits_of() a word.
  std::array<std::int32_t, 2> moment{};  ///< The same: first moments in x and y, units times cells.
  std::array<float, 3> reals{};
  Answer answer = {};  ///< kVerdict; kStage: of the stage that was judged.
  /// kIterateDeflated, kIterateLast: by kept change, how far.
  [[no_unique_address]] PresentIf<kKeepsAnswers, Along<float>> along = {};

  // kBegin, kClusters, kResume
  constexpr float gamma() const { return reals[0]; }  ///< Share of weak springs in open facets.

  constexpr float lever_mm() const { return reals[1]; }  ///< The robot's extent.

  // kIterate: u := u + a (p - c p_older) + b p_older
  constexpr float c() const { return reals[0]; }

  constexpr float a() const { return reals[1]; }

  constexpr float b() const { return reals[2]; }

  // kSeek: of a facet, or of its edge; with kEachState its last four bits are the facet's state.
  constexpr std::uint32_t key() const { return static_cast<std::uint32_t>(mass); }

  // kNext; `count` supports.
  constexpr float ratio_error() const { return reals[0]; }  ///< Bound on that of load ratios.

  constexpr float ratio_now() const { return reals[1]; }  ///< The largest load ratio.

  constexpr float facet_margin() const { return reals[2]; }  ///< As Report::facet_margin().

  constexpr base::Cell far_cell() const { return {mass, moment[0], moment[1]}; }

  constexpr void set_far_cell(const base::Cell& far) {  ///< The box is from cell to this one.
    mass = far.x;
    moment = {far.y, far.z};
  }
};

/// Flags of orders.
inline constexpr std::uint8_t kIsFulfilled = 1;  ///< kForget, kRenew
inline constexpr std::uint8_t kIsEnded = 2;      ///< kRenew: the plan of cell; else a new one, ...
inline constexpr std::uint8_t kIsGrown = 4;      ///< ... or a module has come to cell, ...
inline constexpr std::uint8_t kIsUnchanged = 8;  ///< ... or nothing more is to be learned.
inline constexpr std::uint8_t kKeepsMotion = 8;  ///< kResume: displacements, contact states.
inline constexpr std::uint8_t kRests = 16;       ///< kResume: safe angles are asked for.
inline constexpr std::uint8_t kKeepsFactors = 64;   ///< kRenew, kResume: those of elimination.
inline constexpr std::uint8_t kUnilateralLaw = 1;   ///< kBegin
inline constexpr std::uint8_t kOneSweep = 2;        ///< kBegin: always.
inline constexpr std::uint8_t kWithIterations = 4;  ///< kBegin: for kIterate.
inline constexpr std::uint8_t kWithFronts = 8;      ///< kBegin: elimination with fronts.
inline constexpr std::uint8_t kRestart = 1;         ///< kIterate: without older directions.
inline constexpr std::uint8_t kLeastResidual = 2;   ///< kIterate: least residual, not least energy.
inline constexpr std::uint8_t kKeepStates = 4;      ///< kIterate: contact states are not looked up.
/// kIterate: planned modules between others stand still in the polynomial.
inline constexpr std::uint8_t kHoldPlanned = 16;
/// kIterate: facets act by the symmetric stand-ins of their tangents.
inline constexpr std::uint8_t kStandIn = 32;
inline constexpr std::uint8_t kReleaseOpen = 1;   ///< kHold
inline constexpr std::uint8_t kFreeOpen = 2;      ///< kHold: of all open facets, for comparison.
inline constexpr std::uint8_t kIsHeld = 1;        ///< kNext: a module is fixed, nothing topples.
inline constexpr std::uint8_t kHasForces = 2;     ///< kNext: there is an equilibrium, ...
inline constexpr std::uint8_t kIsUnilateral = 4;  ///< ... by the unilateral law.
inline constexpr std::uint8_t kRemember = 1;      ///< kSeek: states in use are those found.
inline constexpr std::uint8_t kOneFoot = 2;       ///< kSeek: one facet presses alone.
/// kSeek: facets of lesser keys are open, those of greater ones stay as they are.
inline constexpr std::uint8_t kEachState = kRemember | kOneFoot;
inline constexpr std::uint32_t kStateBits = 15;  ///< Of its key.

/// Does a kRenew tell of one plan more?
constexpr bool is_new_plan(const Order& renew) {
  return (renew.flags & (kIsEnded | kIsGrown | kIsUnchanged)) == 0;
}

/// Masses are whole numbers of a unit that all modules of a robot agree on; all of them weigh one
/// unit so far. First moments stay exact, and below this even where a neighbour makes them up.
inline constexpr std::int64_t kMomentMost = std::int64_t{1} << 62U;

/// The direction of the facets that a robot of cubes stands on.
inline constexpr base::Direction kStandingFacet = base::Direction::kMinusZ;

/// The load ratio of what has no connection: below every real one, and a number.
inline constexpr float kNoLoadRatio = -1e20F;

/// The least pressure at the facets of a robot without feet that could let go.
inline constexpr float kNoFacetMargin = 1e20F;

/// The margin of facets where none sticks.
inline constexpr float kNoMomentMargin = 1e20F;

/// What comes back, summed up the tree. Operations share the fields; most have a name for each.
struct Report {
  std::uint8_t flags = 0;
  FaceMask mask = 0;
  std::uint16_t extent = 0;
  std::uint32_t count = 0;
  std::uint32_t number = 0;
  std::array<std::int64_t, 3>
      moment{};  ///< kMass, kRenew: first moments, units of mass times cells.
  std::array<float, 5> reals{};
  std::array<double, 3> products{};  ///< kIterate
  base::Cell cell = {};
  base::Direction direction = base::Direction::kPlusX;
  /// kLoads, kClose: kLimitBits, kGapOpens, kFacetSlips
  [[no_unique_address]] Remarks remarks = {};
  SafeCorners feet = {};
  mechanics::SupportCorners corners = {};
  /// kIterateDeflated, kIterateLast, kResumeDeflated: products of the residual with the changes
  /// that are kept.
  [[no_unique_address]] PresentIf<kKeepsAnswers, Along<float>> along = {};
  /// kResumeDeflated: w_i' K w_j
  [[no_unique_address]] PresentIf<kKeepsAnswers, Energies> energies = {};

  // kIterate, kTreeIterate
  constexpr float error() const { return reals[0]; }  ///< Bound on the error of load ratios.

  constexpr float load_ratio_max() const { return reals[1]; }  ///< The largest of all connections.

  constexpr std::uint16_t changed_count() const { return extent; }  ///< How many facets.

  constexpr std::uint32_t states_hash() const { return number; }  ///< Hash of all contact states.

  // kMass, kRenew
  constexpr std::uint32_t mass() const { return number; }  ///< Units, of all modules.

  // kHold
  constexpr std::uint32_t open_held_count() const { return number; }  ///< How many facets.

  // kSeek: `count` facets may have a second state.
  constexpr std::uint32_t next_key() const { return number; }  ///< The least above the order's; 0.

  // kClusters: `count` beams between clusters; these do not lead to the parent cluster.
  constexpr std::uint32_t stray_count() const { return number; }

  // kShape: `count` supports.
  constexpr std::int64_t cut_label() const { return moment[0]; }  ///< Sum modulo 2, free_faces.hpp.

  constexpr base::Cell far_cell() const {  ///< The box is from cell to this one.
    return {static_cast<std::int32_t>(number), static_cast<std::int32_t>(moment[1]),
            static_cast<std::int32_t>(moment[2])};
  }

  constexpr void set_far_cell(const base::Cell& far) {
    number = static_cast<std::uint32_t>(far.x);
    moment[1] = far.y;
    moment[2] = far.z;
  }

  constexpr float ratio_below() const { return reals[0]; }  ///< The largest load ratio.

  /// The least pressure at an edge of a facet, in N; negative if one does not press all over.
  constexpr float facet_margin() const { return reals[1]; }

  constexpr std::uint8_t support_hops() const {
    return static_cast<std::uint8_t>(mask);
  }  ///< To the nearest one.

  // kBend: of `count` modules, and `number` ends of beams.
  constexpr float energy() const { return reals[0]; }  ///< Twice that of all beams, N mm.

  constexpr float bending_energy() const { return reals[1]; }  ///< What of it is from moments.

  /// The sum, over all ends of beams, of the fourth power of how far they have turned.
  constexpr float rotations() const { return reals[2]; }

  /// The least that may be added to a moment of a facet that sticks before it tilts, N mm.
  constexpr float moment_margin() const { return reals[3]; }

  constexpr float load_n() const { return reals[4]; }  ///< The sum of the sizes of all forces.

  // kNext: `count` free faces are decided.
  constexpr std::uint32_t undecided_count() const { return number; }  ///< Free faces that are not.

  // kLoads
  constexpr float worst_load_ratio() const { return reals[0]; }

  constexpr std::uint32_t module_count() const { return number; }
};

/// Flags of reports.
inline constexpr std::uint8_t kFound = 1;             ///< kPlan: cell is planned.
inline constexpr std::uint8_t kAnyRemote = 0x80;      ///< kHosts
inline constexpr std::uint8_t kAnyFixed = 1;          ///< kMass
inline constexpr std::uint8_t kSumOverflow = 2;       ///< kMass
inline constexpr std::uint8_t kManyLoops = 4;         ///< kMass: more than a Branch can hold.
inline constexpr std::uint8_t kUneven = 8;            ///< kMass: kAngles would not be exact.
inline constexpr std::uint8_t kTooManyAnnounced = 2;  ///< kPlan
inline constexpr std::uint8_t kEnded = 4;             ///< kPlan: the plan of cell has ended, ...
inline constexpr std::uint8_t kFulfilled = 8;         ///< ... as a module sits there.
inline constexpr std::uint8_t kDisputed = 16;         ///< kPlan
inline constexpr std::uint8_t kMoreAnnounced = 8;     ///< kRenew: cell is planned, too.
inline constexpr std::uint8_t kAtOdds = 16;           ///< kRenew: only a new round can settle it.
inline constexpr std::uint8_t kNewLoop = 32;          ///< kRenew: factors cannot be kept.
inline constexpr std::uint8_t kAnyTilting = 1;        ///< kIterate, kTreeIterate
inline constexpr std::uint8_t kNoRoom = 2;            ///< kTreeIterate: a front found no room.
inline constexpr std::uint8_t kNoState = 4;  ///< kTreeIterate: the root found no contact state.
/// kIterate, kTreeIterate: away from a level floor a facet is open or tilts, so its weak
/// spring may carry.
inline constexpr std::uint8_t kMayPull = 8;
/// kIterate, kTreeIterate: a facet may have a second state (is_doubtful()).
inline constexpr std::uint8_t kMayDiffer = 16;
inline constexpr std::uint8_t kStepTold = 32;  ///< kPlan: a step was told.
inline constexpr std::uint8_t kDenied = 2;     ///< kWord: a word does not fit this module.
inline constexpr std::uint8_t kSplit = 4;  ///< kWord: the robot would be in pieces, in stage mask.
inline constexpr std::uint8_t kHasSupport = 1;  ///< kBend: a module is fixed, or a facet sticks.
inline constexpr std::uint8_t kHasTilting = 2;  ///< kBend: a facet tilts, or is held open.
inline constexpr std::uint8_t kHasSliding = 4;  ///< kBend: a facet presses and is not held.
inline constexpr std::uint8_t kNewLinks = 1;    ///< kStage: other connections are off than before.

wire::Writer encode(const Order& order);
wire::Writer encode(wire::Operation operation, const Report& report);

/// Reads the order or report that a message holds. False: no program of this version writes it.
bool decode(std::span<const std::uint8_t> message, Order& order, int face_count = kOwnFaceCount);
bool decode(std::span<const std::uint8_t> message, Report& report, int face_count = kOwnFaceCount);

/// The order in a message that is legal.
inline Order decode_order(std::span<const std::uint8_t> message) {
  Order order;
  decode(message, order);
  return order;
}

/// The report in a message that is legal.
inline Report decode_report(std::span<const std::uint8_t> message) {
  Report report;
  decode(message, report);
  return report;
}

/// What the report of a kClose would say, from that of a kIterateLast: corners, the worst
/// connection.
Report worst_of(const Report& last);

/// The larger number; not a number wins, as it must not get lost.
constexpr float larger(float a, float b) { return b <= a || a != a ? a : b; }

/// Adds `from` to `into`, as the operation demands; of kAngles that is FeetCheck::merge().
void merge(wire::Operation operation, Report& into, const Report& from);

/// How many exchanges of an order go on while its report is on the way up and the next order on its
/// way down. With clusters an iteration has two polynomials; the image of the first is needed, and
/// that of the clusters' part.
constexpr std::uint16_t exchanges_behind(const Order& order) {
  const Exchanges& exchanges = columns::kExchanges[static_cast<std::size_t>(order.operation)];
  if (!exchanges.is_counted) {
    return 0;
  }
  const bool is_twice = (order.flags & exchanges.twice_with) != 0;
  return static_cast<std::uint16_t>(is_twice ? 2 * order.count + 2 : order.count);
}

/// How many times an order makes all neighbours exchange vectors. An iteration shares its move in
/// two parts and then the terms of its polynomial.
constexpr std::uint16_t exchange_count(const Order& order) {
  const Exchanges& exchanges = columns::kExchanges[static_cast<std::size_t>(order.operation)];
  return static_cast<std::uint16_t>(exchanges.fixed + exchanges_behind(order));
}

}  // namespace holdfast::agent
