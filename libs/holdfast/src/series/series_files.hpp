// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"

/// The files of a series for ParaView.
namespace holdfast {

/// STEM.pvd and, beside it, STEM_0.vtu and on, or STEM_0_0.vtu where one time has several parts.
class SeriesFiles {
 public:
  explicit SeriesFiles(std::filesystem::path path) : path_(std::move(path)) {}

  /// Says if the name cannot be written into the .pvd file.
  std::optional<base::Error> find_fault() const {
    const std::string name = path_.stem().string();
    if (io::one_line(name) == name) {
      return std::nullopt;
    }
    return base::Error{.code = base::ErrorCode::kBadInput,
                       .message =
                           "names of .vtu files are written into the .pvd file, expected "
                           "UTF-8 without control characters",
                       .where = {}};
  }

  /// Writes the .vtu file of a part of a time.
  std::optional<base::Error> add(std::size_t time, std::size_t part, std::size_t part_count,
                                 const std::function<void(std::ostream&)>& write) {
    std::string name = path_.stem().string() + "_" + std::to_string(time);
    name += (part_count > 1 ? "_" + std::to_string(part) : "") + ".vtu";
    if (auto error = write_file(path_.parent_path() / name, write)) {
      return error;
    }
    files_.push_back({.time = time, .part = part, .name = std::move(name)});
    return std::nullopt;
  }

  /// Writes the .pvd file.
  std::optional<base::Error> finish() const {
    return write_file(path_, [this](std::ostream& out) { io::write_pvd(out, files_); });
  }

  std::size_t count() const { return files_.size(); }

 private:
  std::filesystem::path path_;
  std::vector<io::SeriesFile> files_;
};

}  // namespace holdfast
