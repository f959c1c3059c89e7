// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "draw/svg_parts.hpp"
#include "holdfast/io/report.hpp"

namespace holdfast::io {
namespace {

using verdict::Verdict;

constexpr double kTitleFont = 20;
constexpr double kVerdictFont = 14;
constexpr double kLegendFont = 12;
constexpr double kBarWidth = 240;
constexpr double kBarHeight = 12;
constexpr double kRowHeight = 23;

std::string stability_text(const Scene& scene) {
  const verdict::Assessment& assessment = scene.assessment;
  if (assessment.simplified.margin_mm) {
    return "stability margin " + millimetres(*assessment.simplified.margin_mm);
  }
  if (assessment.stability_rule == verdict::StabilityRule::kContactForces) {
    const auto& tilt = assessment.rigid.tilt_margin_deg;
    return tilt ? fmt::format("stands until gravity tilts by {:.1f}\u00b0", *tilt)
                : "contact forces hold it";
  }
  return scene.robot.fixed_count() > 0 || !scene.robot.has_bonded_facets()
             ? "held by a fixed module"
             : "held by a bonded support";
}

std::string load_text(const Scene& scene) {
  const verdict::Assessment& assessment = scene.assessment;
  if (!assessment.load_ratio_max) {
    return "no connection that could break";
  }
  if (!assessment.worst) {
    return assessment.load_ratio_range.high < verdict::kLoadRatioTie
               ? "no connection is in tension"
               : "no connection is known to be in tension";
  }
  if (*assessment.load_ratio_max < kNoLoad) {
    return "no connection carries 0.01 of its strength";
  }
  return fmt::format("worst connection {} at {} of its strength",
                     model::ends_text(scene.robot, *assessment.worst),
                     ratio_text(*assessment.load_ratio_max, !assessment.broken.empty()));
}

std::string toppling_text(const Scene& scene) {
  const verdict::RigidBody& body = scene.assessment.simplified;
  if (!body.margin_mm) {
    return scene.assessment.reasons.empty()
               ? "it falls"
               : reason_text(scene.robot, scene.assessment.reasons.front());
  }
  if (*body.margin_mm == 0) {
    return "the centre of mass lies on the edge of the support polygon, nothing to spare";
  }
  return "topples: the centre of mass lies " + millimetres(*body.margin_mm) +
         " outside the support polygon";
}

std::string text_element(ScreenPoint at, double font, std::string_view attributes,
                         std::string_view text) {
  return fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\" {}>{}</text>\n", number(at.x),
                     number(at.y), number(font), attributes, escape(text));
}

std::string legend_text(ScreenPoint at, std::string_view text) {
  return text_element(at, kLegendFont, fmt::format("fill=\"{}\"", kInk), text);
}

std::string swatch(ScreenPoint at, std::string_view attributes) {
  return fmt::format("<rect x=\"{}\" y=\"{}\" width=\"14\" height=\"14\" rx=\"2\" {}/>\n",
                     number(at.x), number(at.y), attributes);
}

/// A sign of 20 x 14 px and what it means.
struct Entry {
  std::string label;
  std::function<std::string(ScreenPoint)> draw;  ///< Given the sign's upper left corner.
};

Entry swatch_entry(std::string label, std::string attributes) {
  return {.label = std::move(label), .draw = [attributes = std::move(attributes)](ScreenPoint at) {
            return swatch(at, attributes);
          }};
}

Entry color_entry(std::string label, Color color) {
  return swatch_entry(
      std::move(label),
      fmt::format("fill=\"{}\" stroke=\"{}\" stroke-width=\"0.8\"", hex(color), kInk));
}

bool has_meaning(const Scene& scene, Meaning meaning) {
  return std::ranges::any_of(scene.paints,
                             [&](const ModulePaint& paint) { return paint.meaning == meaning; });
}

Entry planned_entry(const char* label) {
  return swatch_entry(label, fmt::format("fill=\"#b9bfc4\" fill-opacity=\"0.35\" stroke=\"{}\" "
                                         "stroke-width=\"1.3\" stroke-dasharray=\"2.8 2.2\"",
                                         kInk));
}

Entry polygon_entry() {
  return {.label = "support polygon", .draw = [](ScreenPoint at) {
            return fmt::format(
                "<path fill=\"#9cc3d1\" fill-opacity=\"0.55\" stroke=\"{}\" "
                "stroke-width=\"1.4\" d=\"M{} {}l10-5 10 5-10 5z\"/>\n",
                kGroundInk, number(at.x - 3), number(at.y + 7));
          }};
}

Entry mass_entry() {
  return {.label = "centre of mass", .draw = [](ScreenPoint at) {
            return mass_symbol(at + ScreenPoint{7, 7}, 6.5);
          }};
}

Entry facet_entry(const FacetSign& sign) {
  return {.label = sign.label, .draw = [attributes = sign.attributes](ScreenPoint at) {
            return fmt::format("<path {} stroke-width=\"1.3\" d=\"M{} {}l10-5 10 5-10 5z\"/>\n",
                               attributes, number(at.x - 3), number(at.y + 7));
          }};
}

/// The entries for what occurs in the picture.
std::vector<Entry> entries(const Scene& scene) {
  std::vector<Entry> list;
  const std::array<std::pair<Meaning, const char*>, 4> meanings = {
      {{Meaning::kBroken, "a connection breaks (1 or more)"},
       {Meaning::kFixed, "fixed module"},
       {Meaning::kUnstable, scene.has_fallen ? "falls after the break" : "unstable robot"},
       {Meaning::kUnknown, "loads not known"}}};
  for (const auto& [meaning, label] : meanings) {
    if (has_meaning(scene, meaning)) {
      list.push_back(color_entry(label, scene.color_of({.meaning = meaning})));
    }
  }
  if (scene.robot.planned_count() > scene.ghost_count) {
    list.push_back(planned_entry("planned module"));
  }
  if (scene.ghost_count > 0) {
    list.push_back(planned_entry("place for the next module"));
  }
  if (scene.has_polygon()) {
    list.push_back(polygon_entry());
  }
  if (scene.has_polygon() || fall_of(scene) != nullptr) {
    list.push_back(mass_entry());
  }
  for (const ObstacleSign& sign : obstacle_signs(scene)) {
    list.push_back(swatch_entry(
        sign.label,
        fmt::format("fill=\"{0}\" fill-opacity=\"0.3\" stroke=\"{0}\"", hex(sign.color))));
  }
  for (const FacetSign& sign : facet_signs(scene)) {
    list.push_back(facet_entry(sign));
  }
  if (has_payload_signs(scene)) {
    list.push_back({.label = "payload", .draw = payload_sign});
  }
  return list;
}

std::string draw_bar(const Scene& scene, ScreenPoint at) {
  constexpr int kSteps = 40;
  std::string out = "<g class=\"colour-bar\" shape-rendering=\"crispEdges\">\n";
  for (int i = 0; i < kSteps; ++i) {
    out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                       number(at.x + kBarWidth * i / kSteps), number(at.y),
                       number(kBarWidth / kSteps), number(kBarHeight),
                       hex(scene.color_of({.meaning = Meaning::kLoad,
                                           .percent = (200 * i + 100) / (2 * kSteps)})));
  }
  out += fmt::format(
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" "
      "stroke=\"{}\" stroke-width=\"0.8\"/>\n</g>\n",
      number(at.x), number(at.y), number(kBarWidth), number(kBarHeight), kInk);
  out += "<g class=\"ticks\">\n";
  for (const auto& [share, label] :
       {std::pair(0.0, "0"), {0.25, "0.25"}, {0.5, "0.5"}, {0.75, "0.75"}, {1.0, "1"}}) {
    const double x = at.x + kBarWidth * share;
    out += fmt::format("<path stroke=\"{}\" stroke-width=\"0.8\" d=\"M{} {}v4\"/>\n", kInk,
                       number(x), number(at.y + kBarHeight));
    out += text_element({x, at.y + kBarHeight + 15}, 11,
                        fmt::format("text-anchor=\"middle\" fill=\"{}\"", kInk), label);
  }
  return out + "</g>\n";
}

