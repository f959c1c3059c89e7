// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "holdfast/verdict/assessment.hpp"

namespace holdfast::io {

/// An SVG of the robot in isometric view: every module coloured by its worst connection as in
/// Fig. 6 of [Piranda 2021] (green to orange safe, red broken, purple unstable, blue fixed, planned
/// ones dashed), the failing connection marked, the support polygon and the centre of mass, a
/// legend. Self-contained; `title` is shown and escaped.
std::string write_svg(const model::Robot& robot, const verdict::Assessment& assessment,
                      std::string_view title);

/// A VTK XML unstructured grid (.vtu, ASCII) for ParaView: one hexahedron per module with load
/// ratio, displacement and ground force, one line per connection with its forces. Field names and
/// units are in docs/formats.md.
std::string write_vtu(const model::Robot& robot, const verdict::Assessment& assessment);

}  // namespace holdfast::io
