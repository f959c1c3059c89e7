// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "report/limit_report.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "holdfast/io/beside_one.hpp"
#include "holdfast/io/collapse.hpp"

namespace holdfast::io {
namespace {

using Outcome = limit::LimitLoad::Outcome;

/// Joints that give way are listed in the text up to here.
constexpr std::size_t kListedYields = 3;

/// A factor of rounding.
constexpr double kNoLoad = 1e-9;

std::optional<base::Cell> cell_of(const model::Robot& robot, std::int32_t module) {
  return module == limit::Joint::kGround ? std::nullopt
                                         : std::optional(robot.modules()[base::at(module)].cell);
}

void write_yields(JsonStream& json, const model::Robot& robot, const limit::Mechanism& mechanism) {
  json.key("yields");
  json.begin_array();
  for (const limit::Yield& yield : mechanism.yields) {
    json.begin_object();
    json.member("a", cell_of(robot, yield.a));
    json.member("b", cell_of(robot, yield.b));
    json.member("limit", model::name(yield.limit));
    json.member("speed_mm", yield.speed);
    json.end_object();
  }
  json.end_array();
}

void write_velocities(JsonStream& json, const limit::Mechanism& mechanism) {
  json.key("velocities");
  json.begin_array();
  for (const base::Vec6<double>& velocity : mechanism.velocities) {
    json.begin_array();
    for (const double component : velocity) {
      json.value(component);
    }
    json.end_array();
  }
  json.end_array();
}

/// The two modules, or the module and what it touches.
std::string place_text(const model::Robot& robot, const limit::Yield& yield) {
  const std::string first = model::text(robot.modules()[base::at(yield.a)].cell);
  return yield.b == limit::Joint::kGround
             ? first + " on its support"
             : first + "-" + model::text(robot.modules()[base::at(yield.b)].cell);
}

}  // namespace

std::string collapse_json(const model::Robot& robot, const limit::LimitLoad& load) {
  std::string text;
  JsonStream json(text, JsonStream::Layout::kCompact);
  if (load.outcome == Outcome::kStopped) {
    json.value(nullptr);
    return text;
  }
  json.begin_object();
  json.member("factor", load.outcome == Outcome::kFound ? std::optional(load.low) : std::nullopt);
  write_yields(json, robot, load.mechanism);
  write_velocities(json, load.mechanism);
  json.end_object();
  return text;
}

void write_limit(JsonStream& json, const ReportEntry& entry) {
  const limit::LimitLoad& load = *entry.limit;
  json.member("limit_load_factor",
              load.outcome == Outcome::kFound ? std::optional(load.low) : std::nullopt);
  json.key("limit_load");
  json.begin_object();
  json.member("outcome", limit::name(load.outcome));
  json.key("range");
  json.begin_array();
  json.value(load.low);
  if (load.high < limit::kFactorMax) {
    json.value(load.high);
  } else {
    json.value(nullptr);
  }
  json.end_array();
  json.key("mechanism");
  if (load.mechanism.velocities.empty()) {
    json.value(nullptr);
  } else {
    json.begin_object();
    write_yields(json, *entry.robot, load.mechanism);
    write_velocities(json, load.mechanism);
    json.end_object();
  }
  json.member("programs", load.program_count);
  json.member("seconds", entry.limit_seconds);
  json.end_object();
}

std::string limit_text(const ReportEntry& entry) {
  const limit::LimitLoad& load = *entry.limit;
  if (load.outcome == Outcome::kUnbounded) {
    return "  limit load  unbounded: whatever the factor of all loads, some forces would balance "
           "them\n";
  }
  if (load.outcome == Outcome::kFound && load.high < kNoLoad) {
    return "  limit load  0: no forces balance these loads, nor any share of them\n";
  }
  std::string text =
      load.outcome == Outcome::kFound
          ? fmt::format("  limit load  {} times these loads at most, in {:.2f} s\n",
                        beside_one(load.low, 4), entry.limit_seconds)
      : load.high < limit::kFactorMax
          ? fmt::format("  limit load  not found: from {} to {} times these loads, in {:.2f} s\n",
                        beside_one(load.low, 4), beside_one(load.high, 4), entry.limit_seconds)
          : fmt::format("  limit load  not found: {} times these loads or more, in {:.2f} s\n",
                        beside_one(load.low, 4), entry.limit_seconds);
  const std::vector<limit::Yield>& yields = load.mechanism.yields;
  for (std::size_t i = 0; i < std::min(yields.size(), kListedYields); ++i) {
    text += fmt::format("              then {} {}\n", place_text(*entry.robot, yields[i]),
                        model::name(yields[i].limit));
  }
  if (yields.size() > kListedYields) {
    text += fmt::format("              and {} more give way\n", yields.size() - kListedYields);
  }
  return text;
}

}  // namespace holdfast::io
