// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>

#include "program.hpp"

namespace {

/// Descriptors 0 to 2 are never those of a file: one that is closed is opened so that it cannot be
/// used, and whoever tries gets an error.
void occupy_standard_descriptors() {
  while (true) {
    const int descriptor = ::open("/dev/null", O_RDONLY);
    if (descriptor < 0 || descriptor > STDERR_FILENO) {
      ::close(descriptor);
      return;
    }
    if (descriptor == STDIN_FILENO) {
      ::close(descriptor);
      ::open("/dev/null", O_WRONLY);
    }
  }
}

/// Ends the program as main does after an exception that nobody is left to catch.
[[noreturn]] void terminate_by_exit() {
  if (std::current_exception()) {
    ::_exit(holdfast::cli::report_exception());
  }
  std::abort();
}

}  // namespace

int main(int argc, char** argv) {
  occupy_standard_descriptors();
  std::set_terminate(terminate_by_exit);
  holdfast::host::OutputFile::remove_unfinished_on_signals();
  holdfast::host::use_large_pages();
  try {
    holdfast::cli::Program program;
    return holdfast::cli::run_guarded(program, argc, argv);
  } catch (...) {
    return holdfast::cli::report_exception();
  }
}
