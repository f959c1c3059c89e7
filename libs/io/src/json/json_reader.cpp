// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <type_traits>
#include <utility>

#include "holdfast/host/interruption.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/io/goal_shape.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/io/report_head.hpp"
#include "json/json_connectors.hpp"
#include "json/json_extension.hpp"
#include "json/json_shapes.hpp"
#include "json/json_values.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

class JsonReader {
 public:
  base::Result<ReadDocument> read(const Json& root, const ReadOptions& options) &&;

 private:
  bool read_heading(const Json& root, const JsonPlace& place, const ReadOptions& options);
  void read_robot(const Json& value, const JsonPlace& place, const ReadOptions& options);
  void read_lattice(const Json& value, const JsonPlace& place, const ReadOptions& options);
  bool allows(const JsonPlace& place);
  void read_member(const std::string& key, const Json& value, const JsonPlace& place);
  void note_unknown_member(const JsonPlace& place);
  void read_material(const Json& value, const JsonPlace& place);
  void read_known_answer(const Json& value, const JsonPlace& place);
  void read_visiblesim(const Json& value, const JsonPlace& place);
  void spell_as_known(Attributes& attributes, Names known, const JsonPlace& place);
  void take_old_obstacles(std::vector<Element>& list, const JsonPlace& place);
  std::vector<Element> scenery(const Json& value, const JsonPlace& place);
  std::vector<Element> targets(const Json& value, const JsonPlace& place);
  void expect_goal_shapes();

  template <class Entry>
  std::vector<Entry> entries(const Json& value, const JsonPlace& place, std::size_t step);
  template <class Entry>
  void add_shape(const Json& value, const JsonPlace& place, std::size_t step,
                 std::vector<Entry>& list);
  template <class Entry>
  Entry entry(const Json& value, const JsonPlace& place, OwnParameters& own);
  void keep(const OwnParameters& own);

  Names entry_keys(bool is_module) const;

  JsonReading reading_;
  bool is_extended_ = false;  ///< Whether the document says that it is of version 2.
  Step planned_;
  std::vector<Step> later_steps_;
};

base::Result<ReadDocument> JsonReader::read(const Json& root, const ReadOptions& options) && {
  reading_.allows_unknown = options.allow_unknown;
  const JsonPlace top;
  const Json::object_t& members =
      reading_.members(root, top, fmt::format("an object such as {}", kLeastJson));
  if (!reading_.has_failed() && read_heading(root, top, options)) {
    for (const auto& [key, value] : members) {
      read_member(key, value, top.at(key));
    }
    reading_.complete_material(options, [&] {
      const auto has = [&](const char* key) { return root.contains(key); };
      return has("material") ? top.at("material").pointer()
             : has("robot")  ? top.at("robot").pointer()
                             : "";
    });
    check_kinds(reading_);
    check_pair_lists(reading_);
  }
  std::vector<Step>& steps = reading_.document.steps;
  steps.push_back(std::move(planned_));
  std::ranges::move(later_steps_, std::back_inserter(steps));
  expect_goal_shapes();
  return std::move(reading_).finish();
}

