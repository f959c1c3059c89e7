// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// What the energy norm of a change tells of a robot that is safe by its check.
struct EnergyLimits {
  double ratio_per_norm = 0;
  double error = 0;  ///< The solver's, in the energy norm.
  double room = 0;   ///< The energy norm that leaves every facet stuck.
  bool has_polygon = false;
  std::array<double, 2> sway{};  ///< |K^-1 l| along x and y, kg mm / (N mm)^(1/2).
  double mass_kg = 0;
};

/// Certifies that a robot stays safe if one of its connections is lost, without a solution: what
/// the connection carries goes from one of its ends to the other through loops of beams beside it.
///
/// The rest answers to a loss by displacements v, K' v = p, where p are the forces of what is lost
/// at its ends. By the principle of least complementary energy v . K' v is no more than the sum
/// of t^2 / h over any forces t that balance p: those of p carried along the loops, which have no
/// beam in common, in shares that make the sum least, 1 / sum of 1 / U_i with U_i of one loop.
/// As the displacements v = 0 belong to p as well, the exact change of forces lies on the sphere
/// whose diameter joins 0 and t [Prager 1947]: a load ratio c, convex and homogeneous, grows by no
/// more than c(t) / 2 + r |t| / 2, r being load_ratio_per_energy_norm(), and what a facet lacks to
/// tilting is off by (h_m + h_f b^2)^(1/2) |t| / 2, as no loop has a facet. The solver's error s in
/// the energy norm makes t uncertain by s (sum of |t_k|^2)^(1/2), with t_k what the loops take of a
/// unit of each of the beam's six forces. Across the lost beam itself v opens a gap w with w . h w
/// no more than that sum times v . K' v, so v . K v is no more than 1 + it times v . K' v, and the
/// centre of mass moves by no more than its root times |K^-1 l|, l pulling each module sideways by
/// its mass.
class LoopBound {
 public:
  /// Makes a bound for a robot that is safe by its check, all its facets stuck; none if it is not
  /// of the kind that a bound decides. `spec` is the robot's. Keeps references to the others.
  static std::unique_ptr<LoopBound> make(const model::RobotSpec& spec, const model::Robot& robot,
                                         const verdict::Assessment& solved, bool is_bonded);

  const EnergyLimits& limits() const { return limits_; }

  /// What no load ratio exceeds after a connection is lost; none if the robot may be unsafe then.
  std::optional<double> without(const model::Connection& lost) const;

 private:
  using Vec = base::Vec6<double>;

  /// Beams from one end of a connection to the other, by the directions to go.
  struct Loop {
    std::array<base::Direction, 3> steps{};
    std::size_t count = 0;
    double share = 0;  ///< That it takes of what is carried.
  };

  LoopBound(const model::Robot& robot, const verdict::Assessment& solved);
  bool find_sway(model::RobotSpec spec);
  void look_at_facets(bool is_bonded);
  std::vector<Loop> loops_beside(const model::Connection& lost) const;
  template <class Each>
  void walk(std::size_t from, const Loop& loop, const Vec& at_first, const Each& each) const;
  double energy_along(std::size_t from, const Loop& loop, const Vec& at_first) const;
  double change_of_ratio(std::size_t from, const Loop& loop, const Vec& at_first) const;

  const model::Robot& robot_;
  const verdict::Assessment& solved_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};
  std::vector<std::array<Vec, 6>>
      pulls_;  ///< By direction: a unit of each force, at the first end.
  EnergyLimits limits_;
};

/// Whether a bound of energies may decide about a robot that was checked: it is safe, and all its
/// facets are stuck by the paper's law, or bonded.
bool is_stuck_and_safe(const verdict::Assessment& solved, bool is_bonded);

}  // namespace holdfast::plan
