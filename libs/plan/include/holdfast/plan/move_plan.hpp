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

#include "holdfast/base/result.hpp"
#include "holdfast/plan/module_moves.hpp"
#include "holdfast/plan/sequence.hpp"

/// How does a robot get from one shape to another, module by module, safe at every stage?
///
/// States are shapes: where modules are, no matter which of those that are alike. A step moves one
/// module, without which all others are still in one piece, by a slide or around a convex corner
/// (Group), and is taken only if release, shift and connect are judged `safe`.
namespace holdfast::plan {

struct MoveTask {
  model::RobotSpec start;
  model::RobotSpec target;                      ///< Modules alike are interchangeable.
  std::shared_ptr<const Motions> motions = {};  ///< As of MoveRule.
  std::optional<CellBox> within = {};
  std::vector<base::Cell> avoid = {};  ///< As of MoveRule.
  std::vector<base::Cell> keep = {};  ///< Modules that no step moves; they may be outside `within`.
  /// Steps need not be safe: neither strength nor balance is judged, but that something holds the
  /// robot.
  bool ignores_mechanics = false;
};

struct MoveOptions {
  /// Decides in which order moves are tried; the same seed finds the same plan.
  std::uint64_t seed = 0;
  /// The search stops after this time, or so many judged moves, without an answer.
  double seconds_max = std::numeric_limits<double>::infinity();
  std::size_t state_count_max = std::numeric_limits<std::size_t>::max();
  /// A search for a shorter plan than the first that is found judges so many moves, divided by the
  /// number of modules that are not fixed.
  std::size_t exact_count_max = 40'000;
  solver::EquilibriumOptions solver = {};  ///< Of each check. The result depends on no threads.
  /// Asked between moves; true ends the search as time does.
  std::function<bool()> is_interrupted = {};
  /// Called between moves with the number of those judged, and the least number of moves from the
  /// nearest shape so far to the target.
  std::function<void(std::size_t states, int distance)> progress = {};
};

enum class MoveOutcome : std::uint8_t {
  kFound,
  kNone,      ///< There is no plan: the target is not safe, or all shapes are exhausted.
  kNotFound,  ///< Time or states ran out, or it was interrupted.
};

/// "found", "none", "not-found".
const char* name(MoveOutcome outcome);

/// Whether a plan for the task may have each of these steps, as far as geometry goes: a move by its
/// rules, of a module that does not stay and without which all others are in one piece. Each step
/// moves one module, from where one is to a free cell, the first one in the robot `start`.
std::vector<bool> allowed_steps(const MoveTask& task, const model::RobotSpec& start,
                                std::span<const model::Step> steps);

/// Proves that there is no plan.
struct MoveCertificate {
  MoveTask task;
  /// The target's judgement if it is not safe: nothing more is to be proved, `shapes` is empty.
  std::optional<Judgement> target = {};
  /// Shapes, each as the cells of all modules that are neither fixed nor kept, those alike
  /// together: the start
  /// is one of them, the target is none, and no safe step leads out.
  std::vector<std::vector<base::Cell>> shapes = {};
  /// The other way round: the target is one of them, the start is none, and no safe step leads in.
  bool is_backward = false;
};

struct MovePlan {
  MoveOutcome outcome = MoveOutcome::kNotFound;
  /// The steps to the target, or if it is not found to the nearest shape that was reached.
  std::vector<model::Step> steps = {};
  bool is_shortest = false;  ///< No plan has fewer steps.
  int length_min = 0;        ///< No plan has fewer steps than this.
  /// The cheapest assignment of modules to cells of the target, each with the least number of moves
  /// as if it were alone: a lower bound of the number of steps. Of more than 2,000 misplaced
  /// modules alike each counts as one move.
  int assignment_bound = 0;
  std::size_t state_count = 0;  ///< Moves judged, that is shapes beside others.
  /// Moves, or the target, that were not taken because they are undecided: where there are any,
  /// `none` and the shortest plan are not proved.
  std::size_t undecided_count = 0;
  /// The judgement of the steps as of one sequence; none if there is no step. If mechanics is
  /// ignored, of the first of them, as far as time reached.
  std::optional<SequenceJudgement> judgement = {};
  std::optional<MoveCertificate> certificate = {};  ///< Of kNone.
};

/// Errors: start or target is no robot, the start is not safe; shapes of different robots or in
/// different surroundings; motions of another lattice; a module outside the box, or in a cell to be
/// avoided; a module to be kept that is not there, or that the target lacks.
base::Result<MovePlan> find_moves(const MoveTask& task, const MoveOptions& options = {});

/// What has been replayed of a certificate.
struct MoveCertificateCheck {
  std::size_t shape_count = 0;   ///< Shapes inside.
  std::size_t unsafe_count = 0;  ///< Moves that lead out, judged anew, none of which is safe.
  /// The verdict on the target, judged anew, if that it is not safe is all that was to be proved.
  std::optional<verdict::Verdict> target = {};
};

/// Replays a certificate: every move from every shape leads to another of them or is judged anew
/// and not safe; or the target is judged anew and not safe. Errors: what is not so, and a target
/// that need not be safe.
base::Result<MoveCertificateCheck> verify(const MoveCertificate& certificate,
                                          const solver::EquilibriumOptions& options = {});

}  // namespace holdfast::plan
