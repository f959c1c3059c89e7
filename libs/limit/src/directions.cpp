// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "directions.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace holdfast::limit {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

Directions::Directions() {
  constexpr int kFirst = 8;
  for (int i = 0; i < kFirst; ++i) {
    angles_.push_back(i * kTurn / kFirst);
  }
}

std::vector<Directions::Corner> Directions::corners(Side side) const {
  std::vector<Corner> corners;
  for (std::size_t i = 0; i < angles_.size(); ++i) {
    if (side == Side::kWithin) {
      corners.push_back({.angle = angles_[i]});
      continue;
    }
    const double next = i + 1 < angles_.size() ? angles_[i + 1] : angles_[0] + kTurn;
    const double half = (next - angles_[i]) / 2;
    corners.push_back({.angle = angles_[i] + half, .radius = 1 / std::cos(half)});
  }
  return corners;
}

void Directions::add(double angle) {
  constexpr double kSame = 1e-6;
  const double place = angle - kTurn * std::floor(angle / kTurn);
  const auto next = std::ranges::lower_bound(angles_, place);
  const double above = next != angles_.end() ? *next : angles_[0] + kTurn;
  const double below = next != angles_.begin() ? *(next - 1) : angles_.back() - kTurn;
  if (above - place > kSame && place - below > kSame) {
    insert(place);
    return;
  }
  // Known: look closer on both sides.
  const double known = above - place <= kSame ? above : below;
  const auto at = std::ranges::lower_bound(angles_, known >= kTurn ? known - kTurn : known);
  const double after = at + 1 != angles_.end() ? *(at + 1) : angles_[0] + kTurn;
  const double before = at != angles_.begin() ? *(at - 1) : angles_.back() - kTurn;
  const double middle = *at;
  insert((middle + after) / 2);
  insert((middle + before) / 2);
}

void Directions::insert(double angle) {
  angle -= kTurn * std::floor(angle / kTurn);
  constexpr double kNearest = 1e-5;
  const auto next = std::ranges::lower_bound(angles_, angle);
  const bool is_near = (next != angles_.end() && *next - angle < kNearest) ||
                       (next != angles_.begin() && angle - *(next - 1) < kNearest);
  if (!is_near) {
    angles_.insert(next, angle);
  }
}

}  // namespace holdfast::limit
