// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "bounds/batch_bound.hpp"
#include "bounds/run_judge.hpp"
#include "holdfast/plan/order.hpp"
#include "patience.hpp"

namespace holdfast::plan {

/// Makes time steps of an order: batches of modules that come in any order, so that the robot is
/// safe whichever part of a batch has come.
///
/// List scheduling: of the modules beside the robot those come first behind which the longest chain
/// of others waits. A batch grows module by module as long as all of its parts are certified by a
/// BatchBound; where no bound serves, as long as few enough parts have to be checked each. Where
/// nothing can come any more, though the order could go on, another order is sought from there; if
/// there is none it goes back to where it was in step with the order, and keeps nearer to that.
class TimeSteps {
 public:
  /// Keeps references.
  TimeSteps(const OrderTask& task, const model::Robot& target, const RobotOrderOptions& options,
            const Patience& patience);

  /// Replaces the steps of an order that was found, and their judgements, which are those of the
  /// parts of each step, too: of the step that led to a state or, where the robot is taken apart
  /// (RobotOrderOptions::told_end), of that by which it is left. What remains when time runs out
  /// comes as the order has it.
  void replace(Order& order);

  /// The largest load ratio of states that were solved.
  const std::optional<double>& solved_ratio() const { return solved_ratio_; }

 private:
  /// Where the steps are in step with the order: its first so many modules are there.
  struct Mark {
    ElementSet state;
    std::size_t place = 0;
    std::size_t step_count = 0;
  };

  /// Modules that come together, and what holds of every part of them.
  struct Found {
    Batch batch = {};
    Judgement judgement = {};
    Judgement whole = {};  ///< Of all of them.
  };

  void follow(const ElementSet& state, const Order& order, std::size_t first);
  bool is_in_step() const;
  std::vector<Element> candidates() const;
  bool can_come(Batch batch, Element element) const;
  Found by_bounds(std::span<const Element> candidates);
  Found by_checks(std::span<const Element> candidates);
  Found next();
  Found next_of_order() const;
  bool take(Found found);
  void step();
  bool seek_on();
  void go_back();
  void finish();
  verdict::Assessment solve(const ElementSet& state);
  bool is_told() const;
  void tell_certain(std::size_t count);
  void tell(Order& order);

  const OrderTask& task_;
  const model::Robot& target_;
  const RobotOrderOptions& options_;
  const Patience& patience_;
  ReachFinder reach_;
  RunJudge run_judge_;
  LocalAdjoints nearby_;
  BatchBound bound_;
  std::vector<int> tail_;  ///< By module: the longest chain that waits for it.
  // The order that is followed.
  std::vector<Element> order_;
  std::vector<Judgement> known_;     ///< After each of its modules.
  std::vector<std::size_t> places_;  ///< By module, in the order.
  std::size_t window_ = 0;           ///< Modules come before their turn by so many places.
  Mark mark_;
  std::size_t steps_to_mark_ = 0;  ///< Another order is sought after so many since.
  // What has been reached.
  ElementSet state_;
  std::size_t place_ = 0;  ///< The first of the order that is not there.
  std::optional<verdict::Assessment> solved_;
  std::vector<Found> steps_;
  std::size_t told_count_ = 0;  ///< Of these, as RobotOrderOptions::certified says.
  std::optional<double> solved_ratio_;
  std::size_t state_count_ = 0;
};

/// The least number of time steps from a start: steps from it to the farthest module, or as many as
/// it takes if each has the most modules that it may.
std::size_t step_count_least(const model::Robot& target, const ElementSet& start,
                             std::size_t parallel_max);

}  // namespace holdfast::plan
