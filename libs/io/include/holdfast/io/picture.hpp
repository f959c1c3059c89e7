// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <string_view>

#include "holdfast/io/figure.hpp"
#include "holdfast/io/write_options.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

/// An SVG of the robot, in isometric view unless another is asked for: every module coloured by its
/// worst connection as in Fig. 6 of [Piranda 2021] (green to orange safe, red broken, purple
/// unstable, blue fixed, planned ones dashed), the failing connection marked, the support polygon
/// and the centre of mass, a legend. Modules look like those of their lattice: cubes, prisms,
/// standing discs, balls. Near obstacles are drawn translucent; `obstacles` are those that the
/// robot was made with. The facets that touch say what they do; payloads, and gravity that does not
/// point straight down, are arrows. The text is self-contained; `title` is shown and escaped.
std::string write_svg(const model::Robot& robot, const verdict::Assessment& assessment,
                      std::string_view title, std::span<const model::Obstacle> obstacles = {},
                      const FigureOptions& figure = {});

/// A place where a module may go, and what the robot becomes with one there.
struct Ghost {
  verdict::Verdict verdict = verdict::Verdict::kUndecided;
  std::optional<double> load_ratio_max = {};
};

/// Returns the picture of write_svg() with ghosts: the robot's last modules, which are planned ones
/// and drawn as glass in the colours of their verdicts. `assessment` is that of the robot without
/// them.
std::string write_svg_with_ghosts(const model::Robot& robot, std::span<const Ghost> ghosts,
                                  const verdict::Assessment& assessment, std::string_view title,
                                  std::span<const model::Obstacle> obstacles = {},
                                  const FigureOptions& figure = {});

/// A state of a robot that changes step by step.
struct StripFrame {
  std::size_t step = 0;  ///< How many steps have been done: 0 is the start.
  const model::Robot* robot = nullptr;
  const verdict::Assessment* assessment = nullptr;
  std::span<const model::Obstacle> obstacles = {};
};

/// Returns an SVG with states side by side, all to one scale, each with its verdict and largest
/// load ratio. Modules are coloured as in write_svg(). The views of `frames`, of which there must
/// be some, must outlive the call.
std::string write_strip_svg(std::span<const StripFrame> frames, std::string_view title,
                            const FigureOptions& figure = {});

/// Returns the picture of write_svg() with the modules in these cells in the colour of those that
/// fall.
std::string write_svg_with_fallen(const model::Robot& robot, std::span<const base::Cell> fallen,
                                  const verdict::Assessment& assessment, std::string_view title,
                                  std::span<const model::Obstacle> obstacles = {},
                                  const FigureOptions& figure = {});

/// Writes a VTK XML unstructured grid (.vtu, compressed binary) for ParaView: one cell per module,
/// in the shape of its lattice, with load ratio, displacement and ground force, one line per
/// connection with its forces, one square per facet that touches with its state and force, and a
/// cell like a module's per cell of the obstacles that are near, `kind` 3.
/// Field names and units are in docs/formats.md. A stream that can be sought in gets it in a fixed
/// amount of memory; any other gets it at the end. Ends early if the stream fails.
void write_vtu(std::ostream& out, const model::Robot& robot, const verdict::Assessment& assessment,
               const WriteOptions& options = {}, std::span<const model::Obstacle> obstacles = {});

/// Writes a robot in its deformed shape under `factor` times its loads as write_vtu() does. Modules
/// are turned by their rotation vectors, however large, also where loads are not known; the factor
/// is `load_factor` of the file.
void write_deformed_vtu(std::ostream& out, const model::Robot& robot,
                        const verdict::Assessment& assessment, double factor,
                        const WriteOptions& options = {},
                        std::span<const model::Obstacle> obstacles = {});

/// Writes a part of a robot (model/robot_part.hpp) as write_vtu() does: its first `own_count`
/// modules, and the connections and facets that begin at them, without obstacles. The stream must
/// be seekable.
void write_vtu_piece(std::ostream& out, const model::Robot& part, std::size_t own_count,
                     const verdict::Assessment& assessment, const WriteOptions& options = {});

/// Writes the VTK XML file (.pvtu) by which ParaView opens all pieces of a robot, from any one part
/// of it. `pieces` are the names of the files that write_vtu_piece() has written, seen from this
/// file's folder; they must need no escaping.
void write_pvtu(std::ostream& out, const model::Robot& part, const verdict::Assessment& assessment,
                std::span<const std::string> pieces);

/// A file of a series of files over time; several of one time are parts of the robot.
struct SeriesFile {
  std::size_t time = 0;
  std::size_t part = 0;
  std::string name;  ///< Seen from the index's folder; UTF-8 without control characters.
};

/// Writes the VTK XML file (.pvd) by which ParaView opens a series that write_vtu() has written.
void write_pvd(std::ostream& out, std::span<const SeriesFile> files);

}  // namespace holdfast::io
