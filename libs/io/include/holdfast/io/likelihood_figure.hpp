// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/figure.hpp"
#include "holdfast/verdict/fit.hpp"

namespace holdfast::io {

/// How likely the values of one fitted number are.
struct LikelihoodCurve {
  std::string title;
  std::vector<verdict::ProfilePoint> points;  ///< By ascending value.
  verdict::FittedNumber fitted;
};

/// Returns an SVG with a panel for each number: the logarithm of the likelihood less its maximum,
/// the value of greatest likelihood, the interval at 95 % and the line that ends it.
std::string write_likelihood_svg(std::span<const LikelihoodCurve> curves, std::string_view title,
                                 const FigureOptions& figure = {});

}  // namespace holdfast::io
