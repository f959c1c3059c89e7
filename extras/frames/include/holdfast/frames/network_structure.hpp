// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "holdfast/frames/growing_network.hpp"
#include "holdfast/plan/order_search.hpp"

namespace holdfast::frames {

using plan::Element;
using plan::ElementSet;
using plan::GrowingStructure;
using plan::Judgement;
using plan::Order;
using plan::OrderOptions;
using plan::OrderOutcome;
using plan::Sense;

/// A measure of how much a network in equilibrium uses of what is allowed, from the displacements
/// of its nodes: safe up to 1.
using Criterion = std::function<double(std::span<const base::Vec6<double>> displacements)>;

/// The largest translation of a node, of `limit_mm`.
Criterion translation_limit(double limit_mm);

/// Says which element a search tries first.
enum class Preference : std::uint8_t {
  /// A growing search prefers elements that join two nodes that are there, then those nearest to
  /// the ground along the elements; a shrinking one prefers the farthest. Costs nothing.
  kNearest,
  /// A growing search tries every candidate and prefers the one that uses up least. It serves where
  /// kNearest finds nothing.
  kLeastUsed,
};

/// A network whose elements come one by one, each prefix connected to the ground and in equilibrium
/// (search it with find_order()). A judgement's load ratio is what the criterion says.
///
/// One factorization follows the search from state to state. Where a criterion is within
/// kDoubt of its limit it is asked again after a factorization anew, so that the verdict depends
/// on the state alone.
class NetworkStructure final : public GrowingStructure {
 public:
  static constexpr double kDoubt = 1e-6;

  /// The network must outlive this.
  NetworkStructure(const SpringNetwork& network, Criterion criterion, Preference preference);

  std::size_t element_count() const override { return network_->elements.size(); }

  std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                  std::uint64_t seed) override;
  Judgement judge(const ElementSet& state) override;

  const GrowingWork& work() const { return growing_.work(); }

 private:
  struct Ends {
    std::size_t a = 0;  ///< The ground counts as the node after the last.
    std::size_t b = 0;
  };

  void measure_distances();
  bool is_held(const ElementSet& state) const;
  std::vector<Element> addable(const ElementSet& state, std::uint64_t seed) const;
  std::vector<Element> removable(const ElementSet& state, std::uint64_t seed) const;
  bool go_to(const ElementSet& state);
  bool toggle(Element element);
  bool assign(const ElementSet& state);
  double used();
  double used_with(Element element);

  const SpringNetwork* network_;
  Criterion criterion_;
  Preference preference_;
  GrowingNetwork growing_;
  ElementSet state_;                 ///< What is in growing_.
  std::vector<Element> trail_;       ///< What was added or removed to come here, last at the end.
  std::vector<Ends> ends_;           ///< by element
  std::vector<double> distance_mm_;  ///< by element, both its ends together
  std::vector<std::vector<Element>> touch_;  ///< by node, the ground last
};

/// Seeks an order from nothing to the whole, first by Preference::kNearest, for as many states as
/// two ways through the whole have, then by kLeastUsed, then by each for twice as long as before.
Order find_order(const SpringNetwork& network, const Criterion& criterion,
                 const OrderOptions& options = {});

}  // namespace holdfast::frames
