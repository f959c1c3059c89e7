// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reading.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace holdfast::cli {
namespace {

bool is_given(const CLI::Option& option) {
  return option.count() > 0 && !option.get_lnames().empty() && option.get_group() != kOutputs &&
         !(option.results().size() == 1 && option.results().front() == option.get_default_str());
}

base::Result<io::VoxelPalette> palette_of(const std::string& file) {
  const auto text = read_file(file);
  return text ? io::read_palette(text.value()) : text.error();
}

void add_palette(CLI::App& command, io::ReadOptions& options) {
  command
      .add_option_function<std::string>(
          "--palette",
          [&options](const std::string& file) { options.palette = palette_of(file).value(); },
          "The kinds of modules that voxels (.vox) are by their colour, from a file")
      ->type_name("FILE")
      ->check([](const std::string& file) {
        const auto found = palette_of(file);
        return found ? std::string()
                     : fmt::format("{}: {}{}", file,
                                   found.error().where.empty() ? "" : found.error().where + ": ",
                                   found.error().message);
      });
}

}  // namespace

io::ReportOrigin Reading::origin(const std::string& file) const {
  return {.file = file, .options = given_options(*command)};
}

std::vector<io::GivenOption> given_options(const CLI::App& command) {
  std::vector<io::GivenOption> given;
  for (const CLI::Option* option : command.get_options()) {
    if (is_given(*option)) {
      const bool is_flag = option->get_items_expected_max() == 0;
      given.push_back({.name = option->get_lnames().front(),
                       .values = is_flag ? std::vector<std::string>() : option->results(),
                       .is_list = option->get_items_expected_max() > 1});
    }
  }
  return given;
}

void add_reading(CLI::App& command, Reading& reading) {
  reading.command = &command;
  io::ReadOptions& options = reading;
  command
      .add_option("--robot", options.robot,
                  "Robot to assume if the file names none; holdfast robots lists them")
      ->type_name("NAME")
      ->check(robot_name_fault);
  command
      .add_option_function<std::string>(
          "--lattice",
          [&options](const std::string& name) { options.lattice = io::find_lattice(name).value(); },
          "Lattice to assume if the file names none, as VisibleSim's: cubic, face-centred, "
          "hexagonal, hexagonal-prism, or VisibleSim's name of the modules, such as catoms3D")
      ->type_name("NAME")
      ->check([](const std::string& name) {
        const auto found = io::find_lattice(name);
        return found ? std::string() : found.error().message;
      });
  command
      .add_option_function<std::vector<std::string>>(
          "--set",
          [&options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              options.settings.push_back(io::find_setting(text).value());
            }
          },
          "Give a number of the material another value than the file does, such as "
          "strength_lateral_n=12")
      ->type_name("KEY=NUMBER")
      ->allow_extra_args(false)
      ->check([](const std::string& text) {
        const auto found = io::find_setting(text);
        return found ? std::string() : found.error().message;
      });
  command
      .add_option_function<std::string>(
          "--support-z",
          [&options](const std::string& text) {
            options.support = io::find_support_level(text).value();
          },
          "Let the modules of this layer rest on the ground, whatever the file says: its z, or "
          "lowest")
      ->type_name("Z")
      ->check([](const std::string& text) {
        const auto found = io::find_support_level(text);
        return found ? std::string() : found.error().message;
      });
  command
      .add_option_function<double>(
          "--pitch", [&options](double pitch) { options.mesh_pitch = pitch; },
          "Edge of a module in the unit of a mesh (.stl, .obj) that is filled with modules")
      ->type_name("LENGTH")
      ->check(number_between(1e-9, 1e9));
  add_palette(command, options);
  command.add_flag(
      "--allow-unknown", options.allow_unknown,
      "Ignore keys of holdfast JSON that are unknown, with a note; without it they are "
      "errors");
}

base::Result<io::ReadDocument> read_with_notes(const std::string& file, const Reading& reading) {
  auto read = read_structure(file, reading);
  if (read) {
    print_notes(read.value().warnings, file);
  }
  return read;
}

base::Result<Structure> load_with_notes(const std::string& file, const Reading& reading,
                                        int thread_count) {
  auto loaded = load_file(file, thread_count, reading);
  if (!loaded) {
    return loaded;
  }
  Structure structure = std::move(loaded).value();
  structure.origin = reading.origin(file);
  print_notes(structure.warnings, file);
  return structure;
}

base::Result<StepsFile> load_steps_with_notes(const std::string& file, const Reading& reading) {
  auto loaded = load_steps(file, reading);
  if (!loaded) {
    return loaded;
  }
  StepsFile steps = std::move(loaded).value();
  steps.origin = reading.origin(file);
  print_notes(steps.warnings, file);
  return steps;
}

}  // namespace holdfast::cli
