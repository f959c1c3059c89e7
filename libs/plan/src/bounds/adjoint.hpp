// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "beam_blocks.hpp"
#include "equilibria/local_balance.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/solver/block_lu.hpp"

/// What is known of the force of a facet by its *adjoint*, the displacements z of the robot under a
/// unit load on the facet: by reciprocity z says how that force answers to loads anywhere. The
/// components fz, mx and my of the facet's force are meant throughout.
namespace holdfast::plan {

/// Values for fz, mx and my, or factors of these.
using Triple = std::array<double, 3>;

/// Vectors of one module for fz, mx and my.
using ThreeVectors = std::array<base::Vec6<double>, 3>;

/// The loads of fz, mx and my of a facet on its module: q.
ThreeVectors facet_loads(const model::Robot& target, const model::LatticeBeam<double>& beam,
                         const model::Facet& facet);

/// The inner products of forces of springs for fz, mx and my, over the springs' stiffness.
class Gram {
 public:
  void add(const ThreeVectors& forces, const base::Vec6<double>& stiffness);

  double& at(std::size_t row, std::size_t column) { return products_[3 * row + column]; }

  /// The energy norm of the forces for a combination of fz, mx and my.
  double norm(const Triple& factors) const;

 private:
  std::array<double, 9> products_{};  ///< By rows.
};

/// What is known of a facet from the modules near it: how little its force changes where something
/// changes far away.
///
/// Let q u be a component of the facet's force for displacements u, and z the displacements under
/// the load q. Take z' that is in equilibrium on a patch of modules around the facet, all beyond
/// standing still, and y in equilibrium on the patch and a rim about it, as if nothing were beyond.
/// The forces of y balance q, and those of y - z', s, balance what z' leaves unbalanced at the
/// patch's rim: so |z - z'| <= |s| in the energy norm, and |s|^2 = q (y - z') is as little as such
/// forces have. For displacements u' of equations whose residual does not touch the patch,
/// |q (u - u')| = |(z - z') K (u - u')| <= |s| |u - u'|, instead of |z| |u - u'| [Prager 1947].
struct LocalAdjoint {
  std::vector<std::size_t> patch;  ///< Modules where z' is not zero.
  std::optional<Gram> gram;        ///< Of s; none if it cannot be found.
};

/// Finds them, each kind of neighbourhood once. May be shared by threads.
class LocalAdjoints {
 public:
  /// Keeps a reference to the robot, of which any connected part may be asked for.
  explicit LocalAdjoints(const model::Robot& target);

  /// Finds what is known of a facet in a part of the target; `is_there` by module.
  LocalAdjoint find(const model::Facet& facet,
                    const std::function<bool(std::size_t)>& is_there) const;

 private:
  struct Region;

  Region region_around(const model::Facet& facet,
                       const std::function<bool(std::size_t)>& is_there) const;
  std::string key_of(const model::Facet& facet, const Region& region) const;
  std::optional<Gram> solve(const model::Facet& facet, const Region& region) const;
  std::optional<solver::BlockLu> equations(const Region& region,
                                           const std::vector<std::int16_t>& row) const;
  std::optional<ThreeVectors> displacements(const ThreeVectors& loads, const Region& region,
                                            const std::vector<std::int16_t>& row) const;

