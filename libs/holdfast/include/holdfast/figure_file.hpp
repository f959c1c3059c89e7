// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "holdfast/base/result.hpp"

/// Writes pictures in the format that the name of their file says: SVG, or PNG or PDF, which
/// librsvg makes of it. That library is loaded when it is needed, as it would cost every start of
/// the program longer than most verdicts take.
namespace holdfast {

/// Returns an error if a path asks for PNG or PDF, and this build or this machine has no librsvg.
std::optional<base::Error> find_figure_fault(std::string_view path);

/// Writes an SVG as what the path asks for; "-" is standard output and SVG.
std::optional<base::Error> write_figure(const std::filesystem::path& path, std::string_view svg);

}  // namespace holdfast
