// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "balance.hpp"
#include "bounds/energy_bound.hpp"
#include "holdfast/plan/element_set.hpp"
#include "holdfast/plan/judgement.hpp"

namespace holdfast::plan {

/// Certifies that a robot is safe whichever part of a batch of modules has been attached to it, each
/// of them beside modules that were there before.
///
/// What a module alone does to s and h w of an EnergyBound, d of it being s - h w and e half their
/// sum, is taken for what it does in every part, with the beams between modules of the batch, whose
/// h w is that of their ends, as further ones. As a part has some of them, for each number i of a
/// spring
///   |sum d_i| <= max(sum of positive d_i, sum of -d_i of the negative),
/// so that |s - h w| of every part is bounded by one sum of squares. A load ratio c is convex and
/// homogeneous, c(sum e) <= sum of the positive c(e); and what a facet lacks to tilting is least
/// where the part takes all that is bad for it. The centre of mass is looked at by each edge of the
/// support polygon of the robot before, which feet that come make no smaller.
class BatchBound {
 public:
  /// Keeps references to the whole robot, and to what is known of its facets.
  BatchBound(const model::Robot& target, const LocalAdjoints& nearby);

  /// Begins with a robot that is solved and nothing more. False if nothing can be certified on it,
  /// as of EnergyBound; then every module is refused.
  bool begin(const ElementSet& core, const verdict::Assessment& solved);

  /// Takes a module into the batch, which touches the robot that was begun with. Returns what holds
  /// of all parts of the batch; none if one of them may be unsafe, and then the module is not taken.
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

  /// What one module does.
  struct Footprint {
    Element module = 0;
    Vec u{};
    std::vector<ChangedForces::Spring> beams = {};
    std::vector<std::pair<std::size_t, Vec>> feet = {};  ///< Of the robot before: by how much s changes.
    std::vector<std::size_t> hosts = {};
    double own_energy = 0;  ///< Of facets of its own,
    double own_room = 0;    ///< and what |s - h w| / 2 may be before one of these tilts.
    std::size_t root = 0;
    double sway = 0;
  };

  /// All that is known of a batch.
  struct Batch {
    std::vector<Footprint> members;
    std::map<std::size_t, Beam> beams;
    std::map<std::size_t, Span> feet;  ///< Changes of s.
    std::vector<std::size_t> hosts;
    double own_energy = 0;
    double own_room = 0;
    std::map<std::size_t, double> sway;  ///< By root.
    Span moved;                          ///< Mass times displacement, kg mm.
  };

  std::optional<Footprint> footprint(Element module);
  void take(Footprint print, Batch& batch) const;
  double shift_mm(const Batch& batch, double error) const;
  std::optional<Judgement> judge(const Batch& batch);

  const model::Robot& target_;
  EnergyBound bound_;
  std::optional<Balance> balance_;  ///< Where the support polygon decides.
  ElementSet core_;
  bool has_core_ = false;
  Batch batch_;
};

}  // namespace holdfast::plan
