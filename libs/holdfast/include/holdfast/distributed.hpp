// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/agent/agent.hpp"          // IWYU pragma: export
#include "holdfast/agent/wire/listener.hpp"  // IWYU pragma: export
#include "holdfast/holdfast.hpp"             // IWYU pragma: export
#include "holdfast/sim/simulation.hpp"       // IWYU pragma: export

/// The facade's second half: the robot works its verdict out by itself, in simulation.
///
///     holdfast::sim::SimulationOptions options;
///     options.link = holdfast::sim::blinky_blocks_v1();
///     auto run = holdfast::simulate(structure, holdfast::check(structure), options);
///     if (run && run.value().result.answer.verdict == holdfast::agent::Verdict::kSafe) { ... }
namespace holdfast {

/// Messages that modules refused, as no working module would have sent them (docs/wire.md). Each
/// module counts up to 255.
struct RefusedMessages {
  std::uint64_t count = 0;  ///< By all modules.
  base::Cell cell;          ///< Of the module that refused most, the first of several.
  int count_of_cell = 0;    ///< By that module.
};

/// The meaning of Effort::ratio_error, beside rounding to single precision, for the largest load
/// ratio under the robot's contact law.
enum class ErrorKind : std::uint8_t {
  kBound,     ///< The robot is statically determinate: no error is larger.
  kEstimate,  ///< It was too small in 4 of 1,844 random robots, by 14 times at most.
};

/// The reason why the robot answers otherwise than the exact answer: another verdict, another
/// contact law, or a largest load ratio that differs by more than is promised for one law.
enum class Difference : std::uint8_t {
  kNone,             ///< It does not.
  kModules,          ///< The exact answer is for modules that were taken off, too.
  kRobotUndecided,   ///< The robot does not know, for its own reason.
  kExactUndecided,   ///< The exact answer is not known, for its own reason.
  kContactLaw,       ///< Load ratios are those of two contact laws.
  kOtherSolutions,   ///< The contact law has several solutions.
  kUnstableByModel,  ///< One of the two falls by the states of its contacts.
  kUnexplained,      ///< None of these: an error, of the program too.
};

struct DistributedRun {
  sim::LinkModel link;
  sim::SimulationResult result;
  RefusedMessages refused;
  /// The robot's knowledge in the form of an assessment: its verdict, and its own load ratios where
  /// it has come to know any.
  verdict::Assessment view;
  std::vector<std::string> notes;  ///< What to know when comparing with the exact answer.
  std::array<base::Cell, 2> worst_cells = {};  ///< Of the robot's own worst connection.
  /// The limit that the worst load ratio is nearest to; none where Eq. (17) is the law of all
  /// connections.
  std::optional<model::Limit> worst_limit = {};
  ErrorKind error_kind = ErrorKind::kEstimate;
  Difference difference = Difference::kNone;
};

/// A change that is made to a robot while it computes.
struct Change {
  enum class Kind : std::uint8_t {
    kAttach,    ///< A module comes to the cell.
    kPlan,      ///< A module is planned there.
    kWithdraw,  ///< It is not planned any more; with agent::kEveryCell nothing is.
  };

  Kind kind = Kind::kPlan;
  sim::Time at = 0;
  base::Cell cell;
};

/// A structure with its changes.
struct ChangedStructure {
  Structure structure;                           ///< As it is in the end.
  std::vector<sim::Announcement> announcements;  ///< What the file plans, at 0, then the changes.
  std::vector<sim::Fault> attachments;
};

/// Returns the structure after the changes: with the modules that are attached, behind all others,
/// and the plans that are neither fulfilled nor withdrawn then. The first module of the file is
/// told of plans. Errors: a module is attached to an occupied cell; there is no robot in the end;
/// the robot goes beyond [Piranda 2021], see model::find_beyond_paper().
base::Result<ChangedStructure> with_changes(const Structure& structure,
                                            std::vector<Change> changes);

/// The agents of a robot, by the index of their modules, wherever they run.
struct Agents {
  std::function<const agent::Agent&(std::int32_t)> at;
  std::int32_t count = 0;
};

/// Describes the result of a robot whose agents were run elsewhere, with these options.
DistributedRun describe_run(const model::Robot& robot, const CheckResult& exact,
                            const sim::SimulationOptions& options, const Agents& agents,
                            const sim::SimulationResult& result);

/// A function that is called now and then during a long simulation, and ends it if it returns
/// false.
using SimulationProgress = std::function<bool(const sim::SimulationResult&)>;

/// Simulates the robot's own computation. `exact` gives what the robot does not work out (margin,
/// support polygon, torques) to the view. Errors: options that do not fit the robot.
base::Result<DistributedRun> simulate(const model::Robot& robot, const CheckResult& exact,
                                      const sim::SimulationOptions& options,
                                      const SimulationProgress& progress = {});

/// Simulates the structure's robot.
base::Result<DistributedRun> simulate(const Structure& structure, const CheckResult& exact,
                                      const sim::SimulationOptions& options,
                                      const SimulationProgress& progress = {});

/// check's report with the entry "distributed"; see docs/formats.md.
void write_report_json(std::ostream& out, const Structure& structure, const CheckResult& exact,
                       const DistributedRun& run, const io::ReportOptions& options = {});
std::string report_json(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run);

/// Writes the keys of the entry "distributed" into the object that is open.
void write_distributed(io::JsonStream& json, const DistributedRun& run);

/// The report for people: what the robot found, beside the exact answer, and what it cost by
/// phases.
std::string report_text(const Structure& structure, const CheckResult& exact,
                        const DistributedRun& run, const TextOptions& options = {});

/// The robot in the colours of its own load ratios.
std::string picture_svg(const Structure& structure, const DistributedRun& run,
                        const io::FigureOptions& figure = {});

/// The word that the exact answer has for a verdict of the robot.
verdict::Verdict to_verdict(agent::Verdict verdict);

/// The robot's largest load ratio; none of a single module, which has no connection, and where the
/// verdict is neither `safe` nor `overload`.
std::optional<double> load_ratio_max(const agent::Answer& answer);

/// Returns "bound" or "estimate".
const char* name(ErrorKind kind);

/// Returns "none", "modules", "robot_undecided", "exact_undecided", "contact_law",
/// "other_solutions", "unstable_by_model" or "unexplained".
const char* name(Difference difference);

/// "elimination", "polynomial", "fronts", and back.
const char* name(agent::Method method);
std::optional<agent::Method> find_method(std::string_view name);

}  // namespace holdfast
