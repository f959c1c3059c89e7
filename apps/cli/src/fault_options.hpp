// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "faults.hpp"

/// The options that make faults, which `simulate` and `emulate` have in common: each may be given
/// several times.
namespace holdfast::cli {

/// `Fault` is sim::Fault or emulator::Fault.
template <class Fault>
struct FaultOption {
  std::string name;  ///< Without the two dashes.
  typename Fault::Kind kind{};
  bool has_face = false;  ///< Something happens at one face, not to the whole module.
  std::string help;
  std::vector<std::string> texts = {};  ///< As given on the command line.
};

template <class Fault>
void add_fault_options(CLI::App& command, std::vector<FaultOption<Fault>>& options) {
  for (FaultOption<Fault>& option : options) {
    command.add_option("--" + option.name, option.texts, option.help)
        ->type_name(option.has_face ? "X,Y,Z:FACE@T" : "X,Y,Z@T")
        ->allow_extra_args(false);
  }
}

/// Reads the faults. Throws a UsageError if a text is no place of an existing module and time.
/// `ticks` converts times as given into the robot's.
template <class Fault>
std::vector<Fault> read_faults(const std::vector<FaultOption<Fault>>& options,
                               const Structure& structure,
                               const std::function<sim::Time(double time)>& ticks) {
  std::vector<Fault> faults;
  for (const FaultOption<Fault>& option : options) {
    for (const std::string& text : option.texts) {
      const auto place = read_fault_place(text, option.has_face, structure);
      if (!place || place->module < 0) {
        throw UsageError(!place ? fault_usage(option.name, text, option.has_face)
                                : no_module(option.name, text, place->cell));
      }
      faults.push_back({.kind = option.kind,
                        .at = ticks(place->time),
                        .module = place->module,
                        .face = place->face});
    }
  }
  return faults;
}

}  // namespace holdfast::cli