/// Reads the members that must be there, and refuses versions that cannot be read.
bool JsonReader::read_heading(const Json& root, const JsonPlace& place,
                              const ReadOptions& options) {
  static const Json kNone;
  const auto value_of = [&](const char* key) -> const Json& {
    const auto member = root.find(key);
    return member == root.end() ? kNone : *member;
  };
  const Json& format = value_of("format");
  const Json& version = value_of("version");
  const auto expect = [&](const char* key, const std::string& expected) {
    if (root.find(key) == root.end()) {
      reading_.fail_missing(root, place, key, expected);
    } else {
      reading_.refuse(value_of(key), place.at(key), expected);
    }
  };
  if (format == kReportFormat) {
    reading_.fail(place.at("format"),
                  "expected a structure, found a report: give the file that was judged");
  } else if (format != kJsonFormatName) {
    expect("format", fmt::format("\"{}\"", kJsonFormatName));
  } else if (version.is_number() && version.get<double>() > kJsonVersionMax) {
    reading_.fail(
        {base::ErrorCode::kUnsupported,
         fmt::format("expected version 1 to {}, found {}: this program knows no newer one",
                     kJsonVersionMax, version.dump()),
         place.at("version").pointer()});
  } else if (version != 1 && version != kJsonVersionMax) {
    expect("version", fmt::format("1 or {}", kJsonVersionMax));
  } else if (root.find("modules") == root.end()) {
    expect("modules", "an array of cells");
  }
  is_extended_ = version == kJsonVersionMax;
  const Json& material = value_of("material");
  if (is_extended_ && material.contains("gravity_m_s2") && !value_of("gravity_m_s2").is_null()) {
    reading_.fail(place.at("gravity_m_s2"), "gravity stands here and in the material");
  }
  if (!reading_.has_failed()) {
    read_robot(value_of("robot"), place.at("robot"), options);
    read_lattice(value_of("lattice"), place.at("lattice"), options);
  }
  return !reading_.has_failed();
}

/// Reads the robot's name, null if there is none; to be called before read_lattice().
void JsonReader::read_robot(const Json& value, const JsonPlace& place, const ReadOptions& options) {
  const bool is_named = is_extended_ && !value.is_null();
  const std::string name = is_named ? reading_.string(value, place) : "";
  if (is_named && name.empty()) {
    reading_.refuse(value, place, "the name of a robot");
  }
  reading_.take_robot(name, options, [&] { return place.pointer(); });
}

/// Reads the lattice, null if there is none; to be called before all that depends on it.
void JsonReader::read_lattice(const Json& value, const JsonPlace& place,
                              const ReadOptions& options) {
  const auto where = [&] { return place.pointer(); };
  if (value.is_null() || !is_extended_) {
    reading_.take_lattice(std::nullopt, options, where);
    return;
  }
  std::vector<std::string_view> names;
  std::ranges::transform(kNamedLattices, std::back_inserter(names), &NamedLattice::name);
  const std::string_view name = names[read_choice(reading_, value, place, names)];
  reading_.take_lattice(name, options, where);
}

/// Whether a key that only version 2 has may stand here; a failure if not, as what it says would be
/// lost.
bool JsonReader::allows(const JsonPlace& place) {
  if (!is_extended_) {
    reading_.fail(place, fmt::format("the key {} is one of version 2, the document says version "
                                     "1; set \"version\": 2",
                                     excerpt(place.key)));
  }
  return is_extended_;
}

void JsonReader::read_member(const std::string& key, const Json& value, const JsonPlace& place) {
  Document& document = reading_.document;
  if (std::ranges::find(kExtensionKeys, key) != kExtensionKeys.end()) {
    if (allows(place)) {
      read_extension_member(reading_, key, value, place);
    }
  } else if (key == "name") {
    document.name = reading_.string(value, place);
  } else if (key == "description") {
    document.description = reading_.string(value, place);
  } else if (key == "support_z" && value.is_null()) {
    document.extension.has_floor = !is_extended_;
    if (!is_extended_) {
      reading_.refuse(value, place, "an integer (null, for no floor, needs \"version\": 2)");
    }
  } else if (key == "support_z") {
    document.support_z = reading_.integer(value, place, kCoordinateRange);
  } else if (key == "material") {
    read_material(value, place);
  } else if (key == "modules") {
    document.modules = entries<ModuleEntry>(value, place, 0);
  } else if (key == "planned") {
    planned_ = entries<PlannedEntry>(value, place, 1);
  } else if (key == "later_steps") {
    const Json::array_t& steps = reading_.elements(value, place);
    for (std::size_t i = 0; i < steps.size() && !reading_.has_failed(); ++i) {
      later_steps_.push_back(entries<PlannedEntry>(steps[i], place.at(i), i + 2));
      if (later_steps_.back().empty()) {
        reading_.fail(place.at(i), "expected at least one cell, found an empty array");
      }
    }
  } else if (key == "known_answer") {
    read_known_answer(value, place);
  } else if (key == "visiblesim") {
    read_visiblesim(value, place);
  } else if (key != "format" && key != "version" && key != "$schema") {
    note_unknown_member(place);
  }
}

