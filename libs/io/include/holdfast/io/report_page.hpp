// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

/// Reports as pages for browsers.
namespace holdfast::io {

/// A report with its pictures; views must outlive the call.
struct ReportPage {
  std::string_view command;           ///< The command that wrote it, such as "steps".
  std::string_view name;              ///< The robot's.
  std::string_view answer;            ///< A word, such as "safe".
  std::vector<std::string> pictures;  ///< Each an SVG of its own.
  std::string_view text;              ///< The report for people.
};

/// The page as one text that needs no other file and no script.
std::string write_report_page(const ReportPage& page);

}  // namespace holdfast::io
