// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/io/json_stream.hpp"

/// What every JSON report begins with, so that whoever finds one knows what it is, who wrote it and
/// what it is about: "format", "version" of the format, "report" (the command), "program" and its
/// version, "robot" (its file and how many modules it has) and "options" of the command line.
namespace holdfast::io {

inline constexpr std::string_view kReportFormat = "holdfast-report";

/// The version of all reports. Keys that are added leave it as it is; a key that is taken away, or
/// has another meaning, raises it.
inline constexpr std::int32_t kReportVersion = 1;

/// An option of the command line that was not left at its default.
struct GivenOption {
  std::string name;                 ///< The long name without its dashes: "connections".
  std::vector<std::string> values;  ///< As they were given; none for a flag.
  bool is_list = false;             ///< It may be given several times.
};

/// Where the robot of a report is from, and what was asked.
struct ReportOrigin {
  std::string file = {};  ///< As it was named, "-" for standard input; empty if it is from no file.
  std::string target = {};  ///< The file of the shape that it is to take, or empty.
  /// The program lists its options; a report of the library has no list.
  std::optional<std::vector<GivenOption>> options = {};
};

struct ReportHead {
  std::string_view command;
  ReportOrigin origin = {};
  std::optional<std::size_t> module_count = {};  ///< None if the file could not be read.
};

/// The version of this library, "major.minor.patch".
std::string_view program_version();

/// Appends the members to the object that is open and empty.
void write_report_head(JsonStream& json, const ReportHead& head);

/// Returns the members of write_report_head() as texts, for reports that are laid out line by line.
std::vector<std::string> report_head(const ReportHead& head);

}  // namespace holdfast::io
