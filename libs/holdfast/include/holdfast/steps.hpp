// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "holdfast/io/steps_report.hpp"  // IWYU pragma: export
#include "holdfast/plan/motions.hpp"     // IWYU pragma: export
#include "holdfast/plan/sequence.hpp"    // IWYU pragma: export

/// Sequences of steps: is every stage of each safe?
///
///     auto plan = holdfast::load_steps("plan.json");
///     if (!plan) { ... plan.error().message ... }
///     auto result = holdfast::judge_steps(plan.value());
///     if (!result) { ... a step that cannot be done ... }
///     if (!result.value().judgement.first_unsafe) { ... }
namespace holdfast {

/// The place of an error that is that of a plan which is gone on with.
inline constexpr const char* kAtPlan = "plan";

/// A structure whose steps can be judged.
struct StepsFile {
  std::string name;  ///< The document's, or the file's without folder and ending.
  io::Document document;
  std::vector<std::string> warnings;
  io::ReportOrigin origin = {};  ///< What its reports say of where it is from.
};

/// Reads a structure with steps. Errors: those of read_structure(); there is no
/// step.
base::Result<StepsFile> load_steps(const std::filesystem::path& path,
                                   const io::ReadOptions& options = {});

struct StepsOptions {
  int thread_count = 0;  ///< 0: as many as the machine has cores. The result does not depend on it.
  std::size_t memory_bytes_max = solver::EquilibriumOptions{}.memory_bytes_max;  ///< Per thread.
  bool ends_when_unsafe = false;  ///< Steps behind the first unsafe one are left out.
  /// Whether every stage is solved, also where steps only attach, or only detach, and the robot
  /// comes to have more than plan::kExactModuleCount modules: most stages of such steps are
  /// certified by a bound instead.
  bool is_exact = false;
  /// Every move must be one of these, if they are given, and of a single module.
  std::shared_ptr<const plan::Motions> motions = {};
  std::function<void(std::size_t judged_count)> progress = {};  ///< Called between steps.
};

struct StepsResult {
  plan::SequenceJudgement judgement;
  double seconds = 0;
};

/// Judges every stage of every step, planned steps of VisibleSim and of version 1 first. Errors: a
/// step cannot be done; Error::where is its JSON pointer, the message names step and stage.
base::Result<StepsResult> judge_steps(const StepsFile& file, const StepsOptions& options = {});

/// `more` adds keys at the end of the report.
void write_steps_json(std::ostream& out, const StepsFile& file, const StepsResult& result,
                      const io::MoreKeys& more = {});
std::string steps_text(const StepsFile& file, const StepsResult& result);
std::string steps_csv(const StepsFile& file, const StepsResult& result);
std::string steps_svg(const StepsFile& file, const StepsResult& result,
                      const io::FigureOptions& figure = {});

/// Draws the robot after a step that was judged, with its loads: 0 is the first, none the start.
/// Errors: no such step was judged; the robot is in pieces then.
base::Result<std::string> step_svg(const StepsFile& file, const StepsResult& result,
                                   std::optional<std::size_t> step,
                                   const io::FigureOptions& figure = {},
                                   const StepsOptions& options = {});

/// The most states in a film strip.
inline constexpr std::size_t kStripFrameMax = 24;

/// Draws the start and the robot after each step that was judged side by side, with its loads; of
/// long sequences as many as there is room for, with the first unsafe step and the last. Error: the
/// robot is in pieces after a step.
base::Result<std::string> steps_strip_svg(const StepsFile& file, const StepsResult& result,
                                          const io::FigureOptions& figure = {},
                                          const StepsOptions& options = {});

/// A page with the curves, the film strip where the robot stays in one piece, and the report for
/// people.
std::string steps_html(const StepsFile& file, const StepsResult& result,
                       const StepsOptions& options = {});

/// Writes a series for ParaView: `path`, a .pvd file, and beside it a .vtu file for the start and
/// for the robot after each step that was judged, or for each of its pieces. Error: one cannot be
/// written.
std::optional<base::Error> write_steps_vtk(const std::filesystem::path& path, const StepsFile& file,
                                           const StepsResult& result,
                                           const StepsOptions& options = {});

}  // namespace holdfast
