// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "request.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <vector>

namespace holdfast::web {
namespace {

using model::Material;

/// What files say about a cell, whether its module exists or is planned.
std::map<base::Cell, io::ModuleEntry> entries_by_cell(const io::Document& document) {
  std::map<base::Cell, io::ModuleEntry> entries;
  if (!document.steps.empty()) {
    for (const io::PlannedEntry& planned : document.steps.front()) {
      entries[planned.cell] = {.cell = planned.cell,
                               .is_fixed = false,
                               .color = planned.color,
                               .attributes = planned.attributes};
    }
  }
  for (const io::ModuleEntry& module : document.modules) {
    entries[module.cell] = module;
  }
  return entries;
}

}  // namespace

Request read_request(std::span<const std::uint8_t> bytes) {
  Request request;
  HOLDFAST_CHECK(bytes.size() >= sizeof(RequestHeader));
  std::memcpy(&request.header, bytes.data(), sizeof(RequestHeader));
  const auto count = static_cast<std::size_t>(request.header.module_count);
  HOLDFAST_CHECK((bytes.size() - sizeof(RequestHeader)) / sizeof(PlacedModule) >= count);
  const std::uint8_t* const modules = bytes.data() + sizeof(RequestHeader);
  request.modules = {reinterpret_cast<const PlacedModule*>(modules), count};
  request.tail = bytes.subspan(sizeof(RequestHeader) + count * sizeof(PlacedModule));
  return request;
}

Material material_of(const RequestHeader& header) {
  Material material;
  for (std::size_t i = 0; i < kMaterialCount; ++i) {
    material.*model::kMaterialParameters[i].value = header.material[i];
  }
  return material;
}

std::array<double, kMaterialCount> numbers_of(const Material& material) {
  std::array<double, kMaterialCount> numbers{};
  for (std::size_t i = 0; i < kMaterialCount; ++i) {
    numbers[i] = material.*model::kMaterialParameters[i].value;
  }
  return numbers;
}

model::RobotSpec spec_of(const Request& request) {
  model::RobotSpec spec{.support_z = request.header.support_z,
                        .material = material_of(request.header)};
  for (const PlacedModule& module : request.modules) {
    add_module(spec, module.cell, module.role());
  }
  return spec;
}

bool has_double_cell(const io::Document& document) {
  std::vector<base::Cell> cells;
  for (const io::ModuleEntry& module : document.modules) {
    cells.push_back(module.cell);
  }
  if (!document.steps.empty()) {
    for (const io::PlannedEntry& planned : document.steps.front()) {
      cells.push_back(planned.cell);
    }
  }
  std::sort(cells.begin(), cells.end());
  return std::adjacent_find(cells.begin(), cells.end()) != cells.end();
}

io::Document edited(const io::Document& base, const Request& request) {
  std::map<base::Cell, io::ModuleEntry> entries = entries_by_cell(base);
  io::Document document = base;
  document.support_z = request.header.support_z;
  document.material = material_of(request.header);
  document.modules.clear();
  io::Step step;
  for (const PlacedModule& module : request.modules) {
    io::ModuleEntry& entry = entries[module.cell];
    if (module.role() == Role::kPlanned) {
      step.push_back({.cell = module.cell, .color = entry.color, .attributes = entry.attributes});
    } else {
      document.modules.push_back({.cell = module.cell,
                                  .is_fixed = module.role() == Role::kFixed,
                                  .color = entry.color,
                                  .attributes = entry.attributes});
    }
  }
  if (!step.empty() || document.steps.size() > 1) {
    document.steps.resize(std::max<std::size_t>(document.steps.size(), 1));
    document.steps.front() = std::move(step);
  } else {
    document.steps.clear();
  }
  if (!(document == base)) {
    document.known_answer.reset();
    // By index, of modules that may be others now; what is computed has the material's mass anyway.
    document.extension.own.clear();
  }
  return document;
}

}  // namespace holdfast::web
