// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "bounds/adjoint.hpp"
#include "bounds/followed_robot.hpp"
#include "bounds/load_spread.hpp"
#include "bounds/section_response.hpp"
#include "equilibria/changed_forces.hpp"
#include "equilibria/local_balance.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/verdict/assessment.hpp"
#include "holdfast/verdict/moved_mass.hpp"

namespace holdfast::plan {

/// Certifies that a robot stays safe while modules are attached to it, without solving it again.
///
/// Let u be the displacements of the solved robot, and s the forces of its springs, in the middle
/// of each beam and facet six that know nothing of each other, with stiffness h. A module that is
/// attached moves until it is in balance with its neighbours, which stay, and its load goes down
/// through beams to a support: so there are displacements u with gaps w, and forces s that balance
/// all loads. By
/// [Prager 1947] the exact forces s* lie on the sphere whose diameter joins s and h w:
///   |s* - (s + h w) / 2| = |s - h w| / 2,      |x|^2 = sum x_i^2 / h_i.
/// A load ratio c is convex and homogeneous, so with r = load_ratio_per_energy_norm()
///   c(s*) <= c((s + h w) / 2) + r |s - h w| / 2 <= c(solved) + c(change of s) / 2 + r |s - h w| /
///   2,
/// and what a facet lacks to tilting is off by sqrt(h_m + h_f b^2) |s - h w| / 2 at most, b being
/// half its width. If nothing breaks by that and every facet is in full contact, then that is the
/// equilibrium of the paper's law, with all facets stuck. Each module costs the length of its way
/// down. Where that way leads far aside, so that its beams bend, s is h w in the module's own
/// beams, and what these put on its neighbours goes down through all modules near instead
/// (LoadSpread).
///
/// The centre of mass moves as u says. Let l pull every module sideways by 1 N for each kg of it:
/// by Cauchy and Schwarz the sum of masses times displacements along an axis is off by no more than
/// |K^-1 l| times what u is off. That norm is no more than that of any forces which balance l, such
/// as those that take each pull m down a way of n springs to a support, the k-th of which is no
/// farther from it than k - 1/2 pitches, and which cost no more than
///   m (n / h_force + pitch^2 n (4 n^2 - 1) / 12 / h_moment)^(1/2).
/// Ways to one support add up to their sum at most, those to different ones to the root of squares.
///
/// Facets for which that is too coarse are looked at by what is known of them from the modules
/// around (LocalAdjoint) or, where somebody has found it, from the whole robot (Adjoint).
///
/// Above a section of a slender robot, ways end at the section's modules, and the core moves by its
/// answer to the resultant there (SectionResponse): s and h w then change alike below. New modules
/// are brought into balance on the core where it is now.
///
/// Serves a robot while it grows, however often it is solved on the way.
class EnergyBound {
 public:
  /// Whether modules that are attached stay, or are taken back one by one.
  enum class Use : std::uint8_t { kGrowing, kTrying };

  /// Keeps references to the whole robot and to what is known of its facets by the modules near
  /// them; `adjoints` serve as long as modules are attached in the order in which these have grown.
  EnergyBound(const model::Robot& target, const LocalAdjoints& nearby,
              const Adjoints& adjoints = {}, Use use = Use::kGrowing);

  /// Begins with a solved robot, whose modules are `elements` of the target, in that order. False
  /// if nothing can be built on it: it is not safe, but for an overload where modules are taken
  /// back, a facet tilts or is open, or the polygon does
  /// not decide. Whatever was attached before must be there.
  /// With a section of this robot, modules that are attached must not have facets. Keeps a
  /// reference to it.
  bool begin(const std::vector<Element>& elements, const verdict::Assessment& solved,
             const SectionResponse* section = nullptr);

  /// Attaches a module, which must be beside one that is there. Returns a bound of the largest load
  /// ratio, or none if the robot may be unsafe, or where nothing was begun; it is then to be
  /// solved.
  std::optional<double> add(Element module);

  /// Takes away the module that was attached last, in Use::kTrying: what is known is what it was,
  /// to the last bit.
  void take_back();

