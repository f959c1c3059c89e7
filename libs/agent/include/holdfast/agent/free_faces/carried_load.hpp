// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/base/cell.hpp"

/// What the connections on the way from a support outward would carry with the weight of one more
/// module somewhere beyond them.
///
/// A connection that alone holds all that is beyond it carries the weight w of a module centred at
/// (x, y) by statics: mx and my in its middle change by -w (y - y_e) and w (x - x_e), fz by -w, 0
/// or w. So each of the four terms (+-2 mx / a + fz) / Fmax, (+-2 my / a + fz) / Fmax whose largest
/// is the load ratio, Eq. (17), is linear in one of x and y, with one of four slopes: plus or minus
/// 2 w / (a Fmax) of a vertical or a lateral connection. Of all terms with the same slope along the
/// same axis the one that is largest anywhere is largest everywhere: eight numbers say what a whole
/// way would carry, however long it is, and nothing is lost.
namespace holdfast::agent {

/// A point of the horizontal plane, mm from the root's centre.
struct PlanePoint {
  double x = 0;
  double y = 0;
};

/// The centre of a cell that is counted from the root's.
PlanePoint centre_of(const Setup& setup, const base::Cell& cell);

/// The force that the weight of a module at `place` adds in the middle of the connection of the
/// module at `cell`, the outer one, with its neighbour in `direction`, if all goes this way: local
/// frame, N and N mm.
base::Vec6<double> added_force(const Setup& setup, const base::Cell& cell,
                               base::Direction direction, const PlanePoint& place);

class CarriedLoad {
 public:
  static constexpr int kTermCount = 9;

  /// The terms with a slope at the root's cell, by kind of connection, axis and sign, and the
  /// largest of those without.
  using Terms = std::array<float, kTermCount>;

  CarriedLoad() { terms_.fill(kNoLoadRatio); }

  const Terms& terms() const { return terms_; }

  /// Takes from a message the first six terms, and with the other half the last three.
  void take_first(const base::Vec6<float>& part);
  void take_last(const base::Vec6<float>& part);

  /// The way goes on: from a module at `cell` (from the root's), the outer one, in `direction` to
  /// the inner one, and what that connection carries now.
  void pass(const Setup& setup, const base::Cell& cell, base::Direction direction,
            const MiddleLoad& now);

  /// The largest load ratio on the way with one more module at `cell`, from the root's.
  double ratio_with(const Setup& setup, const base::Cell& cell) const;

 private:
  Terms terms_;
};

/// The load ratio of the connection between a module that comes and its one neighbour in
/// `direction`.
double hanging_ratio(const Setup& setup, base::Direction direction);

}  // namespace holdfast::agent
