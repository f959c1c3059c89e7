// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "request.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace holdfast::web {
namespace {

using model::Material;

/// The entries of files by cell, whether the module exists or is planned.
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

/// The modules' own parameters by cell; of existing modules and those that are planned first.
std::map<base::Cell, io::OwnParameters> own_by_cell(const io::Document& document) {
  std::map<base::Cell, io::OwnParameters> own;
  for (const io::OwnParameters& one : document.extension.own) {
    if (one.step == 0) {
      own[document.modules[one.module].cell] = one;
    } else if (one.step == 1) {
      own[document.steps.front()[one.module].cell] = one;
    }
  }
  return own;
}

/// Gives modules of a document what they have of their own, which `own` says by cell.
void take_own(const std::map<base::Cell, io::OwnParameters>& own, io::Document& document) {
  const auto add = [&](const base::Cell& cell, std::size_t step, std::size_t module) {
    const auto found = own.find(cell);
    if (found != own.end()) {
      io::OwnParameters one = found->second;
      one.step = step;
      one.module = module;
      document.extension.own.push_back(std::move(one));
    }
  };
  document.extension.own.clear();
  for (std::size_t i = 0; i < document.modules.size() && !own.empty(); ++i) {
    add(document.modules[i].cell, 0, i);
  }
  if (!document.steps.empty() && !own.empty()) {
    const io::Step& step = document.steps.front();
    for (std::size_t i = 0; i < step.size(); ++i) {
      add(step[i].cell, 1, i);
    }
  }
}

/// Takes away what is said of connections of modules that are there no more, and bodies of which
/// nothing is left.
void forget_absent_pairs(io::Document& document) {
  const auto entries = entries_by_cell(document);
  const auto is_absent = [&](const model::CellPair& pair) {
    return !entries.contains(pair[0]) || !entries.contains(pair[1]);
  };
  std::erase_if(document.extension.open, is_absent);
  std::erase_if(document.extension.connections,
                [&](const io::ConnectionEntry& entry) { return is_absent(entry.between); });
  std::erase_if(document.extension.bodies, [&](const std::vector<base::Cell>& body) {
    return std::ranges::none_of(body,
                                [&](const base::Cell& cell) { return entries.contains(cell); });
  });
}

/// Makes lengths of modules by direction, of which the page has the ratios, those of the material,
/// whose pitch is the least of them.
void take_pitches(io::Document& document) {
  if (auto& pitches = document.extension.pitch_mm) {
    const double least = *std::min_element(pitches->begin(), pitches->end());
    if (least != document.material.pitch_mm) {
      for (double& pitch : *pitches) {
        pitch *= document.material.pitch_mm / least;
      }
    }
  }
}

/// Takes what the request says beyond cells and material.
std::optional<base::Error> take_more(std::string_view more, io::Document& document) {
  io::Attributes obstacle_list = std::move(document.extension.obstacle_list);
  document.extension = {};
  if (more.empty()) {
    return std::nullopt;
  }
  auto read = io::read_json(more);
  if (!read) {
    return read.error();
  }
  const io::Document& general = read.value().document;
  Material stated = general.material;
  if (general.extension.pitch_mm) {
    stated.pitch_mm = Material{}.pitch_mm;  // The least of them.
  }
  if (!(stated == Material{})) {
    return base::bad_input("the material and gravity straight down are numbers of the request");
  }
  document.is_default_modulus_stated = general.is_default_modulus_stated;
  document.extension = general.extension;
  document.extension.obstacle_list = std::move(obstacle_list);
  take_pitches(document);
  take_own(own_by_cell(general), document);
  forget_absent_pairs(document);
  return std::nullopt;
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
  const auto more_size = static_cast<std::size_t>(request.header.more_size);
  const std::size_t more_at = sizeof(RequestHeader) + count * sizeof(PlacedModule);
  const std::size_t tail_at = more_at + (more_size + 3) / 4 * 4;
  HOLDFAST_CHECK(bytes.size() >= tail_at);
  request.more = {reinterpret_cast<const char*>(bytes.data()) + more_at, more_size};
  request.tail = bytes.subspan(tail_at);
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

base::Result<model::RobotSpec> spec_of(const Request& request) {
  if (!request.more.empty()) {
    const auto document = edited({}, request);
    return document ? io::make_spec(document.value())
                    : base::Result<model::RobotSpec>(document.error());
  }
  model::RobotSpec spec{.support_z = request.header.support_z,
                        .material = material_of(request.header)};
  spec.is_modulus_stated = spec.material.elastic_modulus_mpa != Material{}.elastic_modulus_mpa;
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

base::Result<io::Document> edited(const io::Document& base, const Request& request) {
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
  if (const auto error = take_more(request.more, document)) {
    return *error;
  }
  if (!(document == base)) {
    document.known_answer.reset();
  }
  return document;
}

std::string more_of(const io::Document& document) {
  io::Document general;
  general.is_default_modulus_stated = document.is_default_modulus_stated;
  general.extension = document.extension;
  const auto own = own_by_cell(document);
  for (const auto& [cell, one] : own) {
    general.modules.push_back({.cell = cell, .is_fixed = false, .color = {}, .attributes = {}});
  }
  take_own(own, general);
  return io::write_json(general);
}

}  // namespace holdfast::web
