// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/plan/cell_box.hpp"
#include "holdfast/plan/order_search.hpp"
#include "holdfast/plan/reach.hpp"

/// An order in which the modules of a robot can be attached, or taken apart, so that it is safe all
/// the way; or a certificate that there is none.
namespace holdfast::plan {

/// What an order goes from and to, and how.
struct OrderTask {
  model::RobotSpec target;  ///< All modules exist: none is planned.
  /// The modules that are there at first, all of the target. Empty: all fixed modules, or where
  /// none is fixed any single module that is supported and safe.
  std::vector<base::Cell> start = {};
  ReachRule rule = {};
  std::size_t group_size = 1;
  /// The most modules that one step attaches in any order: whatever part of them has come the robot
  /// is safe, and each touches, and gets to its cell along, what was there before the step. More
  /// than 1 only with groups of one.
  std::size_t parallel_max = 1;
  /// Whether a module may also come on the ground away from the others, so that states are in
  /// pieces, each of which is judged by itself. Only for single modules.
  bool in_pieces = false;
};

/// The task in which the modules in these boxes are there before the first step, as no step may
/// attach or detach them: without a start they and the fixed modules are the start. Errors: those
/// of kept_modules(); the start has not all of them (then `where` is kAtStart).
base::Result<OrderTask> with_kept(OrderTask task, std::span<const CellBox> keep);

/// Hears of a step of an order, and of the state behind it.
using StepListener = std::function<void(const Batch& step, const Judgement& judged)>;

struct RobotOrderOptions {
  /// The options of OrderOptions but the group size, which is the task's.
  std::uint64_t seed = 0;
  double seconds_max = std::numeric_limits<double>::infinity();
  std::size_t state_count_max = std::numeric_limits<std::size_t>::max();
  std::function<bool()> is_interrupted = {};
  Sense told_end = Sense::kGrowing;
  std::function<void(std::size_t states, std::size_t grown, std::size_t shrunk)> progress = {};
  /// Called with every step of the order that is found, in the sequence in which steps are done,
  /// and with the state behind it, as soon as both are certain: the step is not taken back. It is
  /// called first with all modules that are there before any step.
  StepListener certified = {};
  /// Solves in the end every state on the way that a bound has certified, while there is time: then
  /// RobotOrder::load_ratio_max is the largest of all.
  bool is_exact = false;
  /// 0: as many as the machine has cores. The result does not depend on it.
  int thread_count = 0;
};

/// Proves that a task cannot be done: a cut between start and target, see Closure. Elements are the
/// modules of `task.target.existing`, by index.
struct OrderCertificate {
  OrderTask task;
  Closure closure;
};

struct RobotOrder {
  Order order = {};  ///< Elements are the modules of the target's `existing`, by index.
  std::optional<OrderCertificate> certificate = {};  ///< Of OrderOutcome::kNone.
  /// The largest load ratio of all states on the way that were solved; none if no load is known.
  std::optional<double> load_ratio_max = {};
  /// What no state on the way exceeds, errors included: most are certified by a bound instead of
  /// being solved.
  std::optional<double> load_ratio_bound = {};
  /// The smallest margin on the way; none where none is known.
  std::optional<double> margin_min_mm = {};
  /// Where several modules come at a time: no schedule from this start has fewer steps, as each
  /// takes as many modules at most, and each module touches one that was there before.
  std::optional<std::size_t> step_count_least = {};
};

/// The place of an error that is the start's and not the target's.
inline constexpr const char* kAtStart = "start";

/// Errors: the target or the start is no robot, the start has modules that the target has not or is
/// not safe (then `where` is kAtStart); a source is missing or is taken.
base::Result<RobotOrder> find_robot_order(const OrderTask& task,
                                          const RobotOrderOptions& options = {});

/// Tells all steps of an order that was found as RobotOrderOptions::certified says.
void tell_steps(const Order& order, Sense told_end, const StepListener& certified);

/// Sets the bound and the margin of an order, and raises its largest load ratio, by those of its
/// states.
void take_extremes(RobotOrder& result);

/// What has been replayed of a certificate.
struct CertificateCheck {
  std::size_t state_count = 0;    ///< States inside the cut.
  std::size_t blocked_count = 0;  ///< States just beyond, judged anew, none of which is safe.
};

/// Replays a certificate: every state inside is left by every step there is, and each of them leads
/// inside or to a state that is judged anew and is not safe. Errors: what is not so.
base::Result<CertificateCheck> verify(const OrderCertificate& certificate, int thread_count = 0);

}  // namespace holdfast::plan
