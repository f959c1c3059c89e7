// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <thread>

#include "commands.hpp"
#include "serve/server.hpp"

namespace holdfast::cli {
namespace {

struct ServeArguments {
  bool is_mcp = false;
  std::size_t job_count = std::max(1U, std::thread::hardware_concurrency());
  RunningCall::Limits limits{.seconds_max = 600};
};

int run(const ServeArguments& options) {
  const WorkFolder folder;
  Program program;
  Server(program, options.is_mcp ? mcp_protocol(program) : json_rpc_protocol(program),
         {.job_count = options.job_count, .limits = options.limits})
      .run();
  return 0;
}

}  // namespace

Command add_serve(CLI::App& app) {
  auto options = std::make_shared<ServeArguments>();
  CLI::App* command = app.add_subcommand(
      "serve", "Answer requests on standard input, for planners in any language and assistants");
  command->add_flag("--mcp", options->is_mcp,
                    "Speak the Model Context Protocol, for assistants, in place of JSON-RPC 2.0");
  command
      ->add_option("--jobs", options->job_count,
                   "Requests that are worked on at the same time; by default one for each core")
      ->check(CLI::Range(1, 64));
  command
      ->add_option("--request-seconds", options->limits.seconds_max,
                   "Most time for a request, s; 0: no limit")
      ->check(number_between(0.0, 1e6))
      ->capture_default_str();
  command
      ->add_option("--request-memory", options->limits.memory_gb,
                   "Most memory for a request, GB; 0: no limit [default: 0]")
      ->check(number_between(0.0, 1e6));
  return {command,
          [options] { return run(*options); },
          {.examples = {{"serve", "JSON-RPC, a request and an answer in a line each"},
                        {"serve --mcp", "as a tool of an assistant"}},
           .notes = "Methods are check, next, steps, order, move, simulate, generate and robots, "
                    "with the options of the commands of these names, and load, unload, loaded, "
                    "try, methods, cancel and shutdown. It ends with its standard input.",
           .exits = {{0, "standard input has ended, or a client asked to end"}}}};
}

}  // namespace holdfast::cli
