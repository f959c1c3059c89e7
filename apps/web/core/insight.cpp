// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "insight.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace holdfast::web {
namespace {

/// Forces (N) and moments (N mm) below this are rounding.
constexpr double kNothing = 1e-6;

std::size_t as_index(std::int32_t value) { return static_cast<std::size_t>(value); }

struct Lump {
  double mass_kg = 0;
  std::array<double, 3> centre_mm{};
};

Lump lump_of(const model::Robot& robot, const std::vector<std::size_t>& modules) {
  Lump lump;
  for (const std::size_t module : modules) {
    const auto place = base::node_place(robot.lattice(), robot.modules()[module].cell);
    lump.mass_kg += robot.mass(module);
    for (std::size_t k = 0; k < 3; ++k) {
      lump.centre_mm[k] += robot.mass(module) * robot.material().pitch_mm * place[k];
    }
  }
  for (double& coordinate : lump.centre_mm) {
    coordinate /= lump.mass_kg;
  }
  return lump;
}

/// How far the centre of a part is from the middle of a connection, across gravity; mm.
double lever_mm(const model::Robot& robot, const model::Connection& pair, const Lump& lump) {
  const auto a = base::node_place(robot.lattice(), robot.modules()[as_index(pair.a)].cell);
  const auto b = base::node_place(robot.lattice(), robot.modules()[as_index(pair.b)].cell);
  const auto& gravity = robot.gravity();
  double size2 = 0;
  double along = 0;
  double way2 = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double way = lump.centre_mm[k] - robot.material().pitch_mm * (a[k] + b[k]) / 2;
    size2 += gravity[k] * gravity[k];
    along += gravity[k] * way;
    way2 += way * way;
  }
  return std::sqrt(std::max(0.0, way2 - along * along / size2));
}

/// "bend it with 359.4 N mm and pull it with 6.2 N"
std::string actions_text(const verdict::ConnectionResult& load) {
  std::vector<std::string> parts;
  if (load.bending_nmm > kNothing) {
    parts.push_back(fmt::format("bend it with {:.4g} N mm", load.bending_nmm));
  }
  if (std::abs(load.axial_n) > kNothing) {
    parts.push_back(fmt::format("{} it with {:.3g} N", load.axial_n > 0 ? "pull" : "press",
                                std::abs(load.axial_n)));
  }
  return fmt::format("{}", fmt::join(parts, " and "));
}

}  // namespace

std::vector<std::size_t> hanging_modules(const model::Robot& robot, std::size_t connection) {
  model::ConnectedParts parts = model::connected_parts(
      robot.connections(), robot.modules().size(),
      [&](std::size_t index, const model::Connection&) { return index != connection; });
  const model::Connection& pair = robot.connections()[connection];
  if (parts.first_of(pair.a) == parts.first_of(pair.b)) {
    return {};
  }
  for (const std::int32_t end : {pair.a, pair.b}) {
    std::vector<std::size_t> part;
    bool is_held = false;
    for (std::size_t i = 0; i < robot.modules().size(); ++i) {
      if (parts.first_of(static_cast<std::int32_t>(i)) == parts.first_of(end)) {
        part.push_back(i);
        is_held = is_held || robot.modules()[i].support != model::Support::kNone;
      }
    }
    if (!is_held) {
      return part;
    }
  }
  return {};
}

std::string why_text(const model::Robot& robot, const verdict::Assessment& assessment) {
  if (!assessment.worst || !assessment.is_stable || assessment.connections.empty()) {
    return {};
  }
  const std::size_t worst = *assessment.worst;
  const verdict::ConnectionResult& load = assessment.connections[worst];
  const std::string actions = actions_text(load);
  if (!(load.load_ratio > 0) || actions.empty()) {
    return {};
  }
  const std::string holds =
      load.load_ratio > 1 ? fmt::format("it holds {:.0f} % of that", 100 / load.load_ratio)
                          : fmt::format("it would hold {:.3g} times that", 1 / load.load_ratio);
  const std::string where = model::ends_text(robot, worst);
  const auto part = hanging_modules(robot, worst);
  if (part.empty()) {
    return fmt::format("{} is one of several ways to the supports. Forces {}; {}.", where, actions,
                       holds);
  }
  const Lump lump = lump_of(robot, part);
  return fmt::format("{} alone holds {}: {:.3g} kg, centre {:.3g} mm out. They {}; {}.", where,
                     host::counted(part.size(), "module"), lump.mass_kg,
                     lever_mm(robot, robot.connections()[worst], lump), actions, holds);
}

}  // namespace holdfast::web
