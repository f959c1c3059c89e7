// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/messages/order.hpp"

#include <tuple>

#include "holdfast/agent/cells/planned_set.hpp"
#include "holdfast/agent/cells/step_word.hpp"
#include "holdfast/agent/features.hpp"
#include "holdfast/agent/wire/operations.hpp"
#include "messages/codec.hpp"

namespace holdfast::agent {
namespace {

using wire::Codec;
using wire::MessageType;
using wire::Operation;
using wire::Ruler;
using wire::Writer;

/// Where the fields of orders and reports begin: behind type and operation.
constexpr int kOrderAt = 2;

/// The operation is the byte behind the type.
Operation operation_of(std::span<const std::uint8_t> message) {
  return static_cast<Operation>(message[1]);
}

/// Both are within kMomentMost.
std::int64_t saturating_sum(std::int64_t a, std::int64_t b, std::uint8_t& flags) {
  const std::int64_t sum = a + b;
  if (sum > kMomentMost || sum < -kMomentMost) {
    flags = static_cast<std::uint8_t>(flags | kSumOverflow);
    return sum > 0 ? kMomentMost : -kMomentMost;
  }
  return sum;
}

/// A plan that has ended goes before all others.
void merge_plan(Report& into, const Report& from) {
  const auto weight = [](const Report& report) {
    return (report.flags & kEnded) != 0 ? 2 : (report.flags & kFound) != 0 ? 1 : 0;
  };
  into.mask = static_cast<FaceMask>(into.mask | from.mask);
  const bool is_first = weight(from) == weight(into) && from.cell < into.cell;
  if (weight(from) > weight(into) || (weight(from) > 0 && is_first)) {
    into.cell = from.cell;
  }
  into.flags = static_cast<std::uint8_t>(into.flags | from.flags);
}

void merge_mass(Report& into, const Report& from) {
  into.count += from.count;
  into.flags = static_cast<std::uint8_t>(into.flags | from.flags);
  into.extent = into.extent < from.extent ? from.extent : into.extent;
  into.number += from.number;
  for (std::size_t i = 0; i < into.moment.size(); ++i) {
    into.moment[i] = saturating_sum(into.moment[i], from.moment[i], into.flags);
  }
}

/// Keeps the first of the cells that are planned besides.
void merge_renewal(Report& into, const Report& from) {
  const auto has_more = [](const Report& report) { return (report.flags & kMoreAnnounced) != 0; };
  const bool is_first = has_more(from) == has_more(into) && from.cell < into.cell;
  if ((has_more(from) && !has_more(into)) || is_first) {
    into.cell = from.cell;
  }
  into.mask = static_cast<FaceMask>(into.mask | from.mask);
  merge_mass(into, from);
}

/// How many want another state, the hash of all, whether any tilts.
void merge_facets(Report& into, const Report& from) {
  const std::uint32_t changed = std::uint32_t{into.extent} + from.extent;
  into.extent = static_cast<std::uint16_t>(changed < 0xffffU ? changed : 0xffffU);
  into.number += from.number;
  into.flags = static_cast<std::uint8_t>(into.flags | from.flags);
}

void merge_residual(Report& into, const Report& from) {
  into.reals[0] += from.reals[0];
  into.reals[1] = larger(into.reals[1], from.reals[1]);
  for (std::size_t i = 0; i < into.products.size(); ++i) {
    into.products[i] += from.products[i];
  }
  merge_facets(into, from);
}

/// Adds up reals, if the program has them.
template <class Reals>
void add_each(Reals& into, const Reals& from) {
  if constexpr (kKeepsAnswers) {
    for (std::size_t i = 0; i < into.size(); ++i) {
      into[i] += from[i];
    }
  }
}

/// Products with the changes of displacement that are kept.
void merge_along(Report& into, const Report& from) {
  add_each(into.along, from.along);
  add_each(into.energies, from.energies);
}

/// The box of both; supports are added up, labels modulo 2.
void merge_shape(Report& into, const Report& from) {
  base::Cell far = into.far_cell();
  const base::Cell their_far = from.far_cell();
  for (const auto axis : {&base::Cell::x, &base::Cell::y, &base::Cell::z}) {
    into.cell.*axis = from.cell.*axis < into.cell.*axis ? from.cell.*axis : into.cell.*axis;
    far.*axis = far.*axis < their_far.*axis ? their_far.*axis : far.*axis;
  }
  into.set_far_cell(far);
  into.count += from.count;
  into.moment[0] ^= from.moment[0];
  into.reals[0] = larger(into.reals[0], from.reals[0]);
  into.reals[1] = -larger(-into.reals[1], -from.reals[1]);
  into.mask = into.mask < from.mask ? into.mask : from.mask;
}

void merge_loads(Report& into, const Report& from) {
  const bool is_worse =
      larger(into.reals[0], from.reals[0]) != into.reals[0] && into.reals[0] == into.reals[0];
  const bool is_equal = from.reals[0] == into.reals[0];
  const std::uint8_t limit = into.remarks & kLimitBits;
  into.remarks = static_cast<std::uint8_t>((into.remarks | from.remarks) & ~kLimitBits);
  const bool is_theirs = is_worse || (is_equal && from.cell < into.cell);
  into.remarks |= is_theirs ? static_cast<std::uint8_t>(from.remarks & kLimitBits) : limit;
  if (is_theirs) {
    into.reals[0] = from.reals[0];
    into.cell = from.cell;
    into.direction = from.direction;
  }
  into.count += from.count;
  into.number += from.number;
}

/// Sums, and the least margin.
void merge_bending(Report& into, const Report& from) {
  into.flags = static_cast<std::uint8_t>(into.flags | from.flags);
  into.count += from.count;
  into.number += from.number;
  const float margin = -larger(-into.reals[3], -from.reals[3]);
  for (std::size_t i = 0; i < into.reals.size(); ++i) {
    into.reals[i] += from.reals[i];
  }
  into.reals[3] = margin;
}

/// An iteration's sums; of the two largest load ratios the larger one's place.
void merge_last(Report& into, const Report& from) {
  Report worst = worst_of(into);
  merge_loads(worst, worst_of(from));
  into.cell = worst.cell;
  into.direction = worst.direction;
  into.remarks = worst.remarks;
  into.corners = mechanics::merge(into.corners, from.corners);
  merge_residual(into, from);
}

/// The least key.
void merge_keys(Report& into, const Report& from) {
  const bool is_less = from.number != 0 && (into.number == 0 || from.number < into.number);
  into.number = is_less ? from.number : into.number;
  into.count += from.count;
}

/// Keeps the least of two words that was found; two that differ are disputed.
void merge_word(Report& into, const Report& from) {
  const auto is_found = [](const Report& report) { return (report.flags & kFound) != 0; };
  const auto order = [&](const Report& report) {
    return std::tuple(!is_found(report), report.cell, report.number, report.extent);
  };
  const bool differs = is_found(into) && is_found(from) && order(into) != order(from);
  if (order(from) < order(into)) {
    into.cell = from.cell;
    into.number = from.number;
    into.extent = from.extent;
  }
  into.mask = into.mask < from.mask ? from.mask : into.mask;
  into.flags = static_cast<std::uint8_t>(into.flags | from.flags | (differs ? kDisputed : 0U));
  into.count += from.count;
}

constexpr std::uint8_t kPlanReportFlags =
    kFound | kTooManyAnnounced | kEnded | kFulfilled | kDisputed | (kKeepsAnswers ? kStepTold : 0);

/// A mask of which messages hold one byte.
[[gnu::always_inline]] constexpr void byte_flags(auto& codec, FaceMask& mask, unsigned all) {
  auto byte = static_cast<std::uint8_t>(mask);
  codec.flags(byte, static_cast<std::uint8_t>(all));
  mask = byte;
}

[[gnu::always_inline]] constexpr void byte_field(auto& codec, FaceMask& mask, unsigned last) {
  auto byte = static_cast<std::uint8_t>(mask);
  codec.u8(byte, 0, static_cast<std::uint8_t>(last));
  mask = byte;
}

constexpr void feet_fields(auto& codec, SafeCorners& feet) {
  codec.kind(feet.range, mechanics::SafeRange::kEmpty, mechanics::SafeRange::kFull);
  for (FootCorner* corner : {&feet.first, &feet.last}) {
    codec.i32(corner->x);
    codec.i32(corner->y);
    codec.require(feet.range != mechanics::SafeRange::kArc || is_good_corner(*corner));
  }
}

/// Stands in place of the number of corners: the robot is held.
constexpr std::uint8_t kHeld = 4;

constexpr void corner_fields(auto& codec, mechanics::SupportCorners& corners) {
  std::uint8_t count = corners.stable ? kHeld : corners.count;
  codec.u8(count, 0, kHeld);
  codec.require(count != kHeld - 1);
  corners.stable = count == kHeld;
  corners.count = corners.stable ? std::uint8_t{0} : count;
  for (mechanics::Corner& corner : corners.corners) {
    base::Cell cell = {corner.x, corner.y, corner.z};
    codec.half_cells(cell);
    corner = {cell.x, cell.y, cell.z};
  }
}

/// A connection's direction, and above it what there is to say of connections.
template <class Fields>
constexpr void connection_fields(auto& codec, base::Direction& direction,
                                 [[maybe_unused]] Fields& of, [[maybe_unused]] std::uint8_t all) {
  if constexpr (kIsGeneral) {
    codec.direction(direction, of.remarks, all);
  } else {
    codec.direction(direction);
  }
}

constexpr void answer_fields(auto& codec, Answer& answer) {
  codec.kind(answer.verdict, Verdict::kSafe, Verdict::kUndecided);
  codec.kind(answer.reason, Reason::kNone, Reason::kSecondOrder);
  codec.require(is_reasoned(answer) && answer.reason != Reason::kNoAnswer &&
                answer.reason != Reason::kNoAnchor);
  codec.real(answer.load_ratio_max);
  codec.cell(answer.worst_cell);
  connection_fields(codec, answer.worst_direction, answer, kLimitBits | kGapOpens);
}

constexpr void real_fields(auto& codec, std::span<float> reals) {
  for (float& real : reals) {
    codec.real(real);
  }
}

constexpr std::uint8_t kClusterFlags = kUnilateralLaw | kOneSweep | kWithIterations;
constexpr std::uint8_t kBeginFlags = kClusterFlags | (kHasAllMethods ? kWithFronts : 0);

constexpr std::uint8_t kRenewFlags =
    kIsFulfilled | kIsEnded | kIsGrown | kIsUnchanged | kKeepsFactors;
constexpr std::uint8_t kResumeFlags =
    kKeepsFactors | kOneSweep | kWithIterations | kKeepsMotion | kRests;

constexpr void resume_fields(auto& codec, Order& order) {
  codec.flags(order.flags, kResumeFlags);
  codec.u8(order.index, 0, wire::kKeptMax);
  codec.u16(order.count, 0, kDegreeMax);
  real_fields(codec, std::span(order.reals).first(2));
  codec.i32(order.mass);
  codec.i32(order.moment[0]);
  codec.i32(order.moment[1]);
  for (std::size_t k = 0; k < kPlannedMax; ++k) {
    auto byte = static_cast<std::uint8_t>(order.masks[k]);
    codec.resumed_faces(byte);
    order.masks[k] = byte;
  }
}

constexpr void iterate_fields(auto& codec, Order& order, std::uint8_t flags) {
  codec.flags(order.flags, flags);
  codec.u16(order.count, 0, kDegreeMax);
  real_fields(codec, std::span(order.reals).first(3));
}

/// An iteration with the least energy, and how far to go along what is kept.
constexpr void deflated_fields(auto& codec, Order& order) {
  if constexpr (kKeepsAnswers) {
    iterate_fields(codec, order, kRestart | kLeastResidual | kKeepStates | kHoldPlanned);
    real_fields(codec, order.along);
  }
}

constexpr void word_fields(auto& codec, Order& order) {
  codec.u8(order.index);
  codec.require(order.index < kWordCountMax || order.index == kNoWord);
  codec.u16(order.count, 0, kWordCountMax);
  codec.require(order.index == kNoWord || order.index < order.count);
  codec.cell(order.cell);
  codec.i32(order.mass);
  codec.require(is_word(static_cast<std::uint32_t>(order.mass)));
}

constexpr void step_fields(auto& codec, Order& order) {
  if (order.operation == Operation::kWord) {
    return word_fields(codec, order);
  }
  codec.u8(order.index, 0, kStageCount);
  codec.u8(order.flags, 0, kStageCount);
  codec.u16(order.count, 0, kSceneMax - 1);
  answer_fields(codec, order.answer);
}

/// Fields of kShape and kNext, which some programs do not know.
constexpr void face_fields(auto& codec, Order& order) {
  codec.require(kKeepsAnswers);
  if (!kKeepsAnswers || order.operation == Operation::kShape) {
    return;
  }
  codec.flags(order.flags, kIsHeld | kHasForces | kIsUnilateral);
  codec.cell(order.cell);
  base::Cell far = order.far_cell();
  codec.cell(far);
  order.set_far_cell(far);
  codec.u16(order.count);
  real_fields(codec, std::span(order.reals).first(3));
}

/// Messages have room for more than there may be; in the last place is which part of all it is.
constexpr void mask_fields(auto& codec, Order& order) {
  constexpr std::size_t kMasks = 8;
  for (std::size_t k = 0; k < kMasks; ++k) {
    FaceMask none = kIsGeneral && k + 1 == kMasks ? order.index : FaceMask{0};
    codec.faces(k < order.masks.size() ? order.masks[k] : none);
    if (kIsGeneral && k + 1 == kMasks) {
      order.index = static_cast<std::uint8_t>(none);
      codec.require(none < (kPlannedMost + kMasksOfPart - 1) / kMasksOfPart);
    }
  }
}

constexpr void seek_fields(auto& codec, Order& order) {
  codec.flags(order.flags, kRemember | (kIsGeneral ? kOneFoot : 0));
  codec.i32(order.mass);
}

/// What is in an order behind its operation.
constexpr void fields(auto& codec, Order& order) {
  base::Direction facet = kStandingFacet;
  switch (order.operation) {
    case Operation::kPlan:
      codec.u8(order.index);
      codec.require(order.index <= kPlannedMost || order.index == kNoPlanned);
      return codec.cell(order.cell);
    case Operation::kHosts:
      return mask_fields(codec, order);
    case Operation::kMass:
      return codec.cell(order.cell);
    case Operation::kAngles:
      codec.kind(facet, kStandingFacet, kStandingFacet);
      codec.i32(order.mass);
      codec.moment(order.moment[0]);
      return codec.moment(order.moment[1]);
    case Operation::kBegin:
    case Operation::kClusters:
      codec.flags(order.flags, order.operation == Operation::kBegin ? kBeginFlags : kClusterFlags);
      codec.u16(order.count, 0, kDegreeMax);
      return real_fields(codec, std::span(order.reals).first(2));
    case Operation::kHold:
      return codec.flags(order.flags, kReleaseOpen | kFreeOpen);
    case Operation::kVerdict:
      return answer_fields(codec, order.answer);
    case Operation::kIterate:
      return iterate_fields(
          codec, order,
          kRestart | kLeastResidual | kKeepStates | kWithClusters | kHoldPlanned | kStandIn);
    case Operation::kIterateDeflated:
    case Operation::kIterateLast:
      codec.require(kKeepsAnswers);
      return deflated_fields(codec, order);
    case Operation::kForget:
      codec.flags(order.flags, kIsFulfilled);
      return codec.place(order.cell);
    case Operation::kRenew:
      codec.require(kKeepsAnswers);
      codec.flags(order.flags, kRenewFlags);
      return codec.place(order.cell);
    case Operation::kResume:
    case Operation::kResumeDeflated:
      codec.require(kKeepsAnswers);
      return kKeepsAnswers ? resume_fields(codec, order) : void();
    case Operation::kWord:
    case Operation::kStage:
      codec.require(kKeepsAnswers);
      return kKeepsAnswers ? step_fields(codec, order) : void();
    case Operation::kShape:
    case Operation::kNext:
      return face_fields(codec, order);
    case Operation::kSeek:
      codec.require(kHasAllMethods);
      return kHasAllMethods ? seek_fields(codec, order) : void();
    case Operation::kBend:
      return codec.require(kIsGeneral);
    case Operation::kCorners:
    case Operation::kLoads:
    case Operation::kFactor:
    case Operation::kTreeIterate:
    case Operation::kClose:
      return;
  }
}

constexpr std::uint8_t kHostedFlags = (1U << kPlannedMax) - 1 + kAnyRemote;
constexpr std::uint8_t kRenewalFlags =
    kAnyFixed | kSumOverflow | kManyLoops | kMoreAnnounced | kAtOdds | kNewLoop;
constexpr std::uint8_t kFacetFlags = kAnyTilting | kMayPull | (kHasAllMethods ? kMayDiffer : 0);
constexpr std::uint8_t kFrontFlags = kHasAllMethods ? kNoRoom | kNoState : 0;

/// Bound on the error, largest load ratio; facets that change, the hash of all states, any tilting.
constexpr void residual_fields(auto& codec, Report& report, std::uint8_t more_flags = 0) {
  real_fields(codec, std::span(report.reals).first(2));
  codec.u16(report.extent);
  codec.u32(report.number);
  codec.flags(report.flags, kFacetFlags | more_flags);
}

/// The worst connection.
constexpr void worst_fields(auto& codec, Report& report) {
  real_fields(codec, std::span(report.reals).first(1));
  codec.cell(report.cell);
  connection_fields(codec, report.direction, report, kLimitBits | kGapOpens | kFacetSlips);
}

constexpr void along_fields(auto& codec, Report& report) {
  if constexpr (kKeepsAnswers) {
    real_fields(codec, report.along);
  }
}

constexpr void energy_fields(auto& codec, Report& report) {
  if constexpr (kKeepsAnswers) {
    real_fields(codec, report.along);
    real_fields(codec, report.energies);
  }
}

constexpr void resumption_fields(auto& codec, Report& report) {
  byte_flags(codec, report.mask, kHostedFlags);
  feet_fields(codec, report.feet);
}

/// Bound on the error, facets, products.
constexpr void iteration_fields(auto& codec, Report& report) {
  residual_fields(codec, report);
  for (double& product : report.products) {
    codec.long_real(product);
  }
}

/// Where the largest load ratio is, and the corners.
constexpr void last_fields(auto& codec, Report& report) {
  corner_fields(codec, report.corners);
  codec.cell(report.cell);
  connection_fields(codec, report.direction, report, kLimitBits | kGapOpens | kFacetSlips);
}

/// Fields of an equilibrium that begins from what is kept, and of iterations along it.
constexpr void deflated_report_fields(auto& codec, Operation operation, Report& report) {
  if (operation == Operation::kResumeDeflated) {
    resumption_fields(codec, report);
    return energy_fields(codec, report);
  }
  iteration_fields(codec, report);
  along_fields(codec, report);
  if (operation == Operation::kIterateLast) {
    last_fields(codec, report);
  }
}

constexpr void closing_fields(auto& codec, Report& report) {
  corner_fields(codec, report.corners);
  worst_fields(codec, report);
}

constexpr void renewal_fields(auto& codec, Report& report) {
  codec.faces(report.mask);
  codec.flags(report.flags, kRenewalFlags);
  codec.u16(report.extent);
  codec.u32(report.count);
  codec.u32(report.number);
  codec.moment(report.moment[0]);
  codec.moment(report.moment[1]);
  codec.place(report.cell);
}

constexpr void word_report_fields(auto& codec, Report& report) {
  codec.flags(report.flags, kFound | kDenied | kSplit | kDisputed);
  byte_field(codec, report.mask, kStageCount);
  codec.u32(report.count);
  codec.u16(report.extent);
  codec.u32(report.number);
  codec.cell(report.cell);
  codec.require((report.flags & kFound) == 0 || is_word(report.number));
}

constexpr void shape_fields(auto& codec, Report& report) {
  codec.cell(report.cell);
  base::Cell far = report.far_cell();
  codec.cell(far);
  report.set_far_cell(far);
  codec.u32(report.count);
  codec.moment(report.moment[0]);
  real_fields(codec, std::span(report.reals).first(2));
  byte_field(codec, report.mask, 0xff);
}

constexpr void bending_fields(auto& codec, Report& report) {
  codec.flags(report.flags, kHasSupport | kHasTilting | kHasSliding);
  codec.u32(report.count);
  codec.u32(report.number);
  real_fields(codec, report.reals);
}

/// What is in a report behind its operation.
constexpr void fields(auto& codec, Operation operation, Report& report) {
  switch (operation) {
    case Operation::kPlan:
    case Operation::kForget:
      codec.faces(report.mask);
      codec.flags(report.flags, kPlanReportFlags);
      return codec.place(report.cell);
    case Operation::kHosts:
      return byte_flags(codec, report.mask, kHostedFlags);
    case Operation::kMass:
      codec.u32(report.count);
      codec.u32(report.number);
      for (std::int64_t& moment : report.moment) {
        codec.moment(moment);
      }
      codec.flags(report.flags, kAnyFixed | kSumOverflow | kManyLoops | kUneven);
      return codec.u16(report.extent);
    case Operation::kAngles:
      return feet_fields(codec, report.feet);
    case Operation::kRenew:
      return kKeepsAnswers ? renewal_fields(codec, report) : void();
    case Operation::kResume:
      return kKeepsAnswers ? resumption_fields(codec, report) : void();
    case Operation::kTreeIterate:
      return residual_fields(codec, report, kFrontFlags);
    case Operation::kIterate:
      return iteration_fields(codec, report);
    case Operation::kIterateDeflated:
    case Operation::kIterateLast:
    case Operation::kResumeDeflated:
      return kKeepsAnswers ? deflated_report_fields(codec, operation, report) : void();
    case Operation::kHold:
    case Operation::kClusters:
    case Operation::kNext:
    case Operation::kSeek:
      codec.u32(report.count);
      return codec.u32(report.number);
    case Operation::kShape:
      return kKeepsAnswers ? shape_fields(codec, report) : void();
    case Operation::kCorners:
      return corner_fields(codec, report.corners);
    case Operation::kClose:
      return kKeepsAnswers ? closing_fields(codec, report) : void();
    case Operation::kLoads:
      worst_fields(codec, report);
      codec.u32(report.count);
      return codec.u32(report.number);
    case Operation::kVerdict:
      return codec.u32(report.count);
    case Operation::kWord:
      return kKeepsAnswers ? word_report_fields(codec, report) : void();
    case Operation::kStage:
      codec.flags(report.flags, kNewLinks);
      return codec.u32(report.count);
    case Operation::kBend:
      return kIsGeneral ? bending_fields(codec, report) : void();
    case Operation::kBegin:
    case Operation::kFactor:
      return;
  }
}

/// The sizes in the table of operations are those of the fields.
static_assert([] {
  for (const OperationInfo& row : kOperations) {
    Ruler down(kOrderAt);
    Order order{.operation = row.operation};
    fields(down, order);
    Ruler up(kOrderAt);
    Report report;
    fields(up, row.operation, report);
    const bool is_known = row.operation == Operation::kBend
                              ? kIsGeneral
                              : (kKeepsAnswers || row.operation < Operation::kRenew) &&
                                    (kHasAllMethods || row.operation != Operation::kSeek);
    if (is_known && (down.bytes() != row.order_bytes || up.bytes() != row.report_bytes)) {
      return false;
    }
  }
  return true;
}());

}  // namespace

Report worst_of(const Report& last) {
  Report worst = last;
  worst.reals[0] = last.load_ratio_max();
  worst.count = 0;
  return worst;
}

Writer encode(const Order& order) {
  Writer out(MessageType::kOrder, order.operation);
  Codec codec(out);
  Order copy = order;
  fields(codec, copy);
  return out;
}

Writer encode(Operation operation, const Report& report) {
  Writer out(MessageType::kReport, operation);
  Codec codec(out);
  Report copy = report;
  fields(codec, operation, copy);
  return out;
}

bool decode(std::span<const std::uint8_t> message, Order& order, int face_count) {
  Codec codec(message, kOrderAt);
  codec.set_face_count(face_count);
  order = {.operation = operation_of(message)};
  fields(codec, order);
  return codec.is_legal();
}

bool decode(std::span<const std::uint8_t> message, Report& report, int face_count) {
  Codec codec(message, kOrderAt);
  codec.set_face_count(face_count);
  report = {};
  fields(codec, operation_of(message), report);
  return codec.is_legal();
}

void merge(Operation operation, Report& into, const Report& from) {
  switch (operation) {
    case Operation::kPlan:
    case Operation::kForget:
      return merge_plan(into, from);
    case Operation::kHosts:
    case Operation::kResume:
      into.mask = static_cast<FaceMask>(into.mask | from.mask);
      return;
    case Operation::kResumeDeflated:
      into.mask = static_cast<FaceMask>(into.mask | from.mask);
      return merge_along(into, from);
    case Operation::kMass:
      return merge_mass(into, from);
    case Operation::kRenew:
      return kKeepsAnswers ? merge_renewal(into, from) : void();
    case Operation::kIterate:
    case Operation::kTreeIterate:
      return merge_residual(into, from);
    case Operation::kIterateDeflated:
      merge_along(into, from);
      return merge_residual(into, from);
    case Operation::kIterateLast:
      merge_along(into, from);
      return kKeepsAnswers ? merge_last(into, from) : void();
    case Operation::kClose:
      into.corners = mechanics::merge(into.corners, from.corners);
      return merge_loads(into, from);
    case Operation::kCorners:
      into.corners = mechanics::merge(into.corners, from.corners);
      return;
    case Operation::kLoads:
      return merge_loads(into, from);
    case Operation::kWord:
      return kKeepsAnswers ? merge_word(into, from) : void();
    case Operation::kStage:
      into.flags = static_cast<std::uint8_t>(into.flags | from.flags);
      break;
    case Operation::kShape:
      return kKeepsAnswers ? merge_shape(into, from) : void();
    case Operation::kSeek:
      return kHasAllMethods ? merge_keys(into, from) : void();
    case Operation::kBend:
      return kIsGeneral ? merge_bending(into, from) : void();
    default:
      break;
  }
  for (std::size_t i = 0; i < into.reals.size(); ++i) {
    into.reals[i] += from.reals[i];
  }
  into.count += from.count;
  into.number += from.number;
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSafe:
      return "safe";
    case Verdict::kOverload:
      return "overload";
    case Verdict::kUnstable:
      return "unstable";
    case Verdict::kUndecided:
      return "undecided";
    case Verdict::kNone:
      break;
  }
  return "none";
}

const char* name(Reason reason) {
  constexpr const char* kNames[] = {
      "not known yet",
      "it holds",
      "a connection breaks",
      "it topples",
      "a module that is there does not answer",
      "too many planned modules",
      "a plan and its withdrawal were told at once",
      "a planned module touches nothing",
      "the robot is too large to be counted",
      "no method settled",
      "the largest load ratio cannot be distinguished from 1",
      "the verdict depends on feet that may hold or not",
      "no answer in time",
      "no module that knows its cell was heard",
      "the robot would be in pieces",
      "the step as it was told does not fit the robot",
      "a facet may slip: it is pulled by more than its friction",
      "cells contradict: a module or an anchor is not where it was told",
      "faces do not match: a module is turned, or a cable is crossed",
      "bending may matter, and modules know linear theory alone"};
  return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace holdfast::agent
