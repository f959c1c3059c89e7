// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/json_stream.hpp"
#include "holdfast/io/report.hpp"
#include "holdfast/io/steps_report.hpp"

namespace holdfast::io {
namespace {

/// The size at which text is written to the stream.
constexpr std::size_t kBlockBytes = std::size_t{1} << 16U;

void write_pair(JsonStream& json, const model::CellPair& pair) {
  json.begin_array();
  for (const base::Cell& cell : pair) {
    json.value(cell);
  }
  json.end_array();
}

void write_stage(JsonStream& json, const plan::StageJudgement& stage) {
  json.begin_object();
  json.member("verdict", verdict::name(stage.verdict));
  json.key("reasons");
  json.begin_array();
  for (const plan::StageReason& reason : stage.reasons) {
    json.value(reason_text(reason.reason, reason.cells));
  }
  json.end_array();
  json.key("reason_codes");
  json.begin_array();
  for (const plan::StageReason& reason : stage.reasons) {
    json.value(verdict::name(reason.reason.code));
  }
  json.end_array();
  const std::optional<double> none;
  json.member("load_ratio_max", stage.is_bound ? none : stage.load_ratio_max);
  if (stage.is_bound) {
    json.member("load_ratio_bound", stage.load_ratio_max);
  }
  json.member("margin_mm", stage.margin_mm);
  json.key("at");
  if (stage.worst) {
    write_pair(json, *stage.worst);
  } else {
    json.value(nullptr);
  }
  json.member("pieces", stage.piece_count);
  if (stage.waypoint_count > 0) {
    json.member("waypoint", stage.waypoint);
    json.member("waypoints", stage.waypoint_count);
  }
  json.end_object();
}

void write_step(JsonStream& json, const StepsEntry& entry, std::size_t step) {
  json.begin_object();
  json.member("step", step);
  json.member("where", step_pointer(*entry.document, step));
  json.key("stages");
  json.begin_object();
  for (int i = 0; i < plan::kStageCount; ++i) {
    json.key(plan::name(static_cast<plan::Stage>(i)));
    write_stage(json, entry.judgement->steps[step].stages[static_cast<std::size_t>(i)]);
  }
  json.end_object();
  json.end_object();
}

}  // namespace

void write_stage_id(JsonStream& json, std::string_view key,
                    const std::optional<plan::StageId>& id) {
  json.key(key);
  if (!id) {
    json.value(nullptr);
    return;
  }
  json.begin_object();
  json.member("step", id->step);
  json.member("stage", plan::name(id->stage));
  json.end_object();
}

void write_steps_json(std::ostream& out, const StepsEntry& entry,
                      const std::function<void(JsonStream&)>& more) {
  const plan::SequenceJudgement& judged = *entry.judgement;
  std::string text;
  JsonStream json(text);
  json.begin_object();
  write_report_head(
      json,
      {.command = "steps", .origin = entry.origin, .module_count = entry.document->modules.size()});
  json.member("name", entry.name);
  json.member("verdict", verdict::name(judged.verdict()));
  write_stage_id(json, "first_unsafe", judged.first_unsafe);
  write_stage_id(json, "first_undecided", judged.first_undecided);
  json.member("load_ratio_max", judged.load_ratio_max);
  if (judged.load_ratio_bound) {
    json.member("load_ratio_bound", judged.load_ratio_bound);
  }
  json.member("margin_min_mm", judged.margin_min_mm);
  json.key("steps");
  json.begin_array();
  for (std::size_t step = 0; step < judged.steps.size() && out; ++step) {
    write_step(json, entry, step);
    if (text.size() > kBlockBytes) {
      out << text;
      text.clear();
    }
  }
  json.end_array();
  json.key("warnings");
  json.begin_array();
  for (const std::string& warning : entry.warnings) {
    json.value(warning);
  }
  json.end_array();
  json.member("seconds", entry.seconds);
  if (more) {
    more(json);
  }
  json.end_object();
  out << text;
}

}  // namespace holdfast::io
