// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "commands.hpp"
#include "figure.hpp"
#include "holdfast/distributed.hpp"

namespace holdfast::cli {

/// Prints what a robot has worked out, simulated or emulated, and writes the files that the options
/// `json` and `figure` name, with the `connections` chosen; `is_silent` if the terminal gets
/// nothing but a report asked for with "-". False if a file cannot be written.
template <class Options, class Run>
bool show_run(const Options& options, bool is_silent, const Structure& structure,
              const CheckResult& exact, const Run& run, const DistributedRun& picture) {
  if (!is_silent) {
    fmt::print("{} {}\n{}", banner(picture.view.verdict), io::one_line(structure.name),
               report_text(structure, exact, run, text_options()));
  }
  bool is_written = true;
  if (!options.json.empty()) {
    is_written = write_or_complain(options.json, [&](std::ostream& out) {
      io::ReportOptions report;
      report.connections = *io::find_connection_choice(options.connections);
      write_report_json(out, structure, exact, run, report);
      out << '\n';
    });
  }
  return write_figure_or_complain(options.figure,
                                  [&](const io::FigureOptions& figure) {
                                    return picture_svg(structure, picture, figure);
                                  }) &&
         is_written;
}

}  // namespace holdfast::cli
