// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "holdfast/plan/element_set.hpp"
#include "holdfast/plan/judgement.hpp"

/// The order in which a structure can be built, or taken apart, with every state on the way safe.
///
/// States are sets of elements. The search knows nothing of mechanics or geometry: what may come
/// next and what is safe is asked of a GrowingStructure, so that robots of modules, printed frames
/// of bars and whatever else grows share it. It goes from both ends in turns, from the start by
/// adding and from the whole by removing, depth first, the most promising element first; a state
/// from which every way on is blocked is remembered and never entered again. As sets only grow (or
/// only shrink) along a way, an end from which nothing is left to enter proves that there is no
/// order (Closure).
namespace holdfast::plan {

enum class Sense : std::uint8_t { kGrowing, kShrinking };

/// A structure whose elements are added or removed one by one.
class GrowingStructure {
 public:
  virtual ~GrowingStructure() = default;

  /// The whole has the elements 0 to element_count() - 1.
  virtual std::size_t element_count() const = 0;

  /// Whether some elements come and go together only, at one instant.
  virtual bool has_units() const { return false; }

  /// The elements that come and go together with an element, itself among them.
  virtual std::vector<Element> unit(Element element) const { return {element}; }

  /// Every element that can be added to the state (or removed from it) as far as geometry goes,
  /// the most promising first. What is not named is taken for impossible, so proofs rest on it. The
  /// list depends on the arguments alone; a seed other than 0 disturbs its order.
  virtual std::vector<Element> candidates(const ElementSet& state, Sense sense,
                                          std::uint64_t seed) = 0;

  /// The first of the candidates that is open, if any is. What a structure overrides if it need not
  /// look at all of them for that.
  virtual std::optional<Element> first_candidate(const ElementSet& state, Sense sense,
                                                 std::uint64_t seed,
                                                 const std::function<bool(Element)>& is_open);

  /// Whether the state is safe; depends on the set alone.
  virtual Judgement judge(const ElementSet& state) = 0;

  /// Judges the states that arise when the elements of `run` are added to `state` (or removed from
  /// it) one after another, up to and including the first one that is not safe, or fewer once
  /// `is_late`, which several threads may ask. What a structure overrides if it can judge many
  /// states on a way for less than each alone.
  virtual std::vector<Judgement> judge_run(const ElementSet& state, Sense sense,
                                           std::span<const Element> run,
                                           const std::function<bool()>& is_late);

  /// The most states that are judged in one run.
  virtual std::size_t run_length_max() const { return 1; }
};

struct OrderOptions {
  /// The most elements that are added, or removed, at once; only the state after it must be safe.
  /// One unit may always be.
  std::size_t group_size = 1;
  /// Decides in which order candidates are tried; the same seed finds the same order.
  std::uint64_t seed = 0;
  /// The search stops after this time, or so many judged states, without an answer.
  double seconds_max = std::numeric_limits<double>::infinity();
  std::size_t state_count_max = std::numeric_limits<std::size_t>::max();
  /// Asked all the time, by several threads; the search stops once it says so.
  std::function<bool()> is_interrupted = {};
  /// The end whose way is reported if no order is found: from the start, or from the whole.
  Sense told_end = Sense::kGrowing;
  /// Called now and then with the number of states judged so far, and how many elements the largest
  /// state reached from the start has, and how many the smallest reached from the whole.
  std::function<void(std::size_t states, std::size_t grown, std::size_t shrunk)> progress = {};
};

enum class OrderOutcome : std::uint8_t {
  kFound,
  kNone,      ///< There is no order; the closure proves it.
  kNotFound,  ///< Time or states ran out, or undecided states are in the way.
};

/// Elements that are added or removed together.
using Batch = std::vector<Element>;

/// A cut between start and whole: safe states that no step leaves. All safe states at that end are
/// in it, and so is every safe state that one step leads to; the other end is not. For
/// Sense::kGrowing the end is the start, or all starts; for kShrinking the whole.
struct Closure {
  Sense sense = Sense::kGrowing;
  std::vector<ElementSet> states = {};
  /// States just beyond, none of which is safe, and why not; those at the end itself first.
  std::vector<std::pair<ElementSet, Judgement>> blocked = {};
};

/// The order found; of kNotFound only the part of one that led furthest from the end that is to be
/// reported: from a start, or to the whole. It is empty if no state there is safe.
struct Order {
  OrderOutcome outcome = OrderOutcome::kNotFound;
  ElementSet start = {};                   ///< What the order begins with.
  std::vector<Batch> steps = {};           ///< From there to the whole.
  std::vector<Judgement> judgements = {};  ///< Of that and of the state after each step; all safe.
  std::size_t state_count = 0;             ///< Judged in all.
  /// Whether the elements of a step come in any order, so that all parts of it are judged; else
  /// they come at the same instant.
  bool is_any_order = false;
  /// Whether the elements of a step touch none that is there, by step; empty where all do.
  std::vector<bool> is_apart = {};
  /// The number of undecided states if, of kNotFound before time ran out, they are all that could
  /// be entered next, so that nothing is proved.
  std::size_t undecided_count = 0;
  std::optional<Closure> closure = {};  ///< Of kNone.
};

/// Seeks an order from one of the starts, none of which contains another, to the whole.
Order find_order(GrowingStructure& structure, std::span<const ElementSet> starts,
                 const OrderOptions& options = {});

/// Every state that one step leads to from `state`, each once: groups of one first. From when
/// is_late() is true on no more are sought, as there may be very many.
std::vector<Batch> successors(GrowingStructure& structure, const ElementSet& state, Sense sense,
                              std::size_t group_size, std::uint64_t seed = 0,
                              const std::function<bool()>& is_late = {});

/// The state with the elements added, or without them.
ElementSet changed(ElementSet state, Sense sense, std::span<const Element> elements);

}  // namespace holdfast::plan
