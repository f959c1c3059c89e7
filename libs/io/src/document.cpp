// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/document.hpp"

#include <fmt/format.h>

#include "text_input.hpp"

namespace holdfast::io {

base::Result<Format> detect_format(std::string_view text) {
  text = trimmed(without_bom(text));
  if (text.starts_with('<')) {
    return Format::kVisibleSimXml;
  }
  if (text.starts_with('{') || text.starts_with('[')) {
    return Format::kJson;
  }
  if (text.empty()) {
    return base::Error{base::ErrorCode::kBadInput, "the input is empty, expected is a structure",
                       ""};
  }
  return base::Error{base::ErrorCode::kBadInput,
                     fmt::format("the input begins with {}, expected is VisibleSim XML, which "
                                 "begins with '<', or holdfast JSON, with '{{'",
                                 excerpt(text.substr(0, 8))),
                     ""};
}

base::Result<ReadDocument> read_document(std::string_view text) {
  const auto format = detect_format(text);
  if (!format) {
    return format.error();
  }
  return format.value() == Format::kJson ? read_json(text) : read_visiblesim(text);
}

namespace {

base::Error not_yet(std::string_view what, std::string where) {
  return {base::ErrorCode::kUnsupported,
          fmt::format("{} cannot be computed with yet: this program takes cubes of one kind on a "
                      "floor without slip, under their own weight, and one step",
                      what),
          std::move(where)};
}

}  // namespace

std::optional<base::Error> find_unsupported(const Document& document) {
  const Extension& extension = document.extension;
  if (extension.lattice != LatticeName::kCubic) {
    return not_yet("lattices other than the cubic one", "/lattice");
  }
  if (!extension.has_floor) {
    return not_yet("a robot without a floor", "/support_z");
  }
  if (extension.floor_friction) {
    return not_yet("friction", "/floor/friction");
  }
  if (extension.gravity_m_s2) {
    return not_yet("gravity that is not straight down", "/gravity_m_s2");
  }
  for (const auto& [key, value] : extension.connectors) {
    if (key != "foot_mm") {  // Facets of cubes are as wide as facet_mm says.
      return not_yet("this limit of a connection", "/material/" + key);
    }
  }
  for (const OwnParameters& own : extension.own) {
    if (!own.kind.empty()) {
      return not_yet("modules of several kinds", fmt::format("/modules/{}/kind", own.module));
    }
    if (own.mass_kg != document.material.mass_kg) {
      return not_yet("modules of different masses", fmt::format("/modules/{}/mass_kg", own.module));
    }
  }
  if (!extension.obstacles.empty()) {
    return not_yet("obstacles", "/obstacles");
  }
  if (!extension.payloads.empty()) {
    return not_yet("loads besides weight", "/loads");
  }
  if (!extension.plan.empty()) {
    return not_yet("a plan of steps", "/steps");
  }
  return std::nullopt;
}

base::Result<model::Robot> make_robot(const Document& document, int thread_count) {
  if (auto error = find_unsupported(document)) {
    return *std::move(error);
  }
  model::RobotSpec spec{.support_z = document.support_z, .material = document.material};
  spec.existing.reserve(document.modules.size());
  for (const ModuleEntry& module : document.modules) {
    spec.existing.push_back(module.cell);
    if (module.is_fixed) {
      spec.fixed.push_back(module.cell);
    }
  }
  if (!document.steps.empty()) {
    for (const PlannedEntry& planned : document.steps.front()) {
      spec.planned.push_back(planned.cell);
    }
  }
  return model::Robot::create(spec, thread_count);
}

}  // namespace holdfast::io
