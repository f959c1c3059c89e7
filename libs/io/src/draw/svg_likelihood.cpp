// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "draw/chart.hpp"
#include "holdfast/io/likelihood_figure.hpp"
#include "shapes/svg_text.hpp"

namespace holdfast::io {
namespace {

constexpr double kChartWidth = 760;
constexpr double kChartLeft = 70;
constexpr double kChartRight = 730;
constexpr double kChartTop = 64;
constexpr double kChartHeight = 170;
constexpr double kChartGap = 66;

/// What is less likely is not drawn.
constexpr double kLeastDrawn = -4;

constexpr const char* kCurveInk = "#2f6690";
constexpr const char* kLimitInk = "#d1495b";

/// One panel, from values to pixels.
class Panel {
 public:
  Panel(const LikelihoodCurve& curve, double top)
      : curve_(curve),
        top_(top),
        low_(curve.points.front().value),
        high_(curve.points.back().value) {}

  void add_to(std::string& out) const {
    add_chart_text(out, kChartLeft, top_ - 10, "start", 13, curve_.title, kInk);
    add_interval(out);
    for (const double level : {0.0, -1.0, -2.0, -3.0, kLeastDrawn}) {
      add_level(out, level, "#d5d8d6", "");
      add_chart_text(out, kChartLeft - 8, y_of(level) + 4, "end", 12, fmt::format("{:g}", level));
    }
    add_level(out, -verdict::kIntervalDrop, kLimitInk, " stroke-dasharray=\"5 4\"");
    const double stride = round_up((high_ - low_) / 8);
    for (double tick = std::ceil(low_ / stride) * stride; tick <= high_; tick += stride) {
      add_chart_text(out, x_of(tick), y_of(kLeastDrawn) + 16, "middle", 12,
                     fmt::format("{:g}", tick));
    }
    add_curve_to(out);
    if (curve_.fitted.value) {
      add_chart_text(out, x_of(*curve_.fitted.value), top_ - 10, "middle", 12,
                     fmt::format("{:.4g}", *curve_.fitted.value), kCurveInk);
    }
  }

 private:
  double x_of(double value) const {
    const double share = (value - low_) / std::max(high_ - low_, 1e-12);
    return kChartLeft + (kChartRight - kChartLeft) * std::clamp(share, 0.0, 1.0);
  }

  double y_of(double level) const { return top_ + kChartHeight * level / kLeastDrawn; }

  void add_level(std::string& out, double level, const char* ink, const char* dashes) const {
    out += fmt::format("<path d=\"M{} {}H{}\" stroke=\"{}\"{}/>\n", number(kChartLeft),
                       number(y_of(level)), number(kChartRight), ink, dashes);
  }

  void add_interval(std::string& out) const {
    const double from = x_of(curve_.fitted.low.value_or(low_));
    const double to = x_of(curve_.fitted.high.value_or(high_));
    out += fmt::format(
        "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\" "
        "fill-opacity=\"0.12\"><title>95 %</title></rect>\n",
        number(from), number(top_), number(to - from), number(kChartHeight), kCurveInk);
  }

  void add_curve_to(std::string& out) const {
    Path path;
    for (const verdict::ProfilePoint& point : curve_.points) {
      if (point.log_likelihood < kLeastDrawn) {
        continue;
      }
      const ScreenPoint at = {x_of(point.value), y_of(point.log_likelihood)};
      path.empty() ? path.move_to(at) : path.line_to(at);
    }
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.8\"/>\n",
                       path.text(), kCurveInk);
  }

  const LikelihoodCurve& curve_;
  double top_;
  double low_;
  double high_;
};

}  // namespace

std::string write_likelihood_svg(std::span<const LikelihoodCurve> curves, std::string_view title,
                                 const FigureOptions& figure) {
  const auto top_of = [](std::size_t i) {
    return kChartTop + static_cast<double>(i) * (kChartHeight + kChartGap);
  };
  const double height = top_of(curves.size()) - 10;
  std::string out = chart_begin(figure, kChartWidth, height);
  add_chart_text(out, kChartLeft, 26, "start", 16,
                 fit_text(figure.title.empty() ? std::string(title) : figure.title, 16,
                          kChartRight - kChartLeft),
                 kInk);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    if (!curves[i].points.empty()) {
      Panel(curves[i], top_of(i)).add_to(out);
    }
  }
  return finished(out + "</svg>\n", figure);
}

}  // namespace holdfast::io
