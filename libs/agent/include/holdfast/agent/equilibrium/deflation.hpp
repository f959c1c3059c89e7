// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/cells/lattices.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/base/algebra.hpp"

/// The slow modes of a robot that grows, from how it has moved before.
///
/// What M^-1 by a polynomial leaves to do are a few modes that bend the whole robot: a module far
/// away from them excites them by its weight alone, so the changes of displacement w_j of the last
/// steps have them in them. Modules keep those, and iterations use
///   M^-1 + W E^-1 W',     E = W' K W                                                     (1)
/// in the place of M^-1 [Nicolaides 1987; Saad 2000], added: symmetric and positive as
/// before, and modes in the span of W have eigenvalues near 1 instead of near 0.
///
/// All of it is the root's work. With M^-1 r = (by the polynomial) + W g, g = E^-1 W' r, a
/// direction p is what modules know of it and W h; h follows the recurrence of p
/// (minimal_residuals.hpp). Modules add up W' r with every report, and an order says how far to
/// move along W. E they add up when a solve begins, as the robot has grown since the last one.
///
/// What is kept of a solve is what it has found behind the polynomial's first correction, w - M^-1
/// K w, which has little of the modes that need no help. It is no more than a part of M^-1:
/// iterations and their error bounds hold for any.
namespace holdfast::agent {

/// The root's part.
class Deflation {
 public:
  /// Nothing that is kept is of use.
  void forget() { *this = Deflation(); }

  /// A solve goes on from the last one: in whose place its change is kept, which is the least
  /// useful; wire::kKeptMax: nowhere.
  std::uint8_t place();

  /// The solve begins with the products W' r, and with E.
  void begin(const Along<float>& residual, const Energies& energies);

  /// A solve has ended after so many iterations; 0: its change is of no use. One that is the first
  /// of a round says nothing of how many it takes.
  void end(std::uint32_t iterations, bool is_resumed);

  /// Does the next solve use what is kept? It makes messages longer, so it has to pay.
  bool is_used() const { return is_used_; }

  // Iterations, as modules take them.

  /// The W' r of an iteration's residual completes the products (r, p), (q, p), (q_older, p).
  void complete(const Along<float>& residual, std::array<double, 3>& products);

  /// The next one is M^-1 r itself: how far it goes along W.
  Along<float> restart();

  /// Iterations go along nothing, until the next restart().
  void rest() { newer_ = older_ = {}; }

  /// How far to go from u + a (p - c p_older) + b p_older + M^-1 (r - a q - b q_older).
  Along<float> minimise(double c, double a, double b);

 private:
  struct Direction {
    Along<double> h{};  ///< Its part along W.
    Along<double> q{};  ///< W' q
  };

  void factor();
  void use(std::uint8_t change);
  bool uses(std::size_t change) const;
  int kept_count() const;
  Along<double> solve(const Along<double>& sums) const;

  std::array<Along<double>, wire::kKeptMax> energy_{};  ///< E
  std::array<Along<double>, wire::kKeptMax> factor_{};  ///< Rows of its Cholesky factor, ...
  std::array<std::uint8_t, wire::kKeptMax> used_{};     ///< ... of these changes.
  std::uint8_t count_ = 0;                              ///< So many are used.
  /// When each has come, the last one the greatest; 0: it is not kept.
  std::array<std::uint32_t, wire::kKeptMax> time_{};
  std::uint32_t now_ = 0;
  bool has_new_ = false;  ///< The last solve's change is to be kept.
  bool is_used_ = false;
  std::uint32_t plain_ = 0;   ///< Iterations of the last solve that has used nothing.
  Along<double> residual_{};  ///< W' r of the last residual r, ...
  Along<double> reduced_{};   ///< ... and of r - a q - b q_older, from which the last move came.
  Direction newer_;
  Direction older_;
};

/// What a module keeps, lent (LentMemory).
struct KeptChanges {
  /// The changes that are kept; the last one is that of the solve that goes on.
  std::array<base::Vec6<float>, wire::kKeptMax + 1> changes{};
  Energies energies{};     ///< This module's part of E.
  bool has_begun = false;  ///< Equilibria have begun: what neighbours say comes too late.
  Faces heard;             ///< A module that has come: whose changes have added to its own.
  Deflation deflation;     ///< The root's.
};

}  // namespace holdfast::agent
