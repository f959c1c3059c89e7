// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/loads.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/solver/options.hpp"

/// A robot's equations of equilibrium for given contact states, K u = f: linear, and solved
/// directly or by multigrid behind one interface.
///
/// K is the sum of all beams (Eqs. 3 and 5) and of what the contact law makes of every facet on the
/// ground in the state that it is put into; f are the loads. Who seeks the states that belong to
/// the loads (EquilibriumSolver) changes facets and solves again; who knows them asks for
/// displacements under as many loads as there are.
namespace holdfast::solver {

class StressedBeams;

/// A facet of a robot, and the contact state that it is taken to be in. One that is bonded is stuck
/// and held, whatever the law.
struct FacetState {
  std::size_t module = 0;
  base::Direction direction = base::Direction::kMinusZ;
  bool is_bonded = false;
  mechanics::ContactState state;
  bool is_held = true;  ///< Against slip and twist; kUnilateral only.

  friend bool operator==(const FacetState&, const FacetState&) = default;
};

/// Displacements by module, and how good they are. Global frame; mm and rad.
struct Solution {
  std::vector<base::Vec6<double>> displacement;
  /// What is to be added to `displacement` for 106 bits; empty if double precision sufficed.
  std::vector<base::Vec6<double>> displacement_low;
  /// A second answer, to see how far the first may be off: before the last step of iterative
  /// refinement, or at least ten times farther from convergence.
  std::vector<base::Vec6<double>> alternative;
  /// The weak springs that hold beside the contact, as in ContactOptions; 0 if they were left out.
  double gamma = 0;
  /// The error in the energy norm, (N mm)^(1/2), by multigrid's own estimate; and what weak springs
  /// do that could not be left out, infinite if that is not known.
  double energy_error = 0;
  std::vector<mechanics::ContactState> contact;  ///< By facet, in the order of Robot::facets().
};

/// What the facets of a robot do by one law. Keeps a reference to the beams.
template <class Real>
class FacetLaw;

FacetLaw<double> facet_law(const model::Robot& robot, const model::LatticeBeam<double>& beam,
                           const ContactOptions& contact);

/// How a linear solution ended.
enum class LinearOutcome : std::uint8_t {
  kSolved,
  kSingular,  ///< A pivot vanished.
  kTooSlow,   ///< The iteration stands still, or the robot is too slender for the precision.
};

/// What facets do to the modules that they belong to, by one law, in the global frame. Keeps a
/// reference to the beams.
template <class Real>
class FacetLaw {
 public:
  using Vec = base::Vec6<Real>;

  FacetLaw(const model::LatticeBeam<Real>& beam, Real facet_width, Real gamma,
           mechanics::ContactLaw law)
      : beam_(&beam) {
    for (std::size_t group = 0; group < ground_.size(); ++group) {
      ground_[group] = mechanics::ground_facet(
          beam.stiffness_of_group(group), beam.length_of_group(group), facet_width, gamma, law);
    }
  }

  /// What a facet in a direction is, in its own frame. The law, its weak springs and the width are
  /// those of all.
  const mechanics::GroundFacet<Real>& ground(
      base::Direction direction = base::Direction::kPlusX) const {
    return ground_[beam_->group(direction)];
  }

  void set_gamma(Real gamma) {
    for (mechanics::GroundFacet<Real>& ground : ground_) {
      ground.gamma = gamma;
    }
  }

  /// This law with other weak springs.
  FacetLaw with_gamma(Real gamma) const {
    FacetLaw law = *this;
    law.set_gamma(gamma);
    return law;
  }

  /// The trial force on the facet when its module moves by u, local frame.
  Vec trial_force(const FacetState& facet, const Vec& u) const {
    return mechanics::trial_force(ground(facet.direction), beam_->to_local(facet.direction, u));
  }

