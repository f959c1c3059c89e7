// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "holdfast/io/move_report.hpp"  // IWYU pragma: export
#include "holdfast/plan/move_plan.hpp"  // IWYU pragma: export
#include "holdfast/steps.hpp"

/// The facade's moves: how does a robot get from one shape to another, safe at every stage?
///
///     const auto report = holdfast::seek_moves(from, to, {.seconds_max = 60});
///     if (report && report.value().plan.outcome == holdfast::plan::MoveOutcome::kFound) {
///       ... report.value().plan.steps ...
///     }
namespace holdfast {

/// The rules by which modules may go, and the time for which a plan is sought.
struct MoveRequest {
  std::shared_ptr<const plan::Motions> motions = {};  ///< As of plan::MoveTask, all four.
  std::optional<plan::CellBox> within = {};
  std::vector<base::Cell> avoid = {};
  bool ignores_mechanics = false;
  std::vector<plan::CellBox> keep = {};  ///< All modules in these boxes stay where they are.
  std::uint64_t seed = 0;
  double seconds_max = std::numeric_limits<double>::infinity();
  int thread_count = 0;  ///< 0: as many as the machine has cores; decides nothing.
  /// Both functions are as in plan::MoveOptions.
  std::function<bool()> is_interrupted = {};
  std::function<void(std::size_t states, int distance)> progress = {};
};

/// The motions in a file, or those of this name: "pivoting" (plan::pivoting_cubes()), "catoms3D"
/// (balls that roll, and go between no two that are opposite to each other). Errors: those of
/// read_file() and io::read_motions().
base::Result<std::shared_ptr<const plan::Motions>> find_motions(const std::string& name_or_file);

/// Seeks moves from the shape of one document to that of another. Errors: those of io::move_task(),
/// plan::kept_modules() and plan::find_moves().
base::Result<io::MoveReport> seek_moves(const io::Document& start, const io::Document& target,
                                        const MoveRequest& request = {});

/// Goes on with a plan of moves, the structure of io::move_steps(), to the shape that it leads to.
/// `done_count` of its steps are done, and `file` is the robot that it was made for; or without a
/// count `file` is the robot as it is now, and of the plan are left the steps behind the last state
/// in which the fewest modules are elsewhere. The last of them, as many as are safe and allowed by
/// the request one after another, are kept where moves are found that lead to them
/// (io::MoveReport::kept_count), else the moves are sought anew. Errors: those of seek_moves(); the
/// plan has no steps, or does else than to move one module in each, or is that of another robot, or
/// has fewer steps (then `where` is kAtPlan); mechanics is to be ignored.
base::Result<io::MoveReport> continue_moves(const io::Document& file, const io::Document& plan,
                                            std::optional<std::size_t> done_count,
                                            const MoveRequest& request = {});

/// A page with the report for people, and the steps with their pictures as steps_html() has them.
/// `more` stands behind the report.
std::string move_html(const io::MoveReport& report, std::string_view more = {},
                      int thread_count = 0);

/// The claims that a certificate has proved, and of which robots.
struct ProvedMoves {
  std::string start_name;  ///< As the documents say; may be empty, both.
  std::string target_name;
  plan::MoveTask task;
  bool is_backward = false;  ///< As of plan::MoveCertificate.
  plan::MoveCertificateCheck check;
};

/// Replays the certificate in a report for the same documents and the same request.
base::Result<ProvedMoves> verify_moves(const io::Document& start, const io::Document& target,
                                       const MoveRequest& request, std::string_view report);

/// Says for people what is proved, of which robot and under which rules.
std::string proved_text(const ProvedMoves& proved);

}  // namespace holdfast
