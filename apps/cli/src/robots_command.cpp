// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "commands.hpp"

namespace holdfast::cli {
namespace {

using Json = nlohmann::ordered_json;

struct RobotsArguments {
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

Json robot_json(const model::CatalogueRobot& robot) {
  Json figures = Json::array();
  for (const model::RobotFigure& figure : robot.figures) {
    figures.push_back({{"key", figure.key},
                       {"value", figure.value ? Json(*figure.value) : Json()},
                       {"certainty", model::name(figure.certainty)},
                       {"source", figure.source}});
  }
  return {{"name", robot.name},
          {"title", robot.title},
          {"lattice", io::lattice_name(robot.lattice)},
          {"note", robot.note},
          {"figures", figures}};
}

Json list_json() {
  Json list = Json::array();
  for (const model::CatalogueRobot& robot : model::robot_catalogue()) {
    list.push_back(robot_json(robot));
  }
  return list;
}

int run(const RobotsArguments& options) {
  const model::CatalogueRobot* const robot =
      options.name.empty() ? nullptr : model::find_robot(options.name);
  if (!options.json.empty()) {
    const Json json = robot == nullptr ? list_json() : robot_json(*robot);
    return write_or_complain(options.json, json.dump(2) + "\n") ? kExitSafe : kExitBadInput;
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
  command->add_option("NAME", options->name, "Show one of them, with every figure and its source")
      ->type_name("")
      ->check(robot_name_fault);
  command
      ->add_option("--json", options->json,
                   "Write all figures and sources as JSON; - is standard output")
      ->type_name("FILE");
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
