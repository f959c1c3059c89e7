// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/free_faces/carried_load.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/cell.hpp"

/// A way from a support outward, as one module after the other continues it, and what the robot
/// would carry with one more module beyond its end.
///
/// Connections that alone hold what is beyond them carry the new weight by statics. Where there are
/// several ways to supports the weight is shared, and nobody knows how without solving; but if it
/// all went this way, that would be forces G in equilibrium with it. Of all such forces those that
/// the robot adopts, dF, have the least energy, so that (dF, dF - G) = 0 in its product: dF lies on
/// the sphere whose diameter is G [Prager, Synge 1947],
///
///   |dF - G / 2| = |G| / 2.
///
/// A load ratio is convex, and grows by no more than kappa |f| with forces f of the energy |f|^2.
/// So of every connection it is at most (r + r_G) / 2 + kappa |G| / 2, r being what it is now and
/// r_G what it would be if all went this way; and so is the tension at the edge of a facet. G and
/// its energy, which is a square of x and y, are known along the way: connections that hold alone
/// what is beyond them have no part in it, as nothing is shared there.
///
/// It holds as long as the robot is linear: all facets press all over and still do then.
namespace holdfast::agent {

class LoadWay {
 public:
  /// A way has so many parts of six reals if it is certain, and so many otherwise.
  static constexpr int kCertainParts = 2;
  static constexpr int kParts = 6;

  /// Begins at a support that carries by statics what comes: a fixed module, the only foot.
  static LoadWay certain();

  /// Begins at one foot of several, at `cell` from the root's; `now` is in the middle between its
  /// centre and the ground's node.
  static LoadWay from_foot(const Setup& setup, const base::Cell& cell, const MiddleLoad& now);

  /// The way goes on from a module at `cell` (from the root's), the outer one, in `direction` to
  /// the inner one. `is_alone`: this connection alone holds what is beyond it.
  void pass(const Setup& setup, const base::Cell& cell, base::Direction direction,
            const MiddleLoad& now, bool is_alone);

  /// Does every connection of the way hold alone what is beyond it, and the support as well?
  bool is_certain() const { return is_certain_; }

  /// The largest load ratio of the connections that hold alone what is beyond them, with one more
  /// module at `cell`, from the root's.
  double alone_with(const Setup& setup, const base::Cell& cell) const {
    return alone_.ratio_with(setup, cell);
  }

  /// A bound on that of all others in the robot; `ratio` is their largest now.
  double bound_with(const Setup& setup, const base::Cell& cell, double ratio) const;

  /// A bound on the tension at the edge of any facet, in N, negative where all press all over;
  /// `margin_n` is the least pressure at an edge now.
  double tension_with(const Setup& setup, const base::Cell& cell, double margin_n) const;

  // ---- As parts of a message; `elsewhere` goes with them.

  base::Vec6<float> part(int index, float elsewhere) const;

  /// Parts come in their order. Returns `elsewhere` with the second one.
  float take_part(int index, const base::Vec6<float>& part);

  /// How many parts there are, once the second one is here.
  int part_count() const { return is_certain_ ? kCertainParts : kParts; }

 private:
  static std::int32_t place_of(float real);
  double energy_with(const Setup& setup, const base::Cell& cell) const;
  void add_energy(const Setup& setup, const base::Cell& cell, base::Direction direction);

  bool is_certain_ = true;
  CarriedLoad alone_;
  CarriedLoad shared_;
  /// Terms of the energy: 1, x, y, x^2, x y, y^2, with x and y in mm from the root's centre.
  std::array<double, 6> energy_{};
  bool has_foot_ = false;
  std::array<std::int32_t, 2> foot_{};  ///< Its cell, from the root's.
  MiddleLoad foot_load_;
};

}  // namespace holdfast::agent
