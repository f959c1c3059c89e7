// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// What bending changes, bounded by sums over the robot. The energy of a beam, its strains rho and
// psi and their second order are those of the exact solver (solver/second_order/tree_bound.cpp).
// With |x| the root of x . K x, u the linear displacements, s their stresses, D beams on the way
// from a support to any end of a beam, B beams,
//   E = |u|^2,  F of it from forces and torsion,  M = E - F from bending moments,
//   R the sum, over ends of beams, of the fourth power of how far u turns them,  T = R^(1/4),
// k_f <= K_f and k_m <= K_m the least and largest stiffness of a beam against its strains,
//   r^2 = max(K_f / k_f, K_m / k_m),   t^2 = D / k_m,
// no end turns by more than t |x|, and by Cauchy and Schwarz over all beams, -K_G = S,
//   |x . S x| <= W x . K x,   W = A t sqrt(B) + r t sqrt(4 F + M) + C,
//   |x . S u| <= P |x|,       P = A (B R / 2)^(1/4) + r (T sqrt(F) + t F)
//                                 + r (T sqrt(E) + t E) / 2 + C sqrt(E),  or W sqrt(E) if less,
//   A = L t sqrt(5/4 K_f F),  C = sqrt(5/4 K_f F) (L / (12 k_m) + 6 / (5 L k_f)).
//
// So no buckling factor is below 1 / W. The stresses of second order, s2 = k (B u2 + e2(u)),
// balance the forces S u on the robot as it was, so |s2| <= P where it is statically determinate,
// else
//   |s2|^2 <= P^2 + Z^2,  Z = sqrt(K_f) (L/3 sqrt(2 R) + 3 F / (5 L k_f)) + T r sqrt(E),
// as the strains e2(u), which are Z at most, add stresses that are in balance by themselves.
// Statics move forces to the middle of the bent connection, by moments of L |psi| |f| / 2 and shear
// of 6/5 N |rho| / L at most. What |s2| does to a load ratio is ratio_per_energy_root() times that,
// to the moment by which a facet tilts sqrt(K_m + b^2 K_f) times that. The second-order check lets
// these grow by 1 / (1 - 1 / mu), here g = 1 / (1 - W), which is no less.
//
// The centre of mass. The resultant of facets that carry s + g s2 within their limits lies in the
// polygon, below the centre of mass after g u. The second-order check adds g u2: |u2| <= P + Z, and
// no module goes further than (sqrt(D / k_f) + L D t) times that. The moment of all loads for that
// way is asked of one facet.
//
// Facets that tilt lack one or two stiffnesses by the unilateral law; they are held sideways, and
// what they need is a quarter of A more. Under the regularised law, whose tangent is not symmetric,
// and where a facet is open, u is not quite the solution of the exact law, from which the
// second-order check starts: there all this is no proof.
#include "holdfast/agent/conductor/bending.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/conductor/iterations.hpp"

namespace holdfast::agent {
namespace {

/// The share of buckling up to which robots are judged: beyond, what bending adds grows more than
/// twentyfold.
constexpr double kShareMost = 0.95;

/// Sums are of single precision and of an equilibrium as good as load ratios need it: energies may
/// be this share larger.
constexpr double kEnergyError = 0.01;

double least_of(double a, double b) { return a < b ? a : b; }

double largest_of(double a, double b) { return a < b ? b : a; }

/// The least and the largest stiffness against strains of length and shear, and of turning.
struct StiffnessRange {
  double force_least;
  double force_most;
  double moment_least;
  double moment_most;
};

StiffnessRange range_of(const mechanics::BeamStiffness<double>& beam) {
  const double shear_least = least_of(beam.shear_x, beam.shear_y);
  const double shear_most = largest_of(beam.shear_x, beam.shear_y);
  const double bend_least = least_of(beam.bend_x, beam.bend_y) / 4;
  const double bend_most = largest_of(beam.bend_x, beam.bend_y) / 4;
  return {.force_least = least_of(beam.axial, shear_least),
          .force_most = largest_of(beam.axial, shear_most),
          .moment_least = least_of(beam.twist, bend_least),
          .moment_most = largest_of(beam.twist, bend_most)};
}

/// The bounds of the first lines above.
class BendingBound {
 public:
  BendingBound(const Setup& setup, const Whole& whole, const Report& report)
      : k_(range_of(setup.beam)),
        pitch_(setup.section.length),
        depth_(2.0 * whole.depth + whole.planned_count + 1),
        turn_(square_root(depth_ / k_.moment_least)),
        spread_(square_root(
            largest_of(k_.force_most / k_.force_least, k_.moment_most / k_.moment_least))),
        energy_(largest_of(0, static_cast<double>(report.energy())) * (1 + kEnergyError)),
        moments_(static_cast<double>(report.bending_energy())),
        forces_(largest_of(energy_ - moments_, kEnergyError * energy_)),
        rotations_(static_cast<double>(report.rotations())),
        beams_(static_cast<double>(report.number) / 2),
        has_tilting_((report.flags & kHasTilting) != 0),
        is_determinate_(!has_tilting_ && report.number == 2 * report.count) {}