  /// What the largest load ratio of the robot that is there now is no less than, after add() and
  /// without a section; none if a facet may tilt.
  std::optional<double> ratio_low();

  /// Goes on from better displacements of the robot that is there now, all of whose facets are
  /// stuck, by module of the target. Returns as add() does.
  std::optional<double> improve(const std::vector<base::Vec6<double>>& displacement,
                                const FollowedRobot::Result& known);

  /// The facets whose adjoints have been asked for.
  const std::set<std::size_t>& asked_for() const { return watched_.asked_for(); }

  /// How often each facet has left a state without a bound, alone or with others, or nearly so by
  /// its adjoint.
  const std::map<std::size_t, int>& doubtful() const { return doubtful_; }

  /// How far the displacements are off in the energy norm, at most.
  double energy_error() const {
    return std::sqrt(std::max(0.0, changes_.energy())) + solved_error_;
  }

  /// How far bending moves the centre of mass of the robot that is there now, in plan, at most.
  double shift_mm() const {
    return moved_.shift_mm(std::sqrt(sway_square_) * (energy_error() + solved_error_));
  }

  /// The displacement of a module that has a facet, or is new or beside such a one.
  const base::Vec6<double>& displacement(std::size_t module) const { return u_[module]; }

  /// Attaches a module that is not fixed as add() does, but that nothing is said of its load; it is
  /// in balance with its neighbours where they are. In Use::kTrying.
  void place(std::size_t module);

  /// What a module's beams put on its neighbours, but for fixed ones.
  std::vector<LoadSpread::Load> loads_beside(std::size_t module) const;

  /// How a module moves that stays in balance while its neighbours in the robot that was begun with
  /// move by `displacement`, by module of the target.
  base::Vec6<double> follow(std::size_t module,
                            const std::function<base::Vec6<double>(std::size_t)>& displacement);

  const model::LatticeBeam<double>& beam() const { return beam_; }

  /// The facets that are there.
  const std::vector<std::size_t>& facets() const { return facets_; }

  /// The force on a stuck facet whose module moves by u, in the facet's middle.
  base::Vec6<double> trial_force(const model::Facet& facet, const base::Vec6<double>& u) const;

  /// What the module that was added last has changed, in Use::kTrying.
  const ChangedForces& changes() const { return changes_; }

  double sway_square() const { return sway_square_; }

  /// The module whose support bears a module that is there.
  std::size_t root_of(std::size_t module) const { return nodes_[module].root; }

  /// What pulls sideways on all ways to a support add up to; its module's index.
  double sway_of(std::size_t root) const { return sway_[root]; }

  /// What |s - h w| / 2 may be before a facet of the robot that is there tilts,
  double room(std::size_t facet) const { return room_[facet]; }

  /// and what it would be if its module moved by u, and s differed from h w by `change`.
  double room_with(std::size_t facet, const base::Vec6<double>& u,
                   const base::Vec6<double>& change) const;

  /// What the force of a facet may change by, in the facet's middle.
  struct Changes {
    base::Vec6<double> low{};
    base::Vec6<double> high{};
  };

  /// Whether all facets of the robot that was begun with stay stuck if |s - h w| / 2 is no more
  /// than `radius`, by their rooms, and where these do not suffice as far as the modules near them
  /// show if h w changes so there. Modules come beside `hosts`. In Use::kTrying, with nothing
  /// added.
  bool are_pressed_with(std::span<const std::size_t> hosts, double radius,
                        const std::function<double(std::size_t facet)>& room,
                        const std::function<Changes(std::size_t facet)>& changes);

  /// What the robot that was begun with has: the largest load ratio, errors included; what its
  /// displacements are off by in the energy norm, at most; its moved mass.
  double solved_ratio() const { return solved_ratio_; }

  double solved_error() const { return solved_error_; }

  const verdict::MovedMass& still_moved() const { return still_moved_; }

  /// The most that forces of energy 1 do to a load ratio.
  double ratio_per_norm() const { return ratio_per_norm_; }

  /// A bound of a load ratio this near to 1 is not trusted: multigrid's are within 1e-4.
  static constexpr double kRatioMax = 1 - 1e-3;

