// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "page.hpp"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "own_files.hpp"

namespace holdfast::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPlace = "id=\"holdfast-start\">null<";
constexpr std::string_view kReportPlace = "<!-- holdfast view puts the report here. -->";

/// Text that may stand between tags, in JSON too: no letter can end a script or a comment.
std::string harmless_json(const nlohmann::ordered_json& json) {
  const std::string text =
      json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  std::string out;
  for (const char letter : text) {
    letter == '<' ? out += "\\u003c" : out += letter;
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char letter : text) {
    switch (letter) {
      case '<':
        out += "&lt;";
        break;
      case '&':
        out += "&amp;";
        break;
      default:
        out += letter;
    }
  }
  return out;
}

bool replace_once(std::string& text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  if (at != std::string::npos) {
    text.replace(at, from.size(), to);
  }
  return at != std::string::npos;
}

}  // namespace

base::Result<std::string> find_page() {
  const std::vector<fs::path> places = places_of("holdfast.html", "page");
  if (const auto place = find_file(places)) {
    return read_file(*place);
  }
  std::string names;
  for (const fs::path& place : places) {
    names += (names.empty() ? "" : ", ") + place.string();
  }
  return base::Error{.code = base::ErrorCode::kUnreadable,
                     .message = fmt::format("the page is not built: looked for {}; './dev page' "
                                            "builds it",
                                            names),
                     .where = {}};
}

base::Result<std::string> fill_page(std::string_view page, const Structure& structure,
                                    const std::optional<std::string>& report,
                                    const std::optional<limit::LimitLoad>& limit) {
  nlohmann::ordered_json start = {{"structure", io::write_json(structure.document)},
                                  {"name", structure.name}};
  if (report) {
    start["report"] = *report;
  }
  if (limit) {
    start["limit"] = nlohmann::ordered_json::parse(io::collapse_json(structure.robot, *limit));
  }
  std::string filled(page);
  const std::string text = report.value_or("");
  const bool is_filled =
      replace_once(filled, kPlace,
                   fmt::format("id=\"holdfast-start\">{}<", harmless_json(start))) &&
      replace_once(filled, kReportPlace, fmt::format("<pre>{}</pre>", escaped(text))) &&
      replace_once(
          filled, "<title>holdfast</title>",
          fmt::format("<title>{} - holdfast</title>", escaped(io::one_line(structure.name))));
  if (!is_filled) {
    return base::Error{.code = base::ErrorCode::kUnsupported,
                       .message = "holdfast.html is no page of holdfast's; './dev page' builds it",
                       .where = {}};
  }
  return filled;
}

bool open_in_browser(const std::string& path) {
#ifdef __APPLE__
  std::string opener = "open";
#else
  std::string opener = "xdg-open";
#endif
  std::string argument = path;
  char* const arguments[] = {opener.data(), argument.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, opener.c_str(), nullptr, nullptr, arguments, environ) != 0) {
    return false;
  }
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace holdfast::cli
