// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "edge_text.hpp"
#include "factor_text.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/report.hpp"

// The only place where the reasons for a verdict become words.
namespace holdfast::io {
namespace {

using verdict::Reason;
using verdict::ReasonCode;
using Numbers = std::array<double, Reason::kNumberMax>;

using Cells = std::span<const base::Cell>;

/// Counts are among a reason's numbers.
std::string counted(double count, std::string_view one, std::string_view many = {}) {
  return fmt::format("{:.0f} {}", count, host::noun(count == 1, one, many));
}

/// Says which part of a step in any order is meant, or that its parts are not known.
std::string parts_text(const verdict::Reason& reason, Cells cells) {
  const auto& n = reason.numbers;
  if (reason.code == verdict::ReasonCode::kPartsNotKnown) {
    return fmt::format(
        "{} in any order have too many parts to check each, and no bound covers all of them; "
        "steps of fewer may",
        counted(n[0], "module"));
  }
  std::vector<std::string> names;
  std::ranges::transform(cells, std::back_inserter(names), &model::text);
  return fmt::format("that is when of {} in any order {} alone {} there: {}",
                     counted(n[1], "module"), n[0] == 1 ? "one" : fmt::format("{}", n[0]),
                     n[0] == 1 ? "is" : "are", fmt::join(names, ", "));
}

/// Writes the cell of a module that carries or is carried; "a cell" but in the stage of a step,
/// which alone knows it.
std::string carrier_text(Cells cells, std::size_t index) {
  return index < cells.size() ? model::text(cells[index]) : "a cell";
}

/// A number with one digit that is not below it.
double rounded_up(double number) {
  const double unit = std::pow(10, std::floor(std::log10(number)));
  return std::ceil(number / unit) * unit;
}

std::string range_text(double low, double high) {
  const std::string low_text = beside_one(low, 4);
  const std::string high_text = beside_one(high, 4);
  return low_text == high_text ? low_text : fmt::format("{} to {}", low_text, high_text);
}

std::string several_text(const Numbers& n) {
  const bool has_unilateral = !(n[3] > n[4]);
  if (n[0] < 2) {
    return fmt::format(
        "open facets still pull a little by the paper's contact law (Eqs. 9-12): the largest load "
        "ratio is {} by it, {} by exact unilateral contact (Eqs. 6-8)",
        range_text(n[1], n[2]), has_unilateral ? range_text(n[3], n[4]) : "not known");
  }
  return fmt::format(
      "the paper's contact law (Eqs. 9-12) has several solutions here: the largest load ratio is "
      "{} in the {:.0f} that were found, {} by exact unilateral contact (Eqs. 6-8)",
      range_text(n[1], n[2]), n[0], has_unilateral ? range_text(n[3], n[4]) : "not known");
}

std::string connection_text(Cells ends) {
  return model::text(ends[0]) + "-" + model::text(ends[1]);
}

/// The direction of a motion: an axis, or three numbers. Buckling goes either way.
std::string motion_text(double x, double y, double z, bool has_sign) {
  const std::array<double, 3> motion = {x, y, z};
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(motion[i]) > 0.95) {
      const char* const sign = !has_sign ? "" : motion[i] < 0 ? "-" : "+";
      return fmt::format("{}{}", sign, "xyz"[i]);
    }
  }
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", x, y, z);
}

/// The loss of stability of a robot that bends.
std::string losing_text(const Reason& reason, Cells cells) {
  const Numbers& n = reason.numbers;
  const bool is_buckling = reason.code == ReasonCode::kBuckles;
  return fmt::format("it {} at {} of its loads: {} {} {}",
                     is_buckling ? "buckles"
                     : n[5] > 0  ? "tips over as it bends"
                                 : "collapses",
                     factor_text(n[0]), model::text(cells[0]),
                     is_buckling ? "sways along" : "goes towards",
                     motion_text(n[2], n[3], n[4], !is_buckling));
}

