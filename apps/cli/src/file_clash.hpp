// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "holdfast/file_ending.hpp"

/// Files that would overwrite each other.
namespace holdfast::cli {

struct Output {
  std::string_view option;                ///< As it is called on the command line.
  std::string_view path;                  ///< "-" is standard output; empty if there is none.
  std::optional<FileFormat> format = {};  ///< That its ending must not deny.
};

using Outputs = std::vector<Output>;

/// Says what is wrong if an output is an input, or two outputs are one: by whatever spelling, link
/// or further name, or because standard output goes there; or if standard input is named twice.
/// None if all is well. The only device that counts is standard output: /dev/null may be given
/// twice.
std::optional<std::string> find_clash(std::span<const std::string> inputs, const Outputs& outputs);

/// Says what is wrong if the name of an output ends as files of another format do.
std::optional<std::string> find_foreign_ending(const Outputs& outputs);

/// Throws either as a UsageError.
void refuse_clashes(std::span<const std::string> inputs, const Outputs& outputs);

/// Throws a UsageError if a series, a .pvd file and .vtu files beside it, is to go to standard
/// output, or if one of the other files may be one of it.
void refuse_series(const std::string& series, std::span<const std::string> others);

/// Whether the run's text goes to standard output: none of the outputs goes there, as one that does
/// is all that may be there.
bool leaves_standard_output(const Outputs& outputs);

}  // namespace holdfast::cli
