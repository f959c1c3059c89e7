// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ostream>
#include <span>
#include <string_view>

#include "holdfast/file_ending.hpp"
#include "holdfast/holdfast.hpp"

/// The formats in which what check() finds is written, a row each. The options of `holdfast check`
/// and the files of Python's reports are those of this table.
namespace holdfast {

struct CheckFormat {
  std::string_view name;    ///< In Python: report.save_csv.
  std::string_view option;  ///< Of the command line.
  std::string_view help;
  FileFormat file = FileFormat::kJson;  ///< How its files end.

  /// Writes all that was found; what grows with the robot in blocks, with the threads, the
  /// progress and the numbers of other answers that the options name.
  void (*write)(std::ostream& out, const Structure& structure, const CheckResult& result,
                const io::ReportOptions& options) = nullptr;
};

std::span<const CheckFormat> check_formats();

/// The format of that name; null if there is none.
const CheckFormat* find_check_format(std::string_view name);

/// The format whose files end as this path does; null if there is none.
const CheckFormat* find_check_format_of(std::string_view path);

}  // namespace holdfast