  const model::Robot& target_;
  model::LatticeBeam<double> beam_;
  BeamBlocks blocks_;
  std::vector<std::size_t> first_facet_;  ///< By module.
  mutable std::mutex mutex_;
  mutable std::unordered_map<std::string, std::optional<Gram>> known_;  ///< By neighbourhood.
};

/// A facet's adjoint on a whole robot, the *core*, continued to modules with which the robot grows
/// after it, one after another. It serves all states on that way at once: those that have the core
/// and the first so many of these modules.
///
/// Let q u be fz, mx or my of the facet for displacements u, all facets stuck, and z the core's
/// displacements under the load q, K_0 z = q. By reciprocity q u = z f for the displacements under
/// loads f. A robot that has grown since has more beams: z is continued to new modules, each in
/// balance with its neighbours, and e = h w(z) are the forces of the beams and facets that the core
/// has not. With displacements u of the grown robot that leave f - K u unbalanced, and its exact
/// ones u*,
///   q u* = q u + z (f - K u) + (z* - z) K (u* - u),      |z* - z| <= |e| + the error of z.
/// as K z* = q. The last holds as z* minimises 1/2 z K z - q z, and z misses the minimum by
/// 1/2 |z* - z|^2: of the core's part z is the minimum itself, and the rest of it is 1/2 |e|^2.
/// Far from the facet e is small, and where a module is connected to one other it is zero. So the
/// force is known but for the product of two errors [Becker 2001].
///
/// That is also q u* = z f - (K z - q) u + ..., and K z - q is next to nothing but where modules
/// have been attached: there it is what e puts on them, and on the core what its solution has left.
/// So once the whole sum is known for some u_0 of a state, it takes a sum over new modules to know
/// it for later states, but for |z* - z| |u - u_0|.
class Adjoint {
 public:
  using Vec = base::Vec6<double>;

  /// The adjoint as it was solved.
  struct Core {
    std::size_t facet = 0;                                ///< Of the target.
    ThreeVectors load{};                                  ///< q on its module.
    std::shared_ptr<const std::vector<Element>> modules;  ///< Of the target, ascending.
    std::vector<ThreeVectors> z;                          ///< By place in `modules`.
    Triple error{};                                       ///< Of z, in the energy norm.
  };

  /// Keeps a reference to the robot, all modules of which are there in the end.
  Adjoint(const model::Robot& target, Core core);

  /// The facet's index in the target.
  std::size_t facet() const { return core_.facet; }

  /// Continues z to all modules of a connected state; from the core if it has been continued to
  /// others. From then on answers for this state and those beyond. False if the state lacks a
  /// module of the core.
  bool grow_to(const std::vector<Element>& elements);

  /// Continues z to a module beside one that z is known for.
  void grow(std::size_t module);

  /// Forgets the module that z has been continued to last, after grow_to().
  void shrink();

  /// How many modules a state on the way has beyond the core; none if it is not on the way.
  std::optional<std::size_t> count_in(const std::vector<Element>& elements) const;

  /// Whether these modules come next, after so many.
  bool are_next(std::size_t count, std::span<const std::size_t> modules) const;

  /// q u + z (f - K u) of displacements u that leave `rest`, f - K u, unbalanced, both by module of
  /// the target, in the state that has so many modules beyond the core.
  Triple force(const std::vector<Vec>& u, const std::vector<Vec>& rest, std::size_t count) const;

  /// What of that is due to modules beyond the core, from one to before another: z f of these, less
  /// what e puts on modules times how far these are displaced.
  Triple share(const std::vector<Vec>& u, std::size_t first, std::size_t end) const;

  /// What |z* - z| is at most for a combination of fz, mx and my, in the state that has so many
  /// modules beyond the core.
  double error(const Triple& factors, std::size_t count) const;

 private:
  static constexpr std::int32_t kAbsent = -1;

  /// What the beam of a module that has grown puts on one that was there, as much as z moves them.
  struct Pull {
    std::size_t module = 0;
    ThreeVectors force{};
  };

  const Vec& z(std::size_t component, std::size_t module) const {
    const std::size_t place = base::at(place_[module]);
    const std::size_t core_count = core_.z.size();
    return place < core_count ? core_.z[place][component] : grown_[place - core_count][component];
  }

  bool is_known(std::size_t module) const { return place_[module] != kAbsent; }

