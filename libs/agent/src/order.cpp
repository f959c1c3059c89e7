// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/order.hpp"

#include "methods.hpp"

namespace holdfast::agent {
namespace {

using wire::MessageType;
using wire::Operation;
using wire::Reader;
using wire::Writer;

/// The operation is the byte behind the type.
Operation operation_of(std::span<const std::uint8_t> message) {
  return static_cast<Operation>(message[1]);
}

std::int32_t saturating_sum(std::int32_t a, std::int32_t b, std::uint8_t& flags) {
  const std::int64_t sum = std::int64_t{a} + b;
  constexpr std::int64_t kMax = 0x7fffffff;
  if (sum > kMax || sum < -kMax) {
    flags = static_cast<std::uint8_t>(flags | kSumOverflow);
    return static_cast<std::int32_t>(sum > 0 ? kMax : -kMax);
  }
  return static_cast<std::int32_t>(sum);
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
  for (std::size_t i = 0; i < 2; ++i) {
    into.cell_sum[i] = saturating_sum(into.cell_sum[i], from.cell_sum[i], into.flags);
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

void write_feet(Writer& out, const SafeCorners& feet) {
  out.u8(static_cast<std::uint8_t>(feet.range));
  for (const FootCorner& corner : {feet.first, feet.last}) {
    out.i32(corner.x);
    out.i32(corner.y);
  }
}

SafeCorners read_feet(Reader& in) {
  SafeCorners feet;
  feet.range = static_cast<mechanics::SafeRange>(in.u8());
  for (FootCorner* corner : {&feet.first, &feet.last}) {
    corner->x = in.i32();
    corner->y = in.i32();
  }
  return feet;
}

void write_corners(Writer& out, const mechanics::SupportCorners& corners) {
  out.u8(static_cast<std::uint8_t>(corners.count | (corners.stable ? 4U : 0U)));
  for (const mechanics::Corner& corner : corners.corners) {
    out.cell({corner.x, corner.y, corner.z});
  }
}

mechanics::SupportCorners read_corners(Reader& in) {
  const std::uint8_t first = in.u8();
  mechanics::SupportCorners corners{.stable = (first & 4U) != 0,
                                    .count = static_cast<std::uint8_t>(first & 3U)};
  for (mechanics::Corner& corner : corners.corners) {
    const base::Cell cell = in.cell();
    corner = {cell.x, cell.y, cell.z};
  }
  return corners;
}

/// Reals that a report carries at its front.
int real_count(Operation operation) {
  switch (operation) {
    case Operation::kLow:
    case Operation::kStart:
    case Operation::kGradient:
    case Operation::kStep:
    case Operation::kTreeStep:
      return 2;
    case Operation::kSlope:
      return 5;
    case Operation::kJacobi:
    case Operation::kLoads:
      return 1;
    default:
      return 0;
  }
}

void write_reals(Writer& out, std::span<const float> reals) {
  for (const float real : reals) {
    out.real(static_cast<double>(real));
  }
}

}  // namespace

Writer encode(const Order& order) {
  Writer out(MessageType::kOrder, order.operation);
  switch (order.operation) {
    case Operation::kHosts:
      for (const std::uint8_t mask : order.masks) {
        out.u8(mask);
      }
      break;
    case Operation::kPlan:
    case Operation::kForget:
      out.u8(order.operation == Operation::kPlan ? order.index : order.flags);
      [[fallthrough]];
    case Operation::kMass:
      out.cell(order.cell);
      break;
    case Operation::kAngles:
      out.i32(order.module_count);
      out.i32(order.cell_sum[0]);
      out.i32(order.cell_sum[1]);
      break;
    case Operation::kJacobi:
      out.u16(order.count);
      break;
    case Operation::kLow:
    case Operation::kHold:
      out.u8(order.flags);
      break;
    case Operation::kStart:
      out.u8(order.flags);
      out.u8(static_cast<std::uint8_t>(order.count));
      break;
    case Operation::kBegin:
    case Operation::kClusters:
      out.u8(order.flags);
      out.u16(order.count);
      out.real(static_cast<double>(order.reals[0]));
      out.real(static_cast<double>(order.reals[1]));
      break;
    case Operation::kStep:
      out.u8(order.flags);
      out.u16(order.count);
      write_reals(out, order.reals);
      break;
    case Operation::kSlope:
      out.u8(order.flags);
      [[fallthrough]];
    case Operation::kHigh:
      out.real(static_cast<double>(order.reals[0]));
      out.real(static_cast<double>(order.reals[1]));
      break;
    case Operation::kGradient:
      out.u8(static_cast<std::uint8_t>(order.count));
      out.real(static_cast<double>(order.reals[0]));
      out.real(static_cast<double>(order.reals[1]));
      break;
    case Operation::kVerdict:
      out.u8(static_cast<std::uint8_t>(order.answer.verdict));
      out.u8(static_cast<std::uint8_t>(order.answer.reason));
      out.real(static_cast<double>(order.answer.load_ratio_max));
      out.cell(order.answer.worst_cell);
      out.u8(static_cast<std::uint8_t>(order.answer.worst_direction));
      break;
    case Operation::kCorners:
    case Operation::kLoads:
    case Operation::kFactor:
    case Operation::kTreeStep:
      break;
  }
  return out;
}

Order decode_order(std::span<const std::uint8_t> message) {
  Reader in(message, 2);
  Order order{.operation = operation_of(message)};
  switch (order.operation) {
    case Operation::kPlan:
      order.index = in.u8();
      order.cell = in.cell();
      break;
    case Operation::kHosts:
      for (std::uint8_t& mask : order.masks) {
        mask = in.u8();
      }
      break;
    case Operation::kForget:
      order.flags = in.u8();
      [[fallthrough]];
    case Operation::kMass:
      order.cell = in.cell();
      break;
    case Operation::kAngles:
      order.module_count = in.i32();
      order.cell_sum = {in.i32(), in.i32()};
      break;
    case Operation::kJacobi:
      order.count = in.u16();
      break;
    case Operation::kLow:
    case Operation::kHold:
      order.flags = in.u8();
      break;
    case Operation::kStart:
      order.flags = in.u8();
      order.count = in.u8();
      break;
    case Operation::kBegin:
    case Operation::kClusters:
      order.flags = in.u8();
      order.count = in.u16();
      order.reals = {in.real(), in.real()};
      break;
    case Operation::kStep:
      order.flags = in.u8();
      order.count = in.u16();
      order.reals = {in.real(), in.real(), in.real()};
      break;
    case Operation::kSlope:
      order.flags = in.u8();
      [[fallthrough]];
    case Operation::kHigh:
      order.reals = {in.real(), in.real()};
      break;
    case Operation::kGradient:
      order.count = in.u8();
      order.reals = {in.real(), in.real()};
      break;
    case Operation::kVerdict:
      order.answer.verdict = static_cast<Verdict>(in.u8());
      order.answer.reason = static_cast<Reason>(in.u8());
      order.answer.load_ratio_max = in.real();
      order.answer.worst_cell = in.cell();
      order.answer.worst_direction = static_cast<base::Direction>(in.u8());
      break;
    case Operation::kCorners:
    case Operation::kLoads:
    case Operation::kFactor:
    case Operation::kTreeStep:
      break;
  }
  return order;
}

Writer encode(Operation operation, const Report& report) {
  Writer out(MessageType::kReport, operation);
  write_reals(out, std::span(report.reals).first(static_cast<std::size_t>(real_count(operation))));
  switch (operation) {
    case Operation::kPlan:
    case Operation::kForget:
      out.u8(report.mask);
      out.u8(report.flags);
      out.cell(report.cell);
      break;
    case Operation::kHosts:
      out.u8(report.mask);
      break;
    case Operation::kMass:
      out.u32(report.count);
      out.i32(report.cell_sum[0]);
      out.i32(report.cell_sum[1]);
      out.u8(report.flags);
      out.u16(report.extent);
      break;
    case Operation::kAngles:
      write_feet(out, report.feet);
      break;
    case Operation::kStart:
    case Operation::kGradient:
      out.short_real(static_cast<double>(report.reals[2]));
      break;
    case Operation::kLow:
    case Operation::kStep:
    case Operation::kTreeStep:
      out.u16(report.extent);
      out.u32(report.number);
      out.u8(report.flags);
      if (kHasAllMethods && operation == Operation::kStep) {
        for (const double product : report.products) {
          out.long_real(product);
        }
      }
      break;
    case Operation::kHold:
    case Operation::kClusters:
      out.u32(report.count);
      out.u32(report.number);
      break;
    case Operation::kCorners:
      write_corners(out, report.corners);
      break;
    case Operation::kLoads:
      out.cell(report.cell);
      out.u8(static_cast<std::uint8_t>(report.direction));
      out.u32(report.count);
      out.u32(report.number);
      break;
    case Operation::kVerdict:
      out.u32(report.count);
      break;
    default:
      break;
  }
  return out;
}

Report decode_report(std::span<const std::uint8_t> message) {
  const Operation operation = operation_of(message);
  Reader in(message, 2);
  Report report;
  for (int i = 0; i < real_count(operation); ++i) {
    report.reals[static_cast<std::size_t>(i)] = in.real();
  }
  switch (operation) {
    case Operation::kPlan:
    case Operation::kForget:
      report.mask = in.u8();
      report.flags = in.u8();
      report.cell = in.cell();
      break;
    case Operation::kHosts:
      report.mask = in.u8();
      break;
    case Operation::kMass:
      report.count = in.u32();
      report.cell_sum = {in.i32(), in.i32()};
      report.flags = in.u8();
      report.extent = in.u16();
      break;
    case Operation::kAngles:
      report.feet = read_feet(in);
      break;
    case Operation::kStart:
    case Operation::kGradient:
      report.reals[2] = in.short_real();
      break;
    case Operation::kLow:
    case Operation::kStep:
    case Operation::kTreeStep:
      report.extent = in.u16();
      report.number = in.u32();
      report.flags = in.u8();
      if (kHasAllMethods && operation == Operation::kStep) {
        for (double& product : report.products) {
          product = in.long_real();
        }
      }
      break;
    case Operation::kHold:
    case Operation::kClusters:
      report.count = in.u32();
      report.number = in.u32();
      break;
    case Operation::kCorners:
      report.corners = read_corners(in);
      break;
    case Operation::kLoads:
      report.cell = in.cell();
      report.direction = static_cast<base::Direction>(in.u8());
      report.count = in.u32();
      report.number = in.u32();
      break;
    case Operation::kVerdict:
      report.count = in.u32();
      break;
    default:
      break;
  }
  return report;
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
    case Operation::kStep:
    case Operation::kTreeStep:
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
