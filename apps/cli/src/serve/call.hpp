// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "holdfast/holdfast.hpp"
#include "serve/json.hpp"
#include "serve/kept_structures.hpp"

/// The commands of the program as methods of the server: a method has the name of its command, and
/// parameters of the names of its arguments and options, with '_' for '-'.
namespace holdfast::cli {

/// The commands that the server offers.
inline constexpr const char* kServedCommands[] = {"check", "next",     "steps",    "order",
                                                  "move",  "simulate", "generate", "robots"};

/// What a parameter of a method is.
enum class ParameterKind : std::uint8_t {
  kStructure,  ///< A JSON value that is a structure, its text, or the name of a loaded one.
  kFlag,
  kValue,
  kList,    ///< One value or more.
  kOutput,  ///< A file that the command writes: true, or the ending that it is to have.
};

/// A parameter as the command line has it.
struct Parameter {
  std::string name;
  ParameterKind kind = ParameterKind::kValue;
  const CLI::Option* option = nullptr;

  bool is_positional() const { return option->get_positional(); }
};

/// The parameters of a command, positional ones first and in their order. Without those of no use
/// to a client: --help, --quiet, --json, and outputs that consist of several files.
std::vector<Parameter> parameters_of(const CLI::App& command);

/// A file that a call writes.
struct CallOutput {
  std::string name;  ///< The parameter's.
  std::string file;
};

/// A run of a command, ready to begin.
struct Call {
  std::string method;
  std::vector<std::string> arguments;  ///< Behind the name of the program.
  std::vector<std::string> inputs;     ///< Files that were written for this call alone.
  std::vector<CallOutput> outputs;
  std::string report;  ///< The file of the JSON report; empty where the command has none.
};

/// Makes the arguments of a command of the parameters of a request, and writes the structures that
/// stand in them to files. `number` makes the files' names unique. Errors: parameters that are
/// unknown, missing or of the wrong kind; a command's own checks come when it runs.
base::Result<Call> make_call(const CLI::App& command, const Json& parameters,
                             const KeptStructures& kept, std::uint64_t number);

/// Removes the files of a call.
void remove_files(const Call& call);

/// The JSON Schema of a method's parameters.
Json schema_of(const CLI::App& command);

}  // namespace holdfast::cli
