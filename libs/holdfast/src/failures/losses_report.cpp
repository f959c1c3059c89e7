// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "equilibrium_options.hpp"
#include "failures/losses_words.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/losses.hpp"

namespace holdfast {
namespace {

using plan::Loss;
using plan::LossAnswer;
using plan::LossKind;
using plan::LossReport;
using verdict::Verdict;

/// People get no more lines of losses than this; a JSON report has all.
constexpr std::size_t kShownMax = 10;

std::string consequence(const LossAnswer& answer) {
  if (answer.fallen_count > 0) {
    return host::counted(answer.fallen_count, "module") +
           (answer.fallen_count == 1 ? " falls" : " fall");
  }
  std::string text = verdict::name(answer.verdict);
  if (answer.load_ratio_max && answer.verdict != Verdict::kUnstable) {
    text += fmt::format(", load ratio {}", io::beside_one(*answer.load_ratio_max, 4));
  }
  return text;
}

/// What follows a fatal loss, where that was sought.
std::string aftermath(const LossAnswer& answer) {
  if (!answer.after) {
    return "";
  }
  const plan::Aftermath& after = *answer.after;
  const std::string fall = after.fallen_count == 0
                               ? "no module falls"
                               : host::counted(after.fallen_count, "module") +
                                     (after.fallen_count == 1 ? " falls" : " fall");
  const std::string rounds = host::counted(after.round_count, "round");
  return after.outcome == plan::CascadeOutcome::kUndecided
             ? fmt::format("; then undecided after {}: {} by then", rounds, fall)
             : fmt::format(
                   "; in all {} in {}{}", fall, rounds,
                   after.outcome == plan::CascadeOutcome::kFalls ? ", nothing is left" : "");
}

void write_loss(io::JsonStream& json, const model::Robot& robot, const Loss& loss) {
  switch (loss.kind) {
    case LossKind::kConnection:
      json.member("a", loss.cells[0]);
      json.member("b", loss.cells[1]);
      return;
    case LossKind::kModule:
      json.member("module", loss.cells[0]);
      if (loss.body != model::OwnConnector::kNoBody) {
        json.member("body", loss.body);
      }
      return;
    case LossKind::kFoot:
      break;
  }
  json.member("foot", loss.cells[0]);
  json.key("direction");
  if (!loss.direction) {
    json.value(nullptr);
    return;
  }
  json.begin_array();
  for (const double component : base::heading(robot.lattice(), *loss.direction)) {
    json.value(component);
  }
  json.end_array();
}

void write_answer(io::JsonStream& json, const model::Robot& robot, const LossAnswer& answer) {
  json.begin_object();
  write_loss(json, robot, answer.loss);
  json.member("verdict", verdict::name(answer.verdict));
  json.member("load_ratio_max", answer.load_ratio_max);
  json.member("fallen", answer.fallen_count);
  if (answer.after) {
    json.key("cascade");
    json.begin_object();
    json.member("outcome", plan::name(answer.after->outcome));
    json.member("rounds", answer.after->round_count);
    json.member("broken", answer.after->broken_count);
    json.member("fallen", answer.after->fallen_count);
    json.end_object();
  }
  json.end_object();
}

void write_answers(io::JsonStream& json, const char* key, const model::Robot& robot,
                   const std::vector<LossAnswer>& answers) {
  json.key(key);
  json.begin_array();
  for (const LossAnswer& answer : answers) {
    write_answer(json, robot, answer);
  }
  json.end_array();
}

/// What is said first.
std::string headline(const LossReport& report) {
  if (!report.whole.is_safe()) {
    return "not tried: the structure is not safe as it is";
  }
  if (!report.fatal.empty()) {
    return fmt::format("{} of {} single losses bring it down", report.fatal.size(),
                       report.loss_count);
  }
  if (!report.undecided.empty()) {
    return fmt::format("none of {} single losses is known to bring it down", report.loss_count);
  }
  const bool has_bodies = std::ranges::any_of(report.answers, [](const LossAnswer& answer) {
    return answer.loss.body != model::OwnConnector::kNoBody;
  });
  return fmt::format("safe whatever is lost: each of {} connections, modules{} feet",
                     report.loss_count, has_bodies ? ", bodies and" : " and");
}

/// The robot's connections, modules and facets that each loss is of, by kind, as plan::lose_each()
/// goes through them.
using LostPlaces = std::array<std::vector<std::vector<std::size_t>>, plan::kLossKindCount>;

LostPlaces lost_places(const model::Robot& robot) {
  LostPlaces places;
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    if (robot.body(robot.connections()[i]) == model::OwnConnector::kNoBody) {
      places[0].push_back({i});
    }
  }
  const auto modules = robot.modules_by_body();
  const std::vector<std::int32_t> bodies = robot.bodies();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const auto body = modules.find(bodies[i]);
    if (body == modules.end()) {
      places[1].push_back({i});
    } else if (base::at(body->second.front()) == i) {
      places[1].emplace_back(body->second.begin(), body->second.end());
    }
  }
  for (std::size_t i = 0; i < robot.facets().size(); ++i) {
    places[2].push_back({i});
  }
  return places;
}

}  // namespace

