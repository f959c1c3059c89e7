// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "orders/time_steps.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "bounds/robot_growth.hpp"
#include "judges/stage_judge.hpp"
#include "search/layers.hpp"

namespace holdfast::plan {
namespace {

/// Where no bound serves all parts of so many modules at most are checked, 31, or in robots whose
/// states take long 7.
constexpr std::size_t kCheckedMax = 5;
constexpr std::size_t kCheckedMaxOfLarge = 3;

/// The number of candidates that are tried for a batch by checks.
constexpr std::size_t kTriedByChecks = 12;

/// The number of candidates that are looked at together: what they need of the robot before takes
/// one pass over its factors. With 64 instead of 16 some 1,800 modules of a growth of 3,000 had
/// come after a minute instead of 1,300.
constexpr std::size_t kPrepared = 64;

/// A batch ends after this number of candidates in a row that no bound allows: others hardly fare
/// better.
constexpr std::size_t kRefusedMax = 256;

/// Another order is sought by so many states for each module that is to come, and so many more.
constexpr std::size_t kSoughtPerElement = 2;
constexpr std::size_t kSoughtMin = 256;

/// Another order is sought after this number of steps out of step with the one that is followed, as
/// time may run out, and what is behind the last mark would be lost; then after twice as many.
constexpr std::size_t kStepsPerMark = 24;

/// Where ways matter modules come out of turn by so many batches at most: others may be in the way.
constexpr std::size_t kWindowOfWays = 8;

/// Steps from a state to every module through connections.
std::vector<std::int64_t> steps_from(const model::Robot& target, const ElementSet& start) {
  std::vector<std::size_t> sources;
  std::ranges::transform(start.elements(), std::back_inserter(sources),
                         [](Element element) { return base::at(element); });
  return distances_from(target, std::move(sources));
}

/// How many others at most come one after another behind each module on shortest chains.
std::vector<int> waiting_chains(const model::Robot& target, const ElementSet& start) {
  const std::vector<std::int64_t> distance = steps_from(target, start);
  std::vector<Element> farthest_first;
  for (std::size_t i = 0; i < distance.size(); ++i) {
    farthest_first.push_back(static_cast<Element>(i));
  }
  std::ranges::stable_sort(farthest_first, [&](Element a, Element b) {
    return distance[base::at(a)] > distance[base::at(b)];
  });
  std::vector<int> tail(distance.size(), 0);
  for (const Element element : farthest_first) {
    for (const std::int32_t other : target.connected()[base::at(element)]) {
      if (other != model::Robot::kNoNeighbour &&
          distance[base::at(other)] == distance[base::at(element)] + 1) {
        tail[base::at(element)] = std::max(tail[base::at(element)], 1 + tail[base::at(other)]);
      }
    }
  }
  return tail;
}

std::vector<base::Cell> cells_to_come(const OrderTask& task, std::span<const Element> elements) {
  std::vector<base::Cell> cells;
  std::ranges::transform(elements, std::back_inserter(cells),
                         [&](Element element) { return task.target.existing[base::at(element)]; });
  return cells;
}

}  // namespace

std::size_t step_count_least(const model::Robot& target, const ElementSet& start,
                             std::size_t parallel_max) {
  const std::size_t count = target.modules().size() - start.size();
  const std::vector<std::int64_t> distance = steps_from(target, start);
  const std::int64_t farthest = *std::ranges::max_element(distance);
  return std::max(static_cast<std::size_t>(farthest),
                  count / parallel_max + (count % parallel_max == 0 ? 0 : 1));
}

TimeSteps::TimeSteps(const OrderTask& task, const model::Robot& target,
                     const RobotOrderOptions& options, const Patience& patience)
    : task_(task),
      target_(target),
      options_(options),
      patience_(patience),
      reach_(task.target, task.rule),
      run_judge_(task.target, target, options.thread_count),
      nearby_(target),
      bound_(task.target, target, nearby_),
      places_(target.modules().size()) {}

verdict::Assessment TimeSteps::solve(const ElementSet& state) {
  ++state_count_;
  verdict::Assessment solved = run_judge_.assess(state);
  if (solved.verdict == verdict::Verdict::kSafe) {
    solved_ratio_ = larger(solved_ratio_, solved.load_ratio_max);
  }
  return solved;
}

/// Follows an order from the state that it begins with.
void TimeSteps::follow(const ElementSet& state, const Order& order, std::size_t first) {
  order_.clear();
  known_.clear();
  for (std::size_t i = 0; i < order.steps.size(); ++i) {
    for (const Element element : order.steps[i]) {
      places_[base::at(element)] = order_.size();
      order_.push_back(element);
      known_.push_back(order.judgements[i + 1]);
    }
  }
  place_ = 0;
  mark_ = {.state = state, .place = 0, .step_count = first};
}

bool TimeSteps::is_in_step() const {
  return state_.size() - mark_.state.size() + mark_.place == place_;
}

/// Modules beside the robot that are not too early, those first that most wait for.
std::vector<Element> TimeSteps::candidates() const {
  std::vector<Element> list;
  for (std::size_t i = place_; i < std::min(order_.size(), place_ + window_); ++i) {
    const Element element = order_[i];
    const bool is_beside =
        std::ranges::any_of(target_.connected()[base::at(element)], [&](std::int32_t other) {
          return other != model::Robot::kNoNeighbour && state_.contains(other);
        });
    if (is_beside && !state_.contains(element)) {
      list.push_back(element);
    }
  }
  const std::vector<bool> can = reach_.can_reach_each(state_, cells_to_come(task_, list));
  std::size_t kept = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (can[i]) {
      list[kept++] = list[i];
    }
  }
  list.resize(kept);
  std::ranges::stable_sort(
      list, [&](Element a, Element b) { return tail_[base::at(a)] > tail_[base::at(b)]; });
  return list;
}

