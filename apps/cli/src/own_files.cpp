// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "own_files.hpp"

#include <algorithm>
#include <system_error>

namespace holdfast::cli {

namespace fs = std::filesystem;

std::vector<fs::path> places_of(std::string_view name, std::string_view folder) {
  std::error_code code;
  const fs::path here = fs::read_symlink("/proc/self/exe", code).parent_path();
  const fs::path above = here / "..";
  return {(here / name).lexically_normal(), (above / folder / name).lexically_normal(),
          (above / "share" / "holdfast" / name).lexically_normal()};
}

std::optional<fs::path> find_file(const std::vector<fs::path>& places) {
  const auto found = std::ranges::find_if(places, [](const fs::path& place) {
    std::error_code code;
    return fs::is_regular_file(place, code);
  });
  return found == places.end() ? std::nullopt : std::optional(*found);
}

}  // namespace holdfast::cli
