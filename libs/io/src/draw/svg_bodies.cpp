// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "draw/svg_parts.hpp"

namespace holdfast::io {
namespace {

/// Below this size bodies are drawn as the pixels that they fill: there may be a million.
constexpr double kBodyPxMin = 2.5;

constexpr Color kObstacleColor = {.red = 128, .green = 138, .blue = 146};

Color obstacle_color(bool is_bonded) { return is_bonded ? kFixedColor : kObstacleColor; }

/// A polygon that is drawn many times: the path of one whose first corner is at a given place.
class Stamp {
 public:
  Stamp(const std::vector<ScreenPoint>& corners, double edge_px)
      : first_(edge_px * corners.front()) {
    Path path;
    path.move_to({});
    for (std::size_t i = 1; i < corners.size(); ++i) {
      path.line_to(edge_px * corners[i] - first_);
    }
    path.close();
    tail_ = path.text().substr(path.text().find('l'));
  }

  std::string path_at(ScreenPoint centre) const {
    Path path;
    path.move_to(centre + first_);
    return path.text() + tail_;
  }

 private:
  ScreenPoint first_;
  std::string tail_;
};

std::vector<Stamp> stamps(std::span<const SeenFace> faces, double edge_px) {
  std::vector<Stamp> all;
  for (const SeenFace& face : faces) {
    all.emplace_back(face.corners, edge_px);
  }
  return all;
}

Color module_color(const Scene& scene, std::size_t module) {
  const Color color = scene.color_of(scene.paints[module]);
  return scene.robot.modules()[module].is_planned ? lightened(color, kGlassLightness) : color;
}

std::string circle(ScreenPoint centre, double radius, std::string_view attributes) {
  return fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\" {}/>\n", number(centre.x),
                     number(centre.y), number(radius), attributes);
}

/// Draws a ball in the light from above and from the left: a dark edge on the right, and a spot
/// where it shines. The circles have one colour each, as gradients would need names.
std::string draw_ball(ScreenPoint centre, double radius, Color color, bool is_detailed) {
  const auto inner = [&](double share, double aside, Color fill) {
    return circle(centre + ScreenPoint{-0.75 * aside * radius, -aside * radius}, share * radius,
                  fmt::format("fill=\"{}\" stroke=\"none\"", hex(fill)));
  };
  std::string out =
      circle(centre, radius, fmt::format("fill=\"{}\"", hex(shaded(color, Place{1, 0, 0}))));
  out += inner(0.82, 0.1, color);
  if (is_detailed) {
    out += inner(0.52, 0.25, lightened(color, 20));
    out += inner(0.15, 0.42, lightened(color, 65));
  }
  return out;
}

class Painter {
 public:
  explicit Painter(const Scene& scene)
      : scene_(scene),
        view_(*scene.bodies),
        edge_px_(scene.projection.edge_px),
        module_stamps_(stamps(view_.module_faces(), edge_px_)),
        obstacle_stamps_(stamps(view_.obstacle_faces(), edge_px_)) {}

  std::string draw() const {
    const double width = std::clamp(edge_px_ * 0.025, 0.2, 1.1) * (scene_.is_detailed() ? 1 : 0.6);
    std::string out = fmt::format(
        "<g class=\"modules\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\">\n", kInk,
        number(width));
    const BodyItem* last = nullptr;
    for (const BodyItem& item : view_.items()) {
      // Obstacles without a module in between are one pane of glass.
      const bool was_pane = last != nullptr && last->is_obstacle;
      const bool continues = was_pane && item.is_obstacle && item.layer == last->layer;
      out += was_pane && !continues ? "</g>\n" : "";
      if (item.is_obstacle) {
        out += continues ? "" : "<g class=\"obstacles\" opacity=\"0.35\">\n";
        out += draw_obstacle(item);
      } else {
        out += draw_module(item);
      }
      last = &item;
    }
    out += last != nullptr && last->is_obstacle ? "</g>\n" : "";
    return out + "</g>\n";
  }

 private:
  ScreenPoint centre_of(const BodyItem& item) const {
    return scene_.projection.at(LatticePoint(view_.place_of(item)));
  }

  std::string draw_module(const BodyItem& item) const {
    const Color color = module_color(scene_, item.index);
    const ScreenPoint centre = centre_of(item);
    std::string body;
    if (view_.body() == Body::kBall) {
      body = draw_ball(centre, kBallRadius * edge_px_, color, scene_.is_detailed());
    }
    for (std::size_t face = 0; face < module_stamps_.size(); ++face) {
      if ((item.hidden_faces >> face & 1U) == 0) {
        body += fmt::format("<path fill=\"{}\" d=\"{}\"/>\n",
                            hex(shaded(color, view_.module_faces()[face].normal)),
                            module_stamps_[face].path_at(centre));
      }
    }
    const bool is_planned = scene_.robot.modules()[item.index].is_planned;
    if (!is_planned && !scene_.is_detailed()) {
      return body;
    }
    const std::string glass = is_planned ? fmt::format(" opacity=\"{}\" stroke-dasharray=\"{}\"",
                                                       scene_.glass(), number(edge_px_ / 10))
                                         : std::string();
    const std::string title = scene_.is_detailed() ? fmt::format("<title>{}</title>\n",
                                                                 module_tooltip(scene_, item.index))
                                                   : std::string();
    return fmt::format("<g class=\"{}module\"{}>{}{}</g>\n", is_planned ? "planned-" : "", glass,
                       title, body);
  }

