// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "commands.hpp"
#include "holdfast/figure_file.hpp"

/// The picture that a command draws, and what may be asked of it.
namespace holdfast::cli {

struct Figure {
  std::string path;  ///< Empty if none is asked for.
  io::FigureOptions options;
};

/// Adds --svg, which `help` explains, and the options of the figure.
void add_figure(CLI::App& command, Figure& figure, const std::string& help);

/// Writes the picture that `draw(options)` makes, if one is asked for; returns false, and prints
/// the error, if it cannot be written.
template <class Draw>
bool write_figure_or_complain(const Figure& figure, const Draw& draw) {
  if (figure.path.empty()) {
    return true;
  }
  const auto error = write_figure(figure.path, draw(figure.options));
  if (error) {
    print_error(*error, figure.path);
  }
  return !error;
}

}  // namespace holdfast::cli
