// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "shapes/ball_cover.hpp"

#include <algorithm>
#include <cmath>

namespace holdfast::io {
namespace {

/// The nearest balls that cover the disc of one inside a face-centred robot, together, lie within
/// 2.3 pitches of it; with fewer some of it stays, more cost time.
constexpr double kReach = 2.35;  // Pitches.

}  // namespace

BallCover::BallCover(const base::Lattice& lattice, const ViewAxes& axes) : lattice_(lattice) {
  constexpr double kSize = kBallRadius * 2 / kSquaresAcross;
  const auto middle = [](std::size_t i) {
    return (static_cast<double>(i) + 0.5) * kSize - kBallRadius;
  };
  // Calls `set` with every square's place and the distances of its middle from a point.
  const auto for_squares = [&](ScreenPoint from, auto use) {
    for (std::size_t row = 0; row < kSquaresAcross; ++row) {
      for (std::size_t column = 0; column < kSquaresAcross; ++column) {
        use(row * kSquaresAcross + column, std::abs(middle(column) - from.x),
            std::abs(middle(row) - from.y));
      }
    }
  };
  for_squares({}, [&](std::size_t square, double x, double y) {
    disc_[square] =
        length({std::max(x - kSize / 2, 0.0), std::max(y - kSize / 2, 0.0)}) < kBallRadius;
  });
  constexpr std::int32_t kSteps = 4;  // Axial coordinates within kReach are smaller.
  for (std::int32_t i = -kSteps; i <= kSteps; ++i) {
    for (std::int32_t j = -kSteps; j <= kSteps; ++j) {
      for (std::int32_t k = -kSteps; k <= kSteps; ++k) {
        const Place way = base::place_of(lattice, {i, j, k});
        const ScreenPoint at = axes.seen_at(way);
        if (dot(way, way) > kReach * kReach || axes.nearness(way) < 1e-9 ||
            length(at) >= 2 * kBallRadius) {
          continue;
        }
        Blocker blocker = {.step = {i, j, k}, .squares = {}};
        for_squares(at, [&](std::size_t square, double x, double y) {
          blocker.squares[square] = length({x + kSize / 2, y + kSize / 2}) <= kBallRadius;
        });
        blockers_.push_back(blocker);
      }
    }
  }
  std::ranges::sort(blockers_, std::ranges::greater{},
                    [](const Blocker& blocker) { return blocker.squares.count(); });
}

bool BallCover::hides(const model::CellIndex& cells, const base::Cell& cell) const {
  const base::Cell axial = base::axial_of(lattice_, cell);
  Squares left = disc_;
  for (const Blocker& blocker : blockers_) {
    const base::Cell& step = blocker.step;
    const base::Cell there = {axial.x + step.x, axial.y + step.y, axial.z + step.z};
    if (cells.find(base::cell_of(lattice_, there)) != model::CellIndex::kNone) {
      left &= ~blocker.squares;
      if (left.none()) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace holdfast::io
