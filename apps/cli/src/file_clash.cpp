// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "file_clash.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "commands.hpp"
#include "holdfast/figure_file.hpp"

namespace holdfast::cli {
namespace {

namespace fs = std::filesystem;

/// The identity of a file: its number if it exists, or else its place.
struct Identity {
  bool exists = false;
  bool is_regular = false;
  dev_t device = 0;
  ino_t number = 0;
  fs::path place;

  bool is_file() const { return !exists || is_regular; }
};

Identity identity(const struct stat& status) {
  return {.exists = true,
          .is_regular = S_ISREG(status.st_mode),
          .device = status.st_dev,
          .number = status.st_ino,
          .place = {}};
}

/// Identifies a file by its path, or by the descriptor if the path is "-".
Identity identify(std::string_view path, int descriptor) {
  struct stat status {};

  if (path == "-") {
    return ::fstat(descriptor, &status) == 0 ? identity(status)
                                             : Identity{.exists = true, .place = {}};
  }
  const fs::path target = host::OutputFile::target(path);
  if (::stat(target.c_str(), &status) == 0) {
    return identity(status);
  }
  std::error_code code;
  const fs::path parent = target.has_parent_path() ? target.parent_path() : ".";
  return {.exists = false, .place = fs::weakly_canonical(parent, code) / target.filename()};
}

bool are_one(const Identity& a, const Identity& b) {
  if (a.exists != b.exists) {
    return false;
  }
  return a.exists ? a.device == b.device && a.number == b.number : a.place == b.place;
}

bool is_standard_output(std::string_view path) {
  return path == "-" || host::OutputFile::is_descriptor(host::OutputFile::target(path));
}

struct Entry {
  Output output;
  Identity identity;
  bool is_standard = false;
};

/// Whether a file may be one of the series: STEM_3.vtu or STEM_3_1.vtu beside STEM.pvd.
bool is_in_series(const std::filesystem::path& file, const std::filesystem::path& series) {
  const auto folder = [](const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path).parent_path(),
                                             ignored);
  };
  const std::string name = file.filename().string();
  const std::string begin = series.stem().string() + "_";
  return name.starts_with(begin) && name.ends_with(".vtu") &&
         name.find_first_not_of("0123456789_", begin.size()) == name.size() - 4 &&
         folder(file) == folder(series);
}

bool clash(const Entry& a, const Entry& b) {
  return (a.is_standard && b.is_standard) ||
         (are_one(a.identity, b.identity) && a.identity.is_file());
}

}  // namespace

std::optional<std::string> find_clash(std::span<const std::string> inputs, const Outputs& outputs) {
  std::vector<Entry> entries;
  for (const Output& output : outputs) {
    if (!output.path.empty()) {
      entries.push_back(
          {output, identify(output.path, STDOUT_FILENO), is_standard_output(output.path)});
    }
  }
  if (std::ranges::count(inputs, "-") > 1) {
    return "standard input is named for two files, and can be read for one";
  }
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto& [output, file, is_standard] = entries[i];
    for (const std::string& input : inputs) {
      const Identity read = identify(input, STDIN_FILENO);
      if (read.exists && read.is_regular && are_one(read, file)) {
        return fmt::format("{} {} would overwrite the input {}", output.option, output.path, input);
      }
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (clash(entries[j], entries[i])) {
        return fmt::format("{} {} and {} {} are one file", entries[j].output.option,
                           entries[j].output.path, output.option, output.path);
      }
    }
    const Identity shown = identify("-", STDOUT_FILENO);
    if (!is_standard && shown.is_regular && are_one(shown, file)) {
      return fmt::format("{} {} is also where standard output goes", output.option, output.path);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_foreign_ending(const Outputs& outputs) {
  for (const Output& output : outputs) {
    if (output.format && !is_standard_output(output.path)) {
      auto error = holdfast::find_foreign_ending(*output.format, output.path);
      if (!error && *output.format == FileFormat::kFigure) {
        error = find_figure_fault(output.path);
      }
      if (error) {
        return fmt::format("{} {}: {}", output.option, output.path, error->message);
      }
    }
  }
  return std::nullopt;
}

void refuse_clashes(std::span<const std::string> inputs, const Outputs& outputs) {
  auto fault = find_clash(inputs, outputs);
  if (!fault) {
    fault = find_foreign_ending(outputs);
  }
  if (fault) {
    throw UsageError(io::one_line(*fault));
  }
}

void refuse_series(const std::string& series, std::span<const std::string> others) {
  if (series == "-") {
    throw UsageError("--vtk -: a series is several files; expected a name");
  }
  const auto clashing = std::ranges::find_if(
      others, [&](const std::string& file) { return is_in_series(file, series); });
  if (clashing != others.end()) {
    throw UsageError(fmt::format("--vtk {} may write a file of the name {}", io::one_line(series),
                                 io::one_line(*clashing)));
  }
}

bool leaves_standard_output(const Outputs& outputs) {
  return std::ranges::none_of(outputs,
                              [](const Output& output) { return is_standard_output(output.path); });
}

}  // namespace holdfast::cli
