// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <iterator>

#include "holdfast/distributed.hpp"

/// Does what simulated and emulated robots have in common.
namespace holdfast {

/// The robot's knowledge in the form of an assessment.
verdict::Assessment view_of(const model::Robot& robot, const verdict::Assessment& exact,
                            const Agents& agents, const sim::SimulationResult& result);

/// Notes which connection the robot names as the worst, and its limit.
void note_worst(const model::Robot& robot, DistributedRun& run);

/// Whether the robot has load ratios of another contact law than the exact answer.
bool has_other_law(const verdict::Assessment& exact, const sim::SimulationResult& result);

/// Notes the kind of the robot's error, and why it answers otherwise than the exact answer, in a
/// run that has its result and view. `has_lost_modules`: modules were taken off.
void note_difference(const model::Robot& robot, const verdict::Assessment& exact,
                     bool has_lost_modules, DistributedRun& run);

RefusedMessages refused_by(const model::Robot& robot, const Agents& agents);

using TextOut = std::back_insert_iterator<std::string>;

/// "1.250 s"; `otherwise` if ticks of the link have no length.
std::string time_text(const sim::LinkModel& link, sim::Time time, const std::string& otherwise);

/// The exact answer and the robot's.
void write_answer(TextOut out, const Structure& structure, const CheckResult& exact,
                  const DistributedRun& run);

/// Writes how many messages were refused; no line where none was.
void write_refused(TextOut out, const RefusedMessages& refused);

}  // namespace holdfast