/// Numbers of the material are often written beside it.
void JsonReader::note_unknown_member(const JsonPlace& place) {
  const Names known = is_extended_ ? Names(kAllTopKeys) : Names(kTopKeys);
  const Names material = material_keys(is_extended_);
  const auto same = known_spelling(place.key, material);
  const auto meant = same ? same : near_miss(place.key, material);
  if (meant && !reading_.allows_unknown && !place.key.starts_with("x-") &&
      !near_miss(place.key, known)) {
    reading_.fail(place,
                  fmt::format("the key {} is unknown here: did you mean '{}' in \"material\"?",
                              excerpt(place.key), *meant));
  } else {
    reading_.note_unknown_key(place, known);
  }
}

void JsonReader::read_material(const Json& value, const JsonPlace& place) {
  for (const auto& [key, member] :
       reading_.members(value, place, "an object of numbers, such as {\"mass_kg\": 0.061}")) {
    const JsonPlace here = place.at(key);
    const bool is_by_direction = key == kPitchKey && member.is_array();
    if (const auto* const parameter = model::find_parameter(key);
        parameter != nullptr && !is_by_direction) {
      take_number(*parameter, reading_.number(member, here), reading_.document);
    } else if (is_by_direction || is_material_extension(key)) {
      if (allows(here)) {
        read_material_extension(reading_, key, member, here);
      }
    } else {
      reading_.note_unknown_key(here, material_keys(is_extended_));
    }
  }
  expect_one_strength(reading_, value, place);
}

void JsonReader::read_known_answer(const Json& value, const JsonPlace& place) {
  KnownAnswer answer;
  for (const auto& [key, member] :
       reading_.members(value, place, "an object such as {\"verdict\": \"safe\"}")) {
    const JsonPlace here = place.at(key);
    if (key == "verdict") {
      answer.verdict = reading_.string(member, here);
    } else if (key == "margin_mm") {
      answer.margin_mm = reading_.number(member, here);
    } else if (key == "load_ratio_max") {
      answer.load_ratio_max = reading_.number(member, here);
    } else if (key == "source") {
      answer.source = reading_.string(member, here);
    } else {
      reading_.note_unknown_key(here, kKnownAnswerKeys);
    }
  }
  if (value.is_object() && !value.contains("verdict")) {
    reading_.fail_missing(value, place, "verdict");
  }
  reading_.take_known_answer(std::move(answer), [&] { return place.at("verdict").pointer(); });
}

void JsonReader::read_visiblesim(const Json& value, const JsonPlace& place) {
  const auto is_free = [](std::string_view) { return false; };
  Document& document = reading_.document;
  for (const auto& [key, member] : reading_.members(value, place)) {
    const JsonPlace here = place.at(key);
    if (key == "parameters") {
      document.parameters = reading_.attributes(member, here, is_mechanical_parameter);
    } else if (key == "world") {
      document.world = reading_.attributes(member, here, is_free);
      spell_as_known(document.world, kWorldAttributes, here);
      reading_.read_grid([&] { return here.pointer(); });
    } else if (key == "block_list") {
      document.block_list = reading_.attributes(member, here, is_free);
      spell_as_known(document.block_list, kBlockListAttributes, here);
    } else if (key == "obstacle_list") {
      if (allows(here)) {
        document.extension.obstacle_list = reading_.attributes(member, here, is_free);
      }
    } else if (key == "scenery") {
      document.scenery = scenery(member, here);
    } else if (key == "targets") {
      document.targets = targets(member, here);
    } else {
      reading_.note_unknown_key(here, kVisibleSimKeys);
    }
  }
}

