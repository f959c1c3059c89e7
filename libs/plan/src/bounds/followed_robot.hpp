// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "equilibria/local_balance.hpp"
#include "equilibria/stuck_core.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {

/// The displacements of a robot that has some modules more than one that was solved, all facets
/// stuck, and how far they are off, without making its equations.
///
/// Let K_0 be the solved robot's, its *core*. Forces s that balance all loads, and displacements u:
///   1. the modules that have come last, and for now those near them, move until they are in
///      balance while all others stand still; the forces s of their beams and facets are then
///      known. What these put on new modules that have come earlier these hand on to the core;
///   2. the core moves by z more, K_0 z = g, where g is what it has been given, to a tolerance in
///      the energy norm: so s = h w there;
///   3. all new modules move until they are in balance with the core where it is now.
/// What is left are the gaps d = s - h w of the beams and facets of new modules. By [Prager 1947]
/// the exact displacements are no farther from u in the energy norm than |d| and the errors of all
/// solutions for K_0 together: what these leave unbalanced moves the stiffer whole no more than the
/// core. Where |d| is too large the same is done with all new modules for last ones: both s and u
/// then go as far that way, by a factor, as makes |d| least. Where new modules close loops that is
/// so nearly always; so at first the core only comes near z, by one step of the iteration, and the
/// second solution is the coarser the larger |d| was. It goes all the way, as nobody knows how far
/// off the first one is.
class FollowedRobot {
 public:
  using Vec = base::Vec6<double>;

  struct Result {
    double energy_error = 0;  ///< How far displacement() is off in the energy norm, at most.
    double load_ratio = 0;    ///< None exceeds this.
    double moved =
        0;  ///< How far the core has moved since it was solved, in the energy norm, at most.
  };

  /// Takes a safe state, all of whose facets are stuck, as the core. Keeps references to the whole
  /// robot, all modules of which are there in the end, and to what it is made of.
  FollowedRobot(const model::RobotSpec& spec, const model::Robot& target, const ElementSet& state,
                const verdict::Assessment& solved);

  /// Attaches a module, which must be beside one that is there, and not fixed.
  void add(Element module);

  /// Takes all new modules away again: the robot is the core with the displacements `solved`.
  void take_back(const verdict::Assessment& solved);

  /// The displacements by module of the target, after solve().
  const std::vector<Vec>& displacement() const { return u_; }

  /// The robot that is there now; none if the core's equations cannot be solved so.
  std::optional<Result> solve();

  /// Comes nearer than solve(), which asks for it once where that is sure to pay.
  std::optional<Result> improve();

  /// The iterations of multigrid in all solutions.
  int iteration_count() const { return iteration_count_; }

 private:
  /// A beam or a facet of a new module, and the force in its middle, local frame.
  struct Spring {
    std::size_t module = 0;
    std::int32_t other = -1;  ///< None: a facet.
    int direction = 0;
    Vec force{};
  };

  /// A module that is not of the core.
  struct NewModule {
    std::size_t module = 0;
    int way = 0;    ///< The direction of the neighbour that carries it if it is not in balance,
    int depth = 0;  ///< which is that of a facet of its own if this is 0.
  };

  bool is_new(std::size_t module) const { return place_[module] < kAbsent; }

  std::size_t place_in_new(std::size_t module) const {
    return static_cast<std::size_t>(kAbsent - 1 - place_[module]);
  }

  void choose_way(NewModule& added) const;
  void relax(const std::vector<std::size_t>& modules);
  std::vector<std::size_t> modules_from(std::size_t first) const;
  std::vector<std::size_t> modules_near(std::vector<std::size_t> modules) const;
  Vec gap_force(const Spring& spring) const;
  std::vector<Spring> find_springs(std::size_t first) const;
  std::vector<Vec> balance(std::size_t first, std::vector<Spring>& springs);
  std::vector<Vec> find_forces(std::size_t first, std::vector<Spring>& springs);
  bool make_system(const std::vector<Vec>& loads);
  bool find_motion(std::vector<Vec> change, double coarseness);
  double solution_error(double coarseness) const;
  void move_core(double factor);
  std::vector<Vec> gaps() const;
  double energy_of(const Vec& a, const Vec& b) const;
  bool move(std::vector<Vec> change, double coarseness);
  double gap_energy(const std::vector<Vec>& gap) const;
  Result finish(double gap_energy);
  double load_ratio(double error) const;
  double ratio_of(std::size_t module, std::size_t other, int direction, double known) const;

  static constexpr std::int32_t kAbsent = -1;

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};    ///< Of the springs in the middle, h,
  Vec flexibility_{};  ///< and 1 / h.
  double ratio_per_norm_ = 0;
  LocalBalance local_;
  std::vector<std::size_t> first_facet_;  ///< By module.
  /// Each module's place in the core, kAbsent, or less than that if it is new.
  std::vector<std::int32_t> place_;
  ElementSet core_;
  std::vector<Element> elements_;  ///< Of the core.
  std::unique_ptr<StuckCore> stuck_;
  std::vector<NewModule> new_;
  std::vector<Spring> springs_;   ///< Of those that were there at the last solve(), with s.
  std::size_t solved_count_ = 0;  ///< How many of them these are.
  std::vector<Vec> u_;            ///< By module of the target.
  std::vector<Vec> given_;     ///< By module of the core: loads beyond its own that it has taken.
  std::vector<Vec> moved_;     ///< And how far it has moved by them, z.
  std::vector<Vec> change_;    ///< The loads that it may take next,
  std::vector<Vec> motion_;    ///< and how it would move by them.
  double core_error_ = 0;      ///< In the energy norm, of the solution that it is taken from,
  double motion_error_ = 0;    ///< and of moved_; infinite if it is not known.
  double solution_error_ = 0;  ///< Of the last one for the core.
  double unit_ = 0;            ///< The weight of a module on a beam, in the energy norm.
  int iteration_count_ = 0;
  double tolerance_ = 0;  ///< What LinearSystem::solve() is asked for.
};

}  // namespace holdfast::plan
