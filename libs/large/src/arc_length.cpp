// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "arc_length.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace holdfast::large {
namespace {

constexpr int kArcStepMax = 60;
constexpr int kArcIterationMax = 15;

/// The residual that is left, as a share of the largest load.
constexpr double kArcResidual = 1e-9;

/// The residual is not asked to be less than with so many times the loads.
constexpr double kArcFactorMin = 1e-2;

/// The first step, and the longest one: pitches and rad.
constexpr double kArcFirst = 1e-4;
constexpr double kArcLongest = 0.05;

constexpr int kModeIterations = 12;

double product(const System& system, const std::vector<Vec>& a, const std::vector<Vec>& b) {
  const double square = system.pitch() * system.pitch();
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      sum += k < 3 ? a[i][k] * b[i][k] / square : a[i][k] * b[i][k];
    }
  }
  return sum / static_cast<double>(a.size());
}

}  // namespace

double product(const System& system, const Tangent& a, const Tangent& b) {
  return product(system, a.u, b.u) + a.factor * b.factor;
}

void scale(Tangent& tangent, double factor) {
  for (Vec& v : tangent.u) {
    for (double& part : v) {
      part *= factor;
    }
  }
  tangent.factor *= factor;
}

std::optional<Tangent> tangent_at(const System& system, const Found& found,
                                  const Tangent* towards) {
  if (found.direction.empty()) {
    return std::nullopt;
  }
  Tangent tangent{.u = found.direction, .factor = 1};
  const double length = std::sqrt(product(system, tangent, tangent));
  const bool is_back = towards != nullptr && product(system, tangent, *towards) < 0;
  scale(tangent, (is_back ? -1 : 1) / length);
  return tangent;
}

std::optional<Configuration> correct(System& system, Configuration here, const Tangent& tangent,
                                     double length, std::vector<FacetStates>* tried) {
  system.move(here, tangent.u, length);
  here.factor += length * tangent.factor;
  double last_size = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kArcIterationMax; ++iteration) {
    system.look_up_facets(here);
    std::vector<Vec> rest = system.residual(here);
    const Size parts = size_of(rest);
    const double size = std::max(parts.translation, parts.rotation / system.pitch());
    const double loads = std::max(std::abs(here.factor), kArcFactorMin) * system.load_size();
    if (is_done(size, last_size, loads, kArcResidual)) {
      return here;
    }
    if (tried != nullptr && (tried->empty() || tried->back() != here.facets)) {
      tried->push_back(here.facets);
    }
    if (!system.factor(here, false)) {
      return std::nullopt;
    }
    const std::vector<Vec> by_load = system.solve(system.loads());
    std::vector<Vec> step = system.solve(std::move(rest));
    const double change =
        -product(system, tangent.u, step) / (product(system, tangent.u, by_load) + tangent.factor);
    for (std::size_t i = 0; i < step.size(); ++i) {
      base::add_times(step[i], change, by_load[i]);
    }
    const Size moved = size_of(step);
    if (!std::isfinite(moved.translation) || !std::isfinite(moved.rotation) ||
        std::max(moved.translation / system.pitch(), moved.rotation) > 1) {
      return std::nullopt;
    }
    system.move(here, step, 1);
    here.factor += change;
    last_size = size;
  }
  return std::nullopt;
}

Turn turn_at(System& system, const Found& from, double failed_at) {
  Turn turn;
  Found here = from;
  std::optional<Tangent> tangent = tangent_at(system, here, nullptr);
  double length = kArcFirst;
  for (int step = 0; step < kArcStepMax && tangent; ++step) {
    std::optional<Configuration> next = correct(system, here.here, *tangent, length);
    if (!next) {
      length /= 4;
      continue;
    }
    if (next->factor < here.here.factor) {
      turn.does_turn = true;
      return turn;
    }
    here = examined(system, *std::move(next));
    if (here.here.factor > failed_at && here.is_stable) {
      turn.beyond = std::move(here);
      return turn;
    }
    tangent = tangent_at(system, here, &*tangent);
    length = std::min(2 * length, kArcLongest);
  }
  return turn;
}

std::vector<Vec> softest_mode(System& system, const Found& from) {
  system.residual(from.here);
  if (!system.factor(from.here, true)) {
    return {};
  }
  std::vector<Vec> mode = from.direction.empty() ? system.loads() : from.direction;
  for (std::size_t i = 0; i < mode.size(); ++i) {  // All directions take part, unevenly.
    for (std::size_t k = 0; k < 3; ++k) {
      mode[i][k] += 1e-3 * system.pitch() * static_cast<double>((7 * i + 3 * k) % 11 + 1);
    }
  }
  for (int iteration = 0; iteration < kModeIterations; ++iteration) {
    const double length = std::sqrt(product(system, mode, mode));
    for (Vec& v : mode) {
      for (std::size_t k = 0; k < 6; ++k) {
        v[k] /= length * (k < 3 ? system.pitch() * system.pitch() : 1);
      }
    }
    mode = system.solve(std::move(mode));
  }
  return mode;
}

}  // namespace holdfast::large