std::string loss_words(const plan::Loss& loss) {
  std::string cell = model::text(loss.cells[0]);
  switch (loss.kind) {
    case LossKind::kConnection:
      return cell + "-" + model::text(loss.cells[1]);
    case LossKind::kModule:
      return loss.body == model::OwnConnector::kNoBody
                 ? cell
                 : fmt::format("body {} with {}", loss.body, cell);
    case LossKind::kFoot:
      break;
  }
  return (loss.direction ? "a foot of " : "what fixes ") + cell;
}

plan::LossOptions loss_options(const LoseOneOptions& options) {
  plan::LossOptions how;
  how.kinds = options.kinds;
  how.seconds_max = options.seconds_max;
  how.progress = options.progress;
  how.equilibrium = equilibrium_options(options.check);
  how.is_deformed = options.check.is_deformed_wanted;
  how.is_cascade_wanted = options.is_cascade_wanted;
  return how;
}

LossReport lose_one(const Structure& structure, const LoseOneOptions& options) {
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  return plan::lose_each(spec.value(), loss_options(options));
}

std::vector<io::MoreNumbers> lose_one_numbers(const model::Robot& robot, const LossReport& report) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  const auto filled = [&](const char* name, double value) {
    return io::MoreNumbers{.name = name,
                           .connections = std::vector(robot.connections().size(), value),
                           .modules = std::vector(robot.modules().size(), value),
                           .facets = std::vector(robot.facets().size(), value)};
  };
  io::MoreNumbers outcome = filled("loss_outcome", 0);
  io::MoreNumbers ratio = filled("loss_load_ratio", kUnknown);
  using List = std::vector<double> io::MoreNumbers::*;
  constexpr std::array<List, plan::kLossKindCount> kLists = {
      &io::MoreNumbers::connections, &io::MoreNumbers::modules, &io::MoreNumbers::facets};
  const LostPlaces places = lost_places(robot);
  std::array<std::size_t, plan::kLossKindCount> next{};
  for (const LossAnswer& answer : report.answers) {
    const auto kind = static_cast<std::size_t>(answer.loss.kind);
    if (answer.loss.kind == LossKind::kFoot && !answer.loss.direction) {
      continue;  // What fixes a module is no facet.
    }
    for (const std::size_t i : places[kind][next[kind]++]) {
      (outcome.*kLists[kind])[i] = answer.is_fatal() ? 3 : answer.verdict == Verdict::kSafe ? 1 : 2;
      if (answer.verdict != Verdict::kUnstable) {
        (ratio.*kLists[kind])[i] = answer.load_ratio_max.value_or(kUnknown);
      }
    }
  }
  return {std::move(outcome), std::move(ratio)};
}

std::string lose_one_text(const LossReport& report) {
  std::string text;
  const auto add = [&](const std::string& line) {
    text += fmt::format("  {:<12}{}\n", text.empty() ? "lose one" : "", line);
  };
  add(headline(report));
  for (std::size_t i = 0; i < std::min(report.fatal.size(), kShownMax); ++i) {
    add(fmt::format("without {}: {}{}", loss_words(report.fatal[i].loss),
                    consequence(report.fatal[i]), aftermath(report.fatal[i])));
  }
  if (report.fatal.size() > kShownMax) {
    add(fmt::format("(and {} more)", report.fatal.size() - kShownMax));
  }
  if (!report.undecided.empty()) {
    add(fmt::format("{} of the losses {} undecided, the first that of {}", report.undecided.size(),
                    report.undecided.size() == 1 ? "is" : "are",
                    loss_words(report.undecided.front().loss)));
  }
  if (report.worst) {
    add(fmt::format("where all is held, the load ratio is {} {}, without {}",
                    report.worst->is_bound ? "below" : "at most",
                    io::beside_one(*report.worst->load_ratio_max, 4),
                    loss_words(report.worst->loss)));
  }
  return text;
}

void write_lose_one_member(io::JsonStream& json, const model::Robot& robot,
                           const LossReport& report) {
  json.key("lose_one");
  json.begin_object();
  json.member("holds_all", report.holds_all());
  json.member("losses", report.loss_count);
  write_answers(json, "fatal", robot, report.fatal);
  write_answers(json, "undecided", robot, report.undecided);
  json.key("worst");
  if (report.worst) {
    json.begin_object();
    write_loss(json, robot, report.worst->loss);
    json.member("load_ratio_max", report.worst->load_ratio_max);
    json.member("is_bound", report.worst->is_bound);
    json.end_object();
  } else {
    json.value(nullptr);
  }
  json.member("bounds", report.bound_count);
  json.member("checks", report.check_count);
  json.member("seconds", report.seconds);
  json.end_object();
}

}  // namespace holdfast
