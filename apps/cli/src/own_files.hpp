// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

/// Files that belong to the program, found from where it is, wherever it was installed.
namespace holdfast::cli {

/// The places where a file may be: beside the program, in ../`folder`, where ./dev builds it, and
/// in ../share/holdfast, where it is installed.
std::vector<std::filesystem::path> places_of(std::string_view name, std::string_view folder);

/// The first of the places where there is one.
std::optional<std::filesystem::path> find_file(const std::vector<std::filesystem::path>& places);

}  // namespace holdfast::cli
