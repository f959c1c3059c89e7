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
///     const auto sure = holdfast::find_reliability(holdfast::check(structure), {.cv = 0.1});
///     if (sure) { ... sure->holds ... }
namespace holdfast {

/// Says how sure it is, as verdict::find_reliability() does: none where the robot is not known to
/// stay, or no load is known.
std::optional<verdict::Reliability> find_reliability(const CheckResult& result,
                                                     const verdict::StrengthScatter& scatter);

/// Lines for the end of report_text().
std::string reliability_text(const model::Robot& robot,
                             const std::optional<verdict::Reliability>& reliability);

/// Writes the key "reliability" into the report's object, which is open; docs/formats.md.
void write_reliability_member(io::JsonStream& json, const model::Robot& robot,
                              const verdict::StrengthScatter& scatter,
                              const std::optional<verdict::Reliability>& reliability);

}  // namespace holdfast
