// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "help.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <regex>
#include <string_view>
#include <utility>

#include "holdfast/holdfast.hpp"

namespace holdfast::cli {
namespace {

/// Where the second column begins, and how wide a text is: as the terminal, within bounds in which
/// it can be read; 80 where there is none.
constexpr std::size_t kSecondColumn = 28;
constexpr std::size_t kWidthMin = 60;
constexpr std::size_t kWidthMax = 100;
constexpr std::size_t kWidthUsual = 80;
constexpr std::size_t kExampleColumnMin = 6;  ///< If all commands are long.
constexpr std::size_t kExampleColumnMax = 44;

std::size_t terminal_width() {
  winsize size{};
  if (::isatty(STDOUT_FILENO) == 0 || ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0) {
    return kWidthUsual;
  }
  return std::clamp<std::size_t>(size.ws_col, kWidthMin, kWidthMax);
}

/// A text in lines that end before the terminal does. The first one begins in column `used`, the
/// others after `indent` blanks.
std::string wrapped(std::string_view text, std::size_t indent, std::size_t used) {
  const std::size_t width = terminal_width();
  std::string out;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    text.remove_prefix(std::min(word.size() + 1, text.size()));
    if (used + word.size() >= width && used > indent) {
      out += '\n' + std::string(indent, ' ');
      used = indent;
    } else if (!out.empty()) {
      out += ' ';
      ++used;
    }
    out += word;
    used += word.size();
  }
  return out + '\n';
}

/// A line of a list: what is explained, and in the second column the explanation.
std::string entry(const std::string& head, std::string_view text) {
  std::string out = "  " + head;
  if (out.size() + 2 > kSecondColumn) {
    out += '\n' + std::string(kSecondColumn, ' ');
  } else {
    out.resize(kSecondColumn, ' ');
  }
  return out + wrapped(text, kSecondColumn, kSecondColumn);
}

/// Paragraphs; those whose lines are indented are lists that stand as they are.
std::string paragraphs(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t end = text.find("\n\n");
    const std::string_view paragraph = text.substr(0, end);
    const bool is_list = paragraph.find("\n  ") != std::string_view::npos;
    out += '\n' + (is_list ? std::string(paragraph) + '\n' : wrapped(paragraph, 0, 0));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 2);
  }
  return out;
}

/// What an example does stands beside it, or below it if it is too long for that.
std::string list_of(const std::vector<Example>& examples) {
  std::size_t column = kExampleColumnMin;
  for (const Example& example : examples) {
    const std::size_t end = example.command.size() + std::size("  holdfast   ");
    column = end <= kExampleColumnMax ? std::max(column, end) : column;
  }
  std::string out;
  for (const auto& [command, what] : examples) {
    const std::string line = fmt::format("  holdfast {}", command);
    out += line.size() + 2 <= column
               ? fmt::format("{:<{}}{}", line, column, wrapped(what, column, column))
               : fmt::format("{}\n{:{}}{}", line, "", column, wrapped(what, column, column));
  }
  return out.empty() ? out : "\nExamples:\n" + out;
}

std::string list_of(const std::vector<ExitCode>& codes) {
  std::string out = "\nExit status:\n";
  for (const auto& [code, meaning] : codes) {
    out += fmt::format("  {:>2}  ", code) + wrapped(meaning, 6, 6);
  }
  return out;
}

/// The name of an option's value, without what CLI11 says of its checks.
std::string value_name(const CLI::Option& option) {
  std::string name = option.get_type_name();
  for (const std::string_view mark : {":INT", ":FLOAT", ":UINT", ":{", ":NUMBER"}) {
    name = name.substr(0, name.find(mark));
  }
  return name == "INT" || name == "FLOAT" || name == "UINT" ? "N" : name;
}

std::string head_of(const CLI::Option& option, bool is_positional) {
  if (is_positional) {
    const bool is_list = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
    return option.get_name(true, false) + (is_list ? " ..." : "");
  }
  std::string head = std::regex_replace(option.get_name(false, true), std::regex(","), ", ");
  if (option.get_type_size() != 0 && !value_name(option).empty()) {
    head += ' ' + value_name(option);
    head += option.get_expected_max() >= CLI::detail::expected_max_vector_size ? " ..." : "";
  }
  return head;
}

