// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "balance.hpp"
#include "bounds/run_judge.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/order_search.hpp"
#include "holdfast/plan/reach.hpp"
#include "holdfast/solver/options.hpp"
#include "search/layers.hpp"

namespace holdfast::plan {

/// A robot that grows module by module; element i is the target's module i. Every state is a robot
/// of its own, connected and supported, and judged as such; or several of these.
class RobotGrowth final : public GrowingStructure {
 public:
  /// `target` is the robot of `spec`, all of whose modules exist. Modules of `core` are in all
  /// states, which may be `in_pieces`. Keeps references to all three.
  RobotGrowth(const model::RobotSpec& spec, const model::Robot& target, const ElementSet& core,
              const ReachRule& rule, bool in_pieces, int thread_count);

  std::size_t element_count() const override { return spec_.existing.size(); }

  /// Bodies come and go as wholes.
  bool has_units() const override { return !modules_by_body_.empty(); }

  std::vector<Element> unit(Element element) const override;

  /// Growing: in layers about the supports and the core, by steps in the target (LayerPlace).
  /// Shrinking: the other way. On a flat floor those without which the robot would topple, or with
  /// which it would, come last.
  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t seed) override;

  std::optional<Element> first_candidate(const ElementSet& state, Sense sense, std::uint64_t seed,
                                         const std::function<bool(Element)>& is_open) override;

  Judgement judge(const ElementSet& state) override;

  /// Judges runs of more than one element by a RunJudge.
  std::vector<Judgement> judge_run(const ElementSet& state, Sense sense,
                                   std::span<const Element> run,
                                   const std::function<bool()>& is_late) override;

  std::size_t run_length_max() const override { return in_pieces_ ? 1 : RunJudge::kRunLength; }

  /// Judges these states as judge() does, each solved; threads share them. None of those
  /// that are left once `is_late`, which several threads may ask.
  std::vector<std::optional<Judgement>> judge_each(std::span<const ElementSet> states,
                                                   const std::function<bool()>& is_late);

 private:
  /// What decides between candidates: lower first.
  using Rank = std::pair<LayerPlace, Element>;

  Rank rank(Element element) const;
  void set_seed(std::uint64_t seed);
  void move_to(const ElementSet& state);
  void add(Element element);
  void remove(Element element);
  std::vector<Element> removable(const ElementSet& state) const;
  std::vector<bool> needed_in(const ElementSet& state) const;
  void add_feet(std::vector<Element>& list) const;
  std::vector<Element> reachable(std::vector<Element> list, const ElementSet& state,
                                 Sense sense) const;
  void put_toppling_last(std::vector<Element>& list, Sense sense);

  const model::RobotSpec& spec_;
  const model::Robot& target_;
  const ElementSet& core_;
  ReachRule rule_;
  ReachFinder reach_;
  bool in_pieces_;
  std::vector<Element> supported_;  ///< Modules that something supports, if states are in pieces.
  int thread_count_;
  RunJudge run_judge_;
  std::vector<std::int32_t> bodies_;  ///< By module; see Robot::bodies().
  std::map<std::int32_t, std::vector<Element>> modules_by_body_;
  std::vector<LayerPlace> places_;  ///< By module, about the supports and the core.
  std::uint64_t seed_ = 0;
  // What follows the state that was asked for last.
  ElementSet state_;
  std::vector<int> beside_count_;   ///< By module: how many of its neighbours are there.
  std::set<Rank> frontier_;         ///< Modules beside the state, not in it.
  std::optional<Balance> balance_;  ///< On a flat floor.
};

}  // namespace holdfast::plan
