// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/holdfast.hpp"              // IWYU pragma: export
#include "holdfast/io/order_certificate.hpp"  // IWYU pragma: export
#include "holdfast/io/order_report.hpp"       // IWYU pragma: export
#include "holdfast/plan/order.hpp"            // IWYU pragma: export
#include "holdfast/plan/order_help.hpp"       // IWYU pragma: export
#include "holdfast/steps.hpp"

/// The facade's orders: how can a robot be built, module by module, so that it is safe all the way?
///
///     const auto answer = holdfast::seek_order(document, {.start = first_cells});
///     if (answer && answer.value().result.order.outcome == holdfast::plan::OrderOutcome::kFound)
///         { ... }
namespace holdfast {

struct OrderRequest {
  std::vector<base::Cell> start = {};  ///< As of plan::OrderTask.
  /// Modules that no step attaches or detaches, as of plan::with_kept(): all in these boxes.
  std::vector<plan::CellBox> keep = {};
  plan::ReachRule rule = {};
  std::size_t group_size = 1;
  std::size_t parallel_max = 1;  ///< As of plan::OrderTask.
  bool in_pieces = false;        ///< As of plan::OrderTask.
  bool is_reversed = false;      ///< Taken apart, from the target to the start.
  std::uint64_t seed = 0;
  double seconds_max = std::numeric_limits<double>::infinity();
  double help_seconds_max = 0;  ///< Where there is no order: time to seek help; 0: none is sought.
  /// Whether all states on the way are solved in the end, also of robots of more than
  /// plan::kExactModuleCount modules, most of whose states are certified by a bound.
  bool is_exact = false;
  int thread_count = 0;  ///< 0: as many as the machine has cores; decides nothing.
  /// A function that several threads call all the time; once it returns true the search ends, and
  /// its answer is what has been found by then.
  std::function<bool()> is_interrupted = {};
  std::function<void(std::size_t states, std::size_t grown, std::size_t shrunk)> progress = {};
  /// Called with a line of JSON (io::order_step_line) for the start of an order that is found and
  /// for each of its steps, as soon as it is certified and will not be taken back.
  std::function<void(const std::string& line)> stream = {};
};

/// A page with the report for people, and the steps with their pictures as steps_html() has them.
/// `more` stands behind the report.
std::string order_html(const io::OrderReport& report, std::string_view more = {},
                       int thread_count = 0);

/// Seeks an order for all modules of a document, existing or planned. Errors: those of
/// io::make_spec(), plan::with_kept() and plan::find_robot_order().
base::Result<io::OrderReport> seek_order(const io::Document& target, const OrderRequest& request);

/// Goes on with an order's plan, the structure of io::order_steps(). `done_count` of its steps are
/// done, and `file` is the robot that it was made for; or without a count `file` is the robot as it
/// is now. The last steps of the plan, as many as are safe and have a way one after another, are
/// kept where an order is found that leads to them (io::OrderReport::kept_count), else the rest is
/// an order anew. Modules that are there already, or gone, are left out of the steps, and so are
/// kept ones that they would detach. The start of the request counts for nothing. Errors: those of
/// seek_order(); the plan has no steps, or does else than attach or detach, or is that of another
/// robot, or has fewer steps, or its steps do not go with the groups of the request (then `where`
/// is kAtPlan).
base::Result<io::OrderReport> continue_order(const io::Document& file, const io::Document& plan,
                                             std::optional<std::size_t> done_count,
                                             const OrderRequest& request);

/// The least factor of all strengths with which there is a safe order: the bottleneck of all ways
/// from the start to the whole. It lies between `none`, with which it is proved that there is none,
/// and `enough`, with which one was found, and they are apart by kNeededDigits at most unless time
/// or undecided states ended the search.
struct StrengthNeeded {
  double none = 0;
  std::optional<double> enough = {};  ///< None: no order was found with any factor.
  bool is_certain = false;            ///< Whether nothing is left between the two.
  std::size_t search_count = 0;
  /// The order with `enough`, its load ratios those with the strengths as given; without one the
  /// answer to the last search.
  io::OrderReport report;
};

inline constexpr double kNeededDigits = 1e-4;

/// Seeks it by searches with other strengths, all of them together within the time of the request.
/// What is safe with weaker magnets is safe with stronger ones, so every search tells one side.
/// Errors: those of seek_order(); several modules are to come at a time, whose load ratios are
/// bounds.
base::Result<StrengthNeeded> seek_strength_needed(const io::Document& target,
                                                  const OrderRequest& request);

/// A line for the end of the text of its order, and the member "strength_needed" of its report.
std::string strength_needed_text(const StrengthNeeded& needed);
std::string strength_needed_member(const StrengthNeeded& needed);

/// The claims that a certificate has proved, and of which robot.
struct ProvedOrder {
  std::string name;  ///< As the certificate says; may be empty.
  plan::OrderTask task;
  plan::CertificateCheck check;
};

/// Replays the certificate in a text, see plan::verify(). Error: it is of another robot than
/// `target`.
base::Result<ProvedOrder> verify_order_certificate(
    std::string_view text, const std::optional<model::RobotSpec>& target = {},
    int thread_count = 0);

/// Says for people what is proved, of which robot and under which rules.
std::string proved_text(const ProvedOrder& proved);

}  // namespace holdfast
