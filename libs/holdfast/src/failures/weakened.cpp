// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/weakened.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace holdfast {
namespace {

/// A limit of a connection, by its key in files.
struct Limit {
  const char* key;
  double model::ConnectorLaw::*value;
};

constexpr Limit kLimits[] = {{"strength_n", &model::ConnectorLaw::strength_n},
                             {"shear_strength_n", &model::ConnectorLaw::shear_strength_n},
                             {"torsion_strength_nmm", &model::ConnectorLaw::torsion_strength_nmm}};

/// What the document says of a pair, which is nothing yet if it did not list it.
io::ConnectionEntry& entry_of(io::Document& document, const model::CellPair& pair) {
  auto& list = document.extension.connections;
  const auto found = std::ranges::find_if(list, [&](const io::ConnectionEntry& entry) {
    return entry.between == pair || entry.between == model::CellPair{pair[1], pair[0]};
  });
  return found == list.end()
             ? list.emplace_back(io::ConnectionEntry{.between = pair, .connectors = {}})
             : *found;
}

}  // namespace

std::optional<base::Error> weaken(io::Document& document, const Weakening& weakening) {
  io::Document whole = document;
  whole.extension.safety_factor = 1;
  const auto robot = io::make_robot(whole);
  if (!robot) {
    return robot.error();
  }
  const auto modules = robot.value().modules();
  const auto module = std::ranges::find(modules, weakening.cell, &model::Module::cell);
  if (module == modules.end()) {
    return base::bad_input(
        fmt::format("{}: expected a module, found none", model::text(weakening.cell)));
  }
  const auto a = static_cast<std::size_t>(module - modules.begin());
  const auto direction = base::at(base::index(weakening.direction));
  const std::int32_t b = robot.value().connected()[a][direction];
  if (b == model::Robot::kNoNeighbour) {
    return base::bad_input(fmt::format("{}: expected a connection on that side, found none",
                                       model::text(weakening.cell)));
  }
  const model::ConnectorLaw& own = robot.value().kinds()[module->kind].connectors[direction];
  const model::ConnectorLaw& now = robot.value().connector(
      {.a = static_cast<std::int32_t>(a), .b = b, .direction = weakening.direction});
  auto& parameters =
      entry_of(document, {weakening.cell, modules[base::at(b)].cell}).connectors.parameters;
  for (const Limit& limit : kLimits) {
    const double weak = std::min(now.*limit.value, weakening.share * own.*limit.value);
    if (std::isfinite(weak)) {
      std::erase_if(parameters,
                    [&](const io::ConnectorParameter& one) { return one.key == limit.key; });
      parameters.push_back({limit.key, io::Spread::kAll, {weak}});
    }
  }
  return std::nullopt;
}

}  // namespace holdfast
