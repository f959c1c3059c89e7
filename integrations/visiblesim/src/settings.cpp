// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace holdfast::visiblesim {
namespace {

/// The number that a text is as a whole.
template <class Number>
std::optional<Number> number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// Takes the text before the mark; the text goes on behind it.
std::string_view take_until(std::string_view& text, char mark) {
  const std::size_t end = std::min(text.find(mark), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::optional<base::Cell> cell_of(std::string_view text) {
  std::array<std::int32_t, 3> values{};
  for (std::int32_t& value : values) {
    const auto found = number<std::int32_t>(take_until(text, ','));
    if (!found || *found < -base::kCoordinateMax || *found > base::kCoordinateMax) {
      return std::nullopt;
    }
    value = *found;
  }
  return text.empty() ? std::optional(base::Cell{values[0], values[1], values[2]}) : std::nullopt;
}

/// WHAT@SECONDS, with a module's number or a cell.
std::optional<Change> change_of(Change::Kind kind, std::string_view text) {
  constexpr double kSecondsMax = 1e9;
  Change change{.kind = kind};
  const std::string_view what = take_until(text, '@');
  const auto seconds = number<double>(text);
  if (!seconds || !(*seconds >= 0 && *seconds <= kSecondsMax)) {
    return std::nullopt;
  }
  change.at = static_cast<agent::Time>(std::llround(*seconds * 1e6));
  if (kind == Change::Kind::kAttach || kind == Change::Kind::kPlan) {
    const auto cell = cell_of(what);
    change.cell = cell.value_or(base::Cell{});
    return cell ? std::optional(change) : std::nullopt;
  }
  change.id = number<std::uint32_t>(what).value_or(0);
  return change.id > 0 ? std::optional(change) : std::nullopt;
}

struct ChangeLetter {
  char letter;
  Change::Kind kind;
  const char* form;
};

constexpr std::array kChangeLetters = {
    ChangeLetter{'K', Change::Kind::kKill, "ID@SECONDS"},
    ChangeLetter{'D', Change::Kind::kDetach, "ID@SECONDS"},
    ChangeLetter{'A', Change::Kind::kAttach, "X,Y,Z@SECONDS"},
    ChangeLetter{'P', Change::Kind::kPlan, "X,Y,Z@SECONDS"},
    ChangeLetter{'T', Change::Kind::kTap, "ID@SECONDS"},
};

}  // namespace

std::optional<std::string> Settings::take(char letter, std::string_view value) {
  const auto wrong = [&](std::string_view form) {
    return fmt::format("-{} is '{}', expected {}", letter, value, form);
  };
  for (const ChangeLetter& row : kChangeLetters) {
    if (row.letter == letter) {
      const auto change = change_of(row.kind, value);
      if (!change) {
        return wrong(row.form);
      }
      changes.push_back(*change);
      return std::nullopt;
    }
  }
  if (letter == 'C') {
    constexpr std::uint32_t kComputeMax = 1'000'000;
    const auto time = number<std::uint32_t>(value);
    simulation.link.compute_time = time.value_or(0);
    return time && *time <= kComputeMax ? std::nullopt : std::optional(wrong("0 to 1000000"));
  }
  if (letter == 'M') {
    const auto method = find_method(value);
    simulation.method = method ? method : simulation.method;
    return method ? std::nullopt : std::optional(wrong("elimination, polynomial or fronts"));
  }
  if (letter == 'J') {
    json = value;
    return json.empty() ? std::optional(wrong("a file's name")) : std::nullopt;
  }
  return fmt::format("there is no option -{}", letter);
}

std::string_view option_help() {
  return "holdfast options (S: simulated seconds):\n"
         "\t -K ID@S\t\tA module falls silent\n"
         "\t -D ID@S\t\tA module is taken off\n"
         "\t -A X,Y,Z@S\t\tA module is put on\n"
         "\t -P X,Y,Z@S\t\tA module is planned\n"
         "\t -T ID@S\t\tA module is tapped\n"
         "\t -C MICROSECONDS\tEvery event keeps a module busy for so long\n"
         "\t -M NAME\t\tMethod: elimination, polynomial, fronts\n"
         "\t -J FILE\t\tWrite the report of 'holdfast simulate --json' in the end\n";
}

}  // namespace holdfast::visiblesim