bool TimeSteps::can_come(Batch batch, Element element) const {
  batch.push_back(element);
  return reach_.can_reach_in_any_order(state_, cells_to_come(task_, batch));
}

TimeSteps::Found TimeSteps::by_bounds(std::span<const Element> candidates) {
  Found found;
  if (!bound_.begin(state_, *solved_)) {
    return found;
  }
  std::size_t refused_count = 0;
  std::vector<Element> beside_others;  // They come last: beams between two that come are unknown.
  const auto try_one = [&](Element element) {
    const auto judgement =
        can_come(found.batch, element) ? bound_.add(element) : std::optional<Judgement>();
    refused_count = judgement ? 0 : refused_count + 1;
    if (judgement) {
      found.batch.push_back(element);
      found.judgement = *judgement;
    }
  };
  const auto is_over = [&] {
    return found.batch.size() == task_.parallel_max || refused_count == kRefusedMax;
  };
  for (std::size_t i = 0; i < candidates.size() && !is_over(); ++i) {
    if (i % kPrepared == 0) {
      bound_.prepare(candidates.subspan(i, std::min(kPrepared, candidates.size() - i)));
    }
    const bool is_beside =
        std::ranges::any_of(target_.connected()[base::at(candidates[i])], [&](std::int32_t other) {
          return std::ranges::find(found.batch, other) != found.batch.end();
        });
    is_beside ? beside_others.push_back(candidates[i]) : try_one(candidates[i]);
  }
  for (std::size_t i = 0; i < beside_others.size() && !is_over(); ++i) {
    try_one(beside_others[i]);
  }
  return found;
}

TimeSteps::Found TimeSteps::by_checks(std::span<const Element> candidates) {
  const bool is_large = target_.modules().size() > kExactModuleCount;
  const std::size_t count_max =
      std::min(task_.parallel_max, is_large ? kCheckedMaxOfLarge : kCheckedMax);
  RobotGrowth growth(task_.target, target_, state_, task_.rule, false, options_.thread_count);
  Found found{.judgement = {.verdict = verdict::Verdict::kSafe}};
  std::vector<ElementSet> parts = {state_};
  for (const Element element : candidates.first(std::min(candidates.size(), kTriedByChecks))) {
    if (found.batch.size() == count_max || !can_come(found.batch, element)) {
      continue;
    }
    std::vector<ElementSet> more;
    for (const ElementSet& part : parts) {
      more.push_back(changed(part, Sense::kGrowing, {&element, 1}));
    }
    const auto judged = growth.judge_each(more, [&] { return patience_.is_over(); });
    state_count_ += more.size();
    if (!std::ranges::all_of(judged, [](const auto& each) { return each && each->is_safe(); })) {
      continue;
    }
    for (const auto& each : judged) {
      found.judgement = both_of(found.judgement, *each);
    }
    found.batch.push_back(element);
    parts.insert(parts.end(), more.begin(), more.end());
  }
  return found;
}

/// The next module of the order, which is known to be safe where the steps are in step with it.
TimeSteps::Found TimeSteps::next_of_order() const {
  return {.batch = {order_[place_]}, .judgement = known_[place_], .whole = known_[place_]};
}

TimeSteps::Found TimeSteps::next() {
  if (!solved_) {
    solved_ = solve(state_);
  }
  const std::vector<Element> list = candidates();
  Found found = by_bounds(list);
  const bool is_large = target_.modules().size() > kExactModuleCount;
  const std::size_t few =
      std::min({is_large ? kCheckedMaxOfLarge : kCheckedMax, list.size(), task_.parallel_max});
  if (found.batch.size() < few) {
    Found checked = by_checks(list);
    if (checked.batch.size() > found.batch.size()) {
      found = std::move(checked);
    }
  }
  return found.batch.empty() && is_in_step() ? next_of_order() : found;
}

