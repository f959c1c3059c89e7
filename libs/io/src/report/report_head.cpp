// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/report_head.hpp"

#include "version.hpp"

namespace holdfast::io {
namespace {

void write_robot(JsonStream& json, const ReportHead& head) {
  if (head.origin.file.empty() && !head.module_count) {
    return;
  }
  json.key("robot");
  json.begin_object();
  if (!head.origin.file.empty()) {
    json.member("file", std::string_view(head.origin.file));
  }
  if (!head.origin.target.empty()) {
    json.member("target", std::string_view(head.origin.target));
  }
  if (head.module_count) {
    json.member("modules", *head.module_count);
  }
  json.end_object();
}

void write_option(JsonStream& json, const GivenOption& option) {
  json.key(option.name);
  if (option.is_list) {
    json.begin_array();
    for (const std::string& value : option.values) {
      json.value(std::string_view(value));
    }
    json.end_array();
  } else if (option.values.empty()) {
    json.value(true);
  } else {
    json.value(std::string_view(option.values.front()));
  }
}

void write_options(JsonStream& json, const ReportHead& head) {
  if (!head.origin.options) {
    return;
  }
  json.key("options");
  json.begin_object();
  for (const GivenOption& option : *head.origin.options) {
    write_option(json, option);
  }
  json.end_object();
}

using WriteMember = void (*)(JsonStream&, const ReportHead&);

constexpr WriteMember kMembers[] = {
    [](JsonStream& json, const ReportHead&) { json.member("format", kReportFormat); },
    [](JsonStream& json, const ReportHead&) { json.member("version", kReportVersion); },
    [](JsonStream& json, const ReportHead& head) { json.member("report", head.command); },
    [](JsonStream& json, const ReportHead&) {
      json.member("program", std::string_view("holdfast " + std::string(kProgramVersion)));
    },
    write_robot,
    write_options};

}  // namespace

std::string_view program_version() { return kProgramVersion; }

void write_report_head(JsonStream& json, const ReportHead& head) {
  for (const WriteMember write : kMembers) {
    write(json, head);
  }
}

std::vector<std::string> report_head(const ReportHead& head) {
  std::vector<std::string> members;
  for (const WriteMember write : kMembers) {
    std::string text;
    JsonStream json(text, JsonStream::Layout::kLine);
    write(json, head);
    if (!text.empty()) {
      members.push_back(std::move(text));
    }
  }
  return members;
}

}  // namespace holdfast::io
