// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/report_head.hpp"

#include "json/json_text.hpp"
#include "version.hpp"

namespace holdfast::io {
namespace {

std::string program() { return "holdfast " + std::string(kProgramVersion); }

}  // namespace

std::string_view program_version() { return kProgramVersion; }

void write_report_head(JsonStream& json, std::string_view command) {
  json.member("format", kReportFormat);
  json.member("version", kReportVersion);
  json.member("report", command);
  json.member("program", std::string_view(program()));
}

std::vector<std::string> report_head(std::string_view command) {
  return {member("format", json_text(std::string(kReportFormat))),
          member("version", std::to_string(kReportVersion)),
          member("report", json_text(std::string(command))),
          member("program", json_text(program()))};
}

}  // namespace holdfast::io
