// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "holdfast/io/document.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "shapes/module_shape.hpp"
#include "shapes/visible_surface.hpp"

/// Gives each module a colour, and what it says: as in Fig. 6 of [Piranda 2021].
namespace holdfast::io {

enum class Meaning : std::uint8_t {
  kLoad,      ///< Green to orange: the share of strength of its worst connection.
  kBroken,    ///< Red: a connection at 1 or more.
  kFixed,     ///< Blue.
  kUnstable,  ///< Purple: the robot topples.
  kUnknown,   ///< Grey: no loads.
};

struct ModulePaint {
  Meaning meaning = Meaning::kUnknown;
  int percent = 0;         ///< Of the colour scale, 0 to 100; kLoad only.
  double worst_ratio = 0;  ///< The largest load ratio; void unless is_loaded.
  bool is_loaded = false;  ///< Has a connection, and its load is known.
};

/// Whether the assessment says what every connection carries.
bool has_loads(const model::Robot& robot, const verdict::Assessment& assessment);

/// The paint of each module.
std::vector<ModulePaint> paint_modules(const model::Robot& robot,
                                       const verdict::Assessment& assessment);

/// Colours, or greys that tell loads and meanings apart: the darker the more.
enum class Palette : std::uint8_t { kColour, kGrey };

/// The colour of a load, computed in integers, so that it is the same on every machine.
Color load_color(int percent, Palette palette);
Color color_of(const ModulePaint& paint, Palette palette);

/// Mixes a colour with so many percent of white.
Color lightened(Color color, int percent);

/// A face by its direction: light falls from above and from the left.
Color shaded(Color color, Side side);

/// Shades a face by its normal, which may point anywhere; a cube's face looks as it does by its
/// side.
Color shaded(Color color, const Place& normal);

/// Writes "#rrggbb".
std::string hex(Color color);

inline constexpr Color kBrokenColor = {.red = 214, .green = 32, .blue = 43};
inline constexpr Color kFixedColor = {.red = 58, .green = 123, .blue = 200};
inline constexpr Color kUnstableColor = {.red = 142, .green = 77, .blue = 178};
inline constexpr Color kUnknownColor = {.red = 165, .green = 170, .blue = 176};

}  // namespace holdfast::io