std::string text_of(const CLI::Option& option) {
  std::string text = option.get_description();
  if (option.get_type_size() != 0 && !option.get_default_str().empty()) {
    text += fmt::format(" [default: {}]", option.get_default_str());
  }
  std::string others;
  for (const CLI::Option* other : option.get_excludes()) {
    others += (others.empty() ? "" : ", ") + other->get_name();
  }
  return others.empty() ? text : fmt::format("{} [not with {}]", text, others);
}

std::string options_of(const CLI::App& app, const HelpFormatter& formatter, bool is_positional) {
  std::string out;
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional() == is_positional && !option->get_group().empty()) {
      out += formatter.make_option(option, is_positional);
    }
  }
  return out.empty() ? out : (is_positional ? "\nArguments:\n" : "\nOptions:\n") + out;
}

/// The command that was asked, or the program.
const CLI::App& asked(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : *parsed.front();
}

std::string full_name(const CLI::App& command) {
  return command.get_parent() == nullptr
             ? command.get_name()
             : command.get_parent()->get_name() + ' ' + command.get_name();
}

std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::vector<std::string_view> names(known.begin(), known.end());
  const auto near = io::near_miss(name, names);
  return near ? "; " + io::did_you_mean(*near) : std::string();
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) {
      names.push_back("--" + name);
    }
  }
  return names;
}

/// What does that for which other programs have this option; empty if nothing does.
std::string other_option(std::string_view name, const std::vector<std::string>& known) {
  const auto has = [&](const char* option) { return std::ranges::count(known, option) > 0; };
  if ((name == "--png" || name == "--pdf") && has("--svg")) {
    return fmt::format("; --svg FILE.{} writes one", name.substr(2));
  }
  return name == "-o" && has("--json") ? "; the file's format is an option: --json FILE" : "";
}

bool judges_many(const CLI::App& command) {
  constexpr std::array<std::string_view, 4> kNames = {"move", "next", "order", "steps"};
  return std::ranges::find(kNames, command.get_name()) != kNames.end();
}

/// What is said of an option that a command does not have; empty if it has all that are given.
std::string unknown_option(const CLI::App& command) {
  for (const std::string& argument : command.remaining()) {
    if (argument == "--") {
      break;  // What follows are no options.
    }
    if (argument.size() > 1 && argument.starts_with('-')) {
      const std::string name = argument.substr(0, argument.find('='));
      if (name == "--deformed" && judges_many(command)) {
        return fmt::format(
            "{} cannot take --deformed: it judges states by linear theory, and calls none safe for "
            "which that does not suffice; holdfast check --deformed judges one robot",
            command.get_name());
      }
      const std::vector<std::string> known = option_names(command);
      const std::string near = did_you_mean(name, known);
      return fmt::format("there is no option '{}'{}", io::one_line(name),
                         near.empty() ? other_option(name, known) : near);
    }
  }
  return "";
}

std::string one_too_many(const CLI::App& command) {
  const auto rest = command.remaining();
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional()) {
      names.push_back(option->get_name(true, false));
    }
  }
  return fmt::format("the argument '{}' is one too many, expected {}",
                     rest.empty() ? "" : io::one_line(rest.front()), fmt::join(names, " and "));
}

/// "a, b or c" of "a,b,c".
std::string choice(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  }
  return text;
}

/// CLI11's words for what it found, in ours.
std::string reworded(const std::string& text) {
  std::smatch found;
  if (std::regex_match(text, found, std::regex("(.*): (.*) not in \\{(.*)\\}"))) {
    const std::vector<std::string> words = CLI::detail::split(found.str(3), ',');
    return fmt::format("{}: expected {}, found '{}'{}", found.str(1), choice(words),
                       io::one_line(found.str(2)), did_you_mean(found.str(2), words));
  }
  if (std::regex_match(text, found, std::regex("(.*): Value (.*) not in range (.*) to (.*)"))) {
    const bool is_whole = found.str(3).find('.') == std::string::npos;
    return fmt::format("{}: expected a {}number from {} to {}, found {}", found.str(1),
                       is_whole ? "whole " : "", std::stod(found.str(3)), std::stod(found.str(4)),
                       io::one_line(found.str(2)));
  }
  if (std::regex_match(text, found, std::regex("(.*): 1 required (.*) missing"))) {
    return fmt::format("{} has no value, expected {}", found.str(1), found.str(2));
  }
  if (std::regex_match(text, found, std::regex("Could not convert: (.*) = (.*)"))) {
    return fmt::format("{}: expected a whole number, such as 20, found '{}'", found.str(1),
                       io::one_line(found.str(2)));
  }
  if (std::regex_match(text, found, std::regex("(.*): At Most 1 required but received (.*)"))) {
    return fmt::format("{} is given {} times, expected once", found.str(1), found.str(2));
  }
  if (std::regex_match(text, found, std::regex("(.*) excludes (.*)"))) {
    return fmt::format("{} and {} exclude each other", found.str(1), found.str(2));
  }
  return text;
}

