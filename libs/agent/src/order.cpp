// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/order.hpp"

#include "codec.hpp"
#include "holdfast/agent/operations.hpp"
#include "holdfast/agent/planned.hpp"
#include "methods.hpp"

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
  into.mask = static_cast<std::uint8_t>(into.mask | from.mask);
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
  if constexpr (kHasAllMethods) {
    for (std::size_t i = 0; i < into.products.size(); ++i) {
      into.products[i] += from.products[i];
    }
  }
  merge_facets(into, from);
}

void merge_loads(Report& into, const Report& from) {
  const bool is_worse =
      larger(into.reals[0], from.reals[0]) != into.reals[0] && into.reals[0] == into.reals[0];
  const bool is_equal = from.reals[0] == into.reals[0];
  if (is_worse || (is_equal && from.cell < into.cell)) {
    into.reals[0] = from.reals[0];
    into.cell = from.cell;
    into.direction = from.direction;
  }
  into.count += from.count;
  into.number += from.number;
}

constexpr std::uint8_t kPlanReportFlags =
    kFound | kTooManyAnnounced | kEnded | kFulfilled | kDisputed;

constexpr void direction_field(auto& codec, base::Direction& direction) {
  codec.kind(direction, base::kDirections.front(), base::kDirections.back());
}

constexpr void feet_fields(auto& codec, SafeCorners& feet) {
  codec.kind(feet.range, mechanics::SafeRange::kEmpty, mechanics::SafeRange::kFull);
  for (FootCorner* corner : {&feet.first, &feet.last}) {
    codec.i32(corner->x);
    codec.i32(corner->y);
    codec.require(feet.range != mechanics::SafeRange::kArc || is_good_corner(*corner));
  }
}

/// In place of the number of corners: the robot is held.
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

constexpr void answer_fields(auto& codec, Answer& answer) {
  codec.kind(answer.verdict, Verdict::kSafe, Verdict::kUndecided);
  codec.kind(answer.reason, Reason::kNone, Reason::kAmbiguousFeet);
  codec.real(answer.load_ratio_max);
  codec.cell(answer.worst_cell);
  direction_field(codec, answer.worst_direction);
}

constexpr void real_fields(auto& codec, std::span<float> reals) {
  for (float& real : reals) {
    codec.real(real);
  }
}

/// The degree of a preconditioner.
constexpr void degree_field(auto& codec, std::uint16_t& count) {
  auto degree = static_cast<std::uint8_t>(count);
  codec.u8(degree);
  count = degree;
}

/// What is in an order behind its operation.
constexpr void fields(auto& codec, Order& order) {
  base::Direction facet = kStandingFacet;
  switch (order.operation) {
    case Operation::kPlan:
      codec.u8(order.index);
      codec.require(order.index <= kPlannedMax || order.index == kNoPlanned);
      return codec.cell(order.cell);
    case Operation::kHosts:
      for (std::uint8_t& mask : order.masks) {
        codec.faces(mask);
      }
      return;
    case Operation::kMass:
      return codec.cell(order.cell);
    case Operation::kAngles:
      codec.kind(facet, kStandingFacet, kStandingFacet);
      codec.i32(order.mass);
      codec.moment(order.moment[0]);
      return codec.moment(order.moment[1]);
    case Operation::kBegin:
    case Operation::kClusters:
      codec.flags(order.flags, kUnilateralLaw | kOneSweep | kWithIterations);
      codec.u16(order.count, 0, kDegreeMax);
      return real_fields(codec, std::span(order.reals).first(2));
    case Operation::kHigh:
      return real_fields(codec, std::span(order.reals).first(2));
    case Operation::kLow:
      return codec.flags(order.flags, kFollowStates);
    case Operation::kStart:
      codec.flags(order.flags, kAdoptStates | kWithScalars | kWithBlocks);
      return degree_field(codec, order.count);
    case Operation::kGradient:
      degree_field(codec, order.count);
      return real_fields(codec, std::span(order.reals).first(2));
    case Operation::kJacobi:
      return codec.u16(order.count, 1, kJacobiCountMax);
    case Operation::kSlope:
      codec.flags(order.flags, kExchangeFirst | kMixProducts);
      return real_fields(codec, std::span(order.reals).first(2));
    case Operation::kHold:
      return codec.flags(order.flags, kReleaseOpen | kFreeOpen);
    case Operation::kVerdict:
      return answer_fields(codec, order.answer);
    case Operation::kIterate:
      codec.flags(order.flags,
                  kRestart | kLeastResidual | kKeepStates | kWithClusters | kHoldPlanned);
      codec.u16(order.count, 0, kDegreeMax);
      return real_fields(codec, std::span(order.reals).first(3));
    case Operation::kForget:
      codec.flags(order.flags, kIsFulfilled);
      return codec.place(order.cell);
    case Operation::kCorners:
    case Operation::kLoads:
    case Operation::kFactor:
    case Operation::kTreeIterate:
      return;
  }
}

