// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "sequence_view.hpp"

#include <algorithm>
#include <utility>

namespace holdfast::web {
namespace {

void add_cells(const std::vector<base::Cell>& cells, std::vector<std::int32_t>& out) {
  for (const base::Cell& cell : cells) {
    out.insert(out.end(), {cell.x, cell.y, cell.z});
  }
}

void add_count(std::size_t count, std::vector<std::int32_t>& out) {
  out.push_back(static_cast<std::int32_t>(count));
}

void add_transition(const model::Step& step, const plan::Transition& transition,
                    std::vector<std::int32_t>& out) {
  add_count(step.attach.size(), out);
  add_count(step.detach.size(), out);
  add_count(transition.groups.size(), out);
  add_cells(step.attach, out);
  add_cells(step.detach, out);
  for (const plan::Group& group : transition.groups) {
    add_count(group.from.size(), out);
    add_count(group.way.size(), out);
    add_cells(group.from, out);
    add_cells(group.to, out);
    add_cells(group.way, out);
  }
}

}  // namespace

SequenceView::SequenceView(io::Sequence sequence)
    : sequence_(std::move(sequence)), robot_(sequence_.start) {}

std::vector<std::int32_t> SequenceView::transitions() const {
  std::vector<std::int32_t> out;
  plan::RobotState robot(sequence_.start);
  for (const model::Step& step : sequence_.steps) {
    const auto transition = plan::find_transition(robot, step);
    add_transition(step, transition.value(), out);
    plan::apply(step, transition.value(), robot);
  }
  return out;
}

base::Result<plan::Scene> SequenceView::scene(std::size_t step, plan::Stage stage,
                                              std::size_t waypoint) {
  HOLDFAST_CHECK(step < sequence_.steps.size());
  go_to(step);
  const model::Step& doing = sequence_.steps[step];
  auto scenes =
      plan::find_scenes(robot_, doing, plan::find_transition(robot_, doing).value(), stage);
  if (!scenes) {
    return scenes.error();
  }
  const auto is_there = [&](const plan::Scene& scene) { return scene.waypoint == waypoint; };
  const auto found = std::ranges::find_if(scenes.value(), is_there);
  return found == scenes.value().end() ? scenes.value().front() : *found;
}

void SequenceView::go_to(std::size_t step) {
  if (step < step_) {
    robot_ = plan::RobotState(sequence_.start);
    step_ = 0;
  }
  for (; step_ < step; ++step_) {
    const model::Step& doing = sequence_.steps[step_];
    plan::apply(doing, plan::find_transition(robot_, doing).value(), robot_);
  }
}

}  // namespace holdfast::web