  /// W
  double share() const {
    return turning() * turn_ * square_root(beams_) +
           spread_ * turn_ * square_root(4 * forces_ + moments_) + of_one_beam();
  }

  /// P
  double forces(double share) const {
    const double root = square_root(energy_);
    const double sum = turning() * square_root(square_root(beams_ * rotations_ / 2)) +
                       spread_ * (turned() * square_root(forces_) + turn_ * forces_) +
                       spread_ / 2 * (turned() * root + turn_ * energy_) + of_one_beam() * root;
    return least_of(sum, share * root);
  }

  /// Z
  double strains() const {
    return square_root(k_.force_most) * (pitch_ / 3 * square_root(2 * rotations_) +
                                         0.6 * forces_ / (pitch_ * k_.force_least)) +
           turned() * spread_ * square_root(energy_);
  }

  /// |s2|
  double stress(double share) const {
    const double strains_left = is_determinate_ ? 0.0 : strains();
    const double balanced = forces(share);
    return square_root(balanced * balanced + strains_left * strains_left);
  }

  /// What statics add to |s2|.
  double moved() const {
    const double force = square_root(k_.force_most * forces_);
    return force * square_root(energy_) * pitch_ / (2 * k_.moment_least) +
           1.2 * force * square_root(forces_) / (pitch_ * k_.force_least);
  }

  /// The furthest way of a module by u2.
  double way(double share) const {
    return (forces(share) + strains()) *
           (square_root(depth_ / k_.force_least) + pitch_ * depth_ * turn_);
  }

  /// The moment by which facets come nearer to tilting for |s2| = 1.
  double moment_per_stress(double half_width) const {
    return square_root(k_.moment_most + half_width * half_width * k_.force_most);
  }

 private:
  /// T
  double turned() const { return square_root(square_root(rotations_)); }

  /// The root of the sum, over all beams, of the square of what presses and half of what shears.
  double pressed() const { return square_root(1.25 * k_.force_most * forces_); }

  /// A
  double turning() const { return (has_tilting_ ? 1.25 : 1.0) * pitch_ * turn_ * pressed(); }

  /// C
  double of_one_beam() const {
    return pressed() * (pitch_ / (12 * k_.moment_least) + 1.2 / (pitch_ * k_.force_least));
  }

  StiffnessRange k_;
  double pitch_;
  double depth_;      ///< D
  double turn_;       ///< t
  double spread_;     ///< r
  double energy_;     ///< E
  double moments_;    ///< M
  double forces_;     ///< F
  double rotations_;  ///< R
  double beams_;      ///< B
  bool has_tilting_;
  bool is_determinate_;
};

}  // namespace

bool is_bending_small(const Setup& setup, const Whole& whole, const Report& report,
                      double ratio_most) {
  if ((report.flags & kHasSupport) == 0 || (report.flags & kHasSliding) != 0) {
    return false;
  }
  for (const float real : report.reals) {
    if (!is_number(static_cast<double>(real))) {
      return false;  // Of what is none square_root() makes one.
    }
  }
  const BendingBound bound(setup, whole, report);
  const double share = bound.share();
  if (!(share < kShareMost)) {
    return false;
  }
  const double growth = 1 / (1 - share);
  const double stress = growth * bound.stress(share);
  const double ratio_change = (stress + growth * bound.moved()) * ratio_per_energy_root(setup);
  const double half_width =
      setup.section.length * setup.facet_numerator / setup.facet_denominator / 2;
  const double lean =
      whole.is_fixed ? 0.0 : static_cast<double>(report.load_n()) * growth * bound.way(share);
  return ratio_most + ratio_change < 1 && stress * bound.moment_per_stress(half_width) + lean <
                                              static_cast<double>(report.moment_margin());
}

}  // namespace holdfast::agent
