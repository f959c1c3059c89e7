// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

/// Solves Coulomb's law for a few feet whose robot is known by what their slips do to their forces.
///
/// A foot carries T sideways (two components) and N across; s is its slip. The law: |T| <= mu N,
/// and s = 0, or |T| = mu N with s along T (T is what the support takes from the foot, so it grows
/// along the foot's way). That is the root of T - P(T + rho s), P being the nearest point of the
/// disc of radius mu N, for any rho > 0 [Alart 1991]: piecewise smooth, and solved by Newton's
/// method. The slips are those of loads that grow from zero in proportion: then all forces and
/// slips do, and the law in rates is this one.
namespace holdfast::solver {

/// A slip's two components along the foot's axes, mm, and its turn about the normal, rad.
inline constexpr std::size_t kSlipSize = 3;
using SlipVector = std::array<double, kSlipSize>;

/// One foot at the slips where the others' forces are known.
struct SlidingFoot {
  double friction = 0;     ///< The coefficient.
  bool turns = false;      ///< Whether it turns freely; else it does not turn.
  SlipVector stiffness{};  ///< Of its spring against slip and turn.
  SlipVector slip{};
  SlipVector force{};  ///< T and the moment about the normal, at `slip`.
  double press_n = 0;  ///< N at `slip`, not negative.
};

/// Feet, and the derivatives of their forces by their slips.
class SlidingFeet {
 public:
  explicit SlidingFeet(std::vector<SlidingFoot> feet);

  std::size_t count() const { return feet_.size(); }

  /// The derivative of a foot's force by the slip of another, or the same one.
  double& force_by_slip(std::size_t foot, std::size_t i, std::size_t other, std::size_t k) {
    return force_by_slip_[(kSlipSize * foot + i) * size() + kSlipSize * other + k];
  }

  /// The derivative of what presses a foot.
  double& press_by_slip(std::size_t foot, std::size_t other, std::size_t k) {
    return press_by_slip_[foot * size() + kSlipSize * other + k];
  }

  /// The slips by the law; none if no start leads to them.
  std::optional<std::vector<SlipVector>> solve() const;

  /// Whether other starts lead to other forces: without friction at first, and one foot after the
  /// other let go.
  bool has_others(std::span<const SlipVector> slips) const;

  /// The most by which the law is not fulfilled at the slips given, N.
  static double residual(const SlidingFoot& foot);

 private:
  struct State;

  std::size_t size() const { return kSlipSize * feet_.size(); }

  State state_at(const std::vector<double>& slip, double share) const;
  bool go(std::vector<double>& slip, double share) const;
  bool step(std::vector<double>& slip, const State& now, double share) const;
  std::optional<std::vector<double>> from_all_friction() const;
  std::optional<std::vector<double>> from_no_friction() const;
  std::optional<std::vector<double>> from_sweeps() const;
  void move_one(std::size_t foot, std::vector<double>& slip) const;
  std::optional<std::vector<double>> from_one_free(std::size_t foot) const;
  std::vector<double> given() const;
  bool is_other(const std::vector<double>& slip, const std::vector<double>& known) const;

  std::vector<SlidingFoot> feet_;
  std::vector<double> force_by_slip_;
  std::vector<double> press_by_slip_;
  double scale_n_ = 0;  ///< The largest force.
};

}  // namespace holdfast::solver