/// Rows of entries between x and `right`; returns the bottom of the last row.
double draw_entries(const std::vector<Entry>& list, ScreenPoint start, double right,
                    std::string& out) {
  ScreenPoint at = start;
  for (const Entry& entry : list) {
    const double width = 22 + text_width(entry.label, kLegendFont);
    if (at.x > start.x && at.x + width > right) {
      at = {start.x, at.y + kRowHeight};
    }
    out += entry.draw(at);
    out += legend_text({at.x + 22, at.y + 11.5}, entry.label);
    at.x += width + 24;
  }
  return at.y + kRowHeight;
}

}  // namespace

Headline headline(const Scene& scene) {
  const verdict::Assessment& assessment = scene.assessment;
  const std::string stability = stability_text(scene);
  switch (assessment.verdict) {
    case Verdict::kSafe:
      return {"SAFE", load_text(scene) + "; " + stability, {.red = 30, .green = 122, .blue = 58}};
    case Verdict::kOverload:
      return {
          "OVERLOAD", load_text(scene) + "; " + stability, {.red = 165, .green = 15, .blue = 29}};
    case Verdict::kUnstable:
      return {"UNSTABLE", toppling_text(scene), kUnstableColor};
    case Verdict::kUndecided:
      break;
  }
  const bool has_reason = has_loads(scene.robot, assessment) && !assessment.reasons.empty();
  const std::string reason = has_reason ? reason_text(scene.robot, assessment.reasons.front())
                                        : "stable, but the loads are not known; " + stability;
  return {"UNDECIDED", reason, {.red = 90, .green = 96, .blue = 102}};
}

