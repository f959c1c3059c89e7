// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/robot_growth.hpp"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <map>
#include <memory>

#include "cut_vertices.hpp"
#include "holdfast/base/rng.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/verdict/moved_mass.hpp"
#include "holdfast/verdict/rigid_body.hpp"

namespace holdfast::plan {
namespace {

/// A seed moves candidates by up to so many layers.
constexpr std::uint64_t kDisturbance = 4;

/// A facet that has left so many states of a run without a bound, alone or with others, is worth
/// its adjoint, which takes three solutions from nothing and a sum over all modules for each state
/// that is solved; but of so many facets after a run at most.
constexpr int kDoubtMin = 32;
constexpr std::size_t kAdjointCountMax = 16;

/// Where no support polygon decides.
constexpr double kNoEdge = std::numeric_limits<double>::infinity();

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

model::RobotSpec part_of(const model::RobotSpec& spec, const ElementSet& modules) {
  model::RobotSpec part = spec;
  part.existing.clear();
  for (const Element element : modules.elements()) {
    part.existing.push_back(spec.existing[base::at(element)]);
  }
  if (spec.fixed.empty() && spec.released.empty() && spec.own_kinds.empty() &&
      spec.own_masses.empty() && spec.payloads.empty()) {
    return part;
  }
  std::vector<base::Cell> there = part.existing;
  std::ranges::sort(there);
  const auto is_absent = [&](const base::Cell& cell) {
    return !std::ranges::binary_search(there, cell);
  };
  std::erase_if(part.fixed, is_absent);
  std::erase_if(part.released, [&](const model::CellPair& pair) {
    return is_absent(pair[0]) || is_absent(pair[1]);
  });
  const auto is_of_absent = [&](const auto& own) { return is_absent(own.cell); };
  std::erase_if(part.own_kinds, is_of_absent);
  std::erase_if(part.own_masses, is_of_absent);
  std::erase_if(part.payloads, is_of_absent);
  return part;
}

RobotGrowth::RobotGrowth(const model::RobotSpec& spec, const model::Robot& target,
                         const ElementSet& core, ReachRule rule, int thread_count)
    : spec_(spec),
      target_(target),
      core_(core),
      rule_(rule),
      reach_(spec, rule),
      thread_count_(thread_count),
      adjoints_(target),
      bounds_(kPieceCountMax, EnergyBound(target, adjoints_)),
      places_(places_in_layers(target, supports_and(target, core))),
      state_(spec.existing.size()),
      beside_count_(spec.existing.size()) {
  for (std::size_t i = 0; i < kPieceCountMax; ++i) {
    followed_.emplace_back(spec, target);
    sections_.emplace_back(spec, target);
  }
  if (verdict::is_on_flat_floor(target) && target.fixed_count() == 0) {
    balance_.emplace(target);
  }
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

/// Modules that leave a connected robot with a support behind.
std::vector<Element> RobotGrowth::removable(const ElementSet& state) const {
  std::vector<Element> list;
  if (state.size() < 2) {
    return list;
  }
  const std::vector<bool> needed = cut_vertices(
      element_count(), state.elements().front(), target_.connected()[0].size(),
      [&](Element module, std::size_t direction) {
        const std::int32_t other = target_.connected()[base::at(module)][direction];
        return other != model::Robot::kNoNeighbour && state.contains(other) ? other : -1;
      });
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

/// Those that can get to their cells, or come away from them.
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
  }
  list = reachable(std::move(list), state, sense);
  put_toppling_last(list, sense);
  return list;
}

std::optional<Element> RobotGrowth::first_candidate(const ElementSet& state, Sense sense,
                                                    std::uint64_t seed,
                                                    const std::function<bool(Element)>& is_open) {
  if (sense == Sense::kShrinking || rule_.reach != Reach::kFree) {
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

base::Result<model::Robot> RobotGrowth::robot(const ElementSet& state) const {
  return model::Robot::create(part_of(spec_, state), 1);
}

/// What bending may move the centre of mass by, as far as rounding of the margin leaves no doubt.
double RobotGrowth::room_mm(Balance& balance) const {
  return (balance.margin() - Balance::kMarginDoubt) * target_.material().pitch_mm;
}

Judgement RobotGrowth::judge(const ElementSet& state) {
  const auto part = robot(state);
  // A set of modules that is no robot, such as a start that is not connected, is not safe.
  return part ? plan::judge(part.value(), {.thread_count = thread_count_})
              : Judgement{.verdict = verdict::Verdict::kUnstable};
}

std::vector<std::optional<Judgement>> RobotGrowth::judge_each(
    std::span<const ElementSet> states, const std::function<bool()>& is_late) {
  std::vector<std::optional<Judgement>> judgements(states.size());
  host::Team team(thread_count_);
  team.each(states.size(), [&](std::size_t i) {
    if (!is_late()) {
      judgements[i] = judgement_of(assess_alone(states[i]));
    }
  });
  return judgements;
}

verdict::Assessment RobotGrowth::assess_alone(const ElementSet& state) const {
  const auto part = robot(state);
  return part ? assess(part.value(), {.thread_count = 1, .has_rigid_figures = false})
              : verdict::Assessment{};
}

/// A bound of the load ratio of the state that both tools have come to, by solutions that follow
/// the robot; none if that, or how far the centre of mass moves, is too much.
std::optional<double> RobotGrowth::bound_by_following(const Tools& tools, double room_mm) {
  auto known = tools.followed.solve();
  for (int i = 0; known; ++i) {
    const auto ratio = tools.bound.improve(tools.followed.displacement(), *known);
    const bool is_certified = ratio && tools.bound.shift_mm() < room_mm;
    if (is_certified || i == kImprovementMax) {
      return is_certified ? ratio : std::nullopt;
    }
    known = tools.followed.improve();
  }
  return std::nullopt;
}

/// Follows a run from its last state that was solved: which states after it are certified safe.
class RobotGrowth::Piece {
 public:
  /// At the state before the run.
  Piece(const RobotGrowth& growth, const ElementSet& state, Sense sense, const Tools& tools);

  ~Piece() {
    tools_.bound.end();
    tools_.followed.end();
  }

  Piece(const Piece&) = delete;
  Piece& operator=(const Piece&) = delete;

  /// Goes on to the next state; its judgement if it is certified.
  std::optional<Judgement> add(Element element);

  /// Goes on from the state that it has come to, solved and safe, before so many others.
  void begin(const ElementSet& state, const verdict::Assessment& assessment, std::size_t left);

 private:
  std::optional<double> ratio(Element element);
  std::optional<double> followed_ratio(double room_mm);

  const RobotGrowth& growth_;
  const Tools& tools_;
  bool can_certify_;
  std::optional<Balance> balance_;  ///< Where the polygon decides.
  bool has_bound_ = false;
  bool is_followed_ = false;
};

RobotGrowth::Piece::Piece(const RobotGrowth& growth, const ElementSet& state, Sense sense,
                          const Tools& tools)
    : growth_(growth), tools_(tools), can_certify_(sense == Sense::kGrowing) {
  if (growth.balance_ && can_certify_) {
    balance_.emplace(growth.target_);
    for (const Element element : state.elements()) {
      balance_->add(element);
    }
  }
}

std::optional<Judgement> RobotGrowth::Piece::add(Element element) {
  if (balance_) {
    balance_->add(element);
  }
  const auto largest = ratio(element);
  if (!largest) {
    return std::nullopt;
  }
  Judgement judgement{
      .verdict = verdict::Verdict::kSafe, .load_ratio_max = largest, .load_ratio_high = largest};
  judgement.is_bound = true;
  if (balance_) {
    judgement.margin_mm = balance_->margin() * growth_.target_.material().pitch_mm;
  }
  return judgement;
}

/// A bound of the load ratio with one more element; none if it does not certify the state.
std::optional<double> RobotGrowth::Piece::ratio(Element element) {
  const double room_mm = balance_ ? growth_.room_mm(*balance_) : kNoEdge;
  auto ratio = has_bound_ ? tools_.bound.add(element) : std::nullopt;
  if (ratio && !(tools_.bound.shift_mm() < room_mm)) {
    ratio.reset();
  }
  is_followed_ = is_followed_ &&
                 growth_.target_.modules()[base::at(element)].support != model::Support::kFixed;
  if (!is_followed_) {
    return ratio;
  }
  tools_.followed.add(element);
  if (ratio) {
    tools_.followed.worth().certify(false);
    return ratio;
  }
  return followed_ratio(room_mm);
}

/// The same by solutions that follow the robot, where they can pay.
std::optional<double> RobotGrowth::Piece::followed_ratio(double room_mm) {
  FollowingWorth& worth = tools_.followed.worth();
  if (!(room_mm > 0) || !worth.can_pay()) {
    return std::nullopt;
  }
  const auto ratio = bound_by_following(tools_, room_mm);
  if (ratio) {
    worth.certify(true);
  } else {
    worth.end(tools_.followed.iteration_count());
  }
  return ratio;
}

void RobotGrowth::Piece::begin(const ElementSet& state, const verdict::Assessment& assessment,
                               std::size_t left) {
  const bool is_decided_here =
      assessment.stability_rule != verdict::StabilityRule::kPolygon || balance_.has_value();
  const bool is_large = state.size() >= kFollowedMin;
  const bool is_slender = can_certify_ && is_large && tools_.section.find(state);
  const bool has_section = is_slender && left >= kSectionMin && tools_.section.solve();
  has_bound_ =
      can_certify_ && is_decided_here &&
      tools_.bound.begin(state.elements(), assessment, has_section ? &tools_.section : nullptr);
  is_followed_ = has_bound_ && !is_slender && is_large &&
                 tools_.followed.worth().begin(assessment.equilibrium.iteration_count);
  if (is_followed_) {
    tools_.followed.begin(state, assessment);
  }
}

/// Judges states one after another until one is not safe: those that can be certified so by what is
/// known of the last that was solved, all others solved.
std::vector<Judgement> RobotGrowth::judge_piece(ElementSet state, Sense sense,
                                                std::span<const Element> run,
                                                const Tools& tools) const {
  Piece piece(*this, state, sense, tools);
  std::vector<Judgement> judgements;
  for (const Element element : run) {
    if (!judgements.empty() && tools.is_late()) {
      break;
    }
    state = changed(std::move(state), sense, {&element, 1});
    if (auto certified = piece.add(element)) {
      judgements.push_back(*std::move(certified));
      continue;
    }
    const verdict::Assessment assessment = assess_alone(state);
    judgements.push_back(judgement_of(assessment));
    if (!judgements.back().is_safe()) {
      break;
    }
    piece.begin(state, assessment, run.size() - judgements.size());
  }
  return judgements;
}

std::vector<Judgement> RobotGrowth::judge_run(const ElementSet& state, Sense sense,
                                              std::span<const Element> run,
                                              const std::function<bool()>& is_late) {
  if (run.size() == 1) {
    return GrowingStructure::judge_run(state, sense, run, is_late);
  }
  const std::size_t length = std::max(kPieceMin, (run.size() - 1) / kPieceCountMax + 1);
  const std::size_t count = (run.size() - 1) / length + 1;
  std::vector<ElementSet> begins = {state};
  for (std::size_t i = 1; i < count; ++i) {
    begins.push_back(changed(begins.back(), sense, run.subspan((i - 1) * length, length)));
  }
  const auto part = [&](std::size_t i) {
    return run.subspan(i * length, std::min(length, run.size() - i * length));
  };
  std::vector<std::vector<Judgement>> pieces(count);
  if (sense == Sense::kGrowing) {
    grow_adjoints(state, run);
  }
  // The last pieces, whose robots are the largest, first: so threads end at about the same time.
  std::atomic<std::size_t> taken_count{0};
  host::Team team(thread_count_);
  team.each(std::min(count, base::at(team.thread_count())), [&](std::size_t) {
    for (std::size_t turn = taken_count++; turn < count; turn = taken_count++) {
      const std::size_t i = count - 1 - turn;
      pieces[i] =
          judge_piece(begins[i], sense, part(i), {bounds_[i], followed_[i], sections_[i], is_late});
    }
  });
  std::vector<Judgement> judgements;
  ElementSet reached = state;
  for (std::size_t i = 0; i < count; ++i) {
    judgements.insert(judgements.end(), pieces[i].begin(), pieces[i].end());
    if (pieces[i].size() < part(i).size() || !judgements.back().is_safe()) {
      break;
    }
    reached = changed(std::move(reached), sense, part(i));
  }
  if (sense == Sense::kGrowing) {
    renew_adjoints(reached, is_late);
  }
  return judgements;
}

/// The facets that are worth their adjoints after a run, those first that have left the most states
/// without a bound.
std::vector<std::size_t> RobotGrowth::doubtful_facets(const ElementSet& state) {
  std::map<std::size_t, int> doubtful;
  for (EnergyBound& bound : bounds_) {
    for (const auto& [facet, count] : bound.take_doubtful()) {
      doubtful[facet] += count;
    }
  }
  std::vector<std::pair<int, std::size_t>> ranked;
  for (const auto& [facet, count] : doubtful) {
    if (count >= kDoubtMin && state.contains(target_.facets()[facet].module)) {
      ranked.emplace_back(-count, facet);
    }
  }
  std::ranges::sort(ranked);
  ranked.resize(std::min(ranked.size(), kAdjointCountMax));
  std::vector<std::size_t> facets;
  std::ranges::transform(ranked, std::back_inserter(facets),
                         [](const auto& each) { return each.second; });
  return facets;
}

/// Before a run: continues what is known of facets to all its modules.
void RobotGrowth::grow_adjoints(const ElementSet& state, std::span<const Element> run) {
  const std::vector<Element> elements = state.elements();
  host::Team team(thread_count_);
  team.each(facet_adjoints_.size(), [&](std::size_t i) {
    Adjoint& adjoint = *facet_adjoints_[i];
    if (adjoint.grow_to(elements)) {
      std::ranges::for_each(run, [&](Element element) { adjoint.grow(base::at(element)); });
    }
  });
}

/// Finds the adjoints of doubtful facets of a safe state, to which a run has led, anew where they
/// were known, and forgets those that nobody has asked for in the run. All pieces of the next run
/// know the same ones, so that threads make no difference.
void RobotGrowth::renew_adjoints(const ElementSet& state, const std::function<bool()>& is_late) {
  if (element_count() - state.size() < kRunLength / 2) {
    return;  // Too few states are left to come.
  }
  const std::vector<std::size_t> facets = doubtful_facets(state);
  const std::size_t known_count = facet_adjoints_.size();
  std::erase_if(facet_adjoints_, [&](const auto& adjoint) {
    return std::ranges::find(facets, adjoint->facet()) != facets.end() ||
           std::ranges::none_of(bounds_, [&](const EnergyBound& bound) {
             return bound.has_asked_for(adjoint->facet());
           });
  });
  if (!facets.empty()) {
    std::ranges::move(find_adjoints(spec_, target_, state, facets, thread_count_, is_late),
                      std::back_inserter(facet_adjoints_));
  }
  if (known_count + facet_adjoints_.size() > 0) {
    std::ranges::for_each(bounds_,
                          [&](EnergyBound& bound) { bound.take_adjoints(facet_adjoints_); });
  }
}

}  // namespace holdfast::plan
