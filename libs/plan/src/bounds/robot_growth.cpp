// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/robot_growth.hpp"

#include <algorithm>
#include <iterator>

#include "cut_vertices.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/plan/part_of.hpp"
#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {
namespace {

/// A seed moves candidates by up to so many layers.
constexpr std::uint64_t kDisturbance = 4;

std::vector<std::size_t> supports_and(const model::Robot& target, const ElementSet& core) {
  std::vector<std::size_t> sources;
  for (std::size_t i = 0; i < target.modules().size(); ++i) {
    if (target.modules()[i].support != model::Support::kNone ||
        core.contains(static_cast<Element>(i))) {
      sources.push_back(i);
    }
  }
  return sources;
}

}  // namespace

RobotGrowth::RobotGrowth(const model::RobotSpec& spec, const model::Robot& target,
                         const ElementSet& core, const ReachRule& rule, bool in_pieces,
                         int thread_count)
    : spec_(spec),
      target_(target),
      core_(core),
      rule_(rule),
      reach_(spec, rule),
      in_pieces_(in_pieces),
      thread_count_(thread_count),
      run_judge_(spec, target, thread_count),
      bodies_(target.bodies()),
      modules_by_body_(target.modules_by_body()),
      places_(places_in_layers(target, supports_and(target, core))),
      state_(spec.existing.size()),
      beside_count_(spec.existing.size()) {
  for (std::size_t i = 0; in_pieces && i < target.modules().size(); ++i) {
    if (target.modules()[i].support != model::Support::kNone) {
      supported_.push_back(static_cast<Element>(i));
    }
  }
  if (!in_pieces && verdict::is_on_flat_floor(target) && target.fixed_count() == 0) {
    balance_.emplace(target);
  }
}

std::vector<Element> RobotGrowth::unit(Element element) const {
  const auto found = modules_by_body_.find(bodies_[base::at(element)]);
  return found == modules_by_body_.end() ? std::vector{element} : found->second;
}

RobotGrowth::Rank RobotGrowth::rank(Element element) const {
  LayerPlace place = places_[base::at(element)];
  if (seed_ != 0) {
    base::Rng rng(seed_ + 0x9e3779b97f4a7c15U * (static_cast<std::uint64_t>(element) + 1));
    place.layer += static_cast<std::int64_t>(rng.below(kDisturbance + 1));
  }
  return {place, element};
}

void RobotGrowth::set_seed(std::uint64_t seed) {
  if (seed == seed_) {
    return;
  }
  std::vector<Element> elements;
  for (const Rank& rank : frontier_) {
    elements.push_back(rank.second);
  }
  seed_ = seed;
  frontier_.clear();
  for (const Element element : elements) {
    frontier_.insert(rank(element));
  }
}

void RobotGrowth::add(Element element) {
  state_.insert(element);
  frontier_.erase(rank(element));
  for (const std::int32_t other : target_.connected()[base::at(element)]) {
    if (other != model::Robot::kNoNeighbour && ++beside_count_[base::at(other)] == 1 &&
        !state_.contains(other)) {
      frontier_.insert(rank(other));
    }
  }
  if (balance_) {
    balance_->add(element);
  }
}

void RobotGrowth::remove(Element element) {
  state_.erase(element);
  if (beside_count_[base::at(element)] > 0) {
    frontier_.insert(rank(element));
  }
  for (const std::int32_t other : target_.connected()[base::at(element)]) {
    if (other != model::Robot::kNoNeighbour && --beside_count_[base::at(other)] == 0) {
      frontier_.erase(rank(other));
    }
  }
  if (balance_) {
    balance_->remove(element);
  }
}

/// Changes what has changed since the last state.
void RobotGrowth::move_to(const ElementSet& state) {
  for (std::size_t word = 0; word < state.words().size(); ++word) {
    for (std::uint64_t bits = state.words()[word] ^ state_.words()[word]; bits != 0;
         bits &= bits - 1) {
      const Element element = static_cast<Element>(64 * word) + __builtin_ctzll(bits);
      state.contains(element) ? add(element) : remove(element);
    }
  }
}

/// Whether others hang on a module, by module. In pieces what is supported is connected through the
/// ground, a row of further nodes, one for each module that is.
std::vector<bool> RobotGrowth::needed_in(const ElementSet& state) const {
  const std::size_t degree = target_.connected()[0].size();
  const auto beside = [&](Element module, std::size_t direction) {
    const std::int32_t other = target_.connected()[base::at(module)][direction];
    return other != model::Robot::kNoNeighbour && state.contains(other) ? other : -1;
  };
  if (!in_pieces_) {
    return cut_vertices(element_count(), state.elements().front(), degree, beside);
  }
  const auto count = static_cast<std::int32_t>(element_count());
  const auto ground_count = static_cast<std::int32_t>(supported_.size());
  const auto place_of = [&](Element module) {
    const auto found = std::ranges::lower_bound(supported_, module);
    return found != supported_.end() && *found == module
               ? count + static_cast<std::int32_t>(found - supported_.begin())
               : -1;
  };
  const auto below = [&](std::int32_t ground, std::size_t direction) {
    const std::int32_t next = ground + (direction == 0 ? 1 : -1);
    if (direction < 2) {
      return next >= 0 && next < ground_count ? count + next : -1;
    }
    const Element module = supported_[base::at(ground)];
    return direction == 2 && state.contains(module) ? module : -1;
  };
  return cut_vertices(element_count() + supported_.size(), count, degree + 1,
                      [&](std::int32_t node, std::size_t direction) {
                        return node >= count        ? below(node - count, direction)
                               : direction < degree ? beside(node, direction)
                                                    : place_of(node);
                      });
}

