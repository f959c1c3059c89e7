// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "connection_list.hpp"
#include "edge_text.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/report.hpp"
#include "report/deformed_report.hpp"
#include "report/limit_report.hpp"

namespace holdfast::io {
namespace {

/// The number of most loaded connections that are listed.
constexpr std::size_t kListedConnections = 5;

using Out = std::back_insert_iterator<std::string>;

void write_modules(Out out, const model::Robot& robot) {
  fmt::format_to(out, "  modules     {} existing, {} planned; {} supported, {} fixed\n",
                 robot.modules().size() - robot.planned_count(), robot.planned_count(),
                 robot.ground_count(), robot.fixed_count());
}

/// Says how the rigid body stands with supports anywhere.
std::string rigid_text(const limit::RigidStability& rigid) {
  std::string text = fmt::format(": as a rigid body it {}", limit::name(rigid.answer));
  if (rigid.motion) {
    text += ", it " + limit::text(*rigid.motion);
  }
  if (rigid.tilt_margin_deg && rigid.holds()) {
    text += fmt::format(", until gravity tilts by {:.1f} degrees", *rigid.tilt_margin_deg);
  }
  if (rigid.friction_needed && *rigid.friction_needed > 0) {
    text +=
        fmt::format(", it needs a friction coefficient of at least {:.3g}", *rigid.friction_needed);
  }
  return text;
}

void write_stability(Out out, const ReportEntry& entry) {
  const model::Robot& robot = *entry.robot;
  const verdict::Assessment& assessment = *entry.assessment;
  const verdict::RigidBody& body = assessment.simplified;
  const bool is_doubtful = assessment.verdict == verdict::Verdict::kUndecided;
  // What the elastic model also says stable with, or not.
  const bool is_said_stable = assessment.contact_model == verdict::ContactModel::kBonded
                                  ? assessment.is_stable
                                  : assessment.rigid.holds();
  const char* word = entry.is_deformed && is_said_stable ? "unbent stable"
                     : assessment.is_stable              ? "stable"
                     : is_doubtful                       ? "not certain"
                                                         : "unstable";
  if (body.margin_mm) {
    const auto& [a, b] = *body.edge;
    const std::array<double, 4> ends = {a.x, a.y, b.x, b.y};
    fmt::format_to(out, "  stability   {}, margin {} mm at {}{}", word,
                   host::fixed(*body.margin_mm, 2), *body.margin_mm < 0 ? "the line of " : "",
                   edge_text(ends));
  } else if (assessment.stability_rule == verdict::StabilityRule::kHeld) {
    fmt::format_to(out, "  stability   {}, held by a {}", word,
                   robot.fixed_count() > 0 ? "fixed module" : "bonded support");
  } else {
    fmt::format_to(out, "  stability   {}{}", word, rigid_text(assessment.rigid));
  }
  if (!assessment.model.is_settled) {
    fmt::format_to(out, "; the elastic model has no answer\n");
  } else if (assessment.model.is_stable == is_said_stable) {
    fmt::format_to(out, "; the elastic model also says {}\n",
                   is_said_stable ? "stable" : "unstable");
  } else {
    fmt::format_to(out, "; the elastic model says {}\n",
                   assessment.model.is_stable ? "stable" : "unstable");
  }
}

void write_loads(Out out, const model::Robot& robot, const verdict::Assessment& assessment,
                 bool is_deformed) {
  if (assessment.load_ratio_max && !assessment.worst) {
    const bool is_known = assessment.load_ratio_range.high < verdict::kLoadRatioTie;
    fmt::format_to(out, "  load ratio  no connection is {}in tension\n",
                   is_known ? "" : "known to be ");
    return;
  }
  const std::vector<std::size_t> order = most_loaded(assessment, kListedConnections);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const verdict::ConnectionResult& result = assessment.connections[order[i]];
    const std::int32_t body = robot.body(robot.connections()[order[i]]);
    const bool is_inside = body != model::OwnConnector::kNoBody;
    fmt::format_to(
        out, "  {}  {:>7}  {:<24} {:>9} N axial {:>9} N mm bending{}\n",
        i == 0 ? "load ratio" : "          ", is_inside ? "-" : beside_one(result.load_ratio, 4),
        model::ends_text(robot, order[i]), host::fixed(result.axial_n, 3),
        host::fixed(result.bending_nmm, 1), is_inside ? fmt::format(", inside body {}", body) : "");
  }
  if (!order.empty() && !assessment.is_stable) {
    fmt::format_to(out, "              (not meaningful: the robot {})\n",
                   assessment.verdict == verdict::Verdict::kUndecided ? "may move"
                   : is_deformed                                      ? "does not stay"
                                                                      : "topples");
  } else if (assessment.weight_factor && !is_deformed) {
    fmt::format_to(out, "  weight      the first connection breaks at {} times {}\n",
                   beside_one(*assessment.weight_factor, 3),
                   robot.has_payloads() ? "these loads" : "this weight");
  }
}

/// Writes a line for each of a robot's pieces, the worst first.
void write_pieces(Out out, const verdict::Assessment& assessment) {
  constexpr std::size_t kListedPieces = 10;
  const auto& pieces = assessment.pieces;
  for (std::size_t i = 0; i < std::min(pieces.size(), kListedPieces); ++i) {
    const verdict::PieceAnswer& piece = pieces[i];
    fmt::format_to(out, "  {}  {:<9}  load ratio {:>7}, margin {:>9}  {} with {}\n",
                   i == 0 ? "pieces    " : "          ", verdict::name(piece.verdict),
                   piece.load_ratio_max ? beside_one(*piece.load_ratio_max, 4) : "-",
                   piece.margin_mm ? host::fixed(*piece.margin_mm, 2) + " mm" : "-",
                   host::counted(piece.module_count, "module"), model::text(piece.first));
  }
  if (pieces.size() > kListedPieces) {
    fmt::format_to(out, "              (and {} more)\n", pieces.size() - kListedPieces);
  }
}

void write_second_order(Out out, const verdict::Assessment& assessment) {
  if (const auto& second = assessment.second_order) {
    fmt::format_to(out, "  second order  {}: {}\n", buckling_text(*second),
                   verdict::name(second->trust));
  }
}

std::string time_text(double seconds) {
  return seconds < 0.1 ? fmt::format("{:.0f} us", seconds * 1e6) : fmt::format("{:.2f} s", seconds);
}

void write_solver(Out out, const verdict::Assessment& assessment, double seconds) {
  const solver::Equilibrium& equilibrium = assessment.equilibrium;
  const std::string time = time_text(seconds);
  if (equilibrium.outcome == solver::Outcome::kNotSought) {
    fmt::format_to(out, "  loads       not computed, as the robot topples; {}\n", time);
    return;
  }
  fmt::format_to(out, "  contact     {}; {}{} in {}\n", verdict::name(assessment.contact_model),
                 host::counted(equilibrium.steps, "linear solve"),
                 equilibrium.method == solver::Method::kMultigrid
                     ? fmt::format(", {} of multigrid",
                                   host::counted(equilibrium.iteration_count, "iteration"))
                     : "",
                 time);
}

/// Writes the proved range, rounded outwards to about twelve digits.
void write_proof(Out out, const ReportEntry& entry) {
  constexpr double kOutwards = 1e-12;
  const certificate::Verification& found = entry.proof->verification;
  if (!found.is_proved) {
    fmt::format_to(out, "  proof       none: {}\n", found.reason);
    return;
  }
  const double low = found.ratio_low - std::abs(found.ratio_low) * kOutwards;
  const double high = found.ratio_high + std::abs(found.ratio_high) * kOutwards;
  fmt::format_to(
      out, "  proof       the largest load ratio lies between {:.13g} and {:.13g}; {} in {}\n", low,
      high, host::counted(entry.proof->solve_count, "linear solve"),
      time_text(entry.proof_seconds));
  fmt::format_to(out, "  digest      {}\n", certificate::digest(entry.proof->certificate));
}

}  // namespace

