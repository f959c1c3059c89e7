// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A step: the root learns its words, then has one stage after the other judged, and in the end says
// which of them fails.
#include "holdfast/agent/conductor.hpp"

namespace holdfast::agent {
namespace {

using wire::Operation;

}  // namespace

/// `found`: the word of this index.
Order Conductor::ask_word(std::uint8_t index, const Report& found) {
  Order order = ask(Operation::kWord);
  order.index = index;
  order.count = found.extent;
  order.cell = found.cell;
  order.mass = static_cast<std::int32_t>(found.number);
  return order;
}

Order Conductor::after_word(const Report& report, const Stages& stages) {
  const std::uint8_t learned = stages.learned_count();
  const std::uint16_t total = learned == 0 ? report.extent : stages.total();
  const bool is_last = learned > 0 && learned == total;
  const bool is_found = (report.flags & kFound) != 0 && report.extent == total &&
                        total <= kWordCountMax &&
                        stages.is_possible(word_of(report.number, report.cell));
  const bool is_clear = (report.flags & (kDisputed | kDenied)) == 0 &&
                        (is_last ? stages.is_whole(report.count) : is_found);
  if (!is_clear) {
    return finish(Verdict::kUndecided, Reason::kStepUnclear);
  }
  if (!is_last) {
    return ask_word(learned, report);
  }
  Order stage = ask(Operation::kStage);
  stage.answer = {.verdict = Verdict::kUndecided, .reason = Reason::kInPieces};
  const bool is_split = (report.flags & kSplit) != 0;
  stage.flags = static_cast<std::uint8_t>(is_split ? report.mask : 0);
  stage.index = static_cast<std::uint8_t>(is_split ? Stage::kNone : Stage::kRelease);
  return stage;
}

/// Can the next scene, which differs in its loads, start from the displacements of the last one? As
/// after a verdict (can_renew()).
bool Conductor::can_resume_stage(const Setup& setup) const {
  const bool has_method =
      (setup.method == Method::kElimination || setup.method == Method::kPolynomial) &&
      (effort_.method == Method::kElimination || effort_.method == Method::kPolynomial);
  return setup.keeps_answers && has_method && has_motion_ && !is_unilateral_ && !has_clusters_ &&
         !may_have_clusters();
}

/// The report of kMass is here, and nothing is planned.
Order Conductor::resume_stage(const Setup& setup, const Report& report) {
  if (report.count != census_) {
    return finish(Verdict::kUndecided, Reason::kNeighbourSilent);
  }
  const Planned none;
  const Order order = weigh(setup, report, none) ? resume(setup, none) : Order{};
  return order.operation == Operation{} ? finish(Verdict::kUndecided, Reason::kTooLarge) : order;
}

Order Conductor::after_stage(const Setup& setup, const Report& report, const Stages& stages,
                             const Lent& lent) {
  if (asked_ == Operation::kWord) {
    return after_word(report, stages);
  }
  if (stages.stage() == Stage::kNone) {
    answer_ = stages.overall();
    return finish(answer_.verdict, answer_.reason);
  }
  if ((report.flags & kNewLinks) != 0) {
    return {};
  }
  if (stages.stage() == Stage::kConnect || !can_resume_stage(setup)) {
    return begin(setup, root_, census_, depth_, lent);
  }
  is_resumed_ = true;
  has_factors_ = false;
  Order mass = ask(Operation::kMass);
  mass.cell = root_;
  return mass;
}

Order Conductor::end_scene(const Stages& stages, const Answer& answer) {
  const bool is_over = stages.scene() + 1 >= stages.scene_count(stages.stage());
  const auto here = static_cast<std::uint8_t>(stages.stage());
  Order next = ask(Operation::kStage);
  next.flags = here;
  next.index = static_cast<std::uint8_t>(!is_over ? here : here == kStageCount ? 0 : here + 1);
  next.count = static_cast<std::uint16_t>(is_over ? 0 : stages.scene() + 1);
  next.answer = answer;
  return next;
}

}  // namespace holdfast::agent
