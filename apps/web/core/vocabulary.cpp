// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "vocabulary.hpp"

#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>

namespace holdfast::web {
namespace {

using Json = nlohmann::ordered_json;

struct MethodChoice {
  agent::Method method;
  const char* text;
};

struct LinkChoice {
  sim::LinkModel (*make)();
  const char* text;
};

/// The methods in the order in which they are offered; the first one is the default.
constexpr MethodChoice kMethods[] = {
    {agent::Method::kElimination, "elimination or fronts"},
    {agent::Method::kPolynomial, "polynomial"},
};
constexpr LinkChoice kLinks[] = {
    {sim::blinky_blocks_v1, "38,400 baud"},
    {sim::blinky_blocks_v2, "115,200 baud"},
    {sim::unit, "rounds"},
};

Json material_json() {
  Json list = Json::array();
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    list.push_back({{"key", parameter.key},
                    {"label", parameter.label},
                    {"unit", parameter.unit},
                    {"table_i", model::Material{}.*parameter.value},
                    {"lowest", parameter.lowest},
                    {"highest", parameter.highest}});
  }
  return list;
}

Json phases_json() {
  Json list = Json::array();
  for (std::size_t phase = 0; phase < sim::kPhaseCount; ++phase) {
    list.push_back(sim::name(static_cast<agent::Phase>(phase)));
  }
  return list;
}

Json methods_json() {
  Json list = Json::array();
  for (const auto& [method, text] : kMethods) {
    list.push_back({{"value", static_cast<int>(method)}, {"text", text}});
  }
  return list;
}

Json links_json() {
  Json list = Json::array();
  for (const LinkChoice& choice : kLinks) {
    list.push_back({{"value", list.size()}, {"text", choice.text}});
  }
  return list;
}

Json limits_json() {
  Json list = Json::array();
  for (int limit = 0; limit < model::kLimitCount; ++limit) {
    list.push_back(model::name(static_cast<model::Limit>(limit)));
  }
  return list;
}

/// The lattices by their names in io::kNamedLattices, with the members of base::Lattice.
Json lattices_json() {
  Json list = Json::array();
  for (const auto& [name, lattice] : io::kNamedLattices) {
    Json steps = Json::array();
    for (const base::Direction direction : base::directions(lattice)) {
      const base::Cell& step = lattice.steps[static_cast<std::size_t>(base::index(direction))];
      steps.push_back(Json::array({step.x, step.y, step.z}));
    }
    Json basis = Json::array();
    for (const base::Cell& axis : {base::Cell{1, 0, 0}, base::Cell{0, 1, 0}, base::Cell{0, 0, 1}}) {
      basis.push_back(base::place_of(lattice, axis));
    }
    list.push_back({{"name", std::string(name)},
                    {"steps", steps},
                    {"basis", basis},
                    {"shear", Json::array({lattice.shear_x, lattice.shear_y})},
                    {"down", lattice.down}});
  }
  return list;
}

/// How files that are read end.
Json endings_json() {
  std::set<std::string> endings = {".json", ".xml", ".holdfast"};
  for (const io::ForeignFormat& format : io::foreign_formats()) {
    std::istringstream list{std::string(format.endings)};
    endings.insert(std::istream_iterator<std::string>(list), {});
  }
  return endings;
}

}  // namespace

sim::LinkModel link_of(std::int32_t value) {
  const auto at = static_cast<std::size_t>(value);
  HOLDFAST_CHECK(at < std::size(kLinks));
  return kLinks[at].make();
}

std::string vocabulary_json() {
  const Json vocabulary = {{"material", material_json()}, {"phases", phases_json()},
                           {"methods", methods_json()},   {"links", links_json()},
                           {"limits", limits_json()},     {"lattices", lattices_json()},
                           {"endings", endings_json()}};
  return vocabulary.dump();
}

}  // namespace holdfast::web