/// Reasons that have no numbers; empty for all others.
std::string_view fixed_text(ReasonCode code) {
  switch (code) {
    case ReasonCode::kNoDigitsLeft:
      return "stable, but the loads are not known: the robot is so slender that rounding leaves no "
             "digits of them, or the solver that would keep some does not fit into the memory "
             "allowed";
    case ReasonCode::kLoadNotANumber:
      return "stable, but the load of a connection is not a number, so the largest is not known";
    case ReasonCode::kSingleModule:
      return "stable, and a single module has no connection to break";
    case ReasonCode::kNoTension:
      return "stable; no connection is in tension";
    case ReasonCode::kUnilateralContact:
      return "the loads come from exact unilateral contact (Eqs. 6-8): the paper's regularised "
             "contact (Eqs. 9-12) has no usable answer here";
    case ReasonCode::kBonded:
      return "supports are bonded on request: they can neither lift nor tilt, and nothing topples";
    case ReasonCode::kProvedOneSolution:
      return "proved, with the states of all facets, for one solution of the paper's contact law, "
             "which may have others";
    case ReasonCode::kProvedForces:
      return "proved, with the facets that are pressed, for the exact contact law, whose forces "
             "are "
             "then unique";
    case ReasonCode::kProvedUnique:
      return "proved; the solution is unique";
    case ReasonCode::kNoVerdictOfTheRobot:
      return "the modules came to no verdict";
    case ReasonCode::kBalances:
      return "contact forces that hold it exist, but with nothing to spare: any push moves it";
    case ReasonCode::kRigidUndecided:
      return "whether contact forces hold it was not found out";
    case ReasonCode::kModelFalls:
      return "the elastic model says unstable, as no facet is fully pressed and the pressed "
             "corners lie on one line; contact forces of a rigid body that would hold it do "
             "exist, so it may depend on how the load came, and is not safe";
    case ReasonCode::kStatesDisagree:
      return "contact forces of one solution hold it, but the contact laws, which allow several "
             "here, have states in which it falls, too";
    case ReasonCode::kLoadsTogether:
      return "load ratios and the weight factor include payloads";
    default:
      return {};
  }
}

constexpr std::string_view kAskDeformed = "ask with --deformed";

/// A buckling factor, or nothing where it is not known.
std::string softness_text(double factor) {
  return factor > 0 ? fmt::format(" (buckling factor {})", beside_one(factor, 3)) : "";
}

std::string second_order_text(const Numbers& n) {
  switch (static_cast<verdict::SecondOrderDoubt>(n[0])) {
    case verdict::SecondOrderDoubt::kNoStiffness:
      return fmt::format(
          "linear theory does not suffice: in the states of its feet the robot has no stiffness; "
          "{}",
          kAskDeformed);
    case verdict::SecondOrderDoubt::kBuckles:
      return fmt::format(
          "linear theory does not suffice: it would buckle at some {} of its loads; {}",
          beside_one(n[1], 3), kAskDeformed);
    case verdict::SecondOrderDoubt::kLoads:
      return fmt::format(
          "linear theory does not suffice: bending changes the largest load ratio from {} to about "
          "{}{}; {}",
          beside_one(n[2], 4), beside_one(n[3], 2), softness_text(n[1]), kAskDeformed);
    case verdict::SecondOrderDoubt::kTilts:
      break;
  }
  return fmt::format("linear theory does not suffice: bent, the robot would tilt on its feet{}; {}",
                     softness_text(n[1]), kAskDeformed);
}

std::string bending_text(const Numbers& n) {
  if (n[0] != 0) {
    return fmt::format(
        "warning: whether the robot is far from buckling is not certain, as it is too large for a "
        "factorization; {}",
        kAskDeformed);
  }
  if (n[4] > 0) {
    return fmt::format(
        "warning: linear theory is not trusted: with the default elastic modulus the buckling "
        "factor is {}; with less than {:.3g} MPa it would buckle; state elastic_modulus_mpa",
        beside_one(n[1], 3), n[4]);
  }
  return fmt::format(
      "warning: linear theory is not trusted: bent, the largest load ratio is about {} rather than "
      "{}{}; {}",
      beside_one(n[3], 4), beside_one(n[2], 4), softness_text(n[1]),
      n[4] < 0 ? "state elastic_modulus_mpa" : kAskDeformed);
}

