// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "holdfast/io/goal_shape.hpp"
#include "holdfast/io/lattice_names.hpp"
#include "holdfast/model/robot_catalogue.hpp"
#include "robot_defaults.hpp"
#include "settings.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

/// Warns of attributes that nobody knows and of a cell outside the grid.
template <class Entry>
void warn_of_entry(Reading& reading, const Entry& entry, Names known) {
  const base::Cell& cell = entry.cell;
  const auto where = [&] { return fmt::format("module ({},{},{})", cell.x, cell.y, cell.z); };
  for (const auto& attribute : entry.attributes) {
    if (!is_simulation_attribute(attribute.first)) {
      reading.note_unknown(fmt::format("the attribute {}", excerpt(attribute.first)),
                           attribute.first, known, "kept", where);
    }
  }
  const auto& grid = reading.grid();
  const base::Cell at = reading.in_file(cell);
  const bool is_outside = grid && (std::min({at.x, at.y, at.z}) < 0 || at.x >= grid->x ||
                                   at.y >= grid->y || at.z >= grid->z);
  if (is_outside) {
    reading.warn(fmt::format("outside gridSize '{},{},{}'", grid->x, grid->y, grid->z), where);
  }
}

/// The parameter that an attribute of <parameters> was meant to be, if VisibleSim does not know it
/// but the material's numbers are called so elsewhere: a mass that went unread would cost a
/// verdict.
std::optional<std::string> meant_parameter(std::string_view name) {
  std::vector<std::string_view> keys;
  std::ranges::transform(model::kMaterialParameters, std::back_inserter(keys),
                         &model::MaterialParameter::key);
  const auto meant = known_spelling(name, keys);
  const auto key = meant ? meant : near_miss(name, keys);
  if (!key) {
    return std::nullopt;
  }
  const auto* const parameter = model::find_parameter(*key);
  return parameter->visiblesim != nullptr ? parameter->visiblesim
                                          : fmt::format("{}' of '<{}>", *key, kOwnElement);
}

base::Error unknown_name(const std::string& what, std::string_view meant, std::string where = {}) {
  return base::bad_input(fmt::format("{} is unknown: {}", what, did_you_mean(meant)),
                         std::move(where));
}

}  // namespace

const std::string* find_attribute(const Attributes& attributes, std::string_view name) {
  const auto found =
      std::ranges::find_if(attributes, [&](const auto& entry) { return entry.first == name; });
  return found == attributes.end() ? nullptr : &found->second;
}

void Reading::fail(base::Error error) {
  if (!error_) {
    error_ = std::move(error);
  }
}

void Reading::warn(std::string message, const Where& where) {
  const auto same = std::ranges::find(warnings_, message, &Warning::message);
  if (same != warnings_.end()) {
    ++same->count;
  } else if (warnings_.size() == kWarningCountMax) {
    ++warnings_left_out_;
  } else {
    warnings_.push_back({std::move(message), where()});
  }
}

void Reading::note_unknown(const std::string& what, std::string_view name, Names known,
                           std::string_view fate, const Where& where) {
  if (const auto meant = near_miss(name, known)) {
    fail(unknown_name(what, *meant, where()));
  } else {
    warn(fmt::format("{} is unknown and {}", what, fate), where);
  }
}

bool Reading::take_room(std::size_t cell_count, const Where& where) {
  cell_count_ += std::min(cell_count, model::kModuleCountMax + 1);
  if (cell_count_ > model::kModuleCountMax) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("more than the {} cells that are allowed, with {} here",
                      model::kModuleCountMax, cell_count),
          where()});
  }
  return !has_failed();
}

std::optional<Color> Reading::take_color(std::string_view element, std::string_view text,
                                         const Where& where) {
  if (auto color = parse_color(text)) {
    return color;
  }
  const std::optional<Color> near = nearest_color(text);
  warn(fmt::format("color of <{}> is {}, {}: {}", element, excerpt(text), kColorsAllowed,
                   near ? fmt::format("{},{},{} is taken", near->red, near->green, near->blue)
                        : "it is ignored"),
       where);
  return near;
}

void Reading::take_known_answer(KnownAnswer answer, const Where& where) {
  if (!is_known_verdict(answer.verdict)) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("the known verdict is {}, expected safe, overload or unstable",
                      excerpt(answer.verdict)),
          where()});
  }
  document.known_answer = std::move(answer);
}

void Reading::take_robot(const std::string& named, const ReadOptions& options, const Where& where) {
  if (!named.empty() && !options.robot.empty() && named != options.robot) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("the robot is {} here, but {} is asked for", excerpt(named),
                      excerpt(options.robot)),
          where()});
  }
  const std::string& name = named.empty() ? options.robot : named;
  if (name.empty()) {
    return;
  }
  const model::CatalogueRobot* const robot = model::find_robot(name);
  if (robot == nullptr) {
    std::vector<std::string_view> names;
    std::ranges::transform(model::robot_catalogue(), std::back_inserter(names),
                           &model::CatalogueRobot::name);
    const auto meant = near_miss(name, names);
    fail({base::ErrorCode::kBadInput,
          fmt::format("unknown robot {}; {}", excerpt(name),
                      meant ? did_you_mean(*meant)
                            : fmt::format("the catalogue has {}", fmt::join(names, ", "))),
          named.empty() ? "" : where()});
    return;
  }
  document.extension.robot = name;
  document.extension.lattice = robot->lattice;
  document.material = first_material(name);
}

