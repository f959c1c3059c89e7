// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "formats/bricks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "numbers.hpp"
#include "text_input.hpp"

namespace holdfast::io {
namespace {

/// Longer bricks are no bricks.
constexpr std::int32_t kBrickLengthMax = 64;

/// The bricks of StableLego by their `brick_id`; the first is a weight as large as a brick.
constexpr auto kStableLego = std::to_array<LibraryBrick>({{1, {2, 2}, 200},
                                                          {2, {2, 4}},
                                                          {3, {2, 6}},
                                                          {4, {1, 8}},
                                                          {5, {1, 4}},
                                                          {6, {1, 6}},
                                                          {9, {1, 2}},
                                                          {10, {1, 1}},
                                                          {12, {2, 2}}});

/// LDraw's plain bricks by the number of the part; its longer side lies along x.
constexpr auto kLDraw = std::to_array<LibraryBrick>({{3005, {1, 1}},
                                                     {3004, {2, 1}},
                                                     {3622, {3, 1}},
                                                     {3010, {4, 1}},
                                                     {3009, {6, 1}},
                                                     {3008, {8, 1}},
                                                     {6111, {10, 1}},
                                                     {6112, {12, 1}},
                                                     {2465, {16, 1}},
                                                     {3003, {2, 2}},
                                                     {3002, {3, 2}},
                                                     {3001, {4, 2}},
                                                     {2456, {6, 2}},
                                                     {3007, {8, 2}},
                                                     {3006, {10, 2}}});

template <std::size_t N>
const LibraryBrick* find_brick(const std::array<LibraryBrick, N>& list, std::int32_t number) {
  const auto* const found = std::ranges::find(list, number, &LibraryBrick::number);
  return found == list.end() ? nullptr : found;
}

/// Reads "2x4 (0,1,2)"; none if a line is anything else.
struct TextBrick {
  BrickSize size;
  base::Cell corner;
};

std::optional<TextBrick> text_brick(std::string_view line) {
  const std::size_t cross = line.find('x');
  const std::size_t open = line.find('(');
  if (cross == std::string_view::npos || open == std::string_view::npos || cross > open ||
      !line.ends_with(')')) {
    return std::nullopt;
  }
  const auto along_x = parse_number<std::int32_t>(line.substr(0, cross));
  const auto along_y = parse_number<std::int32_t>(line.substr(cross + 1, open - cross - 1));
  const auto corner = parse_triple<std::int32_t>(line.substr(open + 1, line.size() - open - 2));
  if (!along_x || !along_y || !corner || std::min(*along_x, *along_y) < 1 ||
      std::max(*along_x, *along_y) > kBrickLengthMax) {
    return std::nullopt;
  }
  return TextBrick{{*along_x, *along_y}, {(*corner)[0], (*corner)[1], (*corner)[2]}};
}

/// LDraw's unit: a stud is 20 wide, a brick 24 high, and y points down.
constexpr double kStud = 20;
constexpr double kBrickHeight = 24;

/// Places the bricks of LDraw on a grid that begins at the first one.
class LDrawGrid {
 public:
  LDrawGrid(ForeignReading& reading, BrickPile& pile) : reading_(reading), pile_(pile) {}

  /// Reads a line that places a part: 1 COLOUR x y z a b c d e f g h i PART.
  void read(const std::vector<std::string_view>& row, std::size_t line) {
    std::array<double, 12> numbers{};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const auto number = row.size() == 15 ? parse_number<double>(row[i + 2]) : std::nullopt;
      if (!number) {
        reading_.fail_at(line, "expected a part: 1, a colour, twelve numbers and the part's name");
        return;
      }
      numbers[i] = *number;
    }
    const std::string_view name = row.back();
    const auto part = parse_number<std::int32_t>(name.substr(0, name.find('.')));
    const LibraryBrick* const brick = part ? find_brick(kLDraw, *part) : nullptr;
    if (brick == nullptr) {
      reading_.fail({base::ErrorCode::kUnsupported,
                     fmt::format("the part {} is unknown, expected a plain brick, such as "
                                 "3001.dat",
                                 excerpt(name)),
                     fmt::format("line {}", line)});
      return;
    }
    const auto turned = turned_size(numbers, brick->size);
    if (!turned) {
      reading_.fail_at(line, "a part is turned otherwise than by right angles about the vertical");
      return;
    }
    reading_.line = line;
    place({numbers[0], numbers[1], numbers[2]}, *turned, line);
  }