  std::string draw_obstacle(const BodyItem& item) const {
    const bool is_bonded = view_.obstacles().cells[item.index].is_bonded;
    std::string out;
    for (std::size_t face = 0; face < obstacle_stamps_.size(); ++face) {
      if ((item.hidden_faces >> face & 1U) == 0) {
        const Color color = shaded(obstacle_color(is_bonded), view_.obstacle_faces()[face].normal);
        out += fmt::format("<path class=\"obstacle\" fill=\"{}\" stroke=\"{}\" d=\"{}\"/>\n",
                           hex(lightened(color, 30)), hex(color),
                           obstacle_stamps_[face].path_at(centre_of(item)));
      }
    }
    return out;
  }

  const Scene& scene_;
  const BodyView& view_;
  double edge_px_;
  std::vector<Stamp> module_stamps_;
  std::vector<Stamp> obstacle_stamps_;
};

/// Bodies of a pixel or two, as the colours of all pixels.
class PixelPainter {
 public:
  explicit PixelPainter(const Scene& scene)
      : scene_(scene),
        view_(*scene.bodies),
        width_(static_cast<std::size_t>(scene.drawing.right - scene.drawing.left)),
        height_(static_cast<std::size_t>(scene.drawing.bottom - scene.drawing.top)),
        pixels_(width_ * height_) {}

  std::string draw() {
    for (const BodyItem& item : view_.items()) {
      const Color color = item.is_obstacle
                              ? lightened(obstacle_color(false), 60)
                              : shaded(module_color(scene_, item.index), Place{0, 0, 0.3});
      fill(scene_.projection.at(LatticePoint(view_.place_of(item))), color);
    }
    std::map<std::tuple<int, int, int>, PathElements> paths;
    for (std::size_t row = 0; row < height_; ++row) {
      add_row(row, paths);
    }
    std::string out = "<g class=\"modules\" shape-rendering=\"crispEdges\">\n";
    for (auto& [color, elements] : paths) {
      out += elements.text();
    }
    return out + "</g>\n";
  }

 private:
  /// The pixels whose middles are within the body's circle, and the one in which its node lies.
  void fill(ScreenPoint centre, Color color) {
    const ScreenPoint at = centre - ScreenPoint{scene_.drawing.left, scene_.drawing.top};
    const double radius = kBallRadius * scene_.projection.edge_px;
    const auto first = [&](double middle) {
      return static_cast<std::size_t>(std::max(0.0, std::floor(middle - radius)));
    };
    for (std::size_t y = first(at.y); y < height_ && static_cast<double>(y) < at.y + radius; ++y) {
      for (std::size_t x = first(at.x); x < width_ && static_cast<double>(x) < at.x + radius; ++x) {
        const ScreenPoint way = ScreenPoint{static_cast<double>(x), static_cast<double>(y)} - at;
        const bool has_node = way.x <= 0 && way.x > -1 && way.y <= 0 && way.y > -1;
        if (has_node || length(way + ScreenPoint{0.5, 0.5}) <= radius) {
          pixels_[y * width_ + x] = color;
        }
      }
    }
  }

  void add_row(std::size_t row, std::map<std::tuple<int, int, int>, PathElements>& paths) const {
    const auto* const begin = pixels_.data() + row * width_;
    for (std::size_t x = 0; x < width_;) {
      std::size_t end = x + 1;
      while (end < width_ && begin[end] == begin[x]) {
        ++end;
      }
      if (const std::optional<Color>& color = begin[x]) {
        const auto found = paths.try_emplace({color->red, color->green, color->blue},
                                             fmt::format("fill=\"{}\"", hex(*color)));
        add_run(found.first->second, {static_cast<double>(x), static_cast<double>(row)},
                static_cast<double>(end - x));
      }
      x = end;
    }
  }

  void add_run(PathElements& paths, ScreenPoint at, double run) const {
    const ScreenPoint start = at + ScreenPoint{scene_.drawing.left, scene_.drawing.top};
    Path& path = paths.next();
    path.move_to(start);
    path.line_to(start + ScreenPoint{run, 0});
    path.line_to(start + ScreenPoint{run, 1});
    path.line_to(start + ScreenPoint{0, 1});
    path.close();
  }

  const Scene& scene_;
  const BodyView& view_;
  std::size_t width_;
  std::size_t height_;
  std::vector<std::optional<Color>> pixels_;
};

}  // namespace

std::string draw_bodies(const Scene& scene) {
  if (scene.projection.edge_px < kBodyPxMin) {
    return PixelPainter(scene).draw();
  }
  return Painter(scene).draw();
}

std::vector<ObstacleSign> obstacle_signs(const Scene& scene) {
  std::vector<ObstacleSign> signs;
  if (!scene.bodies) {
    return signs;
  }
  const auto& [cells, are_too_many] = scene.bodies->obstacles();
  for (const bool is_bonded : {false, true}) {
    if (std::ranges::find(cells, is_bonded, &ObstacleCell::is_bonded) != cells.end()) {
      signs.push_back({.label = is_bonded ? "obstacle, bonded" : "obstacle",
                       .color = obstacle_color(is_bonded)});
    }
  }
  if (are_too_many) {
    signs.push_back({.label = "obstacles, too many to be drawn", .color = kObstacleColor});
  }
  return signs;
}

}  // namespace holdfast::io
