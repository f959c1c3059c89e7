// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "draw/svg_layout.hpp"
#include "holdfast/io/figure.hpp"

/// What charts have in common.
namespace holdfast::io {

/// The beginning of an SVG of this size, in pixels, with the card's ground.
std::string chart_begin(const FigureOptions& figure, double width, double height);

void add_chart_text(std::string& out, double x, double y, std::string_view anchor, double size,
                    std::string_view text, const char* ink = kInkSoft);

/// A round number of at least so much, which is above 0: 1, 2 or 5 times a power of ten.
double round_up(double value);

}  // namespace holdfast::io
