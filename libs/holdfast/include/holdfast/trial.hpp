// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"               // IWYU pragma: export
#include "holdfast/limit/rigid_stability.hpp"  // IWYU pragma: export
#include "holdfast/plan/remedies.hpp"          // IWYU pragma: export

/// The facade's trials: where may the next module go, and what would make a structure hold?
///
///     const holdfast::NextResult next = holdfast::find_next(structure);
///     if (next.count(holdfast::verdict::Verdict::kSafe) > 0) { ... next.candidates[0].cell ... }
///
/// The same for cells that a program names:
///
///     const holdfast::model::RobotSpec spec{.existing = cells};
///     for (const holdfast::Trial& trial : holdfast::try_cells(spec, holdfast::free_cells(spec))) {
///       if (trial.is_robot && trial.verdict == holdfast::verdict::Verdict::kSafe) { ... }
///     }
///
/// Changes of a structure that does not hold:
///
///     const auto remedies = holdfast::find_remedies(structure, holdfast::check(structure));
///     ... remedies.of(holdfast::plan::RemedyKind::kProp).safe.front().cell ...
namespace holdfast {

/// The role that a module gets that is added to a robot.
enum class Role : std::uint8_t { kExisting, kPlanned, kFixed };

/// Adds a module behind the others of its role. Robot::create tells whether it can be there.
void add_module(model::RobotSpec& spec, const base::Cell& cell, Role role);

/// Every cell that holds no module and is beside one, planned or not; once, in ascending order.
/// Below the ground there are such cells as well: try_cells() tells where a module can be.
std::vector<base::Cell> free_cells(const model::RobotSpec& spec);

/// Returns the answer of the rigid body alone, at once and whatever the size: `unstable` for a
/// robot that topples, else `undecided`, as no load is known.
verdict::Assessment first_look(const model::Robot& robot);

/// How sure it is that a robot with one more module holds, and what a loss does to it.
struct TrialFailures {
  bool has_probability = false;  ///< Whether the next was asked for; none: it is not known.
  std::optional<double> probability_holds = {};
  bool is_improbable = false;      ///< It is less than asked for, or may be.
  std::string fatal_loss = {};     ///< "(0,0,0)-(1,0,0)": of the first that brings it down.
  bool is_loss_undecided = false;  ///< Some loss may.
};

/// The result of adding one more module to a robot.
struct Trial {
  base::Cell cell;
  /// Whether there is such a robot: not if the cell is taken, touches nothing or lies too low. The
  /// rest is void then.
  bool is_robot = false;
  verdict::Verdict verdict = verdict::Verdict::kUndecided;
  /// The largest load ratio; none where no load is known, as for a robot that topples, or only a
  /// bound.
  std::optional<double> load_ratio_max = {};
  /// What the largest load ratio does not exceed, where the robot was certified by a bound.
  std::optional<double> load_ratio_bound = {};
  /// The margin of verdict::RigidBody in mm: negative for a robot that topples, none for one that
  /// is fixed.
  std::optional<double> margin_mm = {};
  /// Whether it is undecided as linear theory does not suffice (verdict::ReasonCode::kSecondOrder).
  bool is_bent = false;
  /// What find_next_failures() has found of a place that is safe by itself; empty if not asked.
  TrialFailures failures = {};
};

/// Tries cells of one robot, as often as it is asked: what was prepared for the first eight cells
/// or more serves all that follow.
class CellTrials {
 public:
  explicit CellTrials(model::RobotSpec spec, Role role = Role::kPlanned,
                      const CheckOptions& options = {});
  ~CellTrials();
  CellTrials(CellTrials&&) noexcept;
  CellTrials& operator=(CellTrials&&) noexcept;

  /// Judges the robot with one more module, of kind 0, at each of the cells in turn. The verdict is
  /// that of check(); most take far less than a check (plan/candidates.hpp). Those with a fixed
  /// module take a check each.
  std::vector<Trial> at(std::span<const base::Cell> cells);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// All cells in one batch of CellTrials.
std::vector<Trial> try_cells(const model::RobotSpec& spec, std::span<const base::Cell> cells,
                             Role role = Role::kPlanned, const CheckOptions& options = {});

/// Robots of so many modules at most have load ratios for all places; of larger ones most places
/// are certified by a bound of it. Factorizations of such robots take a second or two.
inline constexpr std::size_t kNextExactModuleCount = 3000;

/// The options of a search for places.
struct NextOptions {
  CheckOptions check = {};
  /// Whether all load ratios are found, also of robots of more than kNextExactModuleCount modules.
  bool is_exact = false;
  /// The number of the best places that are wanted; others of a large robot may stay open, or known
  /// by a bound only, as soon as these are certain. 0: all.
  std::size_t best_count = 0;
  /// The search ends after this time, or once is_interrupted() says so, with what is known by then.
  double seconds_max = std::numeric_limits<double>::infinity();
  std::function<bool()> is_interrupted = {};
  /// A function that is called now and then with the number of places that are judged, and of all.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

/// The places where the next module may go.
struct NextResult {
  /// All free cells beside the robot where a module can be, best first: the safe by ascending load
  /// ratio, then those undecided, overloaded and unstable, these by descending margin.
  std::vector<Trial> candidates;
  std::size_t open_count = 0;      ///< Places of which nothing is known.
  std::size_t check_count = 0;     ///< So many took a check of their own.
  double preparation_seconds = 0;  ///< Spent on the robot as it is.
  double seconds = 0;              ///< In all.

  std::size_t count(verdict::Verdict verdict) const;
};

/// Judges every free cell beside a structure with its planned modules attached.
NextResult find_next(const Structure& structure, const NextOptions& options = {});

/// The number of candidates, the first ones, that a report lists at most; 0: all.
struct NextReportOptions {
  std::size_t count_max = 0;
};

/// Writes them as JSON, keys as in docs/formats.md, or as a table for people.
void write_next_json(std::ostream& out, const Structure& structure, const NextResult& result,
                     const NextReportOptions& options = {});

/// Writes one place as an object, as write_next_json() does.
void write_candidate(io::JsonStream& json, const Trial& trial);

/// Writes the keys of write_next_json() into the object that is open.
void write_next_members(io::JsonStream& json, const Structure& structure, const NextResult& result,
                        const NextReportOptions& options = {});

std::string next_text(const Structure& structure, const NextResult& result,
                      const NextReportOptions& options = {});

/// A table of the places as CSV, the best first.
std::string next_csv(const NextResult& result, const NextReportOptions& options = {});

/// A page with the picture of next_svg() and the report for people.
std::string next_html(const Structure& structure, const CheckResult& checked,
                      const NextResult& result, const NextReportOptions& options = {});

/// The structure as picture_svg() draws it, with a ghost in every place, in its verdict's colour.
std::string next_svg(const Structure& structure, const CheckResult& checked,
                     const NextResult& result, const NextReportOptions& options = {},
                     const io::FigureOptions& figure = {});

/// Tries single changes of a structure with its planned modules attached; `result` is that of its
/// check with the same options. Progress is called with how many changes are judged, of how many.
plan::Remedies find_remedies(
    const Structure& structure, const CheckResult& result, const CheckOptions& options = {},
    const std::function<void(std::size_t done, std::size_t count)>& progress = {});

/// Lines for the end of report_text().
std::string remedies_text(const plan::Remedies& remedies);

/// Writes the key "remedies" into the report's object, which is open; docs/formats.md.
void write_remedies_member(io::JsonStream& json, const plan::Remedies& remedies);

}  // namespace holdfast
