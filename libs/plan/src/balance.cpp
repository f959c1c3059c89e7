// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "balance.hpp"

#include <algorithm>
#include <cmath>

#include "holdfast/base/lattice.hpp"

namespace holdfast::plan {

Balance::Balance(const model::Robot& target)
    : has_facet_(target.modules().size()),
      standing_(target.modules().size()),
      half_width_(target.foot_half_width_mm() / target.material().pitch_mm) {
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    const auto place = base::node_place(target.lattice(), target.modules()[i].cell);
    places_.push_back({place[0], place[1]});
    masses_.push_back(target.mass(i));
  }
  for (const model::Facet& facet : target.facets()) {
    has_facet_[base::at(facet.module)] = true;
  }
}

void Balance::change(Element module, int by) {
  const std::size_t i = base::at(module);
  mass_ += by * masses_[i];
  moment_.x += by * masses_[i] * places_[i].x;
  moment_.y += by * masses_[i] * places_[i].y;
  if (!has_facet_[i]) {
    return;
  }
  standing_[i] += by;
  if (by > 0 && !is_hull_stale_) {
    hull_ = hull_with(i);
  } else {
    is_hull_stale_ = true;
  }
}

void Balance::put_corners(std::size_t module, std::vector<Point>& points) const {
  for (const double side : {-half_width_, half_width_}) {
    points.push_back({places_[module].x + side, places_[module].y - half_width_});
    points.push_back({places_[module].x + side, places_[module].y + half_width_});
  }
}

/// Andrew's monotone chain, counter-clockwise.
std::vector<Balance::Point> Balance::hull_around(std::vector<Point> points) {
  std::ranges::sort(
      points, [](const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  const auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  std::vector<Point> hull;
  for (int pass = 0; pass < 2 && !points.empty(); ++pass) {
    const std::size_t start = hull.size();
    for (const Point& point : points) {
      while (hull.size() >= start + 2 && turn(hull[hull.size() - 2], hull.back(), point) <= 0) {
        hull.pop_back();
      }
      hull.push_back(point);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The hull of what stands, but for one module.
std::vector<Balance::Point> Balance::hull_without(std::size_t module) const {
  std::vector<Point> points;
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    if (standing_[i] > 0 && i != module) {
      put_corners(i, points);
    }
  }
  return hull_around(std::move(points));
}

/// The hull with one more module; the present hull stands for all others.
std::vector<Balance::Point> Balance::hull_with(std::size_t module) const {
  std::vector<Point> points = hull_;
  put_corners(module, points);
  return hull_around(std::move(points));
}

double Balance::margin_of(const std::vector<Point>& hull, double mass, double x, double y) const {
  if (hull.empty()) {
    return -std::numeric_limits<double>::infinity();
  }
  double margin = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Point& a = hull[i];
    const Point& b = hull[(i + 1) % hull.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const double across = (b.x - a.x) * (y / mass - a.y) - (b.y - a.y) * (x / mass - a.x);
    margin = std::min(margin, across / length);
  }
  return margin;
}

double Balance::margin() {
  if (is_hull_stale_) {
    hull_ = hull_without(places_.size());
    is_hull_stale_ = false;
  }
  return margin_of(hull_, mass_, moment_.x, moment_.y);
}

double Balance::margin_with_parts(std::span<const Element> modules) {
  margin();
  double smallest = hull_.empty() ? -std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull_.size(); ++i) {
    const Point& a = hull_[i];
    const Point& b = hull_[(i + 1) % hull_.size()];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    const auto inside = [&](double x, double y) {
      return ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / length;
    };
    std::vector<std::pair<double, double>> coming;  // How far inside, and the mass.
    for (const Element module : modules) {
      const Point& place = places_[base::at(module)];
      coming.emplace_back(inside(place.x, place.y), masses_[base::at(module)]);
    }
    std::ranges::sort(coming);
    double mass = mass_;
    double margin = inside(moment_.x / mass, moment_.y / mass);
    for (const auto& [distance, more] : coming) {
      if (distance < margin) {  // What lies farther outside than the mean draws it there.
        margin = (margin * mass + distance * more) / (mass + more);
        mass += more;
      }
    }
    smallest = std::min(smallest, margin);
  }
  return smallest;
}

bool Balance::stands_with(Element module) {
  const std::size_t i = base::at(module);
  const double mass = mass_ + masses_[i];
  const double x = moment_.x + masses_[i] * places_[i].x;
  const double y = moment_.y + masses_[i] * places_[i].y;
  margin();
  return margin_of(hull_, mass, x, y) > 0 ||
         (has_facet_[i] && margin_of(hull_with(i), mass, x, y) > 0);
}

bool Balance::stands_without(Element module) {
  const std::size_t i = base::at(module);
  const double mass = mass_ - masses_[i];
  const double x = moment_.x - masses_[i] * places_[i].x;
  const double y = moment_.y - masses_[i] * places_[i].y;
  margin();
  return margin_of(hull_, mass, x, y) > 0 &&
         (!has_facet_[i] || margin_of(hull_without(i), mass, x, y) > 0);
}

}  // namespace holdfast::plan
