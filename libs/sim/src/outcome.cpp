// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "engine.hpp"

/// What a simulation has come to.
namespace holdfast::sim {

bool is_same(const agent::Answer& a, const agent::Answer& b) {
  return a.verdict == b.verdict && a.reason == b.reason &&
         std::bit_cast<std::uint32_t>(a.load_ratio_max) ==
             std::bit_cast<std::uint32_t>(b.load_ratio_max) &&
         a.worst_cell == b.worst_cell && a.worst_direction == b.worst_direction;
}

SimulationResult Engine::result() const {
  SimulationResult result = recorder_.result();
  result.is_quiet = is_quiet_;
  result.all_agree = true;
  bool is_first = true;
  for (std::size_t i = 0; i < agents_.size(); ++i) {
    const Port& port = ports_[i];
    if (port.bytes_sent > result.bytes_module_max) {
      result.bytes_module_max = port.bytes_sent;
      result.packets_module_max = port.packets_sent;
    }
    if (!port.takes_part()) {
      continue;
    }
    const agent::Answer& answer = agents_[i].answer();
    if (is_first) {
      result.answer = answer;
    }
    is_first = false;
    result.all_agree = result.all_agree && answer.verdict != agent::Verdict::kNone &&
                       is_same(answer, result.answer);
    if (result.root < 0 && agents_[i].is_root() && agents_[i].epoch() == result.epoch) {
      result.root = static_cast<std::int32_t>(i);
      result.effort = agents_[i].effort();
    }
  }
  result.all_agree = result.all_agree && !is_first;
  return result;
}

void Engine::finish() {
  if (is_over_) {
    return;
  }
  is_over_ = true;
  if (recorder_.trace() != nullptr) {
    recorder_.trace()->end(result());
  }
}

}  // namespace holdfast::sim