/// Bound on the error, largest load ratio; facets that change, the hash of all states, any tilting.
constexpr void residual_fields(auto& codec, Report& report) {
  real_fields(codec, std::span(report.reals).first(2));
  codec.u16(report.extent);
  codec.u32(report.number);
  codec.flags(report.flags, kAnyTilting);
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
      return codec.flags(report.mask, (1U << kPlannedMax) - 1 + kAnyRemote);
    case Operation::kMass:
      codec.u32(report.count);
      codec.u32(report.number);
      for (std::int64_t& moment : report.moment) {
        codec.moment(moment);
      }
      codec.flags(report.flags, kAnyFixed | kSumOverflow | kManyLoops);
      return codec.u16(report.extent);
    case Operation::kAngles:
      return feet_fields(codec, report.feet);
    case Operation::kLow:
    case Operation::kTreeIterate:
      return residual_fields(codec, report);
    case Operation::kIterate:
      residual_fields(codec, report);
      if constexpr (kHasAllMethods) {
        for (double& product : report.products) {
          codec.long_real(product);
        }
      }
      return;
    case Operation::kStart:
    case Operation::kGradient:
      real_fields(codec, std::span(report.reals).first(2));
      return codec.short_real(report.reals[2]);
    case Operation::kJacobi:
      return real_fields(codec, std::span(report.reals).first(1));
    case Operation::kSlope:
      return real_fields(codec, std::span(report.reals).first(5));
    case Operation::kHold:
    case Operation::kClusters:
      codec.u32(report.count);
      return codec.u32(report.number);
    case Operation::kCorners:
      return corner_fields(codec, report.corners);
    case Operation::kLoads:
      real_fields(codec, std::span(report.reals).first(1));
      codec.cell(report.cell);
      direction_field(codec, report.direction);
      codec.u32(report.count);
      return codec.u32(report.number);
    case Operation::kVerdict:
      return codec.u32(report.count);
    case Operation::kBegin:
    case Operation::kHigh:
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
    const bool is_known = kHasAllMethods || row.operation != Operation::kIterate;
    if (down.bytes() != row.order_bytes || (is_known && up.bytes() != row.report_bytes)) {
      return false;
    }
  }
  return true;
}());

}  // namespace

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

bool decode(std::span<const std::uint8_t> message, Order& order) {
  Codec codec(message, kOrderAt);
  order = {.operation = operation_of(message)};
  fields(codec, order);
  return codec.is_legal();
}

bool decode(std::span<const std::uint8_t> message, Report& report) {
  Codec codec(message, kOrderAt);
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
      into.mask = static_cast<std::uint8_t>(into.mask | from.mask);
      return;
    case Operation::kMass:
      return merge_mass(into, from);
    case Operation::kLow:
    case Operation::kIterate:
    case Operation::kTreeIterate:
      return merge_residual(into, from);
    case Operation::kCorners:
      into.corners = mechanics::merge(into.corners, from.corners);
      return;
    case Operation::kLoads:
      return merge_loads(into, from);
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
  constexpr const char* kNames[] = {"not known yet",
                                    "it holds",
                                    "a connection breaks",
                                    "it topples",
                                    "a module that is there does not answer",
                                    "too many planned modules",
                                    "a plan and its withdrawal were told at once",
                                    "a planned module touches nothing",
                                    "the robot is too large to be counted",
                                    "no method settled",
                                    "the largest load ratio cannot be told from 1",
                                    "the verdict depends on feet that are neither held nor free",
                                    "no answer in time",
                                    "no module that knows its cell was heard"};
  return kNames[static_cast<std::size_t>(reason)];
}

}  // namespace holdfast::agent