/// Adds the value to a message of what an option expects, where it was given one.
std::string with_value(const CLI::App& command, const std::string& text) {
  const std::size_t end = text.find(": expected ");
  if (end == std::string::npos || text.find("found", end) != std::string::npos) {
    return text;
  }
  const CLI::Option* const option = command.get_option_no_throw(text.substr(0, end));
  return option == nullptr || option->results().size() != 1
             ? text
             : fmt::format("{}; found '{}'", text, io::one_line(option->results().front()));
}

}  // namespace

std::string HelpFormatter::make_option(const CLI::Option* option, bool is_positional) const {
  return entry(head_of(*option, is_positional), text_of(*option));
}

std::string HelpFormatter::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description());
}

std::string HelpFormatter::make_help(const CLI::App* app, std::string /*name*/,
                                     CLI::AppFormatMode /*mode*/) const {
  const auto known = helps_.find(app);
  const Help help = known != helps_.end() ? known->second : Help();
  std::string out = wrapped(app->get_description() + '.', 0, 0) + '\n';
  out += make_usage(app, full_name(*app));
  out += list_of(help.examples) + options_of(*app, *this, true) + options_of(*app, *this, false);
  const auto commands = app->get_subcommands({});
  out += commands.empty() ? "" : "\nCommands:\n";
  for (const CLI::App* command : commands) {
    out += make_subcommand(command);
  }
  out += paragraphs(help.notes);
  if (!help.exits.empty()) {
    std::vector<ExitCode> exits = help.exits;
    exits.push_back({kExitUsage, "wrong usage"});
    exits.push_back({kExitFailure, "out of memory"});
    std::ranges::stable_sort(exits, {}, &ExitCode::code);
    out += list_of(exits);
  }
  return out;
}

std::string usage_error(const CLI::App& app, const CLI::Error& error) {
  const CLI::App& command = asked(app);
  const bool is_extra = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  // CLI11 says first what is missing; it may be missing because of a slip in an option.
  std::string what = unknown_option(command);
  if (what.empty() && &command != &app && !app.remaining().empty()) {
    what = fmt::format("'{}' stands before the command, options stand behind it",
                       io::one_line(app.remaining().front()));
  }
  if (what.empty()) {
    what = is_extra ? one_too_many(command) : with_value(command, reworded(error.what()));
  }
  return usage_error(command, what);
}

std::string usage_error(const CLI::App& command, std::string_view what) {
  return fmt::format("{0}: {1}\nTry '{0} --help'.\n", full_name(command), what);
}

namespace {

/// Commands by the names that people try.
constexpr auto kOtherNames =
    std::to_array<std::pair<std::string_view, std::string_view>>({{"new", "generate"},
                                                                  {"create", "generate"},
                                                                  {"init", "generate"},
                                                                  {"verify", "check"},
                                                                  {"predict", "check"},
                                                                  {"plan", "order"},
                                                                  {"build", "order"},
                                                                  {"place", "next"},
                                                                  {"draw", "view"},
                                                                  {"show", "view"},
                                                                  {"open", "view"},
                                                                  {"gui", "view"},
                                                                  {"import", "convert"},
                                                                  {"export", "convert"},
                                                                  {"version", "--version"}});

/// The command that a name is one for, or is like.
std::string meant_command(std::string_view argument, const std::vector<std::string>& names) {
  const auto* const other = std::ranges::find(
      kOtherNames, argument, &std::pair<std::string_view, std::string_view>::first);
  return other != kOtherNames.end() ? "; " + io::did_you_mean(other->second)
                                    : did_you_mean(argument, names);
}

}  // namespace

std::string unknown_command(const CLI::App& app, std::string_view argument) {
  std::vector<std::string> names = {"help"};
  for (const CLI::App* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
  }
  const std::string near = meant_command(argument, names);
  const bool is_file = argument.find_first_of("./") != std::string_view::npos;
  return fmt::format("holdfast: there is no command '{}'{}\n", io::one_line(argument),
                     !near.empty() ? near
                     : is_file ? "; 'holdfast check " + io::one_line(argument) + "' judges a file"
                               : fmt::format("; there are {}", fmt::join(names, ", ")));
}

}  // namespace holdfast::cli
