// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace holdfast::io {

/// The place from which a picture is looked at. The angles are those of the eye: around z from x
/// towards y, as in matplotlib, and above the horizon. The isometric view is from -45 and 35.26
/// degrees.
struct View {
  bool is_isometric = true;
  double azimuth_deg = 0;
  double elevation_deg = 0;  ///< From 0 to 90.
};

/// Reads "iso", "front", "side", "top" or the two angles, "-60,30".
std::optional<View> find_view(std::string_view text);

/// "Isometric view", "Front view", "View from azimuth -60 and elevation 30 degrees".
std::string view_name(const View& view);

/// The size of a picture, in pixels.
struct FigureSize {
  double width = 0;
  std::optional<double> height;  ///< None: as the picture's shape wants it.
};

/// Reads "800" or "800x600".
std::optional<FigureSize> find_figure_size(std::string_view text);

/// What may be asked of a picture.
struct FigureOptions {
  std::optional<FigureSize> size = {};  ///< None: up to 1,100 pixels wide.
  View view = {};
  bool has_legend = true;
  std::string title = {};  ///< Empty: the robot's name.
  bool is_grey = false;    ///< For print: loads from light to dark, all colours as their greys.
};

}  // namespace holdfast::io
