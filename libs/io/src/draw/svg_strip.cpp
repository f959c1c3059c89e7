// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <vector>

#include "draw/svg_parts.hpp"
#include "holdfast/host/text.hpp"
#include "holdfast/io/picture.hpp"
#include "holdfast/io/report.hpp"

namespace holdfast::io {
namespace {

constexpr double kStripWidth = 1100;
constexpr double kTitleHeight = 52;
constexpr double kCaptionHeight = 44;
constexpr double kGap = 12;
constexpr double kFrameHeightMax = 420;

/// How frames are laid out in rows.
struct Rows {
  std::size_t column_count;
  double frame_width;
  double frame_height;  ///< Without the caption.

  ScreenPoint corner(std::size_t frame) const {
    const std::size_t row = frame / column_count;
    return {kGap + static_cast<double>(frame % column_count) * (frame_width + kGap),
            kTitleHeight + static_cast<double>(row) * (frame_height + kCaptionHeight)};
  }
};

std::size_t column_count_of(std::size_t frame_count) {
  constexpr std::size_t kFew = 4;
  constexpr std::size_t kMany = 6;
  return frame_count <= kFew ? frame_count : frame_count <= kFew * 3 ? kFew : kMany;
}

std::string caption_of(const StripFrame& frame) {
  return frame.step == 0 ? "start" : fmt::format("after step {}", frame.step - 1);
}

std::string draw_caption(const Scene& scene, const StripFrame& frame, ScreenPoint at,
                         double width) {
  const Headline line = headline(scene);
  const auto& ratio = scene.assessment.load_ratio_max;
  const std::string load =
      ratio ? "  " + ratio_text(*ratio, !scene.assessment.broken.empty()) : std::string();
  return fmt::format(
      "<text x=\"{0}\" y=\"{1}\" text-anchor=\"middle\" font-size=\"12\" fill=\"{2}\">{3}</text>\n"
      "<text x=\"{0}\" y=\"{4}\" text-anchor=\"middle\" font-size=\"12\" fill=\"{5}\">"
      "<tspan font-weight=\"bold\">{6}</tspan>{7}</text>\n",
      number(at.x + width / 2), number(at.y + 15), kInkSoft, escape(caption_of(frame)),
      number(at.y + 30), hex(line.color), line.verdict, load);
}

std::string draw_frame(const Scene& scene, const StripFrame& frame, ScreenPoint corner,
                       const Rows& rows) {
  std::string out = fmt::format("<g class=\"frame\"><title>{}: {}</title>\n",
                                escape(caption_of(frame)), escape(headline(scene).essence));
  for (const auto& part : {draw_ground(scene), draw_modules(scene), draw_facets(scene),
                           draw_balance(scene), draw_payloads(scene)}) {
    out += part;
  }
  return out +
         draw_caption(scene, frame, corner + ScreenPoint{0, rows.frame_height}, rows.frame_width) +
         "</g>\n";
}

}  // namespace

std::string write_strip_svg(std::span<const StripFrame> frames, std::string_view title,
                            const FigureOptions& figure) {
  std::deque<Scene> scenes;  // Scenes do not move.
  for (const StripFrame& frame : frames) {
    scenes.emplace_back(*frame.robot, *frame.assessment, frame.obstacles, figure);
  }
  Rows rows{.column_count = column_count_of(frames.size()), .frame_width = 0, .frame_height = 0};
  const auto columns = static_cast<double>(rows.column_count);
  rows.frame_width = (kStripWidth - kGap * (columns + 1)) / columns;
  rows.frame_height = scale_alike(scenes, rows.frame_width, kFrameHeightMax);
  std::string body;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    place_frame(scenes[i], rows.corner(i), rows.frame_width, rows.frame_height);
    body += draw_frame(scenes[i], frames[i], rows.corner(i), rows);
  }
  const std::size_t row_count = (frames.size() + rows.column_count - 1) / rows.column_count;
  const double height = rows.corner(row_count * rows.column_count).y + kGap;
  const std::string_view name = figure.title.empty() ? title : std::string_view(figure.title);
  return finished(
      fmt::format(
          "<svg xmlns=\"http://www.w3.org/2000/svg\" {6} viewBox=\"0 0 {0} {1}\" role=\"img\" "
          "font-family=\"sans-serif\">\n<title>{2}</title>\n"
          "<desc>{3} of a sequence of steps. {7}.</desc>\n<rect class=\"card\" width=\"{0}\" "
          "height=\"{1}\" fill=\"{4}\"/>\n<text class=\"title\" x=\"{8}\" y=\"32\" "
          "font-size=\"18\" font-weight=\"bold\" fill=\"{9}\">{10}</text>\n{5}</svg>\n",
          number(kStripWidth), number(height), escape(name), host::counted(frames.size(), "state"),
          kCardFill, body, size_attributes(figure, kStripWidth, height), view_name(figure.view),
          number(kGap), kInk, escape(fit_text(name, 18, kStripWidth - 2 * kGap, true))),
      figure);
}

}  // namespace holdfast::io