/// Adds modules that may come on the ground away from all others.
void RobotGrowth::add_feet(std::vector<Element>& list) const {
  std::vector<Rank> feet;
  for (const Element element : supported_) {
    if (!state_.contains(element) && beside_count_[base::at(element)] == 0) {
      feet.push_back(rank(element));
    }
  }
  std::ranges::sort(feet);
  std::ranges::transform(feet, std::back_inserter(list), &Rank::second);
}

/// Modules that leave a connected robot, or pieces, with a support behind.
std::vector<Element> RobotGrowth::removable(const ElementSet& state) const {
  std::vector<Element> list;
  if (state.size() < 2) {
    return list;
  }
  const std::vector<bool> needed = needed_in(state);
  const auto is_support = [&](Element element) {
    return target_.modules()[base::at(element)].support != model::Support::kNone;
  };
  const std::vector<Element> elements = state.elements();
  const auto support_count = std::ranges::count_if(elements, is_support);
  for (const Element element : elements) {
    const bool is_last_support = is_support(element) && support_count == 1;
    if (!core_.contains(element) && !needed[base::at(element)] && !is_last_support) {
      list.push_back(element);
    }
  }
  std::ranges::sort(list, [&](Element a, Element b) { return rank(a) > rank(b); });
  return list;
}

/// The elements of `list` that can get to their cells, or come away from them.
std::vector<Element> RobotGrowth::reachable(std::vector<Element> list, const ElementSet& state,
                                            Sense sense) const {
  if (rule_.reach == Reach::kFree) {
    return list;
  }
  std::vector<bool> can;
  if (sense == Sense::kGrowing) {
    std::vector<base::Cell> cells;
    for (const Element element : list) {
      cells.push_back(spec_.existing[base::at(element)]);
    }
    can = reach_.can_reach_each(state, cells);
  } else {
    for (const Element element : list) {
      can.push_back(reach_.can_reach(changed(state, Sense::kShrinking, {&element, 1}),
                                     spec_.existing[base::at(element)]));
    }
  }
  std::vector<Element> kept;
  for (std::size_t i = 0; i < list.size(); ++i) {
    if (can[i]) {
      kept.push_back(list[i]);
    }
  }
  return kept;
}

void RobotGrowth::put_toppling_last(std::vector<Element>& list, Sense sense) {
  if (!balance_) {
    return;
  }
  std::stable_partition(list.begin(), list.end(), [&](Element element) {
    return sense == Sense::kGrowing ? balance_->stands_with(element)
                                    : balance_->stands_without(element);
  });
}

std::vector<Element> RobotGrowth::candidates(const ElementSet& state, Sense sense,
                                             std::uint64_t seed) {
  set_seed(seed);
  move_to(state);
  std::vector<Element> list;
  if (sense == Sense::kShrinking) {
    list = removable(state);
  } else {
    for (const Rank& rank : frontier_) {
      list.push_back(rank.second);
    }
    add_feet(list);
  }
  list = reachable(std::move(list), state, sense);
  put_toppling_last(list, sense);
  return list;
}

std::optional<Element> RobotGrowth::first_candidate(const ElementSet& state, Sense sense,
                                                    std::uint64_t seed,
                                                    const std::function<bool(Element)>& is_open) {
  if (sense == Sense::kShrinking || rule_.reach != Reach::kFree || in_pieces_) {
    return GrowingStructure::first_candidate(state, sense, seed, is_open);
  }
  set_seed(seed);
  move_to(state);
  std::optional<Element> toppling;
  for (const Rank& rank : frontier_) {
    if (!is_open(rank.second)) {
      continue;
    }
    if (!balance_ || balance_->stands_with(rank.second)) {
      return rank.second;
    }
    toppling = toppling.value_or(rank.second);
  }
  return toppling;
}

Judgement RobotGrowth::judge(const ElementSet& state) {
  const auto judge_piece = [&](const ElementSet& piece) {
    const auto part = model::Robot::create(part_of(spec_, piece), 1);
    // A set of modules that is no robot, such as a start that is not connected, is not safe.
    return part ? plan::judge(part.value(), {.thread_count = thread_count_})
                : Judgement{.verdict = verdict::Verdict::kUnstable};
  };
  if (!in_pieces_) {
    return judge_piece(state);
  }
  std::optional<Judgement> whole;
  for (const ElementSet& piece : pieces_of(target_, state)) {
    const Judgement judged = judge_piece(piece);
    whole = whole ? both_of(*whole, judged) : judged;
  }
  return whole.value_or(Judgement{.verdict = verdict::Verdict::kUnstable});
}

std::vector<std::optional<Judgement>> RobotGrowth::judge_each(
    std::span<const ElementSet> states, const std::function<bool()>& is_late) {
  std::vector<std::optional<Judgement>> judgements(states.size());
  host::Team team(thread_count_);
  team.each(states.size(), [&](std::size_t i) {
    if (!is_late()) {
      judgements[i] = in_pieces_ ? judge(states[i]) : judgement_of(run_judge_.assess(states[i]));
    }
  });
  return judgements;
}

std::vector<Judgement> RobotGrowth::judge_run(const ElementSet& state, Sense sense,
                                              std::span<const Element> run,
                                              const std::function<bool()>& is_late) {
  return run.size() == 1 ? GrowingStructure::judge_run(state, sense, run, is_late)
                         : run_judge_.judge(state, sense, run, {.is_late = is_late});
}

}  // namespace holdfast::plan
