// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "equilibrium_options.hpp"
#include "holdfast/base/check.hpp"
#include "holdfast/trial.hpp"

namespace holdfast {
namespace {

using plan::RemedyKind;
using plan::RemedyList;

constexpr std::array kKinds = {RemedyKind::kModule, RemedyKind::kProp, RemedyKind::kFixing,
                               RemedyKind::kRemoval};

/// The change in words, with the cell for {}.
std::string words(RemedyKind kind, const base::Cell& cell) {
  const std::string at = model::text(cell);
  switch (kind) {
    case RemedyKind::kModule:
      return fmt::format("one more module at {}", at);
    case RemedyKind::kProp:
      return fmt::format("a prop in {}, below a module", at);
    case RemedyKind::kFixing:
      return fmt::format("{} fixed to the ground or a wall", at);
    case RemedyKind::kRemoval:
      break;
  }
  return fmt::format("{} taken away", at);
}

std::string list_text(RemedyKind kind, const RemedyList& list) {
  const plan::Remedy& best = list.safe.front();
  std::string text = words(kind, best.cell);
  if (best.judgement.load_ratio_max) {
    text += fmt::format(": load ratio {}", io::beside_one(*best.judgement.load_ratio_max, 4));
  }
  return text + fmt::format("; {} of {} would suffice", list.safe.size(), list.tried_count);
}

void write_list(io::JsonStream& json, const RemedyList& list) {
  json.begin_object();
  json.key("safe");
  json.begin_array();
  for (const plan::Remedy& remedy : list.safe) {
    json.begin_object();
    json.member("cell", remedy.cell);
    json.member("load_ratio_max", remedy.judgement.load_ratio_max);
    json.member("margin_mm", remedy.judgement.margin_mm);
    json.end_object();
  }
  json.end_array();
  json.member("tried", list.tried_count);
  json.member("untried", list.untried_count);
  json.end_object();
}

}  // namespace

plan::Remedies find_remedies(
    const Structure& structure, const CheckResult& result, const CheckOptions& options,
    const std::function<void(std::size_t done, std::size_t count)>& progress) {
  const auto spec = io::make_spec(structure.document);
  HOLDFAST_CHECK(spec.has_value());  // The structure's robot was made of it.
  plan::RemedyOptions how;
  how.equilibrium = equilibrium_options(options);
  how.progress = progress;
  return plan::find_remedies(spec.value(), plan::judgement_of(result.assessment), how);
}

std::string remedies_text(const plan::Remedies& remedies) {
  std::string text;
  const auto add = [&](const std::string& line) {
    text += fmt::format("  {:<12}{}\n", text.empty() ? "would hold" : "", line);
  };
  std::size_t tried = 0;
  std::size_t untried = 0;
  for (const RemedyKind kind : kKinds) {
    const RemedyList& list = remedies.of(kind);
    tried += list.tried_count;
    untried += list.untried_count;
    if (!list.safe.empty()) {
      add("with " + list_text(kind, list));
    }
  }
  if (remedies.strength_factor) {
    add(fmt::format("with connections {:.2f} times as strong", *remedies.strength_factor));
  }
  if (text.empty()) {
    add(fmt::format("with none of {} single changes that were tried", tried));
  }
  if (untried > 0) {
    add(fmt::format("({} more changes were not tried)", untried));
  }
  return text;
}

void write_remedies_member(io::JsonStream& json, const plan::Remedies& remedies) {
  json.key("remedies");
  json.begin_object();
  for (const RemedyKind kind : kKinds) {
    json.key(plan::name(kind));
    write_list(json, remedies.of(kind));
  }
  json.member("strength_factor", remedies.strength_factor);
  json.end_object();
}

}  // namespace holdfast
