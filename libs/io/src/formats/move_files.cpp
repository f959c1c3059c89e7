// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// Files of planners that list modules and then their moves: the modules at the start are read.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>

#include "formats/foreign_reading.hpp"
#include "numbers.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kCubeBegin = "Cube[(";
constexpr std::string_view kCubeEnd = ")]";

/// Takes a text from the beginning of another; false if it begins otherwise.
bool take(std::string_view& text, std::string_view beginning) {
  const bool is_there = text.starts_with(beginning);
  text.remove_prefix(is_there ? beginning.size() : 0);
  return is_there;
}

std::string_view without_remark(std::string_view line) {
  return trimmed(line.substr(0, line.find("//")));
}

/// The integers of a row; none if one is no integer, or if there are more or fewer.
template <std::size_t N>
std::optional<std::array<std::int32_t, N>> integers_of(std::string_view line) {
  const std::vector<std::string_view> row = split_row(line);
  // A comma behind the last one is no further column.
  const std::size_t count = row.size() == N + 1 && row.back().empty() ? N : row.size();
  std::array<std::int32_t, N> numbers{};
  if (count != N) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < N; ++i) {
    const auto number = parse_number<std::int32_t>(row[i]);
    if (!number) {
      return std::nullopt;
    }
    numbers[i] = *number;
  }
  return numbers;
}

constexpr std::size_t kScenColumns = 5;

/// A file for the viewer of modular-robotics, whose blocks are parted by empty lines: a name, a
/// description and a kind of modules, which may be absent; groups; modules; moves.
class Scenario {
 public:
  explicit Scenario(ForeignReading& reading) : reading_(reading) {}

  void read() {
    Lines lines(reading_.text);
    for (auto line = lines.next(); line && !reading_.has_failed(); line = lines.next()) {
      const std::string_view content = without_remark(*line);
      if (content.empty()) {
        continue;
      }
      if (last_ != 0 && lines.number() > last_ + 1) {
        ++block_;
      }
      const bool is_first = last_ == 0;
      last_ = lines.number();
      if (is_first && integers_of<kScenColumns>(content)) {
        block_ = kGroups;
        reading_.warn_of_all("the file does not say which kind of modules it has: cubes are taken");
      }
      take_line(content);
    }
    stand_up();
  }

 private:
  enum Block : int { kHead, kGroups, kModules };

  void take_line(std::string_view content) {
    if (block_ == kHead) {
      if (last_ == 3 && content != "CUBE") {
        reading_.fail({base::ErrorCode::kUnsupported,
                       fmt::format("the modules are {}, expected CUBE: places of others are not "
                                   "those of a lattice here",
                                   excerpt(content)),
                       "line 3"});
      }
      return;
    }
    if (block_ > kModules) {
      return;
    }
    const auto numbers = integers_of<kScenColumns>(content);
    if (!numbers) {
      reading_.fail_at(last_, fmt::format("expected five integers, {}, found {}",
                                          block_ == kGroups ? "a group, its colour and its size"
                                                            : "a module, its group, x, y, z",
                                          excerpt(content)));
      return;
    }
    if (block_ == kGroups) {
      take_group(*numbers);
    } else {
      take_module(*numbers);
    }
  }

  void take_group(const std::array<std::int32_t, kScenColumns>& numbers) {
    std::optional<Color> color = Color{numbers[1], numbers[2], numbers[3]};
    if (std::ranges::any_of(std::array{numbers[1], numbers[2], numbers[3]},
                            [](int part) { return !kColorRange.contains(part); })) {
      color.reset();
      reading_.warn(fmt::format("the colour of the group {} is none and left out", numbers[0]),
                    [&] { return fmt::format("line {}", last_); });
    }
    colors_[numbers[0]] = color;
  }

  void take_module(const std::array<std::int32_t, kScenColumns>& numbers) {
    const auto group = colors_.find(numbers[1]);
    if (group == colors_.end()) {
      reading_.warn(
          fmt::format("the group {} is not in the file, so its modules have no colour", numbers[1]),
          [&] { return fmt::format("line {}", last_); });
    }
    reading_.line = last_;
    reading_.add(numbers[2], numbers[3], numbers[4],
                 group == colors_.end() ? std::nullopt : group->second);
  }

  /// Flat shapes are seen from the front.
  void stand_up() {
    std::vector<ModuleEntry>& modules = reading_.document.modules;
    const auto is_level = [&](const ModuleEntry& module) {
      return module.cell.z == modules.front().cell.z;
    };
    if (modules.empty() || !std::ranges::all_of(modules, is_level)) {
      return;
    }
    for (ModuleEntry& module : modules) {
      module.cell = {module.cell.x, 0, module.cell.y};
    }
    reading_.warn_of_all("all z are the same, so it is read as an upright wall: y is a height");
  }

  ForeignReading& reading_;
  int block_ = kHead;
  std::size_t last_ = 0;  ///< Line that was read last.
  std::map<std::int32_t, std::optional<Color>> colors_;
};

/// Takes what is between "Cube[(" and ")]" of a list; false if a cube is not there as it should be.
bool take_cube(ForeignReading& reading, std::string_view& list, bool is_flat) {
  const bool is_quoted = take(list, "'");
  if (!take(list, kCubeBegin)) {
    return false;
  }
  const std::size_t end = list.find(kCubeEnd);
  if (end == std::string_view::npos) {
    return false;
  }
  const std::string numbers = (is_flat ? "0," : "") + std::string(list.substr(0, end));
  const auto cell = parse_triple<std::int32_t>(numbers);
  list.remove_prefix(end + kCubeEnd.size());
  if (!cell || (is_quoted && !take(list, "'"))) {
    return false;
  }
  const auto& [x, y, z] = *cell;
  is_flat ? reading.add(y, 0, z) : reading.add(x, y, z);
  return true;
}

}  // namespace

bool is_scenario(std::string_view /*text*/, std::string_view ending) { return ending == ".scen"; }

void read_scenario(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  Scenario(reading).read();
}

bool is_record(std::string_view /*text*/, std::string_view ending) { return ending == ".record"; }

void read_record(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  Lines lines(reading.text);
  const std::string_view dimension = lines.next().value_or("");
  if (!is_one_of(dimension, {"2", "3"})) {
    reading.fail_at(
        1, fmt::format("expected the number of dimensions, 2 or 3, found {}", excerpt(dimension)));
    return;
  }
  const bool is_flat = dimension == "2";
  std::string_view list = lines.next().value_or("");
  reading.line = lines.number();
  bool is_good = take(list, "[");
  for (bool is_first = true; is_good && list != "]" && !reading.has_failed(); is_first = false) {
    is_good = is_first || take(list, ",");
    list = trimmed(list);
    is_good = is_good && take_cube(reading, list, is_flat);
  }
  if (!is_good) {
    reading.fail_at(reading.line, fmt::format("expected cubes such as ['Cube[({})]'], found {}",
                                              is_flat ? "0, 0" : "0, 0, 0", excerpt(list)));
  }
  if (is_flat) {
    reading.warn_of_all("places have two numbers, so they are read as an upright wall");
  }
}

}  // namespace holdfast::io
