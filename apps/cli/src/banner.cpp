// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "commands.hpp"

namespace holdfast::cli {
namespace {

bool has_colour() { return isatty(STDOUT_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr; }

/// Whether what goes to standard error is seen, or kept, where standard output is.
bool is_one_output() {
  struct stat out {};

  struct stat error {};

  return ::fstat(STDOUT_FILENO, &out) == 0 && ::fstat(STDERR_FILENO, &error) == 0 &&
         out.st_dev == error.st_dev && out.st_ino == error.st_ino;
}

}  // namespace

TextOptions text_options() { return {.has_notes = !is_one_output()}; }

std::string banner(verdict::Verdict verdict) {
  std::string word = verdict::name(verdict);
  for (char& letter : word) {
    letter = static_cast<char>(letter - 'a' + 'A');
  }
  word = fmt::format("{:<9}", word);
  if (!has_colour()) {
    return word;
  }
  constexpr std::array<int, 4> kColours = {32, 31, 35, 33};  // green, red, purple, yellow
  return fmt::format("\033[1;{}m{}\033[0m", kColours[static_cast<std::size_t>(verdict)], word);
}

}  // namespace holdfast::cli