  /// The state that the law prescribes for a trial force. A facet that presses with no more than
  /// the rounding of what else acts on it does not press: its sign depends on how the robot lies.
  mechanics::ContactState state_for(const FacetState& facet, const Vec& trial) const {
    if (facet.is_bonded) {
      return {};
    }
    const mechanics::GroundFacet<Real>& here = ground(facet.direction);
    const Real sideways = base::absolute(trial[0]) + base::absolute(trial[1]);
    const Real torque =
        base::absolute(trial[3]) + base::absolute(trial[4]) + base::absolute(trial[5]);
    const bool is_rounding =
        base::absolute(trial[2]) < Real(kPressureTie) * (sideways + torque / here.lever);
    if (is_rounding && here.law == mechanics::ContactLaw::kRegularised) {
      return {.pressed = false};
    }
    if (here.half_width == Real(0)) {  // A point: no torque tilts it this way rather than that.
      return trial[2] < Real(0) ? mechanics::ContactState{.tilt_x = 1, .tilt_y = 1}
                                : mechanics::ContactState{.pressed = false};
    }
    return mechanics::contact_state(here, trial);
  }

  /// The state that the law prescribes when its module moves by u.
  mechanics::ContactState state_at(const FacetState& facet, const Vec& u) const {
    return state_for(facet, trial_force(facet, u));
  }

  /// The force that the support takes from the module when it moves by u.
  Vec force(const FacetState& facet, const Vec& u) const {
    return beam_->to_global(
        facet.direction,
        mechanics::contact_force(ground(facet.direction), facet.state, facet.is_held,
                                 beam_->to_local(facet.direction, u)));
  }

  /// The derivative of force().
  base::Mat6<Real> tangent(const FacetState& facet) const {
    return beam_->to_global(
        facet.direction,
        mechanics::contact_tangent(ground(facet.direction), facet.state, facet.is_held));
  }

 private:
  /// A pressure below this share of what else acts on the facet is rounding.
  static constexpr double kPressureTie = 1e-9;

  const model::LatticeBeam<Real>* beam_;
  std::array<mechanics::GroundFacet<Real>, model::LatticeBeam<Real>::kGroupMax> ground_{};
};

/// What a linear system has done since it was made.
struct LinearReport {
  Method method = Method::kDirect;
  Precision precision = Precision::kSingle;
  int solve_count = 0;      ///< Calls of solve(); to go on with the same system counts as none.
  int iteration_count = 0;  ///< Multigrid's, in all of them together.
  /// Columns of the factorization made for them: less than one per module and solution, as a change
  /// of some contact states leaves most of the factorization as it is.
  std::size_t made_column_count = 0;
};

/// The equations of one robot, to which it keeps a reference. Begins with the robot's own loads,
/// and needs a contact law before it can be solved, also where no module is on the ground.
class LinearSystem {
 public:
  using Vec = base::Vec6<double>;

  explicit LinearSystem(const model::Robot& robot);
  virtual ~LinearSystem() = default;
  LinearSystem(const LinearSystem&) = delete;
  LinearSystem& operator=(const LinearSystem&) = delete;

  const model::Robot& robot() const { return robot_; }

  /// The robot's facets in its order, and their states.
  std::span<const FacetState> facets() const { return facets_; }

  /// The robot's beams.
  const model::LatticeBeam<double>& beam() const { return beam_; }

  /// What a facet in a direction is by the present law: FacetLaw::ground().
  const mechanics::GroundFacet<double>& ground(
      base::Direction direction = base::Direction::kPlusX) const {
    return law_.ground(direction);
  }

  /// What facets do to their modules by the present law.
  const FacetLaw<double>& law() const { return law_; }

  const model::Loads& loads() const { return loads_; }

  /// Takes a contact law, and all facets stuck.
  void set_law(const ContactOptions& contact);

  /// Puts a facet, by its place in facets(), into a state. Returns whether it was in another one.
  bool set_facet(std::size_t facet, const mechanics::ContactState& state, bool is_held);

  /// Takes other loads; what solve() goes on from is then no displacements at all.
  void set_loads(model::Loads loads);

  /// Takes other loads, of which the displacements of the last solve() are not far: an iteration
  /// goes on from them, and solve()'s tolerance means what it meant before.
  void change_loads(model::Loads loads);

