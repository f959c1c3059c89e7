// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/frames/network_structure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>
#include <utility>

#include "holdfast/base/rng.hpp"

namespace holdfast::frames {
namespace {

using base::at;

/// The share by which a seed other than 0 disturbs what candidates are sorted by: enough to change
/// the order of neighbours, not that of near and far.
constexpr double kDisturbance = 0.05;

/// The factor of an element's key, the same for the same element and seed.
double disturbance(Element element, std::uint64_t seed) {
  if (seed == 0) {
    return 1;
  }
  base::Rng rng(seed ^ (static_cast<std::uint64_t>(element) << 32U));
  return 1 + kDisturbance * static_cast<double>(rng.below(1'000'000)) / 1'000'000;
}

/// A state that is farther away than so many elements is factorized anew: about what that costs.
constexpr std::size_t kRestCountMax = 16;

/// States of the first search, beside two ways through the whole.
constexpr std::size_t kFirstBudgetMin = 256;

/// The elements that one set has and the other has not, ascending.
std::vector<Element> difference(const ElementSet& a, const ElementSet& b) {
  std::vector<Element> list;
  for (std::size_t word = 0; word < a.words().size(); ++word) {
    for (std::uint64_t bits = a.words()[word] ^ b.words()[word]; bits != 0; bits &= bits - 1) {
      list.push_back(static_cast<Element>(64 * word) + __builtin_ctzll(bits));
    }
  }
  return list;
}

/// Sorts ascending by a key, which is asked once of each; equal ones keep their order.
template <class Key>
void sort_by(std::vector<Element>& elements, Key&& key) {
  std::vector<std::pair<double, Element>> keyed;
  keyed.reserve(elements.size());
  for (const Element element : elements) {
    keyed.emplace_back(key(element), element);
  }
  std::ranges::stable_sort(keyed, {}, &std::pair<double, Element>::first);
  std::ranges::transform(keyed, elements.begin(), &std::pair<double, Element>::second);
}

/// The length of a spring, from its lever.
double arm_length(const LowRankTerm& spring) {
  // Rows of moments, columns of forces: minus the cross product with the arm.
  return std::hypot(spring.lever.at(5, 1), spring.lever.at(3, 2), spring.lever.at(4, 0));
}

}  // namespace

Criterion translation_limit(double limit_mm) {
  return [limit_mm](std::span<const base::Vec6<double>> displacements) {
    double largest = 0;
    for (const base::Vec6<double>& u : displacements) {
      largest = std::max(largest, u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    }
    return std::sqrt(largest) / limit_mm;
  };
}

NetworkStructure::NetworkStructure(const SpringNetwork& network, Criterion criterion,
                                   Preference preference)
    : network_(&network),
      criterion_(std::move(criterion)),
      preference_(preference),
      growing_(network),
      state_(network.elements.size()),
      touch_(network.node_count + 1) {
  const auto node = [&](std::int32_t end) { return end == kGround ? network.node_count : at(end); };
  for (std::size_t e = 0; e < network.elements.size(); ++e) {
    const LowRankTerm& spring = network.elements[e].spring;
    ends_.push_back({node(spring.a), node(spring.b)});
    touch_[ends_[e].a].push_back(static_cast<Element>(e));
    touch_[ends_[e].b].push_back(static_cast<Element>(e));
  }
  measure_distances();
}

/// Shortest paths from the ground along the elements [Dijkstra 1959].
void NetworkStructure::measure_distances() {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  std::vector<double> distance(touch_.size(), kFar);
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> reached;
  distance.back() = 0;
  reached.emplace(0, touch_.size() - 1);
  while (!reached.empty()) {
    const auto [far, node] = reached.top();
    reached.pop();
    if (far > distance[node]) {
      continue;
    }
    for (const Element element : touch_[node]) {
      const Ends ends = ends_[at(element)];
      const std::size_t other = ends.a == node ? ends.b : ends.a;
      const double longer = far + arm_length(network_->elements[at(element)].spring);
      if (longer < distance[other]) {
        distance[other] = longer;
        reached.emplace(longer, other);
      }
    }
  }
  for (const Ends& ends : ends_) {
    distance_mm_.push_back(distance[ends.a] + distance[ends.b]);
  }
}

/// Whether every element of the state is connected to the ground by others.
bool NetworkStructure::is_held(const ElementSet& state) const {
  std::vector<std::uint8_t> is_reached(touch_.size(), 0);
  std::vector<std::size_t> open = {touch_.size() - 1};
  is_reached.back() = 1;
  std::size_t count_twice = 0;
  while (!open.empty()) {
    const std::size_t node = open.back();
    open.pop_back();
    for (const Element element : touch_[node]) {
      if (!state.contains(element)) {
        continue;
      }
      ++count_twice;
      const Ends ends = ends_[at(element)];
      const std::size_t other = ends.a == node ? ends.b : ends.a;
      if (is_reached[other] == 0) {
        is_reached[other] = 1;
        open.push_back(other);
      }
    }
  }
  return count_twice == 2 * state.size();
}

std::vector<Element> NetworkStructure::addable(const ElementSet& state, std::uint64_t seed) const {
  const std::size_t ground = touch_.size() - 1;
  std::vector<std::uint8_t> has_node(ground + 1, 0);
  has_node[ground] = 1;
  for (const Element element : state.elements()) {
    has_node[ends_[at(element)].a] = 1;
    has_node[ends_[at(element)].b] = 1;
  }
  std::vector<Element> closing;
  std::vector<Element> others;
  for (std::size_t e = 0; e < ends_.size(); ++e) {
    const auto element = static_cast<Element>(e);
    const int there = has_node[ends_[e].a] + has_node[ends_[e].b];
    if (!state.contains(element) && there > 0) {
      (there == 2 ? closing : others).push_back(element);
    }
  }
  const auto far = [&](Element e) { return distance_mm_[at(e)] * disturbance(e, seed); };
  sort_by(closing, far);
  sort_by(others, far);
  closing.insert(closing.end(), others.begin(), others.end());
  return closing;
}

/// The elements that lie on a closed path of others, and those with nothing behind them. An element
/// without which a node is out of reach takes all with it that is held by it alone, unless that is
/// nothing [Tarjan 1972].
std::vector<Element> NetworkStructure::removable(const ElementSet& state,
                                                 std::uint64_t seed) const {
  struct Visit {
    std::size_t node = 0;
    Element from = -1;
    std::size_t next = 0;
  };

  constexpr std::size_t kUnseen = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> order(touch_.size(), kUnseen);
  std::vector<std::size_t> low(touch_.size(), kUnseen);
  std::vector<std::uint8_t> is_needed(ends_.size(), 0);
  std::vector<std::uint8_t> has_more(touch_.size(), 0);
  std::vector<Visit> way = {{.node = touch_.size() - 1}};
  std::size_t count = 0;
  order.back() = low.back() = count++;
  while (!way.empty()) {
    Visit& visit = way.back();
    if (visit.next < touch_[visit.node].size()) {
      const Element element = touch_[visit.node][visit.next++];
      const Ends ends = ends_[at(element)];
      const std::size_t other = ends.a == visit.node ? ends.b : ends.a;
      if (!state.contains(element) || element == visit.from || other == visit.node) {
        continue;
      }
      has_more[visit.node] = 1;
      if (order[other] == kUnseen) {
        order[other] = low[other] = count++;
        way.push_back({.node = other, .from = element});
      } else {
        low[visit.node] = std::min(low[visit.node], order[other]);
      }
      continue;
    }
    const Visit done = visit;
    way.pop_back();
    if (!way.empty()) {
      const std::size_t parent = way.back().node;
      low[parent] = std::min(low[parent], low[done.node]);
      const bool is_bridge = low[done.node] > order[parent];
      is_needed[at(done.from)] = is_bridge && has_more[done.node] != 0 ? 1 : 0;
    }
  }
  std::vector<Element> list;
  for (const Element element : state.elements()) {
    if (is_needed[at(element)] == 0) {
      list.push_back(element);
    }
  }
  sort_by(list, [&](Element e) { return -distance_mm_[at(e)] * disturbance(e, seed); });
  return list;
}

std::vector<Element> NetworkStructure::candidates(const ElementSet& state, Sense sense,
                                                  std::uint64_t seed) {
  if (sense == Sense::kShrinking) {
    return removable(state, seed);
  }
  std::vector<Element> list = addable(state, seed);
  if (preference_ == Preference::kLeastUsed && go_to(state)) {
    sort_by(list, [&](Element e) { return used_with(e) * disturbance(e, seed); });
  }
  return list;
}

Judgement NetworkStructure::judge(const ElementSet& state) {
  if (!is_held(state)) {
    return {.verdict = verdict::Verdict::kUnstable};
  }
  double ratio = go_to(state) ? used() : std::numeric_limits<double>::quiet_NaN();
  if (!(std::abs(ratio - 1) > kDoubt)) {
    ratio = assign(state) ? used() : std::numeric_limits<double>::quiet_NaN();
  }
  if (std::isnan(ratio)) {
    return {};
  }
  return {.verdict = ratio <= 1 ? verdict::Verdict::kSafe : verdict::Verdict::kOverload,
          .load_ratio_max = ratio};
}

/// The criterion's value for growing_; NaN if its equations cannot be solved.
double NetworkStructure::used() {
  const std::vector<base::Vec6<double>>& u = growing_.displacements();
  return u.size() == network_->node_count ? criterion_(u)
                                          : std::numeric_limits<double>::quiet_NaN();
}

double NetworkStructure::used_with(Element element) {
  constexpr double kNotPossible = std::numeric_limits<double>::infinity();
  if (!growing_.add(at(element))) {
    return kNotPossible;
  }
  const double ratio = used();
  growing_.undo();
  if (std::isnan(ratio)) {
    return kNotPossible;
  }
  return ratio;
}

/// Adds the element if it is not there, removes it if it is.
bool NetworkStructure::toggle(Element element) {
  const bool is_there = state_.contains(element);
  if (is_there ? !growing_.remove(at(element)) : !growing_.add(at(element))) {
    return false;
  }
  is_there ? state_.erase(element) : state_.insert(element);
  return true;
}

/// Goes back as far as the way here and the one to the state differ, then forth if that is by
/// adding, or by removing one element; else begins anew.
bool NetworkStructure::go_to(const ElementSet& state) {
  const auto differs = [&](Element e) { return state_.contains(e) != state.contains(e); };
  while (!trail_.empty() && differs(trail_.back())) {
    if (!toggle(trail_.back())) {
      return assign(state);
    }
    trail_.pop_back();
  }
  std::vector<Element> rest = difference(state_, state);
  const bool is_growing = std::ranges::none_of(rest, [&](Element e) { return state_.contains(e); });
  if (rest.size() > kRestCountMax || (!is_growing && rest.size() > 1)) {
    return assign(state);
  }
  while (!rest.empty()) {
    const auto next = std::ranges::find_if(
        rest, [&](Element e) { return state_.contains(e) || growing_.can_be_added(at(e)); });
    if (next == rest.end() || !toggle(*next)) {
      return assign(state);
    }
    trail_.push_back(*next);
    rest.erase(next);
  }
  return true;
}

bool NetworkStructure::assign(const ElementSet& state) {
  std::vector<std::size_t> elements;
  for (const Element element : state.elements()) {
    elements.push_back(at(element));
  }
  trail_.clear();
  state_ = state;
  return growing_.assign(elements);
}

Order find_order(const SpringNetwork& network, const Criterion& criterion,
                 const OrderOptions& options) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  NetworkStructure structures[] = {{network, criterion, Preference::kNearest},
                                   {network, criterion, Preference::kLeastUsed}};
  const ElementSet starts[] = {ElementSet(network.elements.size())};
  std::size_t state_count = 0;
  for (std::size_t budget = 2 * network.elements.size() + kFirstBudgetMin;; budget *= 2) {
    for (NetworkStructure& structure : structures) {
      OrderOptions part = options;
      const std::chrono::duration<double> passed = Clock::now() - begin;
      part.seconds_max = options.seconds_max - passed.count();
      part.state_count_max = std::min(budget, options.state_count_max - state_count);
      Order order = find_order(structure, starts, part);
      state_count += order.state_count;
      order.state_count = state_count;
      const std::chrono::duration<double> all = Clock::now() - begin;
      if (order.outcome != OrderOutcome::kNotFound || all.count() >= options.seconds_max ||
          state_count >= options.state_count_max) {
        return order;
      }
    }
  }
}

}  // namespace holdfast::frames
