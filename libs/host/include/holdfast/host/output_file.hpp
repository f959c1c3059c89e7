// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <ostream>

#include "holdfast/base/result.hpp"

/// Files that are written whole or not at all.
namespace holdfast::host {

/// A file while it is written. What goes into it stands in a temporary file of a random name in the
/// folder of the target, which nobody else can have opened, until finish() puts it in the target's
/// place. A target that exists keeps its permission bits; of a symbolic link the destination is
/// replaced, and the link stays. Written directly are standard output, devices, pipes, and a file
/// that has further names (hard links), as they cannot be replaced.
class OutputFile {
 public:
  /// Opens a file to write; "-" is standard output, whose text so far goes out first. Errors: a
  /// folder, a target that may not be written, a folder that takes no file.
  static base::Result<OutputFile> open(const std::filesystem::path& path);

  /// The file that text for this path ends up in: the end of a chain of symbolic links, whether it
  /// exists or not. A link to an open descriptor, such as /dev/stdout, is an end.
  static std::filesystem::path target(const std::filesystem::path& path);

  /// Whether a target is an open descriptor of this process, such as /proc/self/fd/1.
  static bool is_descriptor(const std::filesystem::path& target);

  /// Makes SIGHUP, SIGINT, SIGPIPE, SIGQUIT, SIGTERM, SIGXCPU and SIGXFSZ remove unfinished files
  /// before they end the process; those that are ignored stay so. For programs, not for libraries.
  static void remove_unfinished_on_signals();

  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Removes the temporary file where finish() was not called; what went out directly stays.
  ~OutputFile();

  /// Takes the text; its failures show in finish() at the latest. Can be sought in (tellp, seekp)
  /// if a file of our own stands behind it; of what is written directly only a file with several
  /// names can. Places count from the beginning. After a move that cannot be made the stream takes
  /// nothing more, and finish() fails.
  std::ostream& stream();

  /// Writes what is left and puts the file in its place. Called once. Errors: a full disk, a closed
  /// output and the like; the target is then as it was.
  [[nodiscard]] std::optional<base::Error> finish();

 private:
  class Writer;

  explicit OutputFile(std::unique_ptr<Writer> writer);

  std::unique_ptr<Writer> writer_;
};

}  // namespace holdfast::host
