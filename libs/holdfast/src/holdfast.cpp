// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/holdfast.hpp"

#include <chrono>

#include "version.hpp"

namespace holdfast {
namespace {

io::ReportEntry entry_of(const Structure& structure, const CheckResult& result) {
  return {.name = structure.name,
          .robot = &structure.robot,
          .assessment = &result.assessment,
          .warnings = structure.warnings,
          .seconds = result.seconds};
}

}  // namespace

std::string_view version() { return kVersion; }

base::Result<Structure> load_text(std::string_view text, std::string_view name) {
  auto read = io::read_document(text);
  if (!read) {
    return read.error();
  }
  auto [document, warnings] = std::move(read).value();
  auto robot = io::make_robot(document);
  if (!robot) {
    return robot.error();
  }
  std::string title = document.name.empty() ? std::string(name) : document.name;
  return Structure{.name = std::move(title),
                   .document = std::move(document),
                   .robot = std::move(robot).value(),
                   .warnings = std::move(warnings)};
}

base::Result<Structure> load_file(const std::filesystem::path& path) {
  const auto text = read_file(path);
  if (!text) {
    return text.error();
  }
  return load_text(text.value(), path.stem().string());
}

CheckResult check(const Structure& structure) {
  const auto start = std::chrono::steady_clock::now();
  CheckResult result{.assessment = verdict::assess(structure.robot)};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

std::string report_json(const Structure& structure, const CheckResult& result) {
  return io::write_report_json(entry_of(structure, result));
}

std::string report_text(const Structure& structure, const CheckResult& result) {
  return io::write_report_text(entry_of(structure, result));
}

std::string picture_svg(const Structure& structure, const CheckResult& result) {
  return io::write_svg(structure.robot, result.assessment, structure.name);
}

std::string picture_vtu(const Structure& structure, const CheckResult& result) {
  return io::write_vtu(structure.robot, result.assessment);
}

std::string error_json(const base::Error& error, std::string_view name) {
  return io::write_error_json(error, name);
}

std::string describe(const base::Error& error, std::string_view file) {
  std::string line(file);
  for (const std::string& part : {error.where, error.message}) {
    if (!part.empty()) {
      line += (line.empty() ? "" : ": ") + part;
    }
  }
  return line;
}

}  // namespace holdfast
