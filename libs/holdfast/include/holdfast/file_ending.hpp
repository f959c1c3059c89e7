// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "holdfast/base/result.hpp"

/// Knows how the names of files end.
namespace holdfast {

enum class FileFormat : std::uint8_t {
  kJson,       ///< Reports.
  kPlan,       ///< Structures with steps: holdfast JSON or VisibleSim XML, as the ending says.
  kStructure,  ///< The same, VisibleSim's XML or a binary structure, as the ending says.
  kCsv,
  kSvg,
  kFigure,  ///< SVG, PNG or PDF, as the ending says.
  kVtu,
  kPvd,  ///< The list of a series of .vtu files.
  kHtml,
};

/// The ending of a path in small letters, with its dot; empty if it has none.
std::string ending_of(std::string_view path);

/// Whether a path ends so, in small letters or large ones: ".png".
bool has_ending(std::string_view path, std::string_view ending);

/// Whether files of this format may end as this path does.
bool has_ending_of(FileFormat format, std::string_view path);

/// Returns an error if a file's name ends as files of another format do: nobody can read an SVG
/// that is called arm.png. Other endings are allowed where the ending tells no format; none is,
/// always.
std::optional<base::Error> find_foreign_ending(FileFormat format, std::string_view path);

}  // namespace holdfast
