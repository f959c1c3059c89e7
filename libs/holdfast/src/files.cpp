// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "holdfast/holdfast.hpp"

namespace holdfast {
namespace {

namespace fs = std::filesystem;

base::Error unreadable(std::string message) {
  return {.code = base::ErrorCode::kUnreadable, .message = std::move(message)};
}

base::Error unwritable(std::string message) {
  return {.code = base::ErrorCode::kUnwritable, .message = std::move(message)};
}

/// Reads to the end or one byte beyond the limit.
base::Result<std::string> read_stream(std::istream& stream) {
  std::string text;
  char buffer[1U << 16U];
  while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0) {
    text.append(buffer, static_cast<std::size_t>(stream.gcount()));
    if (text.size() > io::kFileBytesMax) {
      return unreadable("larger than " + std::to_string(io::kFileBytesMax) +
                        " bytes, the most that is read");
    }
  }
  if (stream.bad()) {
    return unreadable("reading failed half way");
  }
  return text;
}

}  // namespace

base::Result<std::string> read_file(const fs::path& path) {
  if (path == "-") {
    return read_stream(std::cin);
  }
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) {
    return unreadable("no such file");
  }
  if (fs::is_directory(status)) {
    return unreadable("is a folder, expected is a file of VisibleSim XML or holdfast JSON");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return unreadable("cannot be opened for reading");
  }
  return read_stream(stream);
}

std::optional<base::Error> write_file(const fs::path& path, std::string_view text) {
  std::error_code code;
  if (fs::is_directory(path, code)) {
    return unwritable("is a folder, expected is the name of a file to write");
  }
  // A device or pipe cannot be renamed onto.
  const bool is_special = fs::exists(path, code) && !fs::is_regular_file(path, code);
  fs::path target = path;
  if (!is_special) {
    target += ".part";
  }
  {
    std::ofstream stream(target, std::ios::binary | std::ios::trunc);
    stream.write(text.data(), static_cast<std::streamsize>(text.size()));
    stream.close();
    if (!stream) {
      if (!is_special) {
        fs::remove(target, code);
      }
      return unwritable("cannot be written");
    }
  }
  if (!is_special) {
    fs::rename(target, path, code);
    if (code) {
      fs::remove(target, code);
      return unwritable("cannot be written");
    }
  }
  return std::nullopt;
}

}  // namespace holdfast