/// Makes a step of what was found. False if the robot behind it is not safe, which no bound should
/// let happen.
bool TimeSteps::take(Found found) {
  ElementSet state = changed(state_, Sense::kGrowing, found.batch);
  verdict::Assessment solved = solve(state);
  const Judgement judged = judgement_of(solved);
  const bool is_known = found.batch.size() == 1 && is_in_step() && found.batch[0] == order_[place_];
  if (!judged.is_safe() && !is_known) {
    return false;
  }
  found.whole = judged.is_safe() ? judged : known_[place_];
  if (found.batch.size() == 1) {
    found.judgement = found.whole;
  }
  state_ = std::move(state);
  solved_ = std::move(solved);
  while (place_ < order_.size() && state_.contains(order_[place_])) {
    ++place_;
  }
  steps_.push_back(std::move(found));
  return true;
}

/// Seeks another order from the state that was reached.
bool TimeSteps::seek_on() {
  RobotGrowth growth(task_.target, target_, state_, task_.rule, false, options_.thread_count);
  const std::size_t left = order_.size() - place_;
  const Order found = find_order(growth, {&state_, 1},
                                 {.seed = options_.seed,
                                  .state_count_max = kSoughtMin + kSoughtPerElement * left,
                                  .is_interrupted = [&] { return patience_.is_over(); }});
  state_count_ += found.state_count;
  if (found.outcome != OrderOutcome::kFound) {
    return false;
  }
  follow(state_, found, steps_.size());
  return true;
}

/// Goes back to where the steps were in step with the order.
void TimeSteps::go_back() {
  state_ = mark_.state;
  place_ = mark_.place;
  steps_.resize(mark_.step_count);
  solved_.reset();
}

void TimeSteps::step() {
  if (is_in_step()) {
    mark_ = {.state = state_, .place = place_, .step_count = steps_.size()};
  } else if (steps_.size() >= mark_.step_count + steps_to_mark_) {
    steps_to_mark_ *= 2;
    seek_on();
  }
  Found found = window_ == 1 && is_in_step() ? next_of_order() : next();
  const bool is_stuck = found.batch.empty();
  if (!is_stuck && take(std::move(found))) {
    if (is_in_step()) {
      window_ = std::min(2 * window_, order_.size());
    }
    return;
  }
  if (!is_stuck || !seek_on()) {
    go_back();
  }
  window_ = std::max<std::size_t>(1, window_ / 4);
}

/// Lets the rest come as the order has it.
void TimeSteps::finish() {
  go_back();
  for (; place_ < order_.size(); ++place_) {
    steps_.push_back(next_of_order());
    state_.insert(order_[place_]);
  }
}

void TimeSteps::replace(Order& order) {
  state_ = order.start;
  tail_ = waiting_chains(target_, state_);
  steps_to_mark_ = kStepsPerMark;
  follow(state_, order, 0);
  const bool is_near =
      task_.rule.reach != Reach::kFree && task_.parallel_max < order_.size() / kWindowOfWays;
  window_ = is_near ? kWindowOfWays * task_.parallel_max : std::max<std::size_t>(1, order_.size());
  if (is_told()) {
    options_.certified(state_.elements(), order.judgements.front());
  }
  while (state_.size() < target_.modules().size()) {
    if (patience_.is_over()) {
      finish();
      break;
    }
    step();
    tell_certain(mark_.step_count);
    if (options_.progress) {
      options_.progress(order.state_count + state_count_, state_.size(), state_.size());
    }
  }
  tell_certain(steps_.size());
  tell(order);
}

bool TimeSteps::is_told() const {
  return options_.certified && options_.told_end == Sense::kGrowing;
}

/// Tells the steps up to so many. Those up to the mark are never taken back, and no others are
/// certain before the end.
void TimeSteps::tell_certain(std::size_t count) {
  for (; is_told() && told_count_ < count; ++told_count_) {
    options_.certified(steps_[told_count_].batch, steps_[told_count_].judgement);
  }
}

void TimeSteps::tell(Order& order) {
  const bool is_apart = options_.told_end == Sense::kShrinking;
  Judgement whole = order.judgements.front();
  order.steps.clear();
  order.judgements.clear();
  for (Found& found : steps_) {
    const bool has_parts = found.batch.size() > 1;
    if (is_apart) {
      order.judgements.push_back(has_parts ? both_of(whole, found.judgement) : whole);
    } else {
      order.judgements.push_back(whole);
      found.whole = found.judgement;
    }
    whole = found.whole;
    order.steps.push_back(std::move(found.batch));
  }
  order.judgements.push_back(whole);
  order.state_count += state_count_;
  order.is_any_order = true;
}

}  // namespace holdfast::plan
