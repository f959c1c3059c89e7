// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <system_error>

#include "holdfast/file_ending.hpp"
#include "holdfast/holdfast.hpp"

namespace holdfast {
namespace {

namespace fs = std::filesystem;

base::Error unreadable(std::string message) {
  return {.code = base::ErrorCode::kUnreadable, .message = std::move(message)};
}

/// Reads to the end, to one byte beyond the limit or, unless it is a binary structure or of another
/// format that has them, to the first zero byte.
base::Result<std::string> read_stream(std::istream& stream, std::string_view ending) {
  std::string text;
  bool is_binary = false;
  char buffer[1U << 16U];
  while (stream.read(buffer, sizeof buffer) || stream.gcount() > 0) {
    const std::string_view block(buffer, static_cast<std::size_t>(stream.gcount()));
    is_binary = is_binary || (text.empty() && (block.starts_with(io::kBinaryMagic) ||
                                               io::may_have_zero_bytes(block, ending)));
    const std::size_t at = is_binary ? std::string_view::npos : block.find('\0');
    if (at != std::string_view::npos) {
      const bool is_utf16 =
          text.empty() && (block.starts_with("\xFF\xFE") || block.starts_with("\xFE\xFF"));
      return unreadable(is_utf16 ? "expected text in UTF-8, found UTF-16: save it as UTF-8"
                                 : "expected holdfast JSON or VisibleSim XML, text in UTF-8, found "
                                   "a zero byte after " +
                                       std::to_string(text.size() + at) + " bytes");
    }
    text += block;
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
    return read_stream(std::cin, "");
  }
  std::error_code code;
  const fs::file_status status = fs::status(path, code);
  if (!fs::exists(status)) {
    return unreadable("no such file");
  }
  if (fs::is_directory(status)) {
    return unreadable("expected a file of VisibleSim XML, holdfast JSON or binary, found a folder");
  }
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return unreadable("cannot be read: " + std::generic_category().message(errno));
  }
  return read_stream(stream, ending_of(path.string()));
}

std::optional<base::Error> write_file(const fs::path& path,
                                      const std::function<void(std::ostream&)>& write) {
  auto opened = host::OutputFile::open(path);
  if (!opened) {
    return opened.error();
  }
  host::OutputFile file = std::move(opened).value();
  write(file.stream());
  return file.finish();
}

std::optional<base::Error> write_file(const fs::path& path, std::string_view text) {
  return write_file(path, [&](std::ostream& out) { out << text; });
}

}  // namespace holdfast
