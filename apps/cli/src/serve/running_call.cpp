// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/running_call.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

#include "holdfast/holdfast.hpp"

namespace holdfast::cli {
namespace {

constexpr std::string_view kOwn = "holdfast: ";
constexpr std::string_view kNote = "note: ";

struct Pipe {
  int read = -1;
  int write = -1;
};

Pipe make_pipe() {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) {
    throw std::system_error(errno, std::generic_category(), "a request cannot be run");
  }
  return {ends[0], ends[1]};
}

void close_once(int& descriptor) {
  if (descriptor >= 0) {
    ::close(std::exchange(descriptor, -1));
  }
}

/// Signals as a program has them at its start.
void reset_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGPIPE, SIGHUP}) {
    ::signal(signal, SIG_DFL);
  }
}

void limit_memory(double gigabytes) {
  if (gigabytes > 0) {
    const auto bytes = static_cast<rlim_t>(gigabytes * 1e9);
    const rlimit limit = {bytes, bytes};
    ::setrlimit(RLIMIT_AS, &limit);
  }
}

bool is_note(std::string_view line) { return line.find(kNote) != std::string_view::npos; }

/// A report without its layout: line feeds within strings are escaped.
std::string in_one_line(std::string_view report) {
  std::string line;
  bool is_indent = false;
  for (const char c : report) {
    is_indent = c == '\n' || (is_indent && c == ' ');
    if (!is_indent) {
      line += c;
    }
  }
  return line;
}

/// A file of any content, which may be missing.
std::optional<std::string> read_bytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream content;
  content << stream.rdbuf();
  return stream ? std::optional(std::move(content).str()) : std::nullopt;
}

std::string without_name(std::string_view line) {
  return std::string(line.starts_with(kOwn) ? line.substr(kOwn.size()) : line);
}

}  // namespace

RunningCall::RunningCall(Call call, Program& program, const Limits& limits)
    : call_(std::move(call)) {
  Pipe output = make_pipe();
  Pipe errors = make_pipe();
  process_ = ::fork();
  if (process_ == 0) {
    run_as_child(program, output.write, errors.write, limits.memory_gb);
  }
  ::close(output.write);
  ::close(errors.write);
  output_ = output.read;
  errors_ = errors.read;
  if (process_ < 0) {
    close_outputs();
    throw std::system_error(errno, std::generic_category(), "a request cannot be run");
  }
  if (limits.seconds_max > 0) {
    ends_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                               std::chrono::duration<double>(limits.seconds_max));
  }
}

RunningCall::RunningCall(RunningCall&& other) noexcept
    : call_(std::exchange(other.call_, {})),
      process_(std::exchange(other.process_, -1)),
      output_(std::exchange(other.output_, -1)),
      errors_(std::exchange(other.errors_, -1)),
      ends_(other.ends_),
      killed_(other.killed_),
      line_(std::move(other.line_)),
      lines_(std::move(other.lines_)),
      finished_(std::move(other.finished_)) {}

RunningCall::~RunningCall() {
  close_outputs();
  if (process_ > 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  remove_files(call_);
}

void RunningCall::run_as_child(Program& program, int output, int errors, double memory_gb) {
  reset_signals();
  limit_memory(memory_gb);
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(errors, STDERR_FILENO);
  std::vector<std::string> texts = call_.arguments;
  texts.insert(texts.begin(), "holdfast");
  std::vector<char*> arguments;
  std::ranges::transform(texts, std::back_inserter(arguments),
                         [](std::string& text) { return text.data(); });
  arguments.push_back(nullptr);
  ::_exit(run_guarded(program, static_cast<int>(texts.size()), arguments.data()));
}

void RunningCall::close_outputs() {
  close_once(output_);
  close_once(errors_);
}

std::vector<std::string> RunningCall::take(int descriptor) {
  char buffer[1U << 16U];
  const ssize_t size = ::read(descriptor, buffer, sizeof buffer);
  if (size < 0 && errno == EINTR) {
    return {};
  }
  if (size <= 0) {
    close_once(descriptor == output_ ? output_ : errors_);
    return {};
  }
  const std::string_view text(buffer, static_cast<std::size_t>(size));
  if (descriptor == errors_) {
    return take_error_lines(text);
  }
  finished_.text += text;
  return {};
}

std::vector<std::string> RunningCall::take_error_lines(std::string_view text) {
  std::vector<std::string> progress;
  for (const char c : text) {
    if (c != '\n') {
      line_ += c;
      continue;
    }
    if (is_note(line_)) {
      finished_.notes.push_back(without_name(line_));
    } else {
      progress.push_back(without_name(line_));
      lines_.push_back(progress.back());
    }
    line_.clear();
  }
  return progress;
}

void RunningCall::stop(Finished::End reason) {
  if (killed_ == Clock::time_point::max()) {
    finished_.end = reason;
    ::kill(process_, SIGINT);
    killed_ = Clock::now() + std::chrono::seconds(1);
  }
}

void RunningCall::tick() {
  if (Clock::now() >= ends_) {
    stop(Finished::End::kTooLong);
  }
  if (Clock::now() >= killed_) {
    ::kill(process_, SIGKILL);
  }
}

Finished RunningCall::finish() {
  int status = 0;
  while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
  }
  process_ = -1;
  if (WIFEXITED(status)) {
    finished_.exit_code = WEXITSTATUS(status);
  } else if (finished_.end == Finished::End::kByItself) {
    finished_.end = Finished::End::kBySignal;
  }
  if (!line_.empty()) {
    lines_.push_back(without_name(line_));
  }
  for (const std::string& line : lines_) {
    finished_.errors += (finished_.errors.empty() ? "" : "\n") + line;
  }
  if (!call_.report.empty()) {
    if (const auto report = read_bytes(call_.report)) {
      finished_.report = in_one_line(*report);
    }
  }
  for (const CallOutput& output : call_.outputs) {
    if (auto content = read_bytes(output.file)) {
      finished_.outputs.emplace_back(output.name, std::move(*content));
    }
  }
  return std::move(finished_);
}

}  // namespace holdfast::cli
