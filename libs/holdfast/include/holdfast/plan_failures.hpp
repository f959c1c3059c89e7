// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/losses.hpp"
#include "holdfast/plan/sequence.hpp"
#include "holdfast/reliability.hpp"
#include "holdfast/trial.hpp"

/// How sure is a plan, and does it hold whatever single part is lost? The questions of
/// reliability.hpp and losses.hpp, asked of every stage of every step.
///
///     const auto found = holdfast::find_plan_failures(document, {.scatter = wish, .probability =
///     0.99}); if (found && found.value().first_below) { ... step and stage ... }
namespace holdfast {

struct PlanFailuresWish {
  bool is_scatter_wanted = false;
  ScatterWish scatter = {};
  double probability = 0;  ///< Stages that hold with less are named; 0: none is.
  bool is_lose_one_wanted = false;
  LoseOneOptions lose_one = {};  ///< Its `check` is how stages are checked; the time is of each.
  std::function<void(std::size_t step)> progress = {};

  bool is_wanted() const { return is_scatter_wanted || is_lose_one_wanted; }
};

/// The answer over all stages. Stages are robots by themselves: that a connection held before says
/// nothing of it later. The connection by which a moving group hangs on its carrier counts among
/// those that may fail by scatter, and is not taken away by --lose-one.
struct PlanFailures {
  std::size_t robot_count = 0;  ///< Robots that were looked at: stages, scenes, pieces.
  /// The least probability with which a stage holds, and which one; none where one is not known.
  std::optional<double> probability_min = {};
  std::optional<plan::StageId> least = {};
  std::optional<plan::StageId> first_below = {};      ///< That holds with less than asked for,
  std::optional<plan::StageId> first_unknown = {};    ///< or may.
  std::optional<plan::StageId> first_fatal = {};      ///< That a single loss brings down,
  std::optional<plan::LossAnswer> fatal = {};         ///< which is this one,
  std::optional<plan::StageId> first_undecided = {};  ///< or may.

  /// Whether anything that was asked for does not hold, and whether that is not certain.
  bool fails() const { return first_below || first_fatal; }

  bool is_uncertain() const { return !fails() && (first_unknown || first_undecided); }
};

/// Looks at every stage of the steps of a document. Errors: as of io::make_sequence() and of steps
/// that cannot be done; nothing scatters.
base::Result<PlanFailures> find_plan_failures(const io::Document& document,
                                              const PlanFailuresWish& wish);

/// How many places are looked at, and for how long.
struct NextFailuresLimits {
  std::size_t safe_count_max = 0;  ///< Ends with so many that hold; 0: looks at all.
  double seconds_max = std::numeric_limits<double>::infinity();
  std::function<bool()> is_interrupted = {};
};

/// Looks at the places for the next module that are safe by themselves, the best first: with too
/// little probability a place is `overload`, or `undecided` where that is not certain; where a
/// single loss is fatal it has that loss's verdict. Places that are not looked at become open.
/// Errors: nothing scatters. `wish.progress` is called with the number of places.
std::optional<base::Error> find_next_failures(const Structure& structure,
                                              const PlanFailuresWish& wish,
                                              const NextFailuresLimits& limits, NextResult& result);

/// Lines for the end of a plan's report, and the members "reliability" and "lose_one" that were
/// asked for.
std::string plan_failures_text(const PlanFailuresWish& wish, const PlanFailures& found);
void write_plan_failures_members(io::JsonStream& json, const PlanFailuresWish& wish,
                                 const PlanFailures& found);

/// The answer in the forms in which the reports of plans take it.
struct PlanFailuresReport {
  PlanFailures found = {};
  std::string text = {};
  std::string member_text = {};  ///< "key": value, of all members; empty if nothing is asked for.
  io::MoreKeys members = {};

  /// The members as a list of one or none.
  std::vector<std::string> member_list() const {
    return member_text.empty() ? std::vector<std::string>() : std::vector{member_text};
  }
};

/// Looks at every stage if anything is asked for, else at none. Errors: find_plan_failures().
base::Result<PlanFailuresReport> report_plan_failures(const io::Document& document,
                                                      const PlanFailuresWish& wish);

}  // namespace holdfast