std::string draw_header(const Scene& scene, std::string_view title) {
  const double room = scene.card_width - 2 * kCardMargin;
  const Headline line = headline(scene);
  const std::string verdict = line.verdict + " \u2013";
  constexpr double kGap = 5;
  const double essence_room = room - kGap - text_width(verdict, kVerdictFont, true);
  std::string out =
      text_element({kCardMargin, 40}, kTitleFont,
                   fmt::format("class=\"title\" font-weight=\"bold\" fill=\"{}\"", kInk),
                   fit_text(title, kTitleFont, room, true));
  out += fmt::format(
      "<text class=\"verdict\" x=\"{}\" y=\"66\" font-size=\"{}\" fill=\"{}\">"
      "<tspan font-weight=\"bold\" fill=\"{}\">{}</tspan><tspan dx=\"{}\">{}</tspan></text>\n",
      number(kCardMargin), number(kVerdictFont), kInk, hex(line.color), verdict, number(kGap),
      escape(fit_text(line.essence, kVerdictFont, essence_room)));
  return out;
}

Legend draw_legend(const Scene& scene) {
  if (!scene.figure.has_legend) {
    return {.text = {}, .height = kCardMargin / 2};
  }
  const double top = scene.drawing.bottom + 8;
  const double right = scene.card_width - kCardMargin;
  std::string out = "<g class=\"legend\">\n";
  out += fmt::format("<path stroke=\"#e3e5e4\" d=\"M{} {}H{}\"/>\n", number(kCardMargin),
                     number(top - 8), number(right));
  double left = kCardMargin;
  double bottom = top;
  if (has_meaning(scene, Meaning::kLoad)) {
    out += legend_text({left, top + 16}, "share of the connection's strength");
    out += draw_bar(scene, {left, top + 24});
    left += kBarWidth + 42;
    bottom = top + 64;
  }
  bottom = std::max(bottom, draw_entries(entries(scene), {left, top + 8}, right, out));
  return {.text = out + "</g>\n", .height = bottom + 14 - scene.drawing.bottom};
}

}  // namespace holdfast::io