/// Reasons about loads that are known.
std::string load_text(const Reason& reason, Cells cells) {
  const Numbers& n = reason.numbers;
  switch (reason.code) {
    case ReasonCode::kLimitInRange:
      return fmt::format(
          "stable, but the largest load ratio is only known to lie between {:.9g} and {:.9g}", n[0],
          n[1]);
    case ReasonCode::kSolutionsDisagree:
      return "stable, but " + several_text(n) + "; they do not agree whether anything breaks";
    case ReasonCode::kConnectionsBreak:
      return fmt::format(
          "{:.0f} of {} would break; the worst, {}, is loaded to {} % of its strength", n[0],
          counted(n[1], "connection"), connection_text(cells), percentage(n[3], 2));
    case ReasonCode::kDisplacedMass:
      return fmt::format(
          "stable as a rigid body, but bending moves the centre of mass by {:.3g} mm, {:.3g} mm "
          "beyond an edge of the support polygon that it is {:.3g} mm inside of unbent: it may "
          "topple, so nothing is certain",
          n[0], n[2], n[1]);
    case ReasonCode::kMassMoves:
      return fmt::format(
          "warning: bending moves the centre of mass by {:.3g} mm and leaves {:.3g} mm of its "
          "margin of {:.3g} mm; loads are those of the unbent robot",
          n[0], n[2], n[1]);
    case ReasonCode::kSecondOrder:
      return second_order_text(n);
    case ReasonCode::kBendingMatters:
      return bending_text(n);
    case ReasonCode::kPartHasCome:
    case ReasonCode::kPartsNotKnown:
      return parts_text(reason, cells);
    case ReasonCode::kBuckles:
    case ReasonCode::kCollapses:
      return losing_text(reason, cells);
    case ReasonCode::kTooSoft:
      return fmt::format(
          "at {} of its loads a connection is strained by {} at its facet's edge: so far no linear "
          "law of beams holds, and what follows is not known",
          factor_text(n[0]), n[1]);
    case ReasonCode::kTouchesFloor:
      return fmt::format("at {} of its loads {} bends down to the floor: what follows is not known",
                         factor_text(n[0]), model::text(cells[0]));
    case ReasonCode::kTouchesItself:
      return fmt::format("at {} of its loads {} and {} meet as it bends: what follows is not known",
                         factor_text(n[0]), model::text(cells[0]),
                         cells.size() > 1 ? model::text(cells[1]) : "an obstacle");
    case ReasonCode::kNoKnownTension:
      return fmt::format(
          "stable, and no connection is known to be in tension: none carries more than {:.1g} of "
          "its strength",
          rounded_up(n[0]));
    case ReasonCode::kHolds:
      return fmt::format("stable; the worst connection, {}, is loaded to {} % of its strength",
                         connection_text(cells), percentage(n[1], 2));
    case ReasonCode::kSolutionsAgree:
      return several_text(n) + (n[0] < 2 ? "; both give this verdict" : "; all give this verdict");
    case ReasonCode::kAmbiguousFeet:
      return fmt::format(
          "{} would touch down again if {} slid freely, and lift again if held; between the two "
          "the largest load ratio lies from {} to {}",
          counted(n[0], "lifted foot", "lifted feet"), n[0] == 1 ? "it" : "they",
          beside_one(n[1], 4), beside_one(n[2], 4));
    default:
      return {};
  }
}

}  // namespace

