// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "draw/chart.hpp"
#include "draw/svg_layout.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/steps_report.hpp"
#include "shapes/svg_text.hpp"

namespace holdfast::io {
namespace {

using plan::StageJudgement;
using verdict::Verdict;

constexpr double kWidth = 1100;
constexpr double kLeft = 90;
constexpr double kRight = 1070;
constexpr double kBandTop = 56;
constexpr double kBandHeight = 18;
constexpr double kPanelHeight = 150;
constexpr double kPanelGap = 34;

/// Longer sequences are drawn in so many columns, each by its worst.
constexpr std::size_t kColumnMax = 980;

constexpr std::array<const char*, 4> kVerdictInk = {"#6fae7d", "#d1495b", "#8e5aa8", "#b9bfc4"};
constexpr std::array<const char*, 4> kVerdictGrey = {"#d8d8d8", "#1e1e1e", "#646464", "#f5f5f5"};

/// Some steps in a row, as one.
struct Column {
  std::array<Verdict, plan::kStageCount> verdicts{};
  double ratio = -std::numeric_limits<double>::infinity();
  double margin = std::numeric_limits<double>::infinity();
};

std::vector<Column> columns_of(const plan::SequenceJudgement& judged) {
  const std::size_t step_count = judged.steps.size();
  std::vector<Column> columns(std::min(step_count, kColumnMax));
  for (std::size_t i = 0; i < step_count; ++i) {
    Column& column = columns[i * columns.size() / step_count];
    for (std::size_t k = 0; k < plan::kStageCount; ++k) {
      const StageJudgement& stage = judged.steps[i].stages[k];
      if (severity(stage.verdict) > severity(column.verdicts[k])) {
        column.verdicts[k] = stage.verdict;
      }
      column.ratio = std::max(column.ratio, stage.load_ratio_max.value_or(column.ratio));
      column.margin = std::min(column.margin, stage.margin_mm.value_or(column.margin));
    }
  }
  return columns;
}

double x_of(std::size_t column, std::size_t count) {
  return kLeft + (kRight - kLeft) * static_cast<double>(column) / static_cast<double>(count);
}

/// A row for every stage, with what its verdict is, runs of one verdict in one piece.
void add_bands(std::string& out, const std::vector<Column>& columns, bool is_grey) {
  const std::array<const char*, 4>& inks = is_grey ? kVerdictGrey : kVerdictInk;
  for (std::size_t k = 0; k < plan::kStageCount; ++k) {
    const double y = kBandTop + static_cast<double>(k) * (kBandHeight + 3);
    add_chart_text(out, kLeft - 8, y + 13, "end", 12, plan::name(static_cast<plan::Stage>(k)));
    for (std::size_t i = 0; i < columns.size();) {
      std::size_t end = i + 1;
      while (end < columns.size() && columns[end].verdicts[k] == columns[i].verdicts[k]) {
        ++end;
      }
      const double from = x_of(i, columns.size());
      out += fmt::format(
          "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" "
          "fill=\"{}\"><title>{}</title></rect>\n",
          number(from), number(y), number(x_of(end, columns.size()) - from), number(kBandHeight),
          inks[static_cast<std::size_t>(columns[i].verdicts[k])],
          verdict::name(columns[i].verdicts[k]));
      i = end;
    }
  }
}

/// A curve over the steps in one panel.
struct Curve {
  double Column::*value;
  std::string title;
  double limit = 0;  ///< A line that must not be reached.
  const char* ink;
};

/// A value so near below zero is rounding, and no reason for an axis below zero.
constexpr double kRounding = 1e-9;

void add_curve(std::string& out, const std::vector<Column>& columns, const Curve& curve,
               double top) {
  double low = std::min(0.0, curve.limit);
  double high = std::max(0.0, curve.limit);
  for (const Column& column : columns) {
    if (std::isfinite(column.*curve.value)) {
      low = std::min(low, column.*curve.value);
      high = std::max(high, column.*curve.value);
    }
  }
  high = high > 0 ? round_up(high) : 1;
  low = low < -kRounding ? -round_up(-low) : 0;
  const auto y_of = [&](double value) {
    return top + kPanelHeight * (high - value) / (high - low);
  };
  add_chart_text(out, kLeft, top - 8, "start", 13, curve.title, kInk);
  for (const double tick : {low, 0.0, curve.limit, high}) {
    const bool is_limit = tick == curve.limit;
    out += fmt::format("<path d=\"M{} {}H{}\" stroke=\"{}\"{}/>\n", number(kLeft),
                       number(y_of(tick)), number(kRight), is_limit ? "#d1495b" : "#d5d8d6",
                       is_limit ? " stroke-dasharray=\"5 4\"" : "");
    add_chart_text(out, kLeft - 8, y_of(tick) + 4, "end", 12, fmt::format("{:g}", tick));
  }
  Path path;
  bool is_down = false;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double value = columns[i].*curve.value;
    if (!std::isfinite(value)) {
      is_down = false;
      continue;
    }
    const ScreenPoint from = {x_of(i, columns.size()), y_of(value)};
    is_down ? path.line_to(from) : path.move_to(from);
    path.line_to({x_of(i + 1, columns.size()), from.y});
    is_down = true;
  }
  if (!path.empty()) {
    out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>\n",
                       path.text(), curve.ink);
  }
}

