// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "report/deformed_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "factor_text.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/beside_one.hpp"

namespace holdfast::io {
namespace {

/// The strain at a facet's edge from which on a linear law is in doubt.
constexpr double kDoubtfulStrain = 0.1;

const large::State& reported(const large::Path& path) {
  return path.loaded ? *path.loaded : path.last;
}

void write_event(JsonStream& json, const model::Robot& robot, const large::Event& event) {
  json.begin_object();
  json.member("name", large::name(event.kind));
  json.member("factor", event.factor);
  json.key("cells");
  json.begin_array();
  for (const std::size_t module : event.modules) {
    json.value(robot.modules()[module].cell);
  }
  json.end_array();
  json.end_object();
}

void write_point_members(JsonStream& json, const large::PathPoint& point) {
  json.member("factor", point.factor);
  json.member("load_ratio_max", point.load_ratio_max);
  json.member("displacement_max_mm", point.displacement_max_mm);
}

void write_branch(JsonStream& json, const model::Robot& robot, const large::Branch& branch) {
  json.begin_object();
  json.member("end", large::name(branch.end));
  json.key("cells");
  json.begin_array();
  for (const std::size_t module : branch.modules) {
    json.value(robot.modules()[module].cell);
  }
  json.end_array();
  json.key("holds");
  if (branch.rest) {
    json.begin_object();
    json.member("factor", branch.rest->factor);
    json.member("load_ratio_max",
                branch.rest->worst ? std::optional(branch.rest->load_ratio_max) : std::nullopt);
    json.member("displacement_max_mm", branch.rest->displacement_max_mm);
    json.member("rotation_max_rad", branch.rest->rotation_max_rad);
    json.end_object();
  } else {
    json.value(nullptr);
  }
  json.key("path");
  json.begin_array();
  for (const large::PathPoint& point : branch.points) {
    json.begin_object();
    write_point_members(json, point);
    json.member("stable", point.is_stable);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

/// What happens at a factor of the loads.
std::string event_text(const model::Robot& robot, const large::Event& event) {
  const auto cell = [&](std::size_t i) {
    return model::text(robot.modules()[event.modules[i]].cell);
  };
  switch (event.kind) {
    case large::EventKind::kBreaks:
      return fmt::format("{}-{} breaks", cell(0), cell(1));
    case large::EventKind::kTouchesFloor:
      return fmt::format("{} touches the floor", cell(0));
    case large::EventKind::kTouchesItself:
      return fmt::format("{} and {} meet", cell(0),
                         event.modules.size() > 1 ? cell(1) : "an obstacle");
    case large::EventKind::kTooSoft:
      break;
  }
  return fmt::format("the strain at an edge reaches {}", large::kStrainMax);
}

/// Where a branch that begins is followed to.
std::string end_text(const model::Robot& robot, const large::Branch& branch) {
  const double factor = branch.last.factor;
  const auto event = [&](large::EventKind kind) {
    return fmt::format("to where {} at {} times these loads",
                       event_text(robot, {.kind = kind, .modules = branch.modules}),
                       factor_text(factor));
  };
  switch (branch.end) {
    case large::End::kFactorMax:
      return fmt::format("up to {} times these loads", factor_text(factor));
    case large::End::kUnloaded:
      return "back to no loads";
    case large::End::kTouchesFloor:
      return event(large::EventKind::kTouchesFloor);
    case large::End::kTouchesItself:
      return event(large::EventKind::kTouchesItself);
    case large::End::kTooSoft:
      return event(large::EventKind::kTooSoft);
    case large::End::kLetsGo:
      return fmt::format("to where a facet opens and lets go sideways at {} times these loads",
                         factor_text(factor));
    case large::End::kNotFound:
      return fmt::format("to {} times these loads, beyond which no equilibrium was found",
                         factor_text(factor));
    case large::End::kSteps:
      break;
  }
  return fmt::format("for {} to {} times these loads", host::counted(branch.points.size(), "step"),
                     factor_text(factor));
}

std::string branch_text(const model::Robot& robot, const large::Branch& branch) {
  if (branch.points.empty()) {
    return branch.end == large::End::kLetsGo
               ? "not followed: a facet opens and lets go sideways, a jump"
               : "not followed: no equilibrium was found beside it";
  }
  if (!branch.rest) {
    double most = 0;
    for (const large::PathPoint& point : branch.points) {
      most = point.is_stable ? std::max(most, point.factor) : most;
    }
    return (most > 0 ? fmt::format("stable up to {} times these loads at most", factor_text(most))
                     : std::string("nothing holds")) +
           "; followed " + end_text(robot, branch);
  }
  const large::State& rest = *branch.rest;
  return fmt::format("holds at {} times these loads, moved by {:.3g} mm, turned by {:.3g} rad{}",
                     factor_text(rest.factor), rest.displacement_max_mm, rest.rotation_max_rad,
                     rest.worst && rest.load_ratio_max >= 1
                         ? fmt::format(", if no connection breaks: load ratio {}",
                                       beside_one(rest.load_ratio_max, 4))
                         : std::string());
}

/// What is behind the loss of stability, a line for each branch.
std::string behind_text(const model::Robot& robot, const large::Path& path) {
  std::string text;
  for (std::size_t i = 0; i < path.behind.size(); ++i) {
    text += fmt::format("              behind it{}: {}\n",
                        path.behind.size() < 2 ? ""
                        : i == 0               ? ", one way"
                                               : ", the other way",
                        branch_text(robot, path.behind[i]));
  }
  return text;
}

}  // namespace

void write_deformed(JsonStream& json, const ReportEntry& entry) {
  json.key("deformed");
  if (entry.deformed == nullptr || entry.deformed->last.poses.empty()) {
    json.value(nullptr);
    return;
  }
  const large::Path& path = *entry.deformed;
  const large::State& state = reported(path);
  json.begin_object();
  json.member("factor_critical",
              path.critical ? std::optional(path.critical->factor) : std::nullopt);
  json.key("kind");
  if (path.critical) {
    json.value(std::string_view(large::name(path.critical->loss)));
  } else {
    json.value(nullptr);
  }
  json.key("events");
  json.begin_array();
  for (const large::Event& event : path.events) {
    write_event(json, *entry.robot, event);
  }
  json.end_array();
  json.member("load_ratio_max", state.worst ? std::optional(state.load_ratio_max) : std::nullopt);
  json.key("at");
  if (entry.assessment->worst) {
    json.begin_array();
    for (const base::Cell& cell : model::ends(*entry.robot, *entry.assessment->worst)) {
      json.value(cell);
    }
    json.end_array();
  } else {
    json.value(nullptr);
  }
  json.member("displacement_max_mm", state.displacement_max_mm);
  json.member("rotation_max_rad", state.rotation_max_rad);
  json.member("edge_strain_max", state.edge_strain_max);
  json.key("path");
  json.begin_array();
  for (const large::PathPoint& point : path.points) {
    json.begin_object();
    write_point_members(json, point);
    json.end_object();
  }
  json.end_array();
  if (!path.behind.empty()) {
    json.key("behind");
    json.begin_array();
    for (const large::Branch& branch : path.behind) {
      write_branch(json, *entry.robot, branch);
    }
    json.end_array();
  }
  json.member("steps", path.step_count);
  json.member("solves", path.solve_count);
  json.member("seconds", entry.deformed_seconds);
  json.end_object();
}

std::string deformed_text(const ReportEntry& entry) {
  if (entry.deformed == nullptr) {
    return "  deformed    not followed, as it does not stand unbent\n";
  }
  const large::Path& path = *entry.deformed;
  if (path.last.poses.empty()) {
    return "  deformed    no equilibrium to begin with\n";
  }
  const large::State& state = reported(path);
  const bool is_doubtful = state.edge_strain_max > kDoubtfulStrain;
  std::string text = fmt::format(
      "  deformed    at {} times these loads: moved by {:.3g} mm, turned by {:.3g} rad, strained "
      "by "
      "{:.2g} at an edge{}; E = {:g} MPa\n",
      factor_text(state.factor), state.displacement_max_mm, state.rotation_max_rad,
      state.edge_strain_max, is_doubtful ? " (much for a linear law)" : "",
      entry.robot->material().elastic_modulus_mpa);
  for (const large::Event& event : path.events) {
    text += fmt::format("              at {} times these loads {}\n", factor_text(event.factor),
                        event_text(*entry.robot, event));
  }
  if (path.critical) {
    text += fmt::format("              at {} times these loads it {}\n",
                        factor_text(path.critical->factor),
                        path.critical->loss == large::Loss::kBifurcation ? "buckles" : "collapses");
    text += behind_text(*entry.robot, path);
  } else if (path.outcome == large::Outcome::kNotFound) {
    text += fmt::format("              beyond {} times these loads no equilibrium was found\n",
                        factor_text(path.last.factor));
  } else {
    text +=
        fmt::format("              stable up to {} times these loads, as far as it was followed\n",
                    factor_text(path.last.factor));
  }
  text += fmt::format("              {}, {} in {:.2f} s\n", host::counted(path.step_count, "step"),
                      host::counted(path.solve_count, "factorization"), entry.deformed_seconds);
  return text;
}

}  // namespace holdfast::io
