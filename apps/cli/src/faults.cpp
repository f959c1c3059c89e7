// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "faults.hpp"

#include <fmt/format.h>

#include <iterator>

#include "cell_text.hpp"

namespace holdfast::cli {
namespace {

std::optional<base::Direction> find_direction(std::string_view& text) {
  constexpr std::string_view kNames[] = {"+x", "-x", "+y", "-y", "+z", "-z"};
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (text.starts_with(kNames[i])) {
      text.remove_prefix(kNames[i].size());
      return static_cast<base::Direction>(i);
    }
  }
  return std::nullopt;
}

/// Reads "@T" and expects nothing behind it.
bool take_time(std::string_view text, double& time) {
  return take_mark(text, '@') && take_number(text, time) && text.empty() && time >= 0 &&
         time < 1e12;
}

}  // namespace

std::optional<FaultPlace> read_fault_place(std::string_view text, bool has_face,
                                           const Structure& structure) {
  FaultPlace place;
  if (!take_cell(text, place.cell)) {
    return std::nullopt;
  }
  if (has_face) {
    const auto face = take_mark(text, ':') ? find_direction(text) : std::nullopt;
    if (!face) {
      return std::nullopt;
    }
    place.face = *face;
  }
  if (!take_time(text, place.time)) {
    return std::nullopt;
  }
  const auto modules = structure.robot.modules();
  for (std::size_t i = 0; i < modules.size() - structure.robot.planned_count(); ++i) {
    place.module = modules[i].cell == place.cell ? static_cast<std::int32_t>(i) : place.module;
  }
  return place;
}

std::optional<ChangePlace> read_change_place(std::string_view text, bool allows_all) {
  constexpr std::string_view kAll = "all";
  ChangePlace place;
  if (allows_all && text.starts_with(kAll)) {
    place.cell = agent::kEveryCell;
    text.remove_prefix(kAll.size());
  } else if (!take_cell(text, place.cell)) {
    return std::nullopt;
  }
  return take_time(text, place.time) ? std::optional(place) : std::nullopt;
}

std::optional<Weakening> read_weakening(std::string_view text) {
  Weakening weakening;
  if (!take_cell(text, weakening.cell) || !take_mark(text, ':')) {
    return std::nullopt;
  }
  const auto face = find_direction(text);
  if (!face || !take_mark(text, '=') || !take_number(text, weakening.share) || !text.empty() ||
      !(weakening.share >= 1e-6 && weakening.share <= 1)) {
    return std::nullopt;
  }
  weakening.direction = *face;
  return weakening;
}

std::string weakening_usage(std::string_view text) {
  return fmt::format(
      "expected X,Y,Z:FACE=SHARE, FACE one of +x, -x, +y, -y, +z, -z and SHARE above 0 up to 1, as "
      "in 2,1,0:+x=0.5; found '{}'",
      io::one_line(text));
}

std::string change_usage(std::string_view option, std::string_view text, bool allows_all) {
  return fmt::format("--{} {}: expected X,Y,Z@TIME{}, as in 2,1,0@1.5", option, io::one_line(text),
                     allows_all ? " or all@TIME" : "");
}

std::string fault_usage(std::string_view option, std::string_view text, bool has_face) {
  return fmt::format(
      "--{} {}: expected {}, as in {}", option, io::one_line(text),
      has_face ? "X,Y,Z:FACE@TIME, FACE one of +x, -x, +y, -y, +z, -z" : "X,Y,Z@TIME",
      has_face ? "2,1,0:+z@1.5" : "2,1,0@1.5");
}

std::string no_module(std::string_view option, std::string_view text, const base::Cell& cell) {
  return fmt::format("--{} {}: no module is in {}, expected the cell of an existing module", option,
                     io::one_line(text), model::text(cell));
}

}  // namespace holdfast::cli
