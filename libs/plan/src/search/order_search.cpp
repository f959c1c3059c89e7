// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/plan/order_search.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "holdfast/base/rng.hpp"
#include "patience.hpp"

namespace holdfast::plan {
namespace {

/// How many states each end may judge before it is the other one's turn, by round: enough for one
/// way through the whole and some blocked states, then twice as many each time.
constexpr std::size_t kFirstBudgetPerElement = 2;
constexpr std::size_t kFirstBudgetMin = 256;

/// Runs begin with this many states, double while all of them are safe, and begin anew after one
/// that is not.
constexpr std::size_t kFirstRun = 4;

using States = std::unordered_set<ElementSet, ElementSetHash>;

/// What is known of states, and what may still be spent to know more.
class Knowledge {
 public:
  Knowledge(GrowingStructure& structure, const OrderOptions& options)
      : structure_(structure), options_(options) {}

  const Judgement* find(const ElementSet& state) const {
    const auto found = judgements_.find(state);
    return found == judgements_.end() ? nullptr : &found->second;
  }

  const Judgement& judge(const ElementSet& state) {
    const Judgement* known = find(state);
    return known != nullptr ? *known
                            : judgements_.emplace(state, structure_.judge(state)).first->second;
  }

  void learn(const ElementSet& state, const Judgement& judgement) {
    judgements_.emplace(state, judgement);
  }

  std::size_t state_count() const { return judgements_.size(); }

  bool is_late() const { return patience_.is_over(); }

  bool is_spent() const { return is_late() || state_count() >= options_.state_count_max; }

 private:
  GrowingStructure& structure_;
  const OrderOptions& options_;
  std::unordered_map<ElementSet, Judgement, ElementSetHash> judgements_;
  Patience patience_{options_.seconds_max, options_.is_interrupted};
};

/// One end of the search: depth first from its roots, until a goal is reached or nothing is left.
class Explorer {
 public:
  Explorer(GrowingStructure& structure, Knowledge& knowledge, const OrderOptions& options,
           Sense sense, std::vector<ElementSet> roots, std::vector<ElementSet> goals)
      : structure_(structure),
        knowledge_(knowledge),
        options_(options),
        sense_(sense),
        roots_(std::move(roots)),
        goals_(goals.begin(), goals.end()) {
    furthest_ = roots_.front().size();
  }

  enum class Answer : std::uint8_t { kReached, kExhausted, kSpent };

  /// Begins anew at the roots and judges up to `budget` states.
  Answer explore(std::size_t budget, std::uint64_t seed);

  /// The most (growing) or fewest elements of a safe state so far.
  std::size_t furthest() const { return furthest_; }

  /// A way of safe states: the root, and the groups from it on.
  struct Way {
    ElementSet root;
    std::vector<Batch> groups = {};
  };

  /// The way to the goal, after kReached.
  Way way() const;

  /// The way to the first of the states that are furthest; none if no root is safe.
  std::optional<Way> furthest_way();

  /// The proof that nothing is left to enter, after kExhausted.
  Closure closure() const;

 private:
  /// A state on the present way: what led to it, and what can come next. Groups of one stand in
  /// `singles`, once something else than the first of them is asked for; when none of them is left
  /// all others are in `groups`.
  struct Frame {
    Batch group;
    std::vector<Element> singles = {};
    std::vector<Batch> groups = {};
    std::size_t next = 0;
    bool has_singles = false;
    bool has_groups = false;
  };

  bool is_dead(const ElementSet& state) const { return dead_.contains(state); }

  bool comes_alone(Element element) const {
    return !structure_.has_units() || structure_.unit(element).size() == 1;
  }

  bool is_hopeless(const ElementSet& state) const {
    const Judgement* known = knowledge_.find(state);
    return is_dead(state) || (known != nullptr && !known->is_safe());
  }

  Answer search_from(const ElementSet& root, std::size_t state_count_max);
  bool advance();
  bool take_group();
  std::vector<Element> propose();
  std::optional<Element> next_single(const std::function<bool(Element)>& is_open);
  void enter(Batch group);
  void leave();
  void note(const ElementSet& state);
  void keep_way();

