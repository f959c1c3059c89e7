// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/launcher.hpp"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "holdfast/exit_code.hpp"

namespace holdfast::cluster {
namespace {

/// mpirun itself ends with 1 where it cannot start, and with 128 and a signal's number.
constexpr int kFirstCode = 150;
constexpr int kCodeCount = 75;

/// The environment variable that launch() sets for the ranks that it starts.
constexpr const char* kLaunched = "HOLDFAST_MPI_LAUNCHED";

constexpr std::string_view kOurs = "holdfast-mpi: ";

/// Takes "--ranks N" or "--ranks=N" away. None: it is not there; empty: it has no number.
std::optional<std::string> take_ranks(std::vector<std::string>& arguments) {
  constexpr std::string_view kName = "--ranks";
  const auto found = std::ranges::find_if(arguments, [&](const std::string& argument) {
    return argument == kName || argument.starts_with("--ranks=");
  });
  if (found == arguments.end()) {
    return std::nullopt;
  }
  const bool is_one = found->size() > kName.size();
  const bool is_cut = !is_one && found + 1 == arguments.end();
  std::string number = is_one ? found->substr(kName.size() + 1) : is_cut ? "" : *(found + 1);
  arguments.erase(found, is_one || is_cut ? found + 1 : found + 2);
  return number;
}

[[noreturn]] void become_mpirun(const std::string& ranks,
                                const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"mpirun",        "-n", ranks, "-x", std::string(kLaunched),
                                    "/proc/self/exe"};
  std::array<char, 4096> self{};
  if (const auto size = ::readlink("/proc/self/exe", self.data(), self.size() - 1); size > 0) {
    words.back() = self.data();
  }
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> pointers;
  for (std::string& word : words) {
    pointers.push_back(word.data());
  }
  pointers.push_back(nullptr);
  ::setenv(kLaunched, "1", 1);
  ::execvp(pointers[0], pointers.data());
  fmt::print(stderr, "mpirun cannot be started\n");
  std::fflush(stderr);
  ::_exit(kExitFailure);
}

std::vector<std::string> lines_from(int descriptor) {
  std::vector<std::string> lines;
  FILE* stream = ::fdopen(descriptor, "r");
  char* line = nullptr;
  std::size_t room = 0;
  for (ssize_t size = ::getline(&line, &room, stream); size >= 0;
       size = ::getline(&line, &room, stream)) {
    const std::string_view text(line, static_cast<std::size_t>(size));
    lines.emplace_back(text.substr(0, text.find_last_not_of('\n') + 1));
  }
  std::free(line);
  std::fclose(stream);
  return lines;
}

/// The one line of all that was printed that says why there is no verdict.
std::string cause(const std::vector<std::string>& lines) {
  const auto find = [&](std::string_view part) {
    const auto found = std::ranges::find_if(
        lines, [&](const std::string& line) { return line.find(part) != std::string::npos; });
    return found == lines.end() ? std::string() : *found;
  };
  if (const std::string ours = find("holdfast-mpi: rank "); !ours.empty()) {
    return ours;
  }
  if (!find("not enough slots").empty()) {
    return fmt::format(
        "{}mpirun has not enough slots, one a core; OMPI_MCA_rmaps_base_oversubscribe=1 lets ranks "
        "share cores; no verdict",
        kOurs);
  }
  if (!find("run as root").empty()) {
    return fmt::format(
        "{}mpirun does not run as root unless OMPI_ALLOW_RUN_AS_ROOT=1 and "
        "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 are set; no verdict",
        kOurs);
  }
  for (const std::string_view part : {"exited on signal", "mpirun", "holdfast-mpi: "}) {
    if (const std::string line = find(part); !line.empty()) {
      return line.starts_with(kOurs) ? line : fmt::format("{}{}; no verdict", kOurs, line);
    }
  }
  return fmt::format("{}the ranks ended; no verdict", kOurs);
}

/// Passes on what others than mpirun have said: it sets its own between rules.
void pass_on(const std::vector<std::string>& lines) {
  bool is_mpirun = false;
  for (const std::string& line : lines) {
    const bool is_rule = line.starts_with("-----");
    is_mpirun = is_rule ? !is_mpirun : is_mpirun;
    if (!is_rule && !is_mpirun) {
      fmt::print(stderr, "{}\n", line);
    }
  }
}

int run_mpirun(const std::string& ranks, const std::vector<std::string>& arguments) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    return kExitFailure;
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    ::close(ends[1]);
    become_mpirun(ranks, arguments);
  }
  ::close(ends[1]);
  const std::vector<std::string> lines = lines_from(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
  if (code >= kFirstCode && code < kFirstCode + kCodeCount) {
    pass_on(lines);
    return code - kFirstCode;
  }
  fmt::print(stderr, "{}\n", cause(lines));
  return kExitFailure;
}

}  // namespace

std::optional<int> launch(const std::vector<std::string>& arguments) {
  std::vector<std::string> others = arguments;
  const std::optional<std::string> ranks = take_ranks(others);
  if (!ranks) {
    return std::nullopt;
  }
  int count = 0;
  const auto [end, error] = std::from_chars(ranks->data(), ranks->data() + ranks->size(), count);
  const bool is_twice = take_ranks(others).has_value();
  const bool is_number = error == std::errc() && end == ranks->data() + ranks->size();
  if (!is_number || count < 1 || is_twice) {
    fmt::print(stderr, "{}--ranks {}: expected a number, 1 or more, given once\n", kOurs, *ranks);
    return kExitUsage;
  }
  return run_mpirun(*ranks, others);
}

int rank_exit_code(int code) {
  return std::getenv(kLaunched) == nullptr ? code : kFirstCode + code;
}

}  // namespace holdfast::cluster
