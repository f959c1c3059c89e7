// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "balance.hpp"
#include "bounds/energy_bound.hpp"
#include "bounds/followed_robot.hpp"
#include "bounds/section_response.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/order_search.hpp"
#include "holdfast/plan/reach.hpp"
#include "holdfast/solver/options.hpp"
#include "search/layers.hpp"

namespace holdfast::plan {

/// A robot that grows module by module; element i is the target's module i. Every state is a robot
/// of its own, connected and supported, and judged as such.
class RobotGrowth final : public GrowingStructure {
 public:
  /// `target` is the robot of `spec`, all of whose modules exist. Modules of `core` are in all
  /// states. Keeps references to all three.
  RobotGrowth(const model::RobotSpec& spec, const model::Robot& target, const ElementSet& core,
              ReachRule rule, int thread_count);

  std::size_t element_count() const override { return spec_.existing.size(); }

  /// Growing: in layers about the supports and the core, by steps in the target (LayerPlace).
  /// Shrinking: the other way. On a flat floor those without which the robot would topple, or with
  /// which it would, come last.
  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t seed) override;

  std::optional<Element> first_candidate(const ElementSet& state, Sense sense, std::uint64_t seed,
                                         const std::function<bool(Element)>& is_open) override;

  Judgement judge(const ElementSet& state) override;

  /// Growing, most states are certified by an EnergyBound instead of solved. What is solved is so
  /// from nothing, by pieces of the run on all threads.
  std::vector<Judgement> judge_run(const ElementSet& state, Sense sense,
                                   std::span<const Element> run,
                                   const std::function<bool()>& is_late) override;

  std::size_t run_length_max() const override { return kRunLength; }

  /// The same as judge() of each of these states, each connected, solved; threads share them. None
  /// of those that are left once `is_late`, which several threads may ask.
  std::vector<std::optional<Judgement>> judge_each(std::span<const ElementSet> states,
                                                   const std::function<bool()>& is_late);

  /// The robot of a state.
  base::Result<model::Robot> robot(const ElementSet& state) const;

 private:
  /// Longer runs cost less for each state, as each of their pieces begins with a solution from
  /// nothing, and are in vain beyond the first unsafe one.
  static constexpr std::size_t kRunLength = 1024;
  /// Pieces of a run, each of which begins with a state that is solved: at least so long, and no
  /// more of them than that, whatever the number of threads, so that the same states are solved.
  static constexpr std::size_t kPieceMin = 8;
  static constexpr std::size_t kPieceCountMax = 8;

  /// In robots of fewer modules a solution from nothing costs no more than one that follows.
  static constexpr std::size_t kFollowedMin = 256;
  /// A section's answers take about four solutions from nothing: for fewer states they are not
  /// sought.
  static constexpr std::size_t kSectionMin = 6;
  /// Each costs another solution that follows.
  static constexpr int kImprovementMax = 2;

  /// What decides between candidates: lower first.
  using Rank = std::pair<LayerPlace, Element>;

  /// What a piece of a run is judged with.
  struct Tools {
    EnergyBound& bound;
    FollowedRobot& followed;
    SectionResponse& section;
    const std::function<bool()>& is_late;
  };

  class Piece;

  Rank rank(Element element) const;
  void set_seed(std::uint64_t seed);
  void move_to(const ElementSet& state);
  void add(Element element);
  void remove(Element element);
  double room_mm(Balance& balance) const;
  verdict::Assessment assess_alone(const ElementSet& state) const;
  std::vector<Element> removable(const ElementSet& state) const;
  std::vector<Element> reachable(std::vector<Element> list, const ElementSet& state,
                                 Sense sense) const;
  std::vector<Judgement> judge_piece(ElementSet state, Sense sense, std::span<const Element> run,
                                     const Tools& tools) const;
  std::vector<std::size_t> doubtful_facets(const ElementSet& state);
  void grow_adjoints(const ElementSet& state, std::span<const Element> run);
  void renew_adjoints(const ElementSet& state, const std::function<bool()>& is_late);
  static std::optional<double> bound_by_following(const Tools& tools, double room_mm);
  void put_toppling_last(std::vector<Element>& list, Sense sense);

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  const ElementSet& core_;
  ReachRule rule_;
  ReachFinder reach_;
  int thread_count_;
  LocalAdjoints adjoints_;
  std::vector<EnergyBound> bounds_;        ///< By piece of a run.
  Adjoints facet_adjoints_;                ///< All of these know them.
  std::vector<FollowedRobot> followed_;    ///< The same.
  std::vector<SectionResponse> sections_;  ///< The same.
  std::vector<LayerPlace> places_;         ///< By module, about the supports and the core.
  std::uint64_t seed_ = 0;
  // What follows the state that was asked for last.
  ElementSet state_;
  std::vector<int> beside_count_;   ///< By module: how many of its neighbours are there.
  std::set<Rank> frontier_;         ///< Modules beside the state, not in it.
  std::optional<Balance> balance_;  ///< On a flat floor.
};

/// What remains of a spec if only these of its modules are there.
model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules);

}  // namespace holdfast::plan
