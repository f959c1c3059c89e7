// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "holdfast/trial.hpp"
#include "serve/json.hpp"

namespace holdfast::cli {

/// A folder for files of this process alone, which goes with the object; while it lives it is the
/// working folder. Throws std::filesystem::filesystem_error if there is no place for it.
class WorkFolder {
 public:
  WorkFolder();
  WorkFolder(const WorkFolder&) = delete;
  WorkFolder& operator=(const WorkFolder&) = delete;
  ~WorkFolder();

 private:
  std::filesystem::path before_;
  std::filesystem::path path_;
};

/// The structures that a client has loaded, each a file in the working folder, by their names.
class KeptStructures {
 public:
  /// Reads a text as the ending of its name asks, or else as what it looks like, and keeps it under
  /// this name, in place of an earlier one. Errors: a name that is none, a text that cannot be
  /// read.
  base::Result<Json> load(const std::string& name, const std::string& text);

  /// Forgets one; false if there is none of this name.
  bool unload(const std::string& name);

  bool has(const std::string& name) const { return kept_.contains(name); }

  std::vector<std::string> names() const;

  /// Judges a kept structure with one more module at each of the cells. What was prepared for one
  /// call serves the next (CellTrials). Errors: a structure that is unknown or makes no robot, or
  /// that has more than kTriedModulesMax modules.
  base::Result<std::vector<Trial>> try_cells(const std::string& name,
                                             std::span<const base::Cell> cells);

  /// The largest robot that try_cells() takes: as it cannot be interrupted it has to be quick.
  static constexpr std::size_t kTriedModulesMax = 5000;

 private:
  struct Kept {
    model::RobotSpec spec;
    std::unique_ptr<CellTrials> trials = {};
  };

  std::map<std::string, Kept> kept_;
};

}  // namespace holdfast::cli