/// Corrects the case of attribute names, which VisibleSim XML, where they come from, ignores.
void JsonReader::spell_as_known(Attributes& attributes, Names known, const JsonPlace& place) {
  for (auto& [name, value] : attributes) {
    const auto spelling = known_spelling(name, known);
    if (spelling && *spelling != name) {
      if (find_attribute(attributes, *spelling) != nullptr) {
        reading_.fail(place, fmt::format("{} and {} differ only in case, expected one",
                                         excerpt(*spelling), excerpt(name)));
        return;
      }
      name = *spelling;
    }
  }
}

/// Reads <obstacleList> from the scenery, where older versions kept it.
void JsonReader::take_old_obstacles(std::vector<Element>& list, const JsonPlace& place) {
  const auto found = std::ranges::find(list, kObstacleListElement, &Element::name);
  if (found != list.end() && reading_.document.extension.obstacles.empty()) {
    reading_.take_obstacles(*found, [&] { return place.pointer(); });
    list.erase(found);
  }
}

std::vector<Element> JsonReader::scenery(const Json& value, const JsonPlace& place) {
  std::vector<Element> list = reading_.element_list(value, place, 1);
  take_old_obstacles(list, place);
  for (const Element& element : list) {
    if (is_structural_element(element.name)) {
      reading_.fail(place, fmt::format("<{}> has keys of its own in this format", element.name));
    }
  }
  return list;
}

std::vector<Element> JsonReader::targets(const Json& value, const JsonPlace& place) {
  std::vector<Element> list = reading_.element_list(value, place, 1);
  for (Element& element : list) {
    spell_as_known(element.attributes, kTargetAttributes, place);
    const std::string* const format = find_attribute(element.attributes, "format");
    if (element.name != "target") {
      reading_.fail(place, "expected elements \"target\"");
    } else if (format != nullptr && *format == "grid") {
      const auto cells = goal_cells(element);
      if (!cells) {
        reading_.fail(place, cells.error().message);
        break;
      }
      element = make_goal(cells.value());
    }
  }
  std::stable_partition(list.begin(), list.end(),
                        [](const Element& element) { return !is_goal(element); });
  return list;
}

/// Refuses targets of the format grid that are steps, which have keys of their own.
void JsonReader::expect_goal_shapes() {
  const Document& document = reading_.document;
  const auto first = std::ranges::find_if(document.targets, is_goal);
  if (reading_.has_failed() || first == document.targets.end()) {
    return;
  }
  const bool has_steps =
      std::ranges::any_of(document.steps, [](const Step& step) { return !step.empty(); });
  const bool has_empty = std::any_of(first, document.targets.end(),
                                     [](const Element& goal) { return goal.children.empty(); });
  if (has_steps || has_empty || !is_goal_shape(document.modules, goal_cells(*first).value())) {
    reading_.fail({base::ErrorCode::kBadInput,
                   "targets of the format \"grid\" are shapes to reach, which overlap the modules; "
                   "steps belong in \"planned\" and \"later_steps\"",
                   "/visiblesim/targets"});
  }
}

/// Reads a list of modules; `step` is that of OwnParameters.
template <class Entry>
std::vector<Entry> JsonReader::entries(const Json& value, const JsonPlace& place,
                                       std::size_t step) {
  std::vector<Entry> list;
  const Json::array_t& array = reading_.elements(value, place, "an array of cells [x, y, z]");
  if (reading_.take_room(array.size(), [&] { return place.pointer(); })) {
    list.reserve(array.size());
    for (std::size_t i = 0; i < array.size() && !reading_.has_failed(); ++i) {
      host::ask_whether_to_go_on();
      if (is_shape(array[i])) {
        add_shape(array[i], place.at(i), step, list);
        continue;
      }
      OwnParameters own{step, list.size(), {}, {}};
      list.push_back(entry<Entry>(array[i], place.at(i), own));
      keep(own);
    }
  }
  return list;
}

