// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "holdfast/certificate/certificate.hpp"

/// The program's texts and exit codes; all else is the room certificate's.
namespace {

namespace certificate = holdfast::certificate;

const char* name(certificate::Law law) {
  switch (law) {
    case certificate::Law::kRegularised:
      return "regularised";
    case certificate::Law::kUnilateral:
      return "unilateral";
    case certificate::Law::kBonded:
      break;
  }
  return "bonded";
}

constexpr const char* kUsage = "usage: holdfast-checker CERTIFICATE\n";
constexpr const char* kHelp = R"(
Reads what 'holdfast check --certificate FILE' has written and proves it again, in integers and
without the code that solved it: that the largest load ratio lies in the range shown, and that
the robot stands. The digest is that of the robot that 'holdfast check FILE --prove' shows.

Examples:
  holdfast check arm.json --certificate arm.txt
  holdfast-checker arm.txt

Options:
  -h, --help     Print this help message and exit
  -V, --version  Print the version and exit

Exit status:
   0  it is proved that the robot holds
   1  it is proved that a connection breaks, or that the robot topples
   2  a range is proved, but neither of both follows from it
   3  the certificate proves nothing
  64  wrong usage
  65  the certificate cannot be read
)";

constexpr int kExitHolds = 0;
constexpr int kExitFails = 1;
constexpr int kExitOpen = 2;
constexpr int kExitNotProved = 3;

/// The verdict that is proved of the robot, in words and as the exit code.
struct Verdict {
  const char* text;
  int code;
};

Verdict verdict_of(const certificate::Verification& found) {
  if (found.topples && !found.is_standing) {
    return {"UNSTABLE: it topples, as the centre of mass lies beyond the support polygon",
            kExitFails};
  }
  if (found.ratio_low >= 1) {
    return {"OVERLOAD: a connection breaks", kExitFails};
  }
  if (found.ratio_high >= 1) {
    return {"whether a connection breaks is open: the range has 1 in it", kExitOpen};
  }
  if (!found.is_standing) {
    return {"no connection breaks; that the robot stands is not proved", kExitOpen};
  }
  return {"SAFE: no connection breaks, and the robot stands", kExitHolds};
}

/// The assumption under which all this holds; empty if there is none.
const char* caveat(certificate::Law law, const certificate::Verification& found) {
  switch (law) {
    case certificate::Law::kRegularised:
      return "for one solution of the paper's contact law, which may have others";
    case certificate::Law::kBonded:
      return found.topples ? "for supports that can neither lift nor tilt: it topples if it only "
                             "rests on them"
             : found.facet_count > 0
                 ? "for supports that can neither lift nor tilt: where it only rests on them, "
                   "nothing is proved"
                 : "";
    case certificate::Law::kUnilateral:
      break;
  }
  return "";
}

/// Shows which robot the certificate is of.
void show_robot(const certificate::Certificate& made) {
  std::printf("  robot       %s\n  digest      %s\n",
              certificate::robot_words(made.name, made.modules.size(), made.planned_count).c_str(),
              certificate::digest(made).c_str());
}

/// The range with all its digits, so that no rounding narrows it.
int show(const certificate::Certificate& made) {
  const certificate::Verification found = certificate::verify(made);
  if (!found.is_proved) {
    std::printf("NOT PROVED  %s\n", found.reason.c_str());
    show_robot(made);
    return kExitNotProved;
  }
  std::printf("PROVED      the largest load ratio lies between %.17g and %.17g\n", found.ratio_low,
              found.ratio_high);
  const Verdict verdict = verdict_of(found);
  std::printf("  verdict     %s\n", verdict.text);
  const char* const assumption = caveat(made.law, found);
  if (*assumption != '\0') {
    std::printf("              %s\n", assumption);
  }
  show_robot(made);
  std::printf("  contact     %s; %zu connections, %zu facets on the ground\n", name(made.law),
              found.connection_count, found.facet_count);
  return verdict.code;
}

int run(const char* path) {
  if (std::filesystem::is_directory(path)) {
    std::fprintf(stderr, "holdfast-checker: %s: expected a certificate, found a folder\n", path);
    return 65;
  }
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    std::fprintf(stderr, "holdfast-checker: %s: cannot be read: %s\n", path, std::strerror(errno));
    return 65;
  }
  const certificate::Reading reading = certificate::read(text);
  if (!reading.fault.empty()) {
    std::fprintf(stderr, "holdfast-checker: %s: %s\n", path, reading.fault.c_str());
    return 65;
  }
  return show(reading.certificate);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs(kUsage, stderr);
    return 64;
  }
  if (std::strcmp(argv[1], "--help") == 0 || std::strcmp(argv[1], "-h") == 0) {
    std::fputs(kUsage, stdout);
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (std::strcmp(argv[1], "--version") == 0 || std::strcmp(argv[1], "-V") == 0) {
    std::puts("holdfast-checker " HOLDFAST_VERSION);
    return 0;
  }
  if (argv[1][0] == '-') {
    std::fprintf(stderr, "holdfast-checker: there is no option '%s'\n%s", argv[1], kUsage);
    return 64;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "holdfast-checker: %s\n", error.what());
    return 65;
  }
}
