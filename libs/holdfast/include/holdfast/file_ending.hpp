// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "holdfast/base/result.hpp"

/// How the names of files end.
namespace holdfast {

enum class FileFormat : std::uint8_t {
  kJson,          ///< Reports.
  kHoldfastJson,  ///< Structures.
  kStructure,     ///< The same, VisibleSim's XML or a binary structure, as the ending says.
  kCsv,
  kSvg,
  kVtu,
  kPvd,  ///< The list of a series of .vtu files.
  kHtml,
};

/// What is wrong if a file's name ends as files of another format do: what is written into arm.png
/// as SVG is read by nobody. Other endings, and none, are free.
std::optional<base::Error> find_foreign_ending(FileFormat format, std::string_view path);

}  // namespace holdfast
