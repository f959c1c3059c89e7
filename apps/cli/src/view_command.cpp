// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "file_clash.hpp"
#include "page.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct ViewArguments {
  Reading reading;
  std::string file;
  std::string out;
  bool stays_closed = false;
};

/// A path for a file that the user looks at, or saves, in a folder of its own that only the user
/// may enter.
base::Result<std::string> temporary_path(const std::string& name) {
  std::string safe;
  for (const char letter : name) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-';
    safe += is_plain ? letter : '_';
  }
  std::error_code code;
  std::string folder = (std::filesystem::temp_directory_path(code) / "holdfast-XXXXXX").string();
  if (code || mkdtemp(folder.data()) == nullptr) {
    return base::Error{
        .code = base::ErrorCode::kUnwritable,
        .message = "no folder can be made there; --out FILE says where the page goes"};
  }
  return folder + "/" + safe.substr(0, 80) + ".html";
}

/// Writes the page, prints its name and opens it; to standard output the page alone goes.
int show(const std::string& page, const std::string& out, bool stays_closed) {
  if (const auto error = write_file(out, page)) {
    return fail(*error, out);
  }
  if (out == "-") {
    return 0;
  }
  fmt::print("{}\n", out);
  if (!stays_closed && !open_in_browser(out)) {
    fmt::print(stderr, "holdfast: no browser was found to open it\n");
  }
  return 0;
}

int run(const ViewArguments& options) {
  refuse_clashes({&options.file, 1}, {{{"--out", options.out, FileFormat::kHtml}}});
  const auto structure = load_with_notes(options.file, options.reading);
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
  const auto out = options.out.empty() ? temporary_path(structure.value().name)
                                       : base::Result<std::string>(options.out);
  if (!out) {
    return fail(out.error(), "the folder for temporary files");
  }
  return show(filled.value(), out.value(), options.stays_closed);
}

}  // namespace

Command add_view(CLI::App& app) {
  auto options = std::make_shared<ViewArguments>();
  CLI::App* command =
      app.add_subcommand("view", "Open a structure in the browser, to look at and to change");
  add_required(*command, "FILE", options->file, kStructureHelp);
  add_reading(*command, options->reading);
  add_output(*command, "--out", options->out,
             "Write the page there, not into a temporary file; - is standard output");
  command->add_flag("--no-open", options->stays_closed, "Write the page only");
  return {command,
          [options] { return run(*options); },
          {.examples = {{"view arm.json", "open it in the browser"},
                        {"view arm.json --out arm.html", "keep the page, to send it"}},
           .notes = "Writes one HTML file that needs neither a server nor a network, prints its "
                    "name and opens it. With --out - the page goes to standard output, and "
                    "nothing is opened.",
           .exits = {{0, "the page is written"},
                     {kExitBadInput, "the input cannot be read, or the page not written"}}}};
}

}  // namespace holdfast::cli