 private:
  /// The size of a brick turned by the matrix of its line, rows first, about the vertical.
  static std::optional<BrickSize> turned_size(const std::array<double, 12>& numbers,
                                              const BrickSize& size) {
    const auto at = [&](std::size_t row, std::size_t column) {
      return numbers[3 + 3 * row + column];
    };
    const bool is_upright =
        at(1, 1) == 1 && at(0, 1) == 0 && at(1, 0) == 0 && at(1, 2) == 0 && at(2, 1) == 0;
    const auto is_unit = [](double number) { return std::abs(number) == 1; };
    if (is_upright && is_unit(at(0, 0)) && is_unit(at(2, 2)) && at(0, 2) == 0 && at(2, 0) == 0) {
      return size;
    }
    if (is_upright && is_unit(at(0, 2)) && is_unit(at(2, 0)) && at(0, 0) == 0 && at(2, 2) == 0) {
      return BrickSize{size.along_y, size.along_x};
    }
    return std::nullopt;
  }

  /// LDraw's z is our y, and its y our z, downwards.
  void place(const std::array<double, 3>& middle, const BrickSize& size, std::size_t line) {
    const std::array<double, 3> corner = {middle[0] - size.along_x * kStud / 2,
                                          middle[2] - size.along_y * kStud / 2, -middle[1]};
    if (!has_first_) {
      has_first_ = true;
      first_ = corner;
    }
    std::array<std::int32_t, 3> cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double steps = (corner[i] - first_[i]) / (i < 2 ? kStud : kBrickHeight);
      if (steps != std::trunc(steps) || !kCoordinateRange.contains(steps)) {
        reading_.fail_at(line, fmt::format("a brick at {} {} {} is not on the grid of studs and "
                                           "heights of a brick that begins at the first one",
                                           middle[0], middle[1], middle[2]));
        return;
      }
      cell[i] = static_cast<std::int32_t>(steps);
    }
    pile_.add({cell[0], cell[1], cell[2]}, size);
  }

  ForeignReading& reading_;
  BrickPile& pile_;
  bool has_first_ = false;
  std::array<double, 3> first_{};  ///< Corner of the first brick.
};

}  // namespace

const LibraryBrick* find_stable_lego_brick(std::int32_t number) {
  return find_brick(kStableLego, number);
}

bool is_brick_text(std::string_view text, std::string_view ending) {
  if (!ending.empty() && ending != ".txt") {
    return false;
  }
  Lines lines(text.substr(0, 4096));
  const auto first = lines.next();
  return first && text_brick(*first).has_value();
}

void read_brick_text(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  Lines lines(reading.text);
  BrickPile pile(reading);
  for (auto line = lines.next(); line && !reading.has_failed(); line = lines.next()) {
    const auto brick = text_brick(*line);
    if (!brick) {
      reading.fail_at(lines.number(), fmt::format("expected a brick such as 2x4 (0,0,0), of up to "
                                                  "{} studs a side, found {}",
                                                  kBrickLengthMax, excerpt(*line)));
      return;
    }
    reading.line = lines.number();
    pile.add(brick->corner, brick->size);
  }
  pile.finish(BrickGround::kBasePlate);
}

bool is_ldraw(std::string_view /*text*/, std::string_view ending) {
  return ending == ".ldr" || ending == ".mpd";
}

void read_ldraw(ForeignReading& reading) {
  if (auto fault = find_input_fault(reading.text)) {
    reading.fail(*std::move(fault));
    return;
  }
  Lines lines(reading.text);
  BrickPile pile(reading);
  LDrawGrid grid(reading, pile);
  std::size_t file_count = 0;
  for (auto line = lines.next(); line && !reading.has_failed(); line = lines.next()) {
    const std::vector<std::string_view> row = split_row(*line);
    if (row.front() == "1") {
      grid.read(row, lines.number());
    } else if (row.front() == "0" && row.size() > 1 && row[1] == "FILE" && ++file_count > 1) {
      reading.fail({base::ErrorCode::kUnsupported,
                    "the file has several models, expected one of bricks only",
                    fmt::format("line {}", lines.number())});
    }
  }
  pile.finish(BrickGround::kFloor);
}

}  // namespace holdfast::io
