// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "balance.hpp"
#include "bounds/core_answers.hpp"
#include "bounds/energy_bound.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/plan/judgement.hpp"

namespace holdfast::plan {

/// Certifies that a robot is safe whichever part of a batch of modules has been attached to it,
/// each of them beside modules that were there before.
///
/// What a module alone does to s and h w of an EnergyBound, d of it being s - h w and e half their
/// sum, is taken for what it does in every part; what it does besides if another is there, too, is
/// taken for something that a part may have or not. As a part has some of all these, for each
/// number i of a spring
///   |sum d_i| <= max(sum of positive d_i, sum of -d_i of the negative),
/// so that |s - h w| of every part is bounded by one sum of squares. A load ratio c is convex and
/// homogeneous, c(sum e) <= sum of the positive c(e); and what a facet lacks to tilting is least
/// where the part takes all that is bad for it. The centre of mass is looked at by each edge of the
/// support polygon of the robot before, which feet that come make no smaller.
///
/// Where the robot before can be factorized (CoreAnswers) its answer to what a module's beams put
/// on it is known, and there s = h w. A module that comes is in balance with its neighbours,
/// wherever the whole batch moves these (EnergyBound::follow()); d is what its beams carry besides
/// what they did when nothing moved. Else a module's load goes down a way of beams as of
/// EnergyBound. Beams between modules of the batch carry nothing, and their h w is that of their
/// ends.
class BatchBound {
 public:
  /// Keeps references to the whole robot, to what it is made of, and to what is known of its
  /// facets.
  BatchBound(const model::RobotSpec& spec, const model::Robot& target, const LocalAdjoints& nearby);

  /// Begins with a robot that is solved and nothing more. False if nothing can be certified on it,
  /// as of EnergyBound; then every module is refused.
  bool begin(const ElementSet& core, const verdict::Assessment& solved);

  /// Makes ready for these modules, which touch the robot that was begun with: many at a time cost
  /// less.
  void prepare(std::span<const Element> modules);

  /// Takes a module into the batch, which touches the robot that was begun with. Returns what holds
  /// of all parts of the batch; none if one of them may be unsafe, and then the module is not
  /// taken.
  std::optional<Judgement> add(Element module);

 private:
  using Vec = base::Vec6<double>;

  /// Sums of what is positive in some numbers, and of what is negative.
  struct Span {
    Vec low{};
    Vec high{};

    void add(const Vec& more);
    double energy(const Vec& stiffness) const;
  };

  /// What the batch can do to a beam.
  struct Beam {
    Span lack;              ///< Of d,
    double load_ratio = 0;  ///< and of e.
  };

  /// What it can do to a facet of one of its modules, where that is alone.
  struct OwnFoot {
    Vec u{};
    Span change;  ///< Of h w, by others.
  };

  /// What one module does.
  struct Footprint {
    Element module = 0;
    Vec u{};
    std::vector<ChangedForces::Spring> beams = {};
    std::vector<std::pair<std::size_t, Vec>> feet = {};  ///< Of the robot before: by how much s
                                                         ///< changes.
    std::vector<std::size_t> hosts = {};
    double own_energy = 0;  ///< Of facets of its own,
    double own_room = 0;    ///< and what |s - h w| / 2 may be before one of these tilts.
    std::size_t root = 0;
    double sway = 0;
    CoreAnswers::Vecs answer = {};  ///< How the robot before moves, if that is known.
  };

  /// Two members that are neighbours, by place.
  struct Pair {
    std::size_t later = 0;
    std::size_t earlier = 0;
    int direction = 0;  ///< From the later one.
  };

  /// All that is known of a batch.
  struct Batch {
    std::vector<Footprint> members;
    std::vector<Pair> pairs;
    std::map<std::size_t, Beam> beams;
    std::map<std::size_t, Span> feet;  ///< Changes of s.
    std::map<std::size_t, OwnFoot> own_feet;
    std::vector<std::size_t> hosts;
    double own_energy = 0;
    double own_room = 0;
    std::map<std::size_t, double> sway;  ///< By root.
    Span moved;                          ///< Mass times displacement, kg mm.
    std::vector<double> ratios;          ///< Of the connections of the robot before.
  };

  Footprint placed(Element module);
  std::optional<Footprint> footprint(Element module);
  std::vector<PointLoad> loads_of(const Footprint& print);
  void find_inverse(std::span<const Footprint> prints);
  void settle(Footprint& print, CoreAnswers::Vecs answer);
  void add_springs(const Footprint& print, Batch& batch) const;
  void add_ratios(const Footprint& print, Batch& batch) const;
  void add_answer(const Footprint& print, Batch& batch) const;
  const Vec& followed(const Footprint& print, const Footprint& moving);
  void add_gap(const ChangedForces::Spring& spring, Batch& batch) const;
  void add_followings(Batch& batch);
  void add_following(const Footprint& print, const Footprint& moving, Batch& batch);
  void take(Footprint print, Batch& batch);
  double shift_mm(const Batch& batch, double error) const;
  bool are_pressed(const Batch& batch, double radius);
  double error_of(const Batch& batch) const;
  double ratio_of(const Batch& batch) const;
  std::optional<double> find_margin_mm(const Batch& batch);

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  EnergyBound bound_;
  std::optional<Balance> balance_;  ///< Where the support polygon decides.
  ElementSet core_;
  bool has_core_ = false;
  std::unique_ptr<CoreAnswers> answers_;  ///< None: loads go down ways.
  std::vector<std::int32_t> core_place_;  ///< By module: in the core, or -1.
  std::map<Element, Footprint> prepared_;
  std::map<std::pair<Element, Element>, Vec> followed_;  ///< Of whom by whom.
  Batch batch_;
};

}  // namespace holdfast::plan
