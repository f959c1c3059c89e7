// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ball.hpp"
#include "holdfast/certificate/certificate.hpp"

/// A robot's connections and facets as springs, and what balances exactly.
///
/// In the middle of a connection a beam is six springs that know nothing of each other. With e the
/// step from module a to module b, U displacements and R rotations (in the room's units),
///   w = [U_b - U_a - (R_a + R_b) x e,  R_b - R_a]     the gap between the two faces
///   s = h w                                          what the connection carries
///   force on a: [s_t, s_r + e x s_t],  on b: [-s_t, -s_r + e x s_t].
/// A facet on the ground is the same with an immobile a, one pitch below.
namespace holdfast::certificate {

constexpr int kZ = 2;

using Springs = std::array<Ball, 6>;

/// The ball of an integer: its nearest double, and the rounding of a sum with zero.
inline Ball ball_of(Integer value) { return Ball(0) + Ball(static_cast<double>(value)); }

struct Beam {
  std::size_t a = 0;
  std::size_t b = 0;
  int axis = 0;
};

/// The constants that follow from the material; h by axis, for facets that of z.
struct Constants {
  explicit Constants(const Material& material);

  std::array<Springs, 3> h;
  Ball facet;                    ///< Half the facet's width over half the pitch,
  bool is_facet_whole = false;   ///< which is exactly 1.
  Ball weakness;                 ///< gamma
  Ball follow;                   ///< (1 - gamma) times `facet`
  std::array<Ball, 3> strength;  ///< Over W, by axis.
};

/// The cells, beams and facets of a robot, and the path by which each module's load reaches the
/// ground.
class Structure {
 public:
  explicit Structure(const Certificate& certificate);

  /// Says why this is no robot, or empty.
  const std::string& fault() const { return fault_; }

  const std::vector<Beam>& beams() const { return beams_; }

  /// Modules on the ground, ascending.
  const std::vector<std::size_t>& facets() const { return facets_; }

  /// The values of link() for a module on the ground, a fixed one, and one that is not reached yet.
  static constexpr std::size_t kFacet = static_cast<std::size_t>(-1);
  static constexpr std::size_t kFixed = static_cast<std::size_t>(-2);
  static constexpr std::size_t kNone = static_cast<std::size_t>(-3);

  /// The beam of every module towards a support, or kFacet or kFixed where it is one.
  const std::vector<std::size_t>& link() const { return link_; }

  /// Every module after the one that its link leads to.
  const std::vector<std::size_t>& order() const { return order_; }

  /// The number of beams from a module to its support.
  const std::vector<std::size_t>& depth() const { return depth_; }

 private:
  void connect(const Certificate& certificate);
  bool plant(const Certificate& certificate, bool is_full_only);
  void grow();

  std::string fault_;
  std::vector<Beam> beams_;
  std::vector<std::size_t> facets_;
  std::vector<std::array<std::size_t, 6>> beams_of_;  ///< By module, kNone where there is none.
  std::vector<std::size_t> link_;
  std::vector<std::size_t> order_;
  std::vector<std::size_t> depth_;
};

/// The gap w of a beam, or of the facet of a module.
Six gap(const Field& field, const Beam& beam);
Six facet_gap(const Field& field, std::size_t module);

/// Adds to a module's force what a beam's spring forces s do to its end b, or a.
void add_at_b(Six& force, const Six& s, int axis);
void add_at_a(Six& force, const Six& s, int axis);

/// The nearest integer forces h w; those that are too large are left at zero and `is_too_large` is
/// set. Any integers would do: how far they are from h w is looked at afterwards.
Six spring_force(const Springs& h, const Six& w, bool& is_too_large);

/// Adds to `energy` the sum of (s - h w)^2 / h.
void add_mismatch(Ball& energy, const Springs& h, const Six& s, const Six& w);

/// Adds to `energy` the sum of s^2 / h.
void add_energy(Ball& energy, const Springs& h, const Six& s);

bool is_small(const Six& six);

}  // namespace holdfast::certificate
