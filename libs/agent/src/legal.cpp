// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/legal.hpp"

#include "holdfast/agent/announcements.hpp"
#include "holdfast/agent/branch.hpp"
#include "holdfast/agent/order.hpp"
#include "holdfast/agent/planned.hpp"
#include "holdfast/agent/wire.hpp"

namespace holdfast::agent::wire {
namespace {

/// What the bytes from an offset on must be.
enum class Rule : std::uint8_t {
  kAtMost,     ///< u8
  kOneTo,      ///< u8, 1 to the limit.
  kFlags,      ///< u8, no other bits than those of the limit.
  kPlanned,    ///< u8, a planned index in the bits of the limit.
  kMaybe,      ///< u8, a planned index, kPlannedMax for one too many, or kNoPlanned.
  kMasks,      ///< 8 u8, faces of planned modules.
  kCell,       ///< 9 bytes, coordinates up to kCoordinateMax.
  kPlanCell,   ///< The same, or kEveryCell.
  kExchanges,  ///< u16, up to kDegreeMax.
  kSteps,      ///< u16, 1 to kJacobiCountMax.
  kEpoch,      ///< u16, not 0.
  kFeet,       ///< u8, a safe range, and two corners if it is an arc.
  kCorners,    ///< u8, how many: 0, 1 or 2; 4: held.
};

struct Field {
  MessageType type;
  Operation operation;  ///< kAny but of orders and reports.
  std::uint8_t offset;
  Rule rule;
  std::uint8_t limit;
};

constexpr Operation kAny{};
constexpr std::uint8_t kStages = 3;
constexpr std::uint8_t kFaces = 0x3f;
constexpr std::uint8_t kLastFace = base::kDirectionCount - 1;
constexpr std::uint8_t kPlanReportFlags =
    kFound | kTooManyAnnounced | kEnded | kFulfilled | kDisputed;

using T = MessageType;
using O = Operation;

constexpr Field kFields[] = {
    {T::kJoin, kAny, 1, Rule::kEpoch, 0},
    {T::kJoin, kAny, 7, Rule::kOneTo, kStages},
    {T::kJoin, kAny, 8, Rule::kCell, 0},
    {T::kEcho, kAny, 1, Rule::kEpoch, 0},
    {T::kEcho, kAny, 7, Rule::kOneTo, kStages},
    {T::kEcho, kAny, 18, Rule::kAtMost, 1},
    {T::kAppoint, kAny, 1, Rule::kOneTo, kStages - 1},
    {T::kMark, kAny, 3, Rule::kCell, 0},
    {T::kPlannedDown, kAny, 1, Rule::kPlanned, 0x3f},
    {T::kPlannedUp, kAny, 1, Rule::kPlanned, 0xff},
    {T::kLoop, kAny, 1, Rule::kCell, 0},
    {T::kLoop, kAny, 10, Rule::kAtMost, kLastFace - 1},
    {T::kLoop, kAny, 10, Rule::kFlags, 6},  // Even: a positive direction.
    {T::kColumn, kAny, 1, Rule::kAtMost, Branch::kColumnCount + Branch::kPartCount - 1},
    {T::kBranchUp, kAny, 1, Rule::kAtMost, kLoopsMax},
    {T::kBranchDown, kAny, 1, Rule::kAtMost, kLoopsMax},

    {T::kOrder, O::kPlan, 2, Rule::kMaybe, 0},
    {T::kOrder, O::kPlan, 3, Rule::kCell, 0},
    {T::kOrder, O::kForget, 2, Rule::kFlags, kIsFulfilled},
    {T::kOrder, O::kForget, 3, Rule::kPlanCell, 0},
    {T::kOrder, O::kHosts, 2, Rule::kMasks, kFaces},
    {T::kOrder, O::kMass, 2, Rule::kCell, 0},
    {T::kOrder, O::kBegin, 2, Rule::kFlags, kUnilateralLaw | kOneSweep | kWithSteps},
    {T::kOrder, O::kBegin, 3, Rule::kExchanges, 0},
    {T::kOrder, O::kClusters, 2, Rule::kFlags, kUnilateralLaw | kOneSweep | kWithSteps},
    {T::kOrder, O::kClusters, 3, Rule::kExchanges, 0},
    {T::kOrder, O::kLow, 2, Rule::kFlags, kFollowStates},
    {T::kOrder, O::kStart, 2, Rule::kFlags, kAdoptStates | kWithScalars | kWithBlocks},
    {T::kOrder, O::kJacobi, 2, Rule::kSteps, 0},
    {T::kOrder, O::kSlope, 2, Rule::kFlags, kExchangeFirst | kMixProducts},
    {T::kOrder, O::kHold, 2, Rule::kFlags, kReleaseOpen | kFreeOpen},
    {T::kOrder, O::kVerdict, 2, Rule::kOneTo, static_cast<std::uint8_t>(Verdict::kUndecided)},
    {T::kOrder, O::kVerdict, 3, Rule::kAtMost, static_cast<int>(Reason::kAmbiguousFeet)},
    {T::kOrder, O::kVerdict, 8, Rule::kCell, 0},
    {T::kOrder, O::kVerdict, 17, Rule::kAtMost, kLastFace},
    {T::kOrder, O::kStep, 2, Rule::kFlags,
     kRestart | kLeastResidual | kKeepStates | kWithClusters | kHoldPlanned},
    {T::kOrder, O::kStep, 3, Rule::kExchanges, 0},

    {T::kReport, O::kPlan, 2, Rule::kFlags, kFaces},
    {T::kReport, O::kPlan, 3, Rule::kFlags, kPlanReportFlags},
    {T::kReport, O::kPlan, 4, Rule::kPlanCell, 0},
    {T::kReport, O::kForget, 2, Rule::kFlags, kFaces},
    {T::kReport, O::kForget, 3, Rule::kFlags, kPlanReportFlags},
    {T::kReport, O::kForget, 4, Rule::kPlanCell, 0},
    {T::kReport, O::kHosts, 2, Rule::kFlags, (1U << kPlannedMax) - 1 + kAnyRemote},
    {T::kReport, O::kMass, 14, Rule::kFlags, kAnyFixed | kSumOverflow | kManyLoops},
    {T::kReport, O::kAngles, 2, Rule::kFeet, 0},
    {T::kReport, O::kLow, 16, Rule::kFlags, kAnyTilting},
    {T::kReport, O::kStep, 16, Rule::kFlags, kAnyTilting},
    {T::kReport, O::kTreeStep, 16, Rule::kFlags, kAnyTilting},
    {T::kReport, O::kCorners, 2, Rule::kCorners, 0},
    {T::kReport, O::kLoads, 6, Rule::kCell, 0},
    {T::kReport, O::kLoads, 15, Rule::kAtMost, kLastFace},
};

bool is_good_cell(const base::Cell& cell) {
  for (const std::int32_t coordinate : {cell.x, cell.y, cell.z}) {
    if (coordinate < -base::kCoordinateMax || coordinate > base::kCoordinateMax) {
      return false;
    }
  }
  return true;
}

bool are_good_masks(Reader in, std::uint8_t allowed) {
  unsigned all = 0;
  for (int i = 0; i < 8; ++i) {
    all |= in.u8();
  }
  return (all & ~unsigned{allowed}) == 0;
}

bool are_good_feet(Reader in) {
  const auto range = static_cast<mechanics::SafeRange>(in.u8());
  const FootCorner first = {in.i32(), in.i32()};
  const FootCorner last = {in.i32(), in.i32()};
  return range == mechanics::SafeRange::kArc ? is_good_corner(first) && is_good_corner(last)
                                             : range <= mechanics::SafeRange::kFull;
}

bool is_kept(const Field& field, std::span<const std::uint8_t> message) {
  Reader in(message, field.offset);
  const std::uint8_t value = message[field.offset];
  switch (field.rule) {
    case Rule::kAtMost:
      return value <= field.limit;
    case Rule::kOneTo:
      return value >= 1 && value <= field.limit;
    case Rule::kFlags:
      return (value & ~unsigned{field.limit}) == 0;
    case Rule::kPlanned:
      return (value & field.limit) < kPlannedMax;
    case Rule::kMaybe:
      return value <= kPlannedMax || value == kNoPlanned;
    case Rule::kMasks:
      return are_good_masks(in, field.limit);
    case Rule::kCell:
      return is_good_cell(in.cell());
    case Rule::kPlanCell: {
      const base::Cell cell = in.cell();
      return cell == kEveryCell || is_good_cell(cell);
    }
    case Rule::kExchanges:
      return in.u16() <= kDegreeMax;
    case Rule::kFeet:
      return are_good_feet(in);
    case Rule::kEpoch:
      return in.u16() != 0;
    case Rule::kSteps: {
      const std::uint16_t count = in.u16();
      return count >= 1 && count <= kJacobiCountMax;
    }
    case Rule::kCorners:
      return value <= 2 || value == 4;
  }
  return false;
}

}  // namespace

bool is_legal(std::span<const std::uint8_t> message) {
  const auto type = static_cast<MessageType>(message[0]);
  if (type == MessageType::kVector) {
    return true;  // Most messages are.
  }
  const bool has_operation = type == MessageType::kOrder || type == MessageType::kReport;
  const auto operation = has_operation ? static_cast<Operation>(message[1]) : kAny;
  for (const Field& field : kFields) {
    if (field.type == type && field.operation == operation && !is_kept(field, message)) {
      return false;
    }
  }
  return true;
}

}  // namespace holdfast::agent::wire
