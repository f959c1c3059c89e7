// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "holdfast/holdfast.hpp"       // IWYU pragma: export
#include "holdfast/plan/remedies.hpp"  // IWYU pragma: export

/// What would make a structure hold that does not: one more module, a prop, a module fixed or taken
/// away, stronger connections.
///
///     const holdfast::CheckResult result = holdfast::check(structure);
///     if (result.assessment.verdict != holdfast::verdict::Verdict::kSafe) {
///       const auto remedies = holdfast::find_remedies(structure, result);
///       ... remedies.of(holdfast::plan::RemedyKind::kModule).safe.front().cell ...
///     }
namespace holdfast {

/// Tries changes of a structure with its planned modules attached; `result` is that of its check
/// with the same options. Progress is called with how many changes are judged, of how many.
plan::Remedies find_remedies(
    const Structure& structure, const CheckResult& result, const CheckOptions& options = {},
    const std::function<void(std::size_t done, std::size_t count)>& progress = {});

/// Lines for the end of report_text().
std::string remedies_text(const plan::Remedies& remedies);

/// Writes the key "remedies" into the report's object, which is open; docs/formats.md.
void write_remedies_member(io::JsonStream& json, const plan::Remedies& remedies);

}  // namespace holdfast
