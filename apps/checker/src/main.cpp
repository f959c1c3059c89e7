// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

#include "holdfast/certificate/certificate.hpp"

/// holdfast-checker CERTIFICATE: reads what `holdfast check --certificate` has written and proves
/// it again. Exit: 0 proved, 2 not proved, 64 wrong usage, 65 not readable.
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

/// The range with all its digits, so that no rounding narrows it.
int show(const certificate::Certificate& made) {
  const certificate::Verification found = certificate::verify(made);
  if (!found.is_proved) {
    std::printf("NOT PROVED  %s\n", found.reason.c_str());
    return 2;
  }
  std::printf("PROVED  the largest load ratio lies between %.17g and %.17g\n", found.ratio_low,
              found.ratio_high);
  std::printf("  %zu modules, %zu connections, %zu facets on the ground; contact %s\n",
              made.modules.size(), found.connection_count, found.facet_count, name(made.law));
  std::printf("  %s\n", found.is_standing ? "the robot stands" : "that it stands is not proved");
  return 0;
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
    std::fputs("usage: holdfast-checker CERTIFICATE\n", stderr);
    return 64;
  }
  try {
    return run(argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "holdfast-checker: %s\n", error.what());
    return 65;
  }
}
