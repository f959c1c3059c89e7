// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "figure.hpp"

namespace holdfast::cli {

void add_figure(CLI::App& command, Figure& figure, const std::string& help) {
  CLI::Option* const svg = &add_output(command, "--svg", figure.path,
                                       help + ", as SVG, PNG or PDF by the file's ending");
  io::FigureOptions& options = figure.options;
  const auto add = [&](CLI::Option* option) { option->needs(svg)->group(kOutputs); };
  add(command
          .add_option_function<std::string>(
              "--size", [&](const std::string& text) { options.size = io::find_figure_size(text); },
              "Size of the picture, in pixels")
          ->type_name("WIDTH[xHEIGHT]")
          ->check([](const std::string& text) {
            return io::find_figure_size(text)
                       ? ""
                       : "expected a width, or a size such as 800x600, of 16 to 20000 pixels";
          }));
  add(command.add_option("--title", options.title, "Title in place of the structure's name")
          ->type_name("TEXT"));
  add(command.add_flag("--grey", options.is_grey,
                       "Draw without colours; the darker the more load"));
  add(command
          .add_option_function<std::string>(
              "--view", [&](const std::string& text) { options.view = *io::find_view(text); },
              "Look from there: iso, front, side, top, or the azimuth and elevation of the eye, in "
              "degrees [default: iso]")
          ->type_name("iso|front|side|top|AZ,EL")
          ->check([](const std::string& text) {
            return io::find_view(text) ? ""
                                       : "expected iso, front, side, top, or azimuth and elevation "
                                         "(0 to 90) such as -60,30";
          }));
  add(command.add_flag_callback(
      "--no-legend", [&] { options.has_legend = false; }, "Leave out the legend"));
}

}  // namespace holdfast::cli