std::string edge_text(std::span<const double, 4> ends) {
  return fmt::format("the edge ({}, {})-({}, {}) mm", host::significant(ends[0], 10),
                     host::significant(ends[1], 10), host::significant(ends[2], 10),
                     host::significant(ends[3], 10));
}

std::string reason_text(const model::Robot& robot, const verdict::Reason& reason) {
  return reason_text(reason, verdict::cells_of(robot, reason));
}

std::string reason_text(const verdict::Reason& reason, std::span<const base::Cell> cells) {
  const Numbers& n = reason.numbers;
  switch (reason.code) {
    case ReasonCode::kNothingToSpare:
      return fmt::format(
          "the centre of mass lies exactly over {} of the support polygon: nothing to spare",
          edge_text(std::span(n).first<4>()));
    case ReasonCode::kTopples:
      return fmt::format("it topples over {}: the centre of mass lies {} mm beyond it",
                         edge_text(std::span(n).first<4>()), host::fixed(n[4], 2));
    case ReasonCode::kTooManyModules:
      return fmt::format(
          "stable, but the {:.0f} modules are too many for the solver's memory, so the loads are "
          "not known",
          n[0]);
    case ReasonCode::kNoEquilibrium:
    case ReasonCode::kSingularStiffness:
      return fmt::format("stable, but no equilibrium was found in {} of the contact iteration{}",
                         counted(n[0], "step"),
                         reason.code == ReasonCode::kSingularStiffness
                             ? ": the stiffness matrix became singular"
                             : "");
    case ReasonCode::kModelDisagrees:
      return fmt::format("the elastic model says {}; on flat ground the rigid body decides",
                         n[0] != 0 ? "stable" : "unstable");
    case ReasonCode::kNotProved:
      return "not proved: " + reason.quoted;
    case ReasonCode::kFalls:
      return "no contact forces balance the loads: it " +
             (reason.quoted.empty() ? "moves" : reason.quoted);
    case ReasonCode::kMaySlip:
      return fmt::format(
          "a facet of {} may slip: its sideways force is {} of its pressure, its friction {}; "
          "other contact forces may hold the robot, so nothing is certain",
          model::text(cells[0]), beside_one(n[1], 4), n[2]);
    case ReasonCode::kFeetSlip:
      return fmt::format(
          "{} until friction holds {}: the foot of {} then carries {:.4g} N sideways, {:.4g} of "
          "its pressure, by Coulomb's law for loads that grow from zero",
          n[0] == 1 ? "one foot slips" : fmt::format("{} feet slip", n[0]),
          n[0] == 1 ? "it" : "them", model::text(cells[0]), n[2], n[3]);
    case ReasonCode::kGapsOpen:
      return fmt::format(
          "warning: {} so far that contacts of power and data part; the worst, {}, by {:.3g} mm at "
          "its edge where {:.3g} are allowed",
          n[0] == 1 ? "1 connection opens" : fmt::format("{:.0f} connections open", n[0]),
          connection_text(cells), n[2], n[3]);
    case ReasonCode::kCarrierBreaks:
      return fmt::format(
          "the connection by which {} carries the module from {} would break: it carries {} of its "
          "strength",
          carrier_text(cells, 0), carrier_text(cells, 1), beside_one(n[0], 4));
    case ReasonCode::kCarrierHolds:
      return fmt::format(
          "the worst connection, by which {} carries the module from {}, carries {} of its "
          "strength",
          carrier_text(cells, 0), carrier_text(cells, 1), beside_one(n[0], 4));
    case ReasonCode::kInPieces:
      return fmt::format("the robot is in {}, each judged by itself", counted(n[0], "piece"));
    case ReasonCode::kVerdictOfTheRobot:
      return fmt::format("the robot's own verdict: {}{}", reason.quoted,
                         n[0] != 0 ? "" : "; not every module knows it");
    default:
      break;
  }
  const std::string_view fixed = fixed_text(reason.code);
  return fixed.empty() ? load_text(reason, cells) : std::string(fixed);
}

}  // namespace holdfast::io
