// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

#include "commands.hpp"
#include "reading.hpp"

namespace holdfast::cli {
namespace {

struct RobotsArguments {
  const CLI::App* command = nullptr;
  std::string name;
  std::string json;
};

std::string value_text(const std::optional<double>& value) {
  return value ? fmt::format("{}", *value) : "-";
}

/// The smaller of the two strengths; they are known together or not at all.
std::optional<double> strength(const model::CatalogueRobot& robot) {
  const auto vertical = robot.value("strength_vertical_n");
  const auto lateral = robot.value("strength_lateral_n");
  return vertical && lateral ? std::optional(std::min(*vertical, *lateral)) : std::nullopt;
}

void print_list() {
  fmt::print("{:<15}{:<23}{:<14}{:>8}{:>9}{:>12}\n", "NAME", "ROBOT", "LATTICE", "PITCH/MM",
             "MASS/KG", "STRENGTH/N");
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    fmt::print("{:<15}{:<23}{:<14}{:>8}{:>9}{:>12}\n", robot.name, robot.title,
               io::lattice_name(robot.lattice), value_text(robot.value("pitch_mm")),
               value_text(robot.value("mass_kg")), value_text(strength(robot)));
  }
  fmt::print("- was not found: a structure that names the robot must say it.\n");
}

void print_robot(const model::CatalogueRobot& robot) {
  fmt::print("{} ({}), {}\n", robot.title, robot.name, io::lattice_name(robot.lattice));
  if (!robot.note.empty()) {
    fmt::print("{}\n", robot.note);
  }
  for (const model::RobotFigure& figure : robot.figures) {
    fmt::print("  {:<20}{:>9}  {}: {}\n", figure.key, value_text(figure.value),
               model::name(figure.certainty), figure.source);
  }
}

void write_robot(io::JsonStream& json, const model::CatalogueRobot& robot) {
  json.begin_object();
  json.member("name", robot.name);
  json.member("title", robot.title);
  json.member("lattice", io::lattice_name(robot.lattice));
  json.member("note", robot.note);
  json.key("figures");
  json.begin_array();
  for (const model::RobotFigure& figure : robot.figures) {
    json.begin_object();
    json.member("key", figure.key);
    json.member("value", figure.value);
    json.member("certainty", model::name(figure.certainty));
    json.member("source", figure.source);
    json.end_object();
  }
  json.end_array();
  json.end_object();
}

/// The report of one robot, or of all.
std::string report(const RobotsArguments& options, const model::CatalogueRobot* only) {
  std::string text;
  io::JsonStream json(text);
  json.begin_object();
  io::write_report_head(json, {.command = "robots",
                               .origin = {.file = {}, .options = given_options(*options.command)}});
  json.key("robots");
  json.begin_array();
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    if (only == nullptr || &robot == only) {
      write_robot(json, robot);
    }
  }
  json.end_array();
  json.end_object();
  return text + "\n";
}

int run(const RobotsArguments& options) {
  const model::CatalogueRobot* const robot =
      options.name.empty() ? nullptr : model::find_robot(options.name);
  if (!options.json.empty()) {
    return write_or_complain(options.json, report(options, robot)) ? kExitSafe : kExitBadInput;
  }
  if (robot == nullptr) {
    print_list();
  } else {
    print_robot(*robot);
  }
  return kExitSafe;
}

}  // namespace

Command add_robots(CLI::App& app) {
  auto options = std::make_shared<RobotsArguments>();
  CLI::App* command = app.add_subcommand(
      "robots", "List robots that have been built, with what is known of them and from where");
  options->command = command;
  command->add_option("NAME", options->name, "Show one of them, with every figure and its source")
      ->type_name("")
      ->check(robot_name_fault);
  add_output(*command, "--json", options->json,
             "Write all figures and sources as JSON; - is standard output");
  return {
      command,
      [options] { return run(*options); },
      {.examples = {{"robots", "which robots are known?"},
                    {"robots blinky-blocks", "one of them, with its sources"}},
       .notes = "A structure takes the figures of one of them by \"robot\": NAME, or by "
                "holdfast check --robot NAME.",
       .exits = {{0, "the robots are shown"}, {kExitBadInput, "the output cannot be written"}}}};
}

}  // namespace holdfast::cli
