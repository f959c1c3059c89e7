// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "engine.hpp"

/// Makes the result of a simulation.
namespace holdfast::sim {

bool is_same(const agent::Answer& a, const agent::Answer& b) {
  return a.verdict == b.verdict && a.reason == b.reason &&
         std::bit_cast<std::uint32_t>(a.load_ratio_max) ==
             std::bit_cast<std::uint32_t>(b.load_ratio_max) &&
         a.worst_cell == b.worst_cell && a.worst_direction == b.worst_direction &&
         a.remarks == b.remarks;
}

void Outcome::add(std::int32_t module, const ModuleOutcome& outcome) {
  if (outcome.bytes_sent > result_.bytes_module_max) {
    result_.bytes_module_max = outcome.bytes_sent;
    result_.packets_module_max = outcome.packets_sent;
  }
  if (!outcome.takes_part) {
    return;
  }
  const agent::Answer& answer = outcome.agent.answer();
  if (is_empty_) {
    result_.answer = answer;
  }
  is_empty_ = false;
  agree_ = agree_ && answer.verdict != agent::Verdict::kNone && is_same(answer, result_.answer);
  if (result_.root < 0 && outcome.agent.is_root() && outcome.agent.epoch() == result_.epoch) {
    result_.root = module;
    result_.effort = outcome.agent.effort();
  }
}

SimulationResult Outcome::result() const {
  SimulationResult result = result_;
  result.all_agree = agree_ && !is_empty_;
  return result;
}

SimulationResult Engine::result() const {
  Outcome outcome(ledger_.recorder.result());
  for (std::size_t i = 0; i < modules_.agents.size(); ++i) {
    const Port& port = modules_.ports[i];
    outcome.add(static_cast<std::int32_t>(i), {.agent = modules_.agents[i],
                                               .takes_part = port.takes_part(),
                                               .packets_sent = port.packets_sent,
                                               .bytes_sent = port.bytes_sent});
  }
  SimulationResult result = outcome.result();
  result.is_quiet = is_quiet_;
  return result;
}

SimulationResult Engine::counts() const { return ledger_.recorder.result(); }

void Engine::finish() {
  if (is_over_) {
    return;
  }
  is_over_ = true;
  if (ledger_.recorder.trace() != nullptr) {
    ledger_.recorder.trace()->end(result());
  }
}

}  // namespace holdfast::sim
