// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
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
constexpr const char* kHelp =
    "\n"
    "Reads what 'holdfast check --certificate FILE' has written and proves it again, in integers "
    "and\n"
    "without the code that solved it: that the largest load ratio lies in the range shown, and "
    "that\n"
    "the robot stands.\n"
    "Exit: 0 proved that it holds, 1 proved that a connection breaks, 2 proved, but neither of\n"
    "both, 3 not proved, 64 wrong usage, 65 not readable.\n";

constexpr int kExitHolds = 0;
constexpr int kExitBreaks = 1;
constexpr int kExitOpen = 2;
constexpr int kExitNotProved = 3;

/// What is proved of the robot, in words and as the exit code.
struct Verdict {
  const char* text;
  int code;
};

Verdict verdict_of(const certificate::Verification& found) {
  if (found.ratio_low >= 1) {
    return {"OVERLOAD: a connection breaks", kExitBreaks};
  }
  if (found.ratio_high >= 1) {
    return {"whether a connection breaks is open: the range has 1 in it", kExitOpen};
  }
  if (!found.is_standing) {
    return {"no connection breaks; that the robot stands is not proved", kExitOpen};
  }
  return {"SAFE: no connection breaks, and the robot stands", kExitHolds};
}

/// Under which assumption all this holds; empty if there is none.
const char* caveat(certificate::Law law) {
  switch (law) {
    case certificate::Law::kRegularised:
      return "for one solution of the paper's contact law, which may have others";
    case certificate::Law::kBonded:
      return "for supports that can neither lift nor tilt: where a robot only rests on them, it "
             "may topple all the same";
    case certificate::Law::kUnilateral:
      break;
  }
  return "";
}

/// The range with all its digits, so that no rounding narrows it.
int show(const certificate::Certificate& made) {
  const certificate::Verification found = certificate::verify(made);
  if (!found.is_proved) {
    std::printf("NOT PROVED  %s\n", found.reason.c_str());
    return kExitNotProved;
  }
  std::printf("PROVED  the largest load ratio lies between %.17g and %.17g\n", found.ratio_low,
              found.ratio_high);
  std::printf("  %zu modules, %zu connections, %zu facets on the ground; contact %s\n",
              made.modules.size(), found.connection_count, found.facet_count, name(made.law));
  const Verdict verdict = verdict_of(found);
  std::printf("  %s\n", verdict.text);
  if (*caveat(made.law) != '\0') {
    std::printf("  %s\n", caveat(made.law));
  }
  return verdict.code;
}

int run(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    std::fprintf(stderr, "holdfast-checker: %s: not readable\n", path);
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
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "holdfast-checker: %s\n", error.what());
    return 65;
  }
}
