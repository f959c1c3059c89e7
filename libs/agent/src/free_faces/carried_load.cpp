// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/free_faces/carried_load.hpp"

namespace holdfast::agent {
namespace {

double strength_of(const Setup& setup, base::Direction direction) {
  return base::is_vertical(direction) ? setup.strength_vertical_n : setup.strength_lateral_n;
}

MiddleLoad added_load(const Setup& setup, const base::Cell& cell, base::Direction direction,
                      const PlanePoint& place) {
  const base::Vec6<double> local = added_force(setup, cell, direction, place);
  return {.axial_n = local[2], .bending_x_nmm = local[3], .bending_y_nmm = local[4]};
}

/// The index of a term, by kind of connection, axis and sign.
int term_index(bool is_vertical, bool along_y, bool is_rising) {
  return (is_vertical ? 4 : 0) + (along_y ? 2 : 0) + (is_rising ? 1 : 0);
}

double slope_of(const Setup& setup, bool is_vertical) {
  return 2 * setup.weight_n /
         (setup.facet_mm * (is_vertical ? setup.strength_vertical_n : setup.strength_lateral_n));
}

void raise(float& largest, double value) { largest = larger(largest, static_cast<float>(value)); }

}  // namespace

PlanePoint centre_of(const Setup& setup, const base::Cell& cell) {
  return {setup.section.length * cell.x, setup.section.length * cell.y};
}

base::Vec6<double> added_force(const Setup& setup, const base::Cell& cell,
                               base::Direction direction, const PlanePoint& place) {
  const PlanePoint outer = centre_of(setup, cell);
  const PlanePoint inner = centre_of(setup, base::neighbour(cell, direction));
  const double x = place.x - (outer.x + inner.x) / 2;
  const double y = place.y - (outer.y + inner.y) / 2;
  const double weight = setup.weight_n;
  return mechanics::to_local<double>(direction,
                                     base::Vec6<double>{0, 0, -weight, -weight * y, weight * x, 0});
}

void CarriedLoad::take_first(const base::Vec6<float>& part) {
  for (std::size_t i = 0; i < part.size(); ++i) {
    terms_[i] = part[i];
  }
}

void CarriedLoad::take_last(const base::Vec6<float>& part) {
  for (std::size_t i = 6; i < terms_.size(); ++i) {
    terms_[i] = part[i - 6];
  }
}

void CarriedLoad::pass(const Setup& setup, const base::Cell& cell, base::Direction direction,
                       const MiddleLoad& now) {
  const MiddleLoad at_root = added_load(setup, cell, direction, {0, 0});
  const MiddleLoad east = added_load(setup, cell, direction, {1, 0});
  const MiddleLoad north = added_load(setup, cell, direction, {0, 1});
  const double axial = now.axial_n + at_root.axial_n;
  const double strength = strength_of(setup, direction);
  const auto add = [&](double bending, double per_x, double per_y) {
    for (const double sign : {-1.0, 1.0}) {
      const double ratio = (2 * sign * bending / setup.facet_mm + axial) / strength;
      const double rise = sign * (per_x + per_y);  // One of them is zero, or both.
      const std::size_t term = rise == 0 ? kTermCount - 1
                                         : static_cast<std::size_t>(term_index(
                                               base::is_vertical(direction), per_y != 0, rise > 0));
      raise(terms_[term], ratio);
    }
  };
  add(now.bending_x_nmm + at_root.bending_x_nmm, east.bending_x_nmm - at_root.bending_x_nmm,
      north.bending_x_nmm - at_root.bending_x_nmm);
  add(now.bending_y_nmm + at_root.bending_y_nmm, east.bending_y_nmm - at_root.bending_y_nmm,
      north.bending_y_nmm - at_root.bending_y_nmm);
}

double CarriedLoad::ratio_with(const Setup& setup, const base::Cell& cell) const {
  const PlanePoint place = centre_of(setup, cell);
  auto largest = static_cast<double>(terms_.back());
  for (const bool is_vertical : {false, true}) {
    const double slope = slope_of(setup, is_vertical);
    for (const bool along_y : {false, true}) {
      for (const bool is_rising : {false, true}) {
        const auto term = static_cast<std::size_t>(term_index(is_vertical, along_y, is_rising));
        const double way = (along_y ? place.y : place.x) * (is_rising ? slope : -slope);
        const double ratio = static_cast<double>(terms_[term]) + way;
        largest = ratio > largest || ratio != ratio ? ratio : largest;
      }
    }
  }
  return largest;
}

double hanging_ratio(const Setup& setup, base::Direction direction) {
  // The new module is the outer one.
  const base::Cell cell = {};
  CarriedLoad load;
  load.pass(setup, cell, direction, {});
  return load.ratio_with(setup, cell);
}

}  // namespace holdfast::agent
