// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A step in stages: the words of it, and the rounds in which its stages are judged.
#include "holdfast/agent/agent.hpp"

namespace holdfast::agent {

void Agent::tell_step(const Event& event) {
  if (ws_.stages() != nullptr) {
    ws_.stages()->tell(event.index, event.total, event.word);
    leave_round();
  }
}

/// A round begins; connections that are off in the stage that it is about have no part in it.
void Agent::hide_links(const Round& round, Stage stage) {
  Stages* const stages = ws_.stages();
  if (stages == nullptr) {
    return;
  }
  if (stage == Stage::kNone) {
    stages->leave(round);
  }
  ws_.links.hide(stages->hidden(ws_.tree.cell()));
}

/// A wave over the connections that are left in a stage has come back to this module, which was the
/// root before and knows how many modules there are. If some were not reached, a round over all
/// links tells them why.
bool Agent::find_pieces() {
  const Stage stage = ws_.stage();
  const SpanningTree::Census& census = ws_.tree.census();
  const bool is_first = stage != Stage::kNone && ws_.tree.wave() == SpanningTree::Wave::kFirst;
  if (!is_first || census.doubt != Doubt::kNone || census.count == conductor_.census()) {
    return false;
  }
  ws_.stages()->note_pieces(stage, {.epoch = epoch_after(epoch()), .starter = identity_.id});
  start_round();
  return true;
}

/// The root has all reports on a word, or on a stage that begins, or knows the verdict on a scene.
/// False: it has nothing to do with stages.
bool Agent::go_on_in_stages(const Report& sum) {
  const wire::Operation operation = sweep_.order().operation;
  // Where stages are judged free faces are not.
  const Lent lent{.has_fronts = ws_.front_memory() != nullptr};
  Order next;
  if (operation == wire::Operation::kWord || operation == wire::Operation::kStage) {
    next = conductor_.after_stage(ws_.setup, sum, *ws_.stages(), lent);
    if (next.operation == wire::Operation{}) {
      start_round(ws_.stage());
      return true;
    }
  } else if (ws_.stage() != Stage::kNone) {
    next = conductor_.next(ws_.setup, sum, ws_.planned);
    next = next.operation == wire::Operation::kVerdict
               ? conductor_.end_scene(*ws_.stages(), next.answer)
               : next;
  } else {
    return false;
  }
  keep_order(next);
  is_busy_ = true;
  return true;
}

/// A round begins in which a stage is judged. False: this module does not know the stage, as it has
/// missed what went before; it starts a round that teaches it.
bool Agent::enter_stage(const Join& join) {
  const auto stage = static_cast<Stage>(join.stage);
  const bool is_known = join.round.epoch == epoch_after(epoch()) && !rounds_.is_left() &&
                        ws_.stages() != nullptr && ws_.stages()->scene() == 0 &&
                        ws_.stage() == stage;
  enter_round(join.round, is_known ? stage : Stage::kNone);
  if (!is_known) {
    leave_round();
  }
  return is_known;
}

}  // namespace holdfast::agent
