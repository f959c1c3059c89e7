// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <limits>
#include <string>

#include "holdfast/holdfast.hpp"     // IWYU pragma: export
#include "holdfast/plan/losses.hpp"  // IWYU pragma: export

/// The facade's answer to "and if one connection fails?": what follows from the loss of each single
/// connection, module and foot of a structure.
///
///     const plan::LossReport losses = holdfast::lose_one(structure);
///     if (!losses.holds_all()) { ... losses.fatal ... losses.undecided ... }
namespace holdfast {

struct LoseOneOptions {
  CheckOptions check = {};         ///< In the deformed shape, if that is wanted.
  bool is_cascade_wanted = false;  ///< Finds what follows each fatal loss.
  /// The parts that are lost, by plan::LossKind: connections, modules, feet.
  std::array<bool, plan::kLossKindCount> kinds = {true, true, true};
  /// Losses that are not judged after this time are undecided.
  double seconds_max = std::numeric_limits<double>::infinity();
  /// Called now and then with how many losses are judged, of how many.
  std::function<void(std::size_t done, std::size_t count)> progress = {};
};

/// Judges the loss of each single part of a structure with its planned modules attached, as a check
/// of what is left would.
plan::LossReport lose_one(const Structure& structure, const LoseOneOptions& options = {});

/// Numbers for tables and pictures, of each connection, module and facet: `loss_outcome`, 1 if the
/// robot is safe after its loss, 2 if that is undecided, 3 if it is fatal, and 0 if it was not
/// tried; `loss_load_ratio`, the largest load ratio after it, or what that does not exceed.
std::vector<io::MoreNumbers> lose_one_numbers(const model::Robot& robot,
                                              const plan::LossReport& report);

/// Lines for the end of report_text().
std::string lose_one_text(const plan::LossReport& report);

/// Writes the key "lose_one" into the report's object, which is open; docs/formats.md.
void write_lose_one_member(io::JsonStream& json, const model::Robot& robot,
                           const plan::LossReport& report);

}  // namespace holdfast