 private:
  using Vec = base::Vec6<double>;

  /// A beam to a module that is nearer to a support.
  struct Way {
    std::int32_t to = -1;
    int direction = 0;
  };

  struct Node {
    bool is_there = false;
    bool is_new = false;     ///< Attached since the robot was solved.
    bool is_host = false;    ///< A module has been attached beside it since.
    std::int32_t depth = 0;  ///< Steps to a support.
    std::size_t place = 0;   ///< If new: in new_.
    Way way;                 ///< Towards the support; none at a support.
    std::size_t root = 0;    ///< The module with that support.
  };

  /// What take_back() restores.
  struct Before {
    double sway = 0;  ///< Of the module's root.
    double sway_square = 0;
    std::vector<std::size_t> looked_at;  ///< Facets that were there before.
  };

  void choose_ways(const std::vector<Element>& elements);
  void choose_section_ways();
  void settle_new();
  void forget_changes();
  void forget_nearby(const std::vector<Element>& elements);
  std::optional<double> bound();
  bool has_root(std::size_t module) const;
  bool ends_way(std::size_t module) const;
  void add_sway(std::size_t module);
  double distance_aside(std::size_t module, std::size_t neighbour) const;
  void choose_way(std::size_t module);
  void take_place(std::size_t module);
  void open_gaps(std::size_t module);
  double way_energy(std::size_t from) const;
  bool is_far_aside(std::size_t module) const;
  bool spread(std::size_t from);
  void bear(const LoadSpread::Share& share);
  void carry(std::size_t from);
  std::optional<double> add_above_section(std::size_t module);
  void move_with_section();
  void bear_by_section();
  verdict::MovedMass moved_mass() const;
  void look_at_facet(std::size_t facet);
  bool is_pressed_nearby(std::size_t facet, double radius, const Changes& changes);
  bool are_pressed(double radius);
  double strain_by_adjoint(std::size_t facet);

  const model::Robot& target_;
  const LocalAdjoints& adjoints_;
  Use use_;
  bool has_core_ = false;  ///< A solved robot was begun with.
  LocalBalance local_;
  model::LatticeBeam<double> beam_;
  ChangedForces changes_;
  LoadSpread spread_;
  double ratio_per_norm_ = 0;
  double facet_per_norm_x_ = 0;  ///< How much a facet's lack may be off, by norm.
  double facet_per_norm_y_ = 0;
  std::vector<std::size_t> first_facet_;  ///< By module; facets of module i begin there.
  std::vector<Node> nodes_;
  std::vector<Vec> u_;               ///< Displacements, by module.
  std::vector<std::size_t> new_;     ///< Attached since the robot was solved.
  std::vector<std::size_t> facets_;  ///< There, by index in the target.
  std::vector<double> room_;         ///< By facet of the target: what |s - h w| / 2 may be.
  std::vector<std::optional<LocalAdjoint>> nearby_;  ///< By facet, as far as asked for.
  WatchedFacets watched_;
  std::vector<double> sway_;  ///< By module with a support: of all ways to it, kg mm/(N mm)^(1/2).
  double sway_square_ = 0;    ///< The sum of squares.
  verdict::MovedMass moved_;  ///< By u_, of all modules that are there,
  verdict::MovedMass still_moved_;       ///< and when the robot was solved.
  std::map<std::size_t, int> doubtful_;  ///< As doubtful() says.
  Before before_;
  double solved_ratio_ = 0;
  double solved_ratio_low_ = 0;
  double solved_error_ = 0;
  const SectionResponse* section_ = nullptr;
  std::vector<std::int32_t> section_place_;  ///< By module: in the section, or -1.
  std::vector<Vec> borne_;                   ///< By module of the section, about the origin.
  SectionResponse::Resultant resultant_{};   ///< Of these.
  std::vector<Vec> still_;                   ///< u_ when the robot was solved.
  double own_error_ = 0;                     ///< And solved_error_ then.
  double section_ratio_ = 0;                 ///< R's.
};

}  // namespace holdfast::plan
