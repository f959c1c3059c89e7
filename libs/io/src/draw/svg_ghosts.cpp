// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "draw/svg_parts.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/io/picture.hpp"

namespace holdfast::io {
namespace {

using verdict::Assessment;
using verdict::Verdict;

/// The assessment of a robot, for the same robot with modules behind all others: connections and
/// facets of these come in between. They carry nothing, so no module is coloured by
/// them, and do not press.
Assessment with_ghosts(Assessment assessment, const model::Robot& robot, std::size_t ghost_count) {
  const std::size_t count = robot.modules().size() - ghost_count;
  const auto is_old = [&](const model::Connection& pair) {
    return base::at(pair.a) < count && base::at(pair.b) < count;
  };
  std::vector<std::size_t> places;  // Of old connections.
  for (std::size_t i = 0; i < robot.connections().size(); ++i) {
    if (is_old(robot.connections()[i])) {
      places.push_back(i);
    }
  }
  if (assessment.connections.size() == places.size()) {
    std::vector<verdict::ConnectionResult> results(robot.connections().size());
    for (std::size_t i = 0; i < places.size(); ++i) {
      results[places[i]] = assessment.connections[i];
    }
    assessment.connections = std::move(results);
  }
  if (assessment.worst) {
    assessment.worst = places[*assessment.worst];
  }
  for (std::size_t& index : assessment.broken) {
    index = places[index];
  }
  solver::Equilibrium& equilibrium = assessment.equilibrium;
  if (!equilibrium.contact.empty()) {
    equilibrium.contact.resize(robot.facets().size(), {.pressed = false});
    equilibrium.facet_force.resize(robot.facets().size());
  }
  if (!equilibrium.displacement.empty()) {
    equilibrium.displacement.resize(robot.modules().size());
  }
  return assessment;
}

ModulePaint paint_of(const Ghost& ghost) {
  ModulePaint paint;
  paint.is_loaded = ghost.load_ratio_max.has_value();
  paint.worst_ratio = ghost.load_ratio_max.value_or(0);
  switch (ghost.verdict) {
    case Verdict::kSafe:
      paint.meaning = Meaning::kLoad;
      paint.percent = static_cast<int>(std::lround(100 * std::clamp(paint.worst_ratio, 0.0, 1.0)));
      break;
    case Verdict::kOverload:
      paint.meaning = Meaning::kBroken;
      break;
    case Verdict::kUnstable:
      paint.meaning = Meaning::kUnstable;
      break;
    case Verdict::kUndecided:
      break;
  }
  return paint;
}

}  // namespace

std::string write_svg_with_ghosts(const model::Robot& robot, std::span<const Ghost> ghosts,
                                  const Assessment& assessment, std::string_view title,
                                  std::span<const model::Obstacle> obstacles,
                                  const FigureOptions& figure) {
  const Assessment mapped = with_ghosts(assessment, robot, ghosts.size());
  Scene scene(robot, mapped, obstacles, figure);
  scene.ghost_count = ghosts.size();
  std::ranges::transform(ghosts, scene.paints.end() - static_cast<std::ptrdiff_t>(ghosts.size()),
                         paint_of);
  return draw_card(scene, title);
}

}  // namespace holdfast::io
