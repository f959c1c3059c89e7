// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/lattice_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "holdfast/io/near_miss.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kUnknownSimulatedModules = "datoms";

std::string all_names() {
  std::string names;
  for (const NamedLattice& row : kNamedLattices) {
    names += fmt::format("{}, ", row.name);
  }
  names += "and for VisibleSim's modules";
  for (const SimulatedModules& row : kSimulatedModules) {
    names += fmt::format(" {}", row.name);
  }
  return names;
}

}  // namespace

base::Result<base::Lattice> find_lattice(std::string_view name) {
  const auto* const row = std::ranges::find(kNamedLattices, name, &NamedLattice::name);
  if (row != kNamedLattices.end()) {
    return row->lattice;
  }
  const auto* const modules = std::ranges::find(kSimulatedModules, name, &SimulatedModules::name);
  if (modules != kSimulatedModules.end()) {
    return modules->lattice;
  }
  if (name == kUnknownSimulatedModules) {
    return base::Error{base::ErrorCode::kUnsupported, kNoDatoms, ""};
  }
  std::vector<std::string_view> names;
  std::ranges::transform(kNamedLattices, std::back_inserter(names), &NamedLattice::name);
  std::ranges::transform(kSimulatedModules, std::back_inserter(names), &SimulatedModules::name);
  const auto meant = near_miss(name, names);
  return base::bad_input(
      fmt::format("the lattice {} is unknown{}", excerpt(name),
                  meant ? "; " + did_you_mean(*meant) : ", expected " + all_names()));
}

}  // namespace holdfast::io