/// The first, the last, and some between; and the first that is unsafe.
void add_step_numbers(std::string& out, const plan::SequenceJudgement& judged, double y) {
  const std::size_t count = judged.steps.size();
  const auto stride =
      static_cast<std::size_t>(std::max(1.0, round_up(static_cast<double>(count) / 10)));
  for (std::size_t step = 0; step < count; step += stride) {
    add_chart_text(out, x_of(step, count), y, "start", 12, fmt::format("{}", step));
  }
  add_chart_text(out, kRight, y + 16, "end", 12, "step");
  if (judged.first_unsafe) {
    const double x = x_of(judged.first_unsafe->step, count);
    out += fmt::format("<path d=\"M{} {}V{}\" stroke=\"{}\"/>\n", number(x), number(kBandTop - 4),
                       number(y - 14), kInk);
    add_chart_text(out, x, kBandTop - 8, x > kWidth / 2 ? "end" : "start", 12,
                   fmt::format("first unsafe: step {}, {}", judged.first_unsafe->step,
                               plan::name(judged.first_unsafe->stage)),
                   kInk);
  }
}

}  // namespace

std::string write_steps_svg(const StepsEntry& entry, const FigureOptions& figure) {
  const std::vector<Column> columns = columns_of(*entry.judgement);
  const double first_panel = kBandTop + plan::kStageCount * (kBandHeight + 3) + kPanelGap;
  const double second_panel = first_panel + kPanelHeight + kPanelGap;
  const double height = second_panel + kPanelHeight + 44;
  std::string out = chart_begin(figure, kWidth, height);
  add_chart_text(
      out, kLeft, 24, "start", 16,
      fit_text(fmt::format("{}: {}, {}", figure.title.empty() ? entry.name : figure.title,
                           host::counted(entry.judgement->steps.size(), "step"),
                           verdict::name(entry.judgement->verdict())),
               16, kRight - kLeft),
      kInk);
  add_bands(out, columns, figure.is_grey);
  add_curve(out, columns,
            {.value = &Column::ratio,
             .title = entry.judgement->load_ratio_bound ? "largest load ratio, or a bound of it"
                                                        : "largest load ratio",
             .limit = 1,
             .ink = "#2f6690"},
            first_panel);
  add_curve(out, columns,
            {.value = &Column::margin, .title = "margin, mm", .limit = 0, .ink = "#3f6b7d"},
            second_panel);
  add_step_numbers(out, *entry.judgement, second_panel + kPanelHeight + 18);
  return finished(out + "</svg>\n", figure);
}

}  // namespace holdfast::io
