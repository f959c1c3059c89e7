// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "equilibrium_options.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/cascade.hpp"

namespace holdfast {
namespace {

using plan::Cascade;
using plan::CascadeOutcome;
using plan::CascadeRound;

/// People get no more lines of rounds than this; a JSON report has all.
constexpr std::size_t kRoundsShownMax = 10;

std::string fall_text(std::size_t fallen, std::size_t count) {
  return fallen == 0       ? "no module falls"
         : fallen == count ? "everything falls"
                           : fmt::format("{} of {} fall", fallen, host::counted(count, "module"));
}

std::string cascade_headline(const Cascade& cascade, std::size_t count) {
  const std::string fall = fall_text(cascade.fallen_count(), count);
  const std::string rounds = host::counted(cascade.rounds.size(), "round");
  switch (cascade.outcome) {
    case CascadeOutcome::kHolds:
      return "nothing breaks and nothing falls";
    case CascadeOutcome::kUndecided:
      return fmt::format("undecided after {}: {} by then", rounds, fall);
    case CascadeOutcome::kStands:
    case CascadeOutcome::kFalls:
      break;
  }
  return cascade.broken_count() > 0 ? fmt::format("breaks in {}; {}", rounds, fall)
                                    : fmt::format("topples; {}", fall);
}

std::string round_text(const CascadeRound& round) {
  std::string text;
  if (!round.broken.empty()) {
    const auto& [between, ratio] = round.broken.front();
    text = fmt::format("{} at {}", model::text(between[0]) + "-" + model::text(between[1]),
                       io::beside_one(ratio, 4));
    text += round.broken.size() > 1 ? fmt::format(" and {} more break", round.broken.size() - 1)
                                    : std::string(" breaks");
  }
  if (!round.fallen.empty()) {
    text += fmt::format("{}{} {}", text.empty() ? "" : "; ",
                        host::counted(round.fallen.size(), "module"),
                        round.fallen.size() == 1 ? "falls" : "fall");
  }
  return text;
}

void write_cells(io::JsonStream& json, const char* key, const std::vector<base::Cell>& cells) {
  json.key(key);
  json.begin_array();
  for (const base::Cell& cell : cells) {
    json.value(cell);
  }
  json.end_array();
}

void write_round(io::JsonStream& json, const CascadeRound& round) {
  json.begin_object();
  json.key("broken");
  json.begin_array();
  for (const plan::BrokenConnection& broken : round.broken) {
    json.begin_object();
    json.member("a", broken.between[0]);
    json.member("b", broken.between[1]);
    json.member("load_ratio", broken.load_ratio);
    json.end_object();
  }
  json.end_array();
  write_cells(json, "fallen", round.fallen);
  json.end_object();
}

}  // namespace

Cascade find_cascade(const Structure& structure, const CheckOptions& options,
                     const std::function<void(std::size_t, std::size_t)>& progress) {
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  plan::CascadeOptions how;
  how.equilibrium = equilibrium_options(options);
  how.is_deformed = options.is_deformed_wanted;
  how.progress = progress;
  auto found = plan::find_cascade(spec.value(), how);
  HOLDFAST_CHECK(found.has_value());  // Connected parts that something supports are robots.
  return std::move(found).value();
}

std::string cascade_text(const model::Robot& robot, const Cascade& cascade) {
  std::string text =
      fmt::format("  {:<12}{}\n", "cascade", cascade_headline(cascade, robot.modules().size()));
  const auto add = [&](const std::string& line) { text += fmt::format("  {:<12}{}\n", "", line); };
  for (std::size_t i = 0; i < std::min(cascade.rounds.size(), kRoundsShownMax); ++i) {
    add(fmt::format("{}: {}", i + 1, round_text(cascade.rounds[i])));
  }
  if (cascade.rounds.size() > kRoundsShownMax) {
    add(fmt::format("(and {} more)",
                    host::counted(cascade.rounds.size() - kRoundsShownMax, "round")));
  }
  if (!cascade.reasons.empty()) {
    const plan::StageReason& first = cascade.reasons.front();
    add(first.reason.code == verdict::ReasonCode::kConnectionsBreak
            ? "which connections break next is within the error of their loads"
            : io::reason_text(first.reason, first.cells));
  }
  return text;
}

void write_cascade_member(io::JsonStream& json, const Cascade& cascade) {
  json.key("cascade");
  json.begin_object();
  json.member("outcome", plan::name(cascade.outcome));
  json.key("rounds");
  json.begin_array();
  for (const CascadeRound& round : cascade.rounds) {
    write_round(json, round);
  }
  json.end_array();
  json.member("broken", cascade.broken_count());
  json.member("fallen", cascade.fallen_count());
  write_cells(json, "standing", cascade.standing);
  json.member("checks", cascade.check_count);
  json.end_object();
}

std::string cascade_svg(const Structure& structure, const CheckResult& result,
                        const Cascade& cascade, const io::FigureOptions& figure) {
  std::vector<base::Cell> fallen;
  for (const CascadeRound& round : cascade.rounds) {
    fallen.insert(fallen.end(), round.fallen.begin(), round.fallen.end());
  }
  return io::write_svg_with_fallen(structure.robot, fallen, result.assessment, structure.name,
                                   structure.document.extension.obstacles, figure);
}

}  // namespace holdfast
