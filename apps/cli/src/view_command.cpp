// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "page.hpp"

namespace holdfast::cli {
namespace {

struct Options {
  std::string file;
  std::string out;
  bool stays_closed = false;
};

int fail(const base::Error& error, const std::string& file) {
  print_error(error, file);
  return kExitBadInput;
}

/// Where nobody minds a file: the user looks at it, or saves it.
std::string temporary_path(const std::string& name) {
  std::string safe;
  for (const char letter : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-';
    safe += is_plain ? letter : '_';
  }
  std::error_code code;
  const auto folder = std::filesystem::temp_directory_path(code);
  return (folder / ("holdfast_" + safe.substr(0, 80) + ".html")).string();
}

int run(const Options& options) {
  const auto structure = load_file(options.file);
  if (!structure) {
    return fail(structure.error(), options.file);
  }
  const auto page = find_page();
  if (!page) {
    return fail(page.error(), "view");
  }
  const auto filled = fill_page(page.value(), structure.value(), std::nullopt);
  if (!filled) {
    return fail(filled.error(), "view");
  }
  const std::string out =
      options.out.empty() ? temporary_path(structure.value().name) : options.out;
  if (const auto error = write_file(out, filled.value())) {
    return fail(*error, out);
  }
  fmt::print("{}\n", out);
  if (!options.stays_closed && !open_in_browser(out)) {
    fmt::print(stderr, "holdfast: no browser was found to open it\n");
  }
  return 0;
}

}  // namespace

Command add_view(CLI::App& app) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("view", "Open a structure in the browser, to look at and to change");
  add_required(*command, "FILE", options->file,
               "Structure, VisibleSim XML or holdfast JSON; - is standard input");
  command->add_option("--out", options->out, "Write the page there, not into a temporary file")
      ->type_name("FILE");
  command->add_flag("--no-open", options->stays_closed, "Write the page only");
  command->footer(
      "Writes one HTML file that needs neither a server nor a network, prints its name, opens it.\n"
      "Exit: 0 written, 64 wrong usage, 65 bad input, no page or not writable.");
  return {command, [options] { return run(*options); }};
}

}  // namespace holdfast::cli