  GrowingStructure& structure_;
  Knowledge& knowledge_;
  const OrderOptions& options_;
  Sense sense_;
  std::vector<ElementSet> roots_;
  States goals_;
  States dead_;
  std::vector<ElementSet> dead_in_order_;
  ElementSet root_;
  ElementSet state_;
  std::vector<Frame> frames_;
  std::size_t run_length_ = kFirstRun;
  std::uint64_t seed_ = 0;
  std::size_t furthest_ = 0;
  std::optional<Way> kept_;        ///< The furthest one that was left.
  std::size_t kept_furthest_ = 0;  ///< The elements of the state at its end.
};

void Explorer::note(const ElementSet& state) {
  furthest_ = sense_ == Sense::kGrowing ? std::max(furthest_, state.size())
                                        : std::min(furthest_, state.size());
}

/// Goes on to a state that is safe.
void Explorer::enter(Batch group) {
  state_ = changed(std::move(state_), sense_, group);
  note(state_);
  frames_.push_back({.group = std::move(group)});
}

/// Keeps the present way, before it is left, if it led further than the one that is kept.
void Explorer::keep_way() {
  const bool is_further =
      sense_ == Sense::kGrowing ? state_.size() > kept_furthest_ : state_.size() < kept_furthest_;
  if (!frames_.empty() && (!kept_ || is_further)) {
    kept_ = way();
    kept_furthest_ = state_.size();
  }
}

/// Goes back from a state from which no way is left.
void Explorer::leave() {
  keep_way();
  dead_in_order_.push_back(state_);
  dead_.insert(state_);
  const Sense back = sense_ == Sense::kGrowing ? Sense::kShrinking : Sense::kGrowing;
  state_ = changed(std::move(state_), back, frames_.back().group);
  frames_.pop_back();
}

/// The next elements to try one after another: from the present state the first candidate that is
/// not known to lead nowhere, then always the most promising one, up to a state that is known.
std::vector<Element> Explorer::propose() {
  std::vector<Element> run;
  ElementSet state = state_;
  while (run.size() < run_length_) {
    const auto is_open = [&](Element element) {
      return comes_alone(element) && !is_hopeless(changed(state, sense_, {&element, 1}));
    };
    const auto found = run.empty() ? next_single(is_open)
                                   : structure_.first_candidate(state, sense_, seed_, is_open);
    if (!found) {
      break;
    }
    state = changed(std::move(state), sense_, {&*found, 1});
    const bool is_known = knowledge_.find(state) != nullptr;
    if (is_known && !run.empty()) {
      break;
    }
    run.push_back(*found);
    if (is_known || goals_.contains(state)) {
      break;
    }
  }
  return run;
}

/// The next candidate of the present state that is open, where the frame then stands.
std::optional<Element> Explorer::next_single(const std::function<bool(Element)>& is_open) {
  Frame& frame = frames_.back();
  if (!frame.has_singles) {
    frame.singles = structure_.candidates(state_, sense_, seed_);
    frame.has_singles = true;
  }
  const auto found = std::find_if(frame.singles.begin() + static_cast<std::ptrdiff_t>(frame.next),
                                  frame.singles.end(), is_open);
  frame.next = static_cast<std::size_t>(found - frame.singles.begin());
  return found == frame.singles.end() ? std::nullopt : std::optional(*found);
}

/// Tries one run of single elements. False if no single element is left here.
bool Explorer::advance() {
  const std::vector<Element> run = propose();
  if (run.empty()) {
    return false;
  }
  ++frames_.back().next;
  ElementSet first = changed(state_, sense_, {run.data(), 1});
  if (knowledge_.find(first) != nullptr) {  // Safe, as it is not hopeless.
    enter({run.front()});
    return true;
  }
  const std::vector<Judgement> judgements =
      structure_.judge_run(state_, sense_, run, [&] { return knowledge_.is_late(); });
  for (std::size_t i = 0; i < judgements.size(); ++i) {
    knowledge_.learn(changed(state_, sense_, {&run[i], 1}), judgements[i]);
    if (!judgements[i].is_safe()) {
      run_length_ = 1;
      return true;
    }
    if (i > 0) {
      ++frames_.back().next;
    }
    enter({run[i]});
  }
  run_length_ = std::min(std::max(2 * run_length_, kFirstRun), structure_.run_length_max());
  return true;
}

/// Tries the next group of several elements. False if none is left; true, too, if time is over.
bool Explorer::take_group() {
  if (options_.group_size == 1 && !structure_.has_units()) {
    return false;
  }
  if (!frames_.back().has_groups) {
    Frame& frame = frames_.back();
    frame.groups = successors(structure_, state_, sense_, options_.group_size, seed_,
                              [&] { return knowledge_.is_late(); });
    if (knowledge_.is_late()) {
      return true;  // Some may be missing, and the search ends here.
    }
    std::erase_if(frame.groups, [](const Batch& group) { return group.size() == 1; });
    frame.has_groups = true;
    frame.next = 0;
  }
  Frame& frame = frames_.back();
  while (frame.next < frame.groups.size()) {
    Batch group = frame.groups[frame.next++];
    const ElementSet state = changed(state_, sense_, group);
    if (!is_hopeless(state) && knowledge_.judge(state).is_safe()) {
      enter(std::move(group));
      return true;
    }
    if (knowledge_.is_spent()) {
      return true;
    }
  }
  return false;
}

Explorer::Answer Explorer::search_from(const ElementSet& root, std::size_t state_count_max) {
  keep_way();
  root_ = root;
  state_ = root;
  frames_.clear();
  run_length_ = std::min(kFirstRun, structure_.run_length_max());
  enter({});
  while (!goals_.contains(state_)) {
    if (knowledge_.is_spent() || knowledge_.state_count() >= state_count_max) {
      return Answer::kSpent;
    }
    const bool has_singles = !frames_.back().has_groups && advance();
    if (!has_singles && !take_group()) {
      leave();
      if (frames_.empty()) {
        return Answer::kExhausted;
      }
    }
    if (options_.progress) {
      options_.progress(knowledge_.state_count(), state_.size(), furthest_);
    }
  }
  return Answer::kReached;
}

Explorer::Answer Explorer::explore(std::size_t budget, std::uint64_t seed) {
  seed_ = seed;
  const std::size_t state_count_max = knowledge_.state_count() + budget;
  for (const ElementSet& root : roots_) {
    if (is_dead(root) || !knowledge_.judge(root).is_safe()) {
      continue;
    }
    const Answer answer = search_from(root, state_count_max);
    if (answer != Answer::kExhausted) {
      return answer;
    }
  }
  return Answer::kExhausted;
}

Explorer::Way Explorer::way() const {
  Way way{.root = root_};
  for (std::size_t i = 1; i < frames_.size(); ++i) {
    way.groups.push_back(frames_[i].group);
  }
  return way;
}

std::optional<Explorer::Way> Explorer::furthest_way() {
  keep_way();
  return kept_;
}

Closure Explorer::closure() const {
  Closure closure{.sense = sense_, .states = dead_in_order_};
  States seen = dead_;
  const auto block = [&](const ElementSet& state) {
    if (seen.insert(state).second) {
      closure.blocked.emplace_back(state, knowledge_.judge(state));
    }
  };
  std::ranges::for_each(roots_, block);
  for (const ElementSet& state : dead_in_order_) {
    for (const Batch& group : successors(structure_, state, sense_, options_.group_size)) {
      block(changed(state, sense_, group));
    }
  }
  return closure;
}

/// The seed of a round: that of the caller for the first, others after it.
std::uint64_t seed_of(std::uint64_t seed, std::size_t round) {
  return round == 0 ? seed : base::Rng(seed + round).next() | 1U;
}

/// The order that a way from one end is, with what is known of its states.
Order order_along(Explorer::Way way, Sense sense, Knowledge& knowledge) {
  Order order{.start = std::move(way.root), .steps = std::move(way.groups)};
  if (sense == Sense::kShrinking) {
    std::ranges::reverse(order.steps);
    for (Batch& group : order.steps) {
      order.start = changed(std::move(order.start), Sense::kShrinking, group);
      std::ranges::reverse(group);
    }
  }
  ElementSet state = order.start;
  order.judgements.push_back(knowledge.judge(state));
  for (const Batch& group : order.steps) {
    state = changed(std::move(state), Sense::kGrowing, group);
    order.judgements.push_back(knowledge.judge(state));
  }
  return order;
}

/// What an end says from which nothing is left to enter. An undecided state may be safe in truth,
/// so one just beyond leaves the question open.
Order order_closed(Closure closure, const Knowledge& knowledge) {
  const auto undecided_count = std::ranges::count_if(closure.blocked, [](const auto& blocked) {
    return blocked.second.verdict == verdict::Verdict::kUndecided;
  });
  Order order{.state_count = knowledge.state_count(),
              .undecided_count = static_cast<std::size_t>(undecided_count)};
  if (undecided_count == 0) {
    order.outcome = OrderOutcome::kNone;
    order.closure = std::move(closure);
  }
  return order;
}

/// Appends what `before` and one unit more make of its state, if it was not seen, and then what
/// these and yet another unit make: a set depends not on the order in which it was made, so the
/// first one will do. Most units are single elements.
void add_groups(GrowingStructure& structure, const ElementSet& state, Sense sense,
                const OrderOptions& options, const Batch& before,
                const std::function<bool()>& is_late, States& seen, std::vector<Batch>& groups) {
  const std::size_t begin = groups.size();
  for (const Element element : structure.candidates(state, sense, options.seed)) {
    const Batch unit = structure.has_units() ? structure.unit(element) : Batch{element};
    const bool has_room = before.empty() || before.size() + unit.size() <= options.group_size;
    if (has_room && seen.insert(changed(state, sense, unit)).second) {
      groups.push_back(before);
      groups.back().insert(groups.back().end(), unit.begin(), unit.end());
    }
  }
  const std::size_t end = groups.size();
  for (std::size_t i = begin; before.size() + 1 < options.group_size && i < end; ++i) {
    if (is_late && is_late()) {
      return;
    }
    const Batch group = groups[i];
    if (group.size() < options.group_size) {
      const auto unit = std::span(group).subspan(before.size());
      add_groups(structure, changed(state, sense, unit), sense, options, group, is_late, seen,
                 groups);
    }
  }
}

}  // namespace

std::optional<Element> GrowingStructure::first_candidate(
    const ElementSet& state, Sense sense, std::uint64_t seed,
    const std::function<bool(Element)>& is_open) {
  const std::vector<Element> list = candidates(state, sense, seed);
  const auto found = std::ranges::find_if(list, is_open);
  return found == list.end() ? std::nullopt : std::optional(*found);
}

std::vector<Judgement> GrowingStructure::judge_run(const ElementSet& state, Sense sense,
                                                   std::span<const Element> run,
                                                   const std::function<bool()>& is_late) {
  std::vector<Judgement> judgements;
  ElementSet next = state;
  for (const Element element : run) {
    next = changed(std::move(next), sense, {&element, 1});
    judgements.push_back(judge(next));
    if (!judgements.back().is_safe() || is_late()) {
      break;
    }
  }
  return judgements;
}

ElementSet changed(ElementSet state, Sense sense, std::span<const Element> elements) {
  for (const Element element : elements) {
    sense == Sense::kGrowing ? state.insert(element) : state.erase(element);
  }
  return state;
}

std::vector<Batch> successors(GrowingStructure& structure, const ElementSet& state, Sense sense,
                              std::size_t group_size, std::uint64_t seed,
                              const std::function<bool()>& is_late) {
  States seen;
  std::vector<Batch> groups;
  const OrderOptions options{.group_size = group_size, .seed = seed};
  add_groups(structure, state, sense, options, {}, is_late, seen, groups);
  std::ranges::stable_sort(groups, {}, &Batch::size);
  return groups;
}

Order find_order(GrowingStructure& structure, std::span<const ElementSet> starts,
                 const OrderOptions& options) {
  ElementSet whole(structure.element_count());
  for (std::size_t i = 0; i < structure.element_count(); ++i) {
    whole.insert(static_cast<Element>(i));
  }
  Knowledge knowledge(structure, options);
  const std::vector<ElementSet> begins(starts.begin(), starts.end());
  Explorer explorers[] = {{structure, knowledge, options, Sense::kGrowing, begins, {whole}},
                          {structure, knowledge, options, Sense::kShrinking, {whole}, begins}};
  if (!knowledge.judge(whole).is_safe()) {
    explorers[1].explore(0, options.seed);
    return order_closed(explorers[1].closure(), knowledge);
  }
  const auto explorer_from = [&](Sense sense) -> Explorer& {
    return explorers[sense == Sense::kGrowing ? 0 : 1];
  };
  const auto furthest = [&](std::size_t undecided_count) {
    const auto way = explorer_from(options.told_end).furthest_way();
    Order order = way ? order_along(*way, options.told_end, knowledge) : Order{};
    order.state_count = knowledge.state_count();
    order.undecided_count = undecided_count;
    return order;
  };
  std::size_t budget =
      std::max(kFirstBudgetMin, kFirstBudgetPerElement * structure.element_count());
  std::array<bool, 2> is_closed{};
  for (std::size_t round = 0; !knowledge.is_spent() || round == 0; ++round, budget *= 2) {
    for (const Sense sense : {Sense::kGrowing, Sense::kShrinking}) {
      Explorer& explorer = explorer_from(sense);
      const Explorer::Answer answer = explorer.explore(budget, seed_of(options.seed, round));
      if (answer == Explorer::Answer::kReached) {
        Order order = order_along(explorer.way(), sense, knowledge);
        order.outcome = OrderOutcome::kFound;
        order.state_count = knowledge.state_count();
        return order;
      }
      if (answer == Explorer::Answer::kExhausted) {
        Order order = order_closed(explorer.closure(), knowledge);
        is_closed[sense == Sense::kGrowing ? 0 : 1] = true;
        if (order.outcome == OrderOutcome::kNone) {
          return order;
        }
        if (is_closed[0] && is_closed[1]) {
          return furthest(order.undecided_count);
        }
      }
    }
  }
  return furthest(0);
}

}  // namespace holdfast::plan