  /// Solves for the present facets and loads. An iteration goes on from the last solution until its
  /// error in the energy norm is `tolerance` times that of no displacements; a direct solution is
  /// as exact as it gets.
  [[nodiscard]] virtual LinearOutcome solve(double tolerance) = 0;

  /// Comes nearer to the solution: an iteration makes one step from the last one, and does not look
  /// how far it is then; a direct solution is as exact as it gets. That is a third of the time of a
  /// short solve(), for those who have other loads next.
  [[nodiscard]] virtual LinearOutcome approach() = 0;

  /// The last solution, by module; fixed modules do not move.
  virtual std::vector<Vec> displacement() = 0;

  /// The displacements of the facets' modules alone, by facet.
  virtual std::vector<Vec> facet_displacement();

  /// Takes the last solve()'s solution to the last digits that the options ask for. Returns false
  /// if there are not so many. What `solution` then holds is not complete before hand_over().
  [[nodiscard]] virtual bool refine(Solution& solution) = 0;

  /// What a system is asked for after hand_over().
  enum class Further : std::uint8_t {
    kNothing,  ///< Most likely; it may give back what it can make again.
    kMore,
  };

  /// Fills in all that a solution holds; to be called after refine().
  virtual void hand_over(Solution& /*solution*/, Further /*further*/) {}

  /// Displacements by module under each of several loads, for the present facets; none if a
  /// solution fails. The loads that were set are forgotten.
  [[nodiscard]] virtual std::optional<std::vector<std::vector<Vec>>> solve_each(
      std::span<const model::Loads> loads, double tolerance);

  /// Whether K + factor K_G is positive definite, K_G being the geometric stiffness of the beams,
  /// by a factorization for the present facets; none if there is none. With a factor of 0: whether
  /// K is.
  [[nodiscard]] virtual std::optional<bool> is_definite(StressedBeams& /*beams*/,
                                                        double /*factor*/) {
    return std::nullopt;
  }

  /// Whether solutions are exact but for rounding, whatever the tolerance.
  virtual bool is_exact() const = 0;

  /// How far every facet's trial force may be off after solve(), N, a torque counted at half a
  /// facet's width; empty if is_exact().
  virtual std::vector<double> facet_errors() const = 0;

  /// How far the last solve() is from its solution in the energy norm, by its own estimate, which
  /// may be much less than the tolerance asks for; 0 if is_exact().
  virtual double energy_error() const = 0;

  virtual LinearReport report() const = 0;

 protected:
  /// What an implementation does about facets() in other states, another law, other loads.
  virtual void take_law() = 0;
  virtual void take_facet(std::size_t facet) = 0;
  virtual void take_loads() = 0;

  /// Takes loads that have changed little from those `before`.
  virtual void take_changed_loads(const model::Loads& /*before*/) { take_loads(); }

  /// Weak springs are taken back in so many steps at most, as long as each is so much shorter than
  /// the one before. A robot that stands without them takes two or three; where they alone hold it,
  /// or nearly, steps do not become shorter.
  static constexpr int kTakeBackMax = 20;
  static constexpr double kTakeBackPace = 0.7;

  /// Whether there are springs beside the exact law, which are no part of it.
  bool has_weak_springs() const {
    return ground().law == mechanics::ContactLaw::kUnilateral && ground().gamma > 0;
  }

  /// Changes the weak springs and nothing else.
  void set_gamma(double gamma);

 private:
  const model::Robot& robot_;
  model::LatticeBeam<double> beam_;
  model::Loads loads_;
  FacetLaw<double> law_;
  std::vector<FacetState> facets_;
};

/// Makes the system that options.method asks for, by size if it is kAutomatic: with a sparse
/// factorization (block_lu.hpp), or with conjugate gradients and multigrid (docs/solver.md). None
/// if it needs more memory, or fills in more, than the options allow.
std::unique_ptr<LinearSystem> make_linear_system(const model::Robot& robot,
                                                 const EquilibriumOptions& options);

}  // namespace holdfast::solver
