// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "holdfast/holdfast.hpp"             // IWYU pragma: export
#include "holdfast/verdict/reliability.hpp"  // IWYU pragma: export

/// The facade's answer to "how sure?": the probability that every connection of a checked structure
/// holds where strengths scatter.
///
///     const auto scatter = holdfast::find_scatter(structure, {.strength_cv = 0.1});
///     const auto sure = holdfast::find_reliability(structure, result, *scatter);
///     if (sure) { ... sure->holds ... }
namespace holdfast {

/// How strengths and masses are to scatter; what is none is as the structure states it, or not at
/// all.
struct ScatterWish {
  std::optional<double> strength_cv = {};  ///< Of all connections, from kCvMin to kCvMax.
  double common_cv = 0;                    ///< Of all together; structures do not state it.
  std::optional<verdict::StrengthDistribution> distribution = {};
  std::optional<double> mass_cv = {};  ///< Of all modules, from kCvMin to kMassCvMax.
};

/// How the parts of a structure scatter; none where neither it nor the wish says that any does. A
/// connection of modules of two kinds scatters as the one that scatters more; strengths that do not
/// scatter where others do have a cv of kCvMin.
std::optional<verdict::StrengthScatter> find_scatter(const io::Extension& stated,
                                                     const model::Robot& robot,
                                                     const ScatterWish& wish = {});
std::optional<verdict::StrengthScatter> find_scatter(const Structure& structure,
                                                     const ScatterWish& wish = {});

/// Says how sure it is, as verdict::find_reliability() does: none where the robot is not known to
/// stay, or no load is known. `options` are those of the check. Where masses scatter, samples in
/// which facets change their states are checked from scratch, for which the structure's document
/// must be whole.
std::optional<verdict::Reliability> find_reliability(
    const Structure& structure, const CheckResult& result, const verdict::StrengthScatter& scatter,
    const CheckOptions& options = {}, std::size_t likeliest_max = verdict::kLikeliestMax);

/// A robot, and what is known of it.
struct AssessedRobot {
  const model::Robot& robot;
  const verdict::Assessment& assessment;
  /// What the robot is made from; none: samples that would need a check are not known.
  const model::RobotSpec* spec = nullptr;
  double safety_factor = 1;  ///< What its strengths were divided by: those as given scatter.
  std::size_t likeliest_max = verdict::kLikeliestMax;  ///< So many connections are named.
};

/// Says it for a robot that is no structure.
std::optional<verdict::Reliability> find_reliability(const AssessedRobot& assessed,
                                                     const verdict::StrengthScatter& scatter,
                                                     const CheckOptions& options = {});

/// Numbers for tables and pictures: `fail_share` of each connection, of a reliability that names
/// all of them (`likeliest_max`).
std::vector<io::MoreNumbers> reliability_numbers(
    const model::Robot& robot, const std::optional<verdict::Reliability>& reliability);

/// Lines for the end of report_text().
std::string reliability_text(const model::Robot& robot,
                             const std::optional<verdict::Reliability>& reliability);

/// Writes the key "reliability" into the report's object, which is open; docs/formats.md.
void write_reliability_member(io::JsonStream& json, const model::Robot& robot,
                              const verdict::StrengthScatter& scatter,
                              const std::optional<verdict::Reliability>& reliability);

}  // namespace holdfast
