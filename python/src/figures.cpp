// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "common.hpp"
#include "holdfast/figure_file.hpp"
#include "long_work.hpp"

namespace holdfast::python {
namespace {

io::FigureOptions figure_of(const py::handle& size, const py::handle& view, const py::handle& title,
                            bool is_grey, bool has_legend) {
  io::FigureOptions figure{
      .has_legend = has_legend, .title = utf8_of(title, "title"), .is_grey = is_grey};
  if (!size.is_none()) {
    const std::string text = utf8_of(size, "size");
    figure.size = io::find_figure_size(text);
    if (!figure.size) {
      throw Error("size: expected a width, or a width and a height, of 16 to 20000 pixels, found " +
                  text);
    }
  }
  const std::string text = utf8_of(view, "view");
  const auto found = io::find_view(text);
  if (!found) {
    throw Error(
        "view: expected iso, front, side, top, or azimuth and elevation (0 to 90), found '" + text +
        "'");
  }
  figure.view = *found;
  return figure;
}

}  // namespace

void add_figures(py::module_& module) {
  py::class_<io::FigureOptions>(module, "Figure").def(py::init(&figure_of));
  module.def("write_figure", [](const py::handle& given, const py::handle& svg) {
    const std::string path = path_of(given);
    take(find_foreign_ending(FileFormat::kFigure, path), path);
    take(find_figure_fault(path), path);
    const std::string text = utf8_of(svg, "svg");
    take(without_gil([&] { return write_figure(path, text); }), path);
  });
}

}  // namespace holdfast::python
