// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/view_axes.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "numbers.hpp"

namespace holdfast::io {
namespace {

struct NamedView {
  std::string_view word;
  std::string_view title;
  View view;
};

constexpr NamedView kNamedViews[] = {
    {"iso", "Isometric view", {}},
    {"front", "Front view", {.is_isometric = false, .azimuth_deg = -90, .elevation_deg = 0}},
    {"side", "Side view", {.is_isometric = false, .azimuth_deg = 0, .elevation_deg = 0}},
    {"top", "Top view", {.is_isometric = false, .azimuth_deg = -90, .elevation_deg = 90}}};

bool are_one(const View& a, const View& b) {
  return a.is_isometric == b.is_isometric &&
         (a.is_isometric || (a.azimuth_deg == b.azimuth_deg && a.elevation_deg == b.elevation_deg));
}

/// Two numbers with a mark in between.
std::optional<std::pair<double, double>> pair_of(std::string_view text, char mark) {
  const std::size_t at = text.find(mark);
  if (at == std::string_view::npos) {
    return std::nullopt;
  }
  const auto first = parse_number<double>(text.substr(0, at));
  const auto second = parse_number<double>(text.substr(at + 1));
  return first && second ? std::optional(std::pair(*first, *second)) : std::nullopt;
}

bool is_size(double pixels) { return pixels >= 16 && pixels <= 20000; }

/// The cosine of an angle; exactly 0 where it is a right one.
double cosine(double degrees) {
  const double cosine = std::cos(degrees * std::numbers::pi / 180);
  return std::abs(cosine) < 1e-12 ? 0 : cosine;
}

double sine(double degrees) { return cosine(degrees - 90); }

}  // namespace

std::optional<View> find_view(std::string_view text) {
  for (const NamedView& named : kNamedViews) {
    if (named.word == text) {
      return named.view;
    }
  }
  const auto angles = pair_of(text, ',');
  if (!angles || !(std::abs(angles->first) <= 360 && angles->second >= 0) || angles->second > 90) {
    return std::nullopt;
  }
  return View{.is_isometric = false, .azimuth_deg = angles->first, .elevation_deg = angles->second};
}

std::string view_name(const View& view) {
  for (const NamedView& named : kNamedViews) {
    if (are_one(named.view, view)) {
      return std::string(named.title);
    }
  }
  return fmt::format("View from azimuth {} and elevation {} degrees", view.azimuth_deg,
                     view.elevation_deg);
}

std::optional<FigureSize> find_figure_size(std::string_view text) {
  if (const auto width = parse_number<double>(text)) {
    return is_size(*width) ? std::optional(FigureSize{.width = *width, .height = {}})
                           : std::nullopt;
  }
  const auto size = pair_of(text, 'x');
  return size && is_size(size->first) && is_size(size->second)
             ? std::optional(FigureSize{.width = size->first, .height = size->second})
             : std::nullopt;
}

ViewAxes axes_of(const View& view) {
  if (view.is_isometric) {
    return {};
  }
  const double east = cosine(view.azimuth_deg);
  const double north = sine(view.azimuth_deg);
  const double level = cosine(view.elevation_deg);
  const double up = sine(view.elevation_deg);
  const Place right = {-north, east, 0};
  const Place down = {up * east, up * north, -level};
  constexpr double kAcross = 2 * kBallRadius;  // A pitch across the line of sight.
  return {.u = scaled(kAcross / kCos30, right),
          .v = scaled(2 * kAcross, down),
          .eye = {level * east, level * north, up},
          .is_isometric = false};
}

}  // namespace holdfast::io
