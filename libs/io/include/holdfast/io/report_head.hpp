// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/json_stream.hpp"

/// What every JSON report begins with, so that whoever finds one knows what it is and who wrote
/// it: "format", "version" of the format, "report" (the command), "program" and its version.
namespace holdfast::io {

inline constexpr std::string_view kReportFormat = "holdfast-report";

/// The version of all reports. Keys that are added leave it as it is; a key that is taken away, or
/// has another meaning, raises it.
inline constexpr std::int32_t kReportVersion = 1;

/// The version of this library, "major.minor.patch".
std::string_view program_version();

/// Appends the members to the object that is open and empty.
void write_report_head(JsonStream& json, std::string_view command);

/// Returns the members of write_report_head() as texts, for reports that are laid out line by line.
std::vector<std::string> report_head(std::string_view command);

}  // namespace holdfast::io
