// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/experiments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "json/json_connectors.hpp"
#include "json/json_values.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kFormat = "holdfast-experiments";
constexpr auto kKeys = std::to_array<std::string_view>(
    {"format", "version", "name", "strength_cv", "strength_distribution", "experiments", "next"});
constexpr auto kEntryKeys = std::to_array<std::string_view>(
    {"name", "structure", "outcome", "where", "pull", "held_n", "broke_n", "chain", "held", "broke",
     "mass_kg", "gravity_m_s2"});
constexpr auto kNextKeys = std::to_array<std::string_view>({"family", "sizes", "structures"});
constexpr auto kOutcomes = std::to_array<std::string_view>({"held", "broke"});
constexpr double kForceMax = 1e12;
constexpr int kChainMax = 100'000;
constexpr std::int32_t kSizeMax = 1000;

using Form = ExperimentEntry::Form;

StructureSource source(JsonReading& reading, const Json& value, const JsonPlace& place) {
  if (value.is_object()) {
    return {.file = {}, .text = value.dump()};
  }
  StructureSource found{.file = reading.string(value, place), .text = {}};
  if (found.file.empty()) {
    reading.refuse(value, place, "the name of a file or a structure");
  }
  return found;
}

/// Reads the members of one experiment.
class EntryReader {
 public:
  EntryReader(JsonReading& reading, const Json& value, const JsonPlace& place)
      : reading_(reading), value_(value), place_(place) {}

  ExperimentEntry read() {
    weight_ = model::module_weight_n(model::Material());
    for (const auto& [key, member] : reading_.members(value_, place_)) {
      read(key, member, place_.at(key));
    }
    expect_one_form();
    entry_.module_weight_n = weight_ * mass_share_ * gravity_share_;
    return std::move(entry_);
  }

 private:
  bool has(std::string_view key) const { return value_.is_object() && value_.contains(key); }

  void read(const std::string& key, const Json& value, const JsonPlace& here) {
    const model::Material table;
    if (key == "name") {
      entry_.name = reading_.string(value, here);
    } else if (key == "structure") {
      entry_.structure = source(reading_, value, here);
    } else if (key == "outcome") {
      entry_.has_held = read_choice(reading_, value, here, kOutcomes) == 0;
    } else if (key == "where") {
      read_where(value, here);
    } else if (key == "pull" || key == "chain") {
      entry_.form = key == "pull" ? Form::kPull : Form::kChain;
      entry_.connector =
          static_cast<base::ConnectorClass>(read_choice(reading_, value, here, kClassKeys));
    } else if (key == "held_n" || key == "broke_n") {
      entry_.has_held = key == "held_n";
      entry_.force_n = positive(value, here);
    } else if (key == "held") {
      entry_.held_count = reading_.integer(value, here, {0, kChainMax});
    } else if (key == "broke") {
      entry_.broke_count = reading_.integer(value, here, {1, kChainMax});
    } else if (key == "mass_kg") {
      mass_share_ = positive(value, here) / table.mass_kg;
    } else if (key == "gravity_m_s2") {
      gravity_share_ = positive(value, here) / table.gravity_m_s2;
    } else {
      reading_.note_unknown_key(here, kEntryKeys);
    }
  }

  double positive(const Json& value, const JsonPlace& here) {
    const double number = read_positive(reading_, value, here);
    if (number > kForceMax) {
      reading_.refuse(value, here, fmt::format("a number up to {}", kForceMax));
    }
    return number;
  }

