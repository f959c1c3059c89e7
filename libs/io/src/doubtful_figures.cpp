// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "holdfast/io/document.hpp"

namespace holdfast::io {
namespace {

// What lies beyond is rarely meant. Foams have 0.02 t/m3, osmium 22; diamond has 1.2 TPa.
constexpr double kDensityMin = 0.02;
constexpr double kDensityMax = 22;
constexpr double kModulusMax = 1.2e6;
constexpr double kPitchMin = 1;
constexpr double kPitchMax = 1e4;

/// Whether a valid number lies beyond the range.
bool is_beyond(double value, double lowest, double highest) {
  return value > 0 && std::isfinite(value) && (value < lowest || value > highest);
}

void note_masses(const Document& document, std::vector<std::string>& doubts) {
  const model::Material& material = document.material;
  std::set<double> masses = {material.mass_kg};
  for (const KindEntry& kind : document.extension.kinds) {
    masses.insert(kind.mass_kg.value_or(material.mass_kg));
  }
  for (const OwnParameters& own : document.extension.own) {
    masses.insert(own.mass_kg.value_or(material.mass_kg));
  }
  double cube_m3 = std::pow(material.pitch_mm / 1000, 3);
  if (const auto& pitch = document.extension.pitch_mm) {
    cube_m3 = (*pitch)[0] * (*pitch)[1] * (*pitch)[2] / 1e9;
  }
  // The lowest and the highest are those that say most.
  for (const double mass : {*masses.begin(), *masses.rbegin()}) {
    const double density = mass / 1000 / cube_m3;
    if (is_beyond(density, kDensityMin, kDensityMax)) {
      doubts.push_back(
          fmt::format("density {:.3g} t/m3 of a module of {} kg in a cell of {} mm: is the mass "
                      "in kg?",
                      density, mass, material.pitch_mm));
    }
    if (masses.size() == 1) {
      return;
    }
  }
}

/// Whether all modules form a shape in one layer that fills no rectangle, three or more cells wide
/// along y: an arch, a crane or stairs whose file has y up.
bool lies_flat(const Document& document) {
  const Extension& extension = document.extension;
  if (!extension.has_floor || extension.gravity_m_s2 || !extension.obstacles.empty() ||
      extension.lattice == base::kHexagonal || document.modules.empty()) {
    return false;
  }
  const auto is_low = [&](const auto& entry) { return entry.cell.z == document.support_z; };
  if (!std::ranges::all_of(document.modules, is_low) ||
      !std::ranges::all_of(document.steps,
                           [&](const Step& step) { return std::ranges::all_of(step, is_low); })) {
    return false;
  }
  base::Cell low = document.modules.front().cell;
  base::Cell high = low;
  for (const ModuleEntry& module : document.modules) {
    low = {std::min(low.x, module.cell.x), std::min(low.y, module.cell.y), low.z};
    high = {std::max(high.x, module.cell.x), std::max(high.y, module.cell.y), high.z};
  }
  const std::int64_t width = std::int64_t{high.x} - low.x + 1;
  const std::int64_t depth = std::int64_t{high.y} - low.y + 1;
  return width >= 2 && depth >= 3 &&
         width * depth > static_cast<std::int64_t>(document.modules.size());
}

}  // namespace

std::vector<std::string> doubtful_figures(const Document& document) {
  std::vector<std::string> doubts;
  const model::Material& material = document.material;
  // Where modules are not as long as wide no facet is wider than its face.
  if (material.facet_mm > material.pitch_mm && !document.extension.pitch_mm) {
    doubts.push_back(
        fmt::format("facets of {} mm are wider than the pitch of {} mm: feet reach beyond their "
                    "cells, and the support polygon with them",
                    material.facet_mm, material.pitch_mm));
  }
  if (is_beyond(material.pitch_mm, kPitchMin, kPitchMax)) {
    doubts.push_back(fmt::format("pitch {} mm: is it in mm?", material.pitch_mm));
  } else {
    note_masses(document, doubts);
  }
  if (is_beyond(material.elastic_modulus_mpa, 0, kModulusMax)) {
    doubts.push_back(fmt::format("elastic modulus {:.3g} TPa, diamond has 1.2: is it in MPa?",
                                 material.elastic_modulus_mpa / 1e6));
  }
  if (lies_flat(document)) {
    doubts.push_back(
        fmt::format("all {} modules lie on the floor, in the layer z = {}: if y is up in this "
                    "file, exchange y and z",
                    document.modules.size(), document.support_z));
  }
  return doubts;
}

}  // namespace holdfast::io