  void shrink_to_core();
  bool is_beside(std::size_t module) const;
  void add_gaps(std::size_t module, Gram& gram) const;
  void find_pulls(std::size_t module);
  std::span<const Pull> pulls(std::size_t first, std::size_t end) const;
  template <class Each>
  void for_each_beam(std::size_t module, const Each& each) const;
  template <class Each>
  void for_each_facet(std::size_t module, const Each& each) const;

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  Vec stiffness_{};  ///< Of the springs in the middle, h.
  Core core_;
  LocalBalance local_;                  ///< What z is known for.
  std::vector<std::int32_t> place_;     ///< By module: in the core's z, then in grown_; kAbsent.
  std::vector<ThreeVectors> grown_;     ///< z beyond the core,
  std::vector<Element> grown_modules_;  ///< and whose it is.
  std::vector<Gram> gram_;         ///< Of e, with no module beyond the core, with one, and so on.
  std::vector<Triple> lift_;       ///< z f of grown modules, summed up in the same way.
  std::size_t settled_count_ = 0;  ///< So many had grown at the last grow_to().
  std::vector<Pull> pulls_;        ///< Of those that have grown since,
  std::vector<std::size_t> pull_count_;  ///< with none of them, with one, and so on so many.
};

using Adjoints = std::vector<std::shared_ptr<Adjoint>>;

/// Finds the adjoints of facets, by index in the target, of a robot all whose facets are stuck;
/// none of those that cannot be solved, nor of any more when it is late. The number of threads
/// makes no other difference.
Adjoints find_adjoints(const model::RobotSpec& spec, const model::Robot& target,
                       const ElementSet& core, const std::vector<std::size_t>& facets,
                       int thread_count, const std::function<bool()>& is_late);

/// Facets of a growing robot whose adjoints are known, and what these say of displacements, which
/// is found when it is asked for, as few of them are at a time.
class WatchedFacets {
 public:
  using Vec = base::Vec6<double>;

  /// Watches these and no others. Keeps a reference to the robot, all modules of which are there in
  /// the end.
  WatchedFacets(const model::Robot& target, const Adjoints& adjoints);

  /// What an adjoint says of a facet.
  struct Answer {
    const Adjoint* adjoint = nullptr;
    std::size_t count = 0;  ///< The modules beyond its core, of which the first so many
    std::size_t still = 0;  ///< were there when the robot was solved.
    double moved = 0;       ///< As of improve().
    Triple force{};

    /// How far a combination of its components is off, at most, where the displacements are so far
    /// off.
    double error(const Triple& factors, double energy_error) const {
      return adjoint->error(factors, count) * energy_error + adjoint->error(factors, still) * moved;
    }
  };

  /// The facets that have been asked for and are watched.
  const std::set<std::size_t>& asked_for() const { return asked_for_; }

  /// The robot with these modules was solved, with these displacements, by module of the target.
  void begin(const std::vector<Element>& elements, const std::vector<Vec>& u);

  /// A module was attached.
  void attach(std::size_t module) { attached_.push_back(module); }

  /// The module that was attached last is taken away again.
  void detach_last() { attached_.pop_back(); }

  /// The robot that is there now has got better displacements: modules that were there when it was
  /// solved have moved so far since, in the energy norm.
  void improve(double moved) { moved_ = moved; }

  /// What the adjoint says for displacements u: those of the solved robot, or the better ones, and
  /// of the modules that have been attached since. None if the facet is not watched, or the robot
  /// does not grow the way its adjoint has grown.
  std::optional<Answer> find(std::size_t facet, const std::vector<Vec>& u);

 private:
  /// A facet's state on the way of its adjoint when the robot was solved.
  struct Begun {
    std::optional<std::size_t> count;  ///< The modules beyond the adjoint's core; none: not on it.
    Triple force{};
  };

  const Begun& begun(const Adjoint& adjoint);
  void find_rest();
  void pull(std::size_t module, base::Direction direction, std::size_t other);

  const model::Robot* target_;
  model::LatticeBeam<double> beam_;
  LocalBalance there_;                                              ///< When the robot was solved.
  std::map<std::size_t, std::shared_ptr<const Adjoint>> adjoints_;  ///< By facet.
  std::set<std::size_t> asked_for_;
  std::map<std::size_t, Begun> begun_;  ///< By facet, as far as asked for since it was solved.
  std::vector<Element> elements_;       ///< When the robot was solved,
  std::vector<Vec> u_;                  ///< its displacements,
  std::vector<Vec> rest_;               ///< and f - K u; empty: not yet asked for.
  double moved_ = 0;                    ///< As of improve().
  std::vector<std::size_t> attached_;   ///< Since then.
};

}  // namespace holdfast::plan
