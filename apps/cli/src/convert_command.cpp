// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "commands.hpp"
#include "file_clash.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct ConvertArguments {
  Reading reading;
  std::string from;
  std::string to;
};

/// Notes obstacles of which VisibleSim is shown a corner only.
void note_large_boxes(const io::Document& document, const ConvertArguments& options) {
  const auto count = std::ranges::count_if(document.extension.obstacles, io::is_large_box);
  if (count > 0) {
    const std::string note = fmt::format(
        "of {} VisibleSim is shown the first corner only; holdfast reads {} back",
        host::counted(count, "large obstacle"), count == 1 ? "all of it" : "all of them");
    print_notes({&note, 1}, options.to);
  }
}

/// Returns false, and prints an error, if VisibleSim has no grid for these cells.
bool note_shift(const io::Document& document, const ConvertArguments& options) {
  const auto shift = io::visiblesim_shift(document);
  if (!shift) {
    print_error(shift.error(), options.from);
    return false;
  }
  if (shift.value() != base::Cell{}) {
    const std::string note = fmt::format(
        "all cells and the support level are moved by {}, as VisibleSim knows none below 0; "
        "holdfast takes it back when it reads the file, scenery and targets are not moved",
        model::text(shift.value()));
    print_notes({&note, 1}, options.to);
  }
  return true;
}

int write_binary(const io::Document& document, const ConvertArguments& options) {
  const auto structure = io::make_binary(document);
  if (!structure) {
    return fail(structure.error(), options.from);
  }
  print_notes(io::lost_in_binary(document), options.to);
  const auto error =
      write_file(options.to, [&](std::ostream& out) { io::write_binary(out, structure.value()); });
  return error ? fail(*error, options.to) : 0;
}

/// The format of robots as links and joints that the ending says; none if it says another one.
std::optional<io::RobotDescription> find_description(const std::string& path) {
  return has_ending(path, ".urdf")  ? std::optional(io::RobotDescription::kUrdf)
         : has_ending(path, ".sdf") ? std::optional(io::RobotDescription::kSdf)
                                    : std::nullopt;
}

int write_description(const io::Document& document, const ConvertArguments& options,
                      io::RobotDescription format) {
  const auto structure = make_structure(document);
  if (!structure) {
    return fail(structure.error(), options.from);
  }
  const model::Robot& robot = structure.value().robot;
  const auto text = io::write_robot_description(robot, named(document, options.from).name, format);
  if (!text) {
    return fail(text.error(), options.from);
  }
  print_notes(io::lost_in_robot_description(robot), options.to);
  return write_or_complain(options.to, text.value()) ? 0 : kExitBadInput;
}

int run(const ConvertArguments& options) {
  const bool to_json = has_ending(options.to, ".json");
  const bool to_binary = has_ending(options.to, ".holdfast");
  const auto description = find_description(options.to);
  if (!to_json && !to_binary && !description && !has_ending(options.to, ".xml")) {
    throw UsageError(
        fmt::format("{}: the ending says the format: expected .json (holdfast JSON), .xml "
                    "(VisibleSim XML), .holdfast (binary), .urdf or .sdf",
                    io::one_line(options.to)));
  }
  refuse_clashes({&options.from, 1}, {{{"the output", options.to}}});
  const auto read = read_with_notes(options.from, options.reading);
  if (!read) {
    return fail(read.error(), options.from);
  }
  const io::Document& document = read.value().document;
  if (description) {
    return write_description(document, options, *description);
  }
  if (to_binary) {
    return write_binary(document, options);
  }
  if (!to_json && !note_shift(document, options)) {
    return kExitBadInput;
  }
  if (!to_json) {
    note_large_boxes(document, options);
  }
  const auto error =
      write_file(options.to, to_json ? io::write_json(document) : io::write_visiblesim(document));
  return error ? fail(*error, options.to) : 0;
}

/// The formats of other programs, by their endings.
std::string foreign_text() {
  std::string list;
  for (const io::ForeignFormat& format : io::foreign_formats()) {
    list += fmt::format("{}{} ({})", list.empty() ? "" : ", ", format.name, format.endings);
  }
  return fmt::format("All commands read, beside these three: {}. A note says what of it is lost. ",
                     list);
}

}  // namespace

Command add_convert(CLI::App& app) {
  auto options = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Convert a structure between VisibleSim XML, holdfast JSON and binary, or from others");
  add_required(*command, "FROM", options->from,
               "Structure to read, any format; - is standard input");
  add_required(*command, "TO", options->to,
               "File to write; .xml, .json, .holdfast, .urdf or .sdf says the format");
  add_reading(*command, options->reading);
  return {command,
          [options] { return run(*options); },
          {.examples = {{"convert robot.xml robot.json", "from VisibleSim to holdfast JSON"},
                        {"convert robot.json robot.xml", "and back"},
                        {"convert robot.json robot.holdfast", "small and quick to read"},
                        {"convert robot.json robot.urdf", "for simulators of rigid bodies"},
                        {"convert figure.stl figure.json --pitch 40",
                         "fill a mesh with modules of 40 mm"}},
           .notes = foreign_text() +
                    "Modules, steps, parameters, obstacles, loads, colours and all of "
                    "VisibleSim's own attributes are kept; comments and the layout of the text "
                    "are not. A binary structure, .holdfast, has what check needs; a note says "
                    "what it leaves out.",
           .exits = {{0, "the file is written"},
                     {kExitBadInput, "the input cannot be read, or the output not written"}}}};
}

}  // namespace holdfast::cli
