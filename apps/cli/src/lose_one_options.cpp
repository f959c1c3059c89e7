// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "lose_one_options.hpp"

#include <algorithm>

namespace holdfast::cli {
namespace {

constexpr std::array<const char*, plan::kLossKindCount> kPartNames = {"connections", "modules",
                                                                      "feet"};

}  // namespace

void add_lose_one_options(CLI::App& command, LoseOneArguments& arguments) {
  CLI::Option* const lose_one =
      command.add_flag("--lose-one", arguments.is_wanted,
                       "Say what follows if any single connection, module or foot is lost");
  command.add_option("--lose", arguments.parts, "The parts that --lose-one takes away")
      ->type_name("connections,modules,feet")
      ->delimiter(',')
      ->needs(lose_one)
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        return std::ranges::find(kPartNames, text) != kPartNames.end()
                   ? std::string()
                   : fmt::format("expected connections, modules or feet; found '{}'",
                                 io::one_line(text));
      });
  command
      .add_option("--lose-seconds", arguments.seconds_max,
                  "Most time for --lose-one, s; losses that are left are undecided")
      ->check(number_between(0.0, 1e6))
      ->needs(lose_one)
      ->capture_default_str();
}

LoseOneOptions lose_one_options(const LoseOneArguments& arguments, const CheckOptions& check) {
  LoseOneOptions options{.check = check, .seconds_max = arguments.seconds_max};
  for (std::size_t i = 0; i < kPartNames.size() && !arguments.parts.empty(); ++i) {
    options.kinds[i] = std::ranges::find(arguments.parts, kPartNames[i]) != arguments.parts.end();
  }
  return options;
}

int exit_code_of(const plan::LossReport& report) {
  if (!report.fatal.empty()) {
    return kExitUnsafe;
  }
  return report.undecided.empty() ? kExitSafe : kExitUndecided;
}

}  // namespace holdfast::cli