/// Reads many modules that are alike but for their cells.
template <class Entry>
void JsonReader::add_shape(const Json& value, const JsonPlace& place, std::size_t step,
                           std::vector<Entry>& list) {
  OwnParameters own{step, 0, {}, {}};
  auto one = entry<Entry>(value, place, own);
  if (reading_.has_failed()) {
    return;
  }
  for (const base::Cell& cell : shape_cells(reading_, value, place)) {
    own.module = list.size();
    one.cell = cell;
    list.push_back(one);
    keep(own);
  }
}

/// Keeps what a module has of its own, if it has anything.
void JsonReader::keep(const OwnParameters& own) {
  if (!own.kind.empty() || own.mass_kg) {
    reading_.document.extension.own.push_back(own);
  }
}

/// Reads a module, or what the modules of a shape have in common; `own` gets what it has of its
/// own.
template <class Entry>
Entry JsonReader::entry(const Json& value, const JsonPlace& place, OwnParameters& own) {
  constexpr bool kIsModule = std::is_same_v<Entry, ModuleEntry>;
  Entry entry;
  if (value.is_array()) {
    entry.cell = reading_.cell(value, place);
    return entry;
  }
  const bool is_many = is_shape(value);
  if (!is_many && !value.contains("cell")) {
    reading_.refuse(value, place,
                    is_extended_ ? "a cell [x, y, z] or an object with \"cell\", with \"from\" and "
                                   "\"to\", or with \"layers\""
                                 : "a cell [x, y, z] or an object with the key \"cell\"");
    return entry;
  }
  for (const auto& [key, member] : reading_.members(value, place)) {
    const JsonPlace here = place.at(key);
    if constexpr (kIsModule) {
      if (key == "fixed") {
        entry.is_fixed = reading_.boolean(member, here);
        continue;
      }
    }
    if (key == "cell") {
      entry.cell = reading_.cell(member, here);
    } else if (std::ranges::find(kShapeKeys, key) != kShapeKeys.end()) {
      if (allows(here) && !is_many) {
        reading_.fail(
            here, "a module with \"cell\" is one module, this key is of many: give one of both");
      }
    } else if (is_many && key == "attributes") {
      reading_.fail(here, "attributes are of one module, with \"cell\"");
    } else if (key == "color") {
      entry.color = reading_.color(member, here);
    } else if (key == "attributes") {
      entry.attributes =
          reading_.attributes(member, here, kIsModule ? is_module_attribute : is_planned_attribute);
      if (kIsModule && find_attribute(entry.attributes, kDatomAttribute) != nullptr) {
        reading_.fail({base::ErrorCode::kUnsupported,
                       fmt::format("a module with '{}' is a datom: {}", kDatomAttribute, kNoDatoms),
                       here.pointer()});
      }
    } else if (std::ranges::find(kOwnParameterKeys, key) != kOwnParameterKeys.end()) {
      if (allows(here)) {
        read_own_parameter(reading_, key, member, here, own);
      }
    } else {
      reading_.note_unknown_key(here, entry_keys(kIsModule));
    }
  }
  return entry;
}

Names JsonReader::entry_keys(bool is_module) const {
  if (is_module) {
    return is_extended_ ? Names(kAllModuleKeys) : Names(kModuleKeys);
  }
  return is_extended_ ? Names(kAllPlannedKeys) : Names(kPlannedKeys);
}

}  // namespace

base::Result<ReadDocument> read_json(std::string_view text, const ReadOptions& options) {
  text = without_bom(text);
  if (auto fault = find_input_fault(text)) {
    return *std::move(fault);
  }
  const auto root = parse_json(text);
  return root ? JsonReader().read(root.value(), options) : root.error();
}

}  // namespace holdfast::io