std::string buckling_text(const verdict::SecondOrder& second) {
  using solver::BucklingAnswer;
  if (const auto factor = second.buckling_factor();
      factor && second.answer == BucklingAnswer::kFactor) {
    return fmt::format("buckling factor {} (linear estimate)", beside_one(*factor, 3));
  }
  switch (second.answer) {
    case BucklingAnswer::kNone:
      return "no buckling";
    case BucklingAnswer::kAbove:
      return fmt::format("buckling factor above {:g}", second.factor);
    case BucklingAnswer::kAtMost:
      return std::isfinite(second.factor)
                 ? fmt::format("buckling factor at most {:.3g} (linear estimate)", second.factor)
                 : "buckling factor not known";
    case BucklingAnswer::kNoStiffness:
    case BucklingAnswer::kFactor:
      break;
  }
  return "no stiffness in the states of its feet";
}

std::string write_report_text(const ReportEntry& entry) {
  const verdict::Assessment& assessment = *entry.assessment;
  std::string text;
  const Out out(text);
  for (const verdict::Reason& reason : assessment.reasons) {
    fmt::format_to(out, "  {}\n", reason_text(*entry.robot, reason));
  }
  fmt::format_to(out, "\n");
  write_modules(out, *entry.robot);
  write_stability(out, entry);
  write_loads(out, *entry.robot, assessment, entry.is_deformed);
  write_pieces(out, assessment);
  write_second_order(out, assessment);
  write_solver(out, assessment, entry.seconds);
  if (entry.is_deformed) {
    text += deformed_text(entry);
  }
  if (entry.proof != nullptr) {
    write_proof(out, entry);
  }
  if (entry.limit != nullptr) {
    text += limit_text(entry);
  }
  for (const std::string& warning : entry.warnings) {
    fmt::format_to(out, "  note        {}\n", warning);
  }
  return text;
}

}  // namespace holdfast::io