void Reading::complete_material(const ReadOptions& options, const Where& where) {
  for (const Setting& setting : options.settings) {
    if (auto fault = take_setting(setting, document)) {
      fail(base::bad_input(*std::move(fault), where()));
    }
    warn(fmt::format("{} is set to {} by an option", setting.key, setting.value),
         [] { return std::string(); });
  }
  const std::vector<std::string> missing = missing_keys(document.material);
  if (!missing.empty()) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("of the robot {} no {} is published: the structure must say it in its "
                      "material",
                      document.extension.robot, fmt::join(missing, ", ")),
          where()});
  }
  model::fill_section(document.material);
}

bool Reading::take_lattice(std::optional<std::string_view> named, const ReadOptions& options,
                           const Where& where) {
  base::Lattice& lattice = document.extension.lattice;
  if (named) {
    const auto found = find_lattice(*named);
    if (!found) {
      fail({found.error().code, found.error().message, where()});
      return true;
    }
    lattice = found.value();
  }
  if (options.lattice) {
    if (named && lattice != *options.lattice) {
      fail({base::ErrorCode::kBadInput,
            fmt::format("the lattice is {} here, but {} is asked for", excerpt(*named),
                        excerpt(lattice_name(*options.lattice))),
            where()});
    }
    lattice = *options.lattice;
  }
  return named || options.lattice;
}

void Reading::read_grid(const Where& where) {
  const std::string* const text = find_attribute(document.world, kGridSize);
  if (text == nullptr) {
    return;
  }
  if (parse_triple<std::int32_t>(*text + ",1")) {
    warn(
        fmt::format("gridSize '{}' has two numbers, not three; no cell is compared with it", *text),
        where);
    return;
  }
  const auto size = parse_triple<std::int32_t>(*text);
  if (!size || !std::ranges::all_of(*size, [](auto n) { return kGridRange.contains(n); })) {
    fail({base::ErrorCode::kBadInput,
          fmt::format("gridSize is {}, expected three integers from {} to {}, such as 8,3,4",
                      excerpt(*text), kGridRange.lowest, kGridRange.highest),
          where()});
    return;
  }
  grid_ = {(*size)[0], (*size)[1], (*size)[2]};
}

base::Result<ReadDocument> Reading::finish() && {
  if (error_) {
    return *error_;
  }
  // Empty steps at the end say nothing; files for VisibleSim have them.
  while (!document.steps.empty() && document.steps.back().empty()) {
    document.steps.pop_back();
  }
  warn_of_content();
  if (error_) {
    return *error_;
  }
  return ReadDocument{std::move(document), warning_texts()};
}

void Reading::warn_of_content() {
  const Where nowhere = [] { return std::string(); };
  for (std::string& doubt : doubtful_figures(document)) {
    warn(std::move(doubt), nowhere);
  }
  warn_of_attributes();
  for (const ModuleEntry& module : document.modules) {
    warn_of_entry(*this, module, kBlockAttributes);
  }
  for (const Step& step : document.steps) {
    for (const PlannedEntry& planned : step) {
      warn_of_entry(*this, planned, kCellAttributes);
    }
  }
  for (const Element& element : document.scenery) {
    if (!is_scenery_element(element.name)) {
      note_unknown(fmt::format("the element {}", excerpt(element.name)), element.name,
                   kWorldElements, "kept", nowhere);
    }
  }
  warn_of_targets();
}

/// Notes attributes of <parameters>, <world> and <blockList>, which both formats keep whole.
void Reading::warn_of_attributes() {
  const auto look_at = [&](const Attributes& attributes, const char* kind, Names known) {
    for (const auto& attribute : attributes) {
      const bool is_known = std::ranges::find(known, attribute.first) != known.end();
      const auto meant = is_known || kind != std::string_view("parameter")
                             ? std::nullopt
                             : meant_parameter(attribute.first);
      if (meant) {
        fail(unknown_name(fmt::format("the {} {}", kind, excerpt(attribute.first)), *meant));
      } else if (!is_known) {
        note_unknown(fmt::format("the {} {}", kind, excerpt(attribute.first)), attribute.first,
                     known, "kept", [] { return std::string(); });
      }
    }
  };
  look_at(document.parameters, "parameter", parameter_names());
  look_at(document.world, "attribute of <world>", kWorldAttributes);
  look_at(document.block_list, "attribute of <blockList>", kBlockListAttributes);
}

void Reading::warn_of_targets() {
  const Where nowhere = [] { return std::string(); };
  for (const Element& target : document.targets) {
    if (is_goal(target)) {
      continue;
    }
    const std::string* const format = find_attribute(target.attributes, "format");
    if (const auto meant = near_miss(format == nullptr ? "" : *format, kTargetFormats)) {
      fail(unknown_name("the target format " + excerpt(*format), *meant));
    }
    warn(fmt::format("the target format {} is not supported: the target is kept, not checked",
                     format == nullptr ? "''" : excerpt(*format)),
         nowhere);
  }
}

std::vector<std::string> Reading::warning_texts() const {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings_) {
    texts.push_back(
        fmt::format("{}{}{}", warning.where, warning.where.empty() ? "" : ": ", warning.message));
    if (warning.count > 1) {
      texts.back() += fmt::format(" ({} times, first here)", warning.count);
    }
  }
  if (warnings_left_out_ > 0) {
    texts.push_back(fmt::format("{} further warnings are left out", warnings_left_out_));
  }
  return texts;
}

}  // namespace holdfast::io
