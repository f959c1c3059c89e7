// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/kept_structures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>

namespace holdfast::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kNameSizeMax = 100;

/// Whether a text can be the name of a file in the working folder, and none of the server's own.
bool is_structure_name(const std::string& name) {
  const auto is_fine = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= kNameSizeMax && std::ranges::all_of(name, is_fine) &&
         name.front() != '.' && name.front() != '-' && !name.starts_with("request-");
}

}  // namespace

WorkFolder::WorkFolder() : before_(fs::current_path()) {
  std::string name = (fs::temp_directory_path() / "holdfast-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw fs::filesystem_error("cannot make a folder for the structures of clients", name,
                               std::error_code(errno, std::generic_category()));
  }
  path_ = name;
  fs::current_path(path_);
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::current_path(before_, ignored);
  fs::remove_all(path_, ignored);
}

base::Result<Json> KeptStructures::load(const std::string& name, const std::string& text) {
  if (!is_structure_name(name)) {
    return base::bad_input(
        "expected a name of at most 100 letters, digits, '.', '_' and '-' that begins with a "
        "letter or digit and not with 'request-'");
  }
  const std::string file = "request-load-" + name;
  if (auto error = write_file(file, text)) {
    return *error;
  }
  auto read = read_structure(file, {});
  auto spec = read ? io::make_spec(read.value().document) : read.error();
  if (!spec) {
    std::error_code ignored;
    fs::remove(file, ignored);
    return spec.error();
  }
  fs::rename(file, name);
  Json answer = {{"name", name},
                 {"modules", spec.value().existing.size() + spec.value().planned.size() +
                                 spec.value().fixed.size()},
                 {"notes", read.value().warnings}};
  kept_[name] = {.spec = std::move(spec).value()};
  return answer;
}

bool KeptStructures::unload(const std::string& name) {
  std::error_code ignored;
  return kept_.erase(name) > 0 && fs::remove(name, ignored);
}

std::vector<std::string> KeptStructures::names() const {
  std::vector<std::string> names;
  for (const auto& [name, kept] : kept_) {
    names.push_back(name);
  }
  return names;
}

base::Result<std::vector<Trial>> KeptStructures::try_cells(const std::string& name,
                                                           std::span<const base::Cell> cells) {
  const auto found = kept_.find(name);
  if (found == kept_.end()) {
    return base::bad_input(fmt::format("no structure '{}' is loaded", io::one_line(name)));
  }
  Kept& kept = found->second;
  if (!kept.trials) {
    const auto robot = model::Robot::create(kept.spec);
    if (!robot) {
      return robot.error();
    }
    const std::size_t count = robot.value().modules().size();
    if (count > kTriedModulesMax) {
      return base::bad_input(fmt::format("try takes at most {} modules, found {}; next takes any",
                                         kTriedModulesMax, count));
    }
    CheckOptions options;
    options.thread_count = 1;
    kept.trials = std::make_unique<CellTrials>(kept.spec, Role::kPlanned, options);
  }
  return kept.trials->at(cells);
}

}  // namespace holdfast::cli