  void read_where(const Json& value, const JsonPlace& here) {
    const Json::array_t& pairs = reading_.elements(value, here, "an array of pairs of cells");
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const JsonPlace there = here.at(i);
      const Json::array_t& cells = reading_.elements(pairs[i], there, "a pair of cells");
      if (cells.size() != 2) {
        reading_.refuse(pairs[i], there, "the two cells of a connection");
        return;
      }
      entry_.where.push_back(
          {reading_.cell(cells[0], there.at(0)), reading_.cell(cells[1], there.at(1))});
    }
  }

  void expect_one_form() {
    const int forms = (has("structure") ? 1 : 0) + (has("pull") ? 1 : 0) + (has("chain") ? 1 : 0);
    const bool is_whole = entry_.form == Form::kStructure ? has("outcome")
                          : entry_.form == Form::kPull    ? has("held_n") != has("broke_n")
                                                          : has("held") || has("broke");
    if (forms != 1 || !is_whole) {
      reading_.fail(place_,
                    "expected \"structure\" with \"outcome\", \"pull\" with \"held_n\" or "
                    "\"broke_n\", or \"chain\" with \"held\", \"broke\" or both");
    }
    if (entry_.broke_count && *entry_.broke_count <= entry_.held_count) {
      reading_.fail(place_, fmt::format("a chain that held {} modules and broke with {}: expected "
                                        "more where it broke",
                                        entry_.held_count, *entry_.broke_count));
    }
    if (!entry_.where.empty() && entry_.has_held) {
      reading_.fail(place_, "\"where\" is for structures that broke");
    }
  }

  JsonReading& reading_;
  const Json& value_;
  const JsonPlace& place_;
  ExperimentEntry entry_;
  double weight_ = 0;
  double mass_share_ = 1;
  double gravity_share_ = 1;
};

void read_next(JsonReading& reading, const Json& value, const JsonPlace& place,
               Experiments& found) {
  for (const auto& [key, member] : reading.members(value, place)) {
    const JsonPlace here = place.at(key);
    if (key == "family") {
      found.family = reading.string(member, here);
    } else if (key == "sizes") {
      const Json::array_t& sizes = reading.elements(member, here, "two sizes, [least, largest]");
      if (sizes.size() != 2) {
        reading.refuse(member, here, "two sizes, [least, largest]");
        return;
      }
      found.size_min = base::at(reading.integer(sizes[0], here.at(0), {1, kSizeMax}));
      found.size_max = base::at(reading.integer(
          sizes[1], here.at(1), {static_cast<std::int32_t>(found.size_min), kSizeMax}));
    } else if (key == "structures") {
      const Json::array_t& list = reading.elements(member, here);
      for (std::size_t i = 0; i < list.size(); ++i) {
        found.next.push_back(source(reading, list[i], here.at(i)));
      }
    } else {
      reading.note_unknown_key(here, kNextKeys);
    }
  }
  if (found.family.empty() != (found.size_max == 0)) {
    reading.fail(place, "\"family\" and \"sizes\" belong together");
  }
}

void read_member(JsonReading& reading, const std::string& key, const Json& value,
                 const JsonPlace& here, Experiments& found) {
  if (key == "name") {
    found.name = reading.string(value, here);
  } else if (key == "strength_cv") {
    found.strength_cv = reading.number(value, here);
    if (const auto fault = find_cv_fault(key, *found.strength_cv)) {
      reading.fail(here, *fault);
    }
  } else if (key == "strength_distribution") {
    const auto law = verdict::find_strength_distribution(reading.string(value, here));
    if (!law) {
      reading.refuse(value, here, "one of \"lognormal\", \"normal\", \"weibull\"");
    }
    found.distribution = law.value_or(found.distribution);
  } else if (key == "experiments") {
    const Json::array_t& list = reading.elements(value, here);
    for (std::size_t i = 0; i < list.size() && !reading.has_failed(); ++i) {
      const JsonPlace place = here.at(i);
      found.entries.push_back(EntryReader(reading, list[i], place).read());
    }
  } else if (key == "next") {
    read_next(reading, value, here, found);
  } else if (key != "format" && key != "version" && key != "$schema") {
    reading.note_unknown_key(here, kKeys);
  }
}

}  // namespace

base::Result<Experiments> read_experiments(std::string_view text) {
  const auto root = parse_json(text);
  if (!root) {
    return root.error();
  }
  JsonReading reading;
  const JsonPlace top;
  const Json& value = root.value();
  Experiments found;
  expect_format(reading, value, top, kFormat);
  for (const auto& [key, member] : reading.members(value, top)) {
    read_member(reading, key, member, top.at(key), found);
  }
  if (!reading.has_failed() && found.entries.empty()) {
    reading.fail(top.at("experiments"), "expected at least one experiment");
  }
  auto finished = std::move(reading).finish();
  return finished ? base::Result<Experiments>(std::move(found)) : finished.error();
}

}  // namespace holdfast::io
