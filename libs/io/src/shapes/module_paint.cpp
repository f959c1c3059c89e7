// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/module_paint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace holdfast::io {
namespace {

constexpr Color kWhite = {.red = 255, .green = 255, .blue = 255};
constexpr Color kBlack = {.red = 0, .green = 0, .blue = 0};

struct Stop {
  int percent;
  Color color;
};

/// The colours of loads: green, yellow, orange. Broken is a darker red, so that it stands apart
/// from orange in print and for eyes that see red and green alike.
constexpr Stop kStops[] = {{0, {.red = 62, .green = 166, .blue = 88}},
                           {50, {.red = 242, .green = 218, .blue = 78}},
                           {100, {.red = 240, .green = 138, .blue = 36}}};

Color mix(Color a, Color b, int share, int whole) {
  const auto channel = [&](int from, int to) {
    return (from * (whole - share) + to * share + whole / 2) / whole;
  };
  return {.red = channel(a.red, b.red),
          .green = channel(a.green, b.green),
          .blue = channel(a.blue, b.blue)};
}

Color grey(int value) { return {.red = value, .green = value, .blue = value}; }

/// The largest ratio of every module's connections; NaN wins, for then it is not known.
void add_ratio(ModulePaint& paint, double ratio) {
  if (!paint.is_loaded || !(ratio <= paint.worst_ratio)) {
    paint.worst_ratio = std::isnan(paint.worst_ratio) ? paint.worst_ratio : ratio;
  }
  paint.is_loaded = true;
}

Meaning meaning_of(const ModulePaint& paint, bool is_broken) {
  if (is_broken) {
    return Meaning::kBroken;
  }
  return std::isnan(paint.worst_ratio) ? Meaning::kUnknown : Meaning::kLoad;
}

/// Whether each module topples: with its robot, or with its piece of one in several.
std::vector<bool> find_toppling(const model::Robot& robot, const verdict::Assessment& assessment) {
  const bool is_whole = assessment.pieces.empty();
  std::vector<bool> topples(robot.modules().size(),
                            is_whole && assessment.verdict == verdict::Verdict::kUnstable);
  for (const model::RobotPiece& piece : robot.pieces()) {
    const auto answer = std::ranges::find(assessment.pieces, piece.robot.modules().front().cell,
                                          &verdict::PieceAnswer::first);
    for (const std::int32_t module : piece.modules) {
      topples[static_cast<std::size_t>(module)] =
          answer != assessment.pieces.end() && answer->verdict == verdict::Verdict::kUnstable;
    }
  }
  return topples;
}

}  // namespace

bool has_loads(const model::Robot& robot, const verdict::Assessment& assessment) {
  return assessment.connections.size() == robot.connections().size() &&
         (!assessment.connections.empty() || assessment.verdict != verdict::Verdict::kUndecided);
}

std::vector<ModulePaint> paint_modules(const model::Robot& robot,
                                       const verdict::Assessment& assessment) {
  std::vector<ModulePaint> paints(robot.modules().size());
  const bool is_known = has_loads(robot, assessment);
  std::vector<bool> is_broken(paints.size(), false);
  if (is_known) {
    for (std::size_t i = 0; i < robot.connections().size(); ++i) {
      for (const std::int32_t end : {robot.connections()[i].a, robot.connections()[i].b}) {
        add_ratio(paints[static_cast<std::size_t>(end)], assessment.connections[i].load_ratio);
      }
    }
    for (const std::size_t i : assessment.broken) {
      is_broken[static_cast<std::size_t>(robot.connections()[i].a)] = true;
      is_broken[static_cast<std::size_t>(robot.connections()[i].b)] = true;
    }
  }
  const std::vector<bool> topples = find_toppling(robot, assessment);
  for (std::size_t i = 0; i < paints.size(); ++i) {
    ModulePaint& paint = paints[i];
    if (topples[i]) {
      paint.meaning = Meaning::kUnstable;
    } else if (robot.modules()[i].support == model::Support::kFixed) {
      paint.meaning = Meaning::kFixed;
    } else if (is_known) {
      paint.meaning = meaning_of(paint, is_broken[i]);
      if (paint.meaning == Meaning::kLoad) {
        paint.percent =
            static_cast<int>(std::lround(std::clamp(paint.worst_ratio, 0.0, 1.0) * 100));
      }
    }
  }
  return paints;
}

Color load_color(int percent, Palette palette) {
  if (palette == Palette::kGrey) {
    return mix(grey(230), grey(120), percent, 100);
  }
  const Stop* next =
      std::ranges::find_if(kStops, [&](const Stop& stop) { return stop.percent >= percent; });
  if (next == std::begin(kStops)) {
    return next->color;
  }
  const Stop& last = *(next - 1);
  return mix(last.color, next->color, percent - last.percent, next->percent - last.percent);
}

Color color_of(const ModulePaint& paint, Palette palette) {
  const bool is_grey = palette == Palette::kGrey;
  switch (paint.meaning) {
    case Meaning::kLoad:
      return load_color(paint.percent, palette);
    case Meaning::kBroken:
      return is_grey ? grey(30) : kBrokenColor;
    case Meaning::kFixed:
      return is_grey ? grey(80) : kFixedColor;
    case Meaning::kUnstable:
      return is_grey ? grey(150) : kUnstableColor;
    case Meaning::kUnknown:
      break;
  }
  return is_grey ? grey(245) : kUnknownColor;
}

Color lightened(Color color, int percent) { return mix(color, kWhite, percent, 100); }

Color shaded(Color color, Side side) {
  switch (side) {
    case Side::kTop:
      return lightened(color, 14);
    case Side::kLeft:
      return mix(color, kBlack, 4, 100);
    case Side::kRight:
      break;
  }
  return mix(color, kBlack, 22, 100);
}

Color shaded(Color color, const Place& normal) {
  // Towards white where positive, in percent; linear, with the values of a cube's three sides.
  const auto percent =
      static_cast<int>(std::lround(14 * normal[2] + 4 * normal[1] - 22 * normal[0]));
  return percent > 0 ? lightened(color, percent) : mix(color, kBlack, -percent, 100);
}

std::string hex(Color color) {
  return fmt::format("#{:02x}{:02x}{:02x}", color.red, color.green, color.blue);
}

}  // namespace holdfast::io
