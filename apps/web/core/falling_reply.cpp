// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "falling_reply.hpp"

#include <algorithm>

namespace holdfast::web {

Reply falling_reply(const model::RobotSpec& spec, const model::Robot& robot,
                    const plan::Cascade& cascade) {
  const FallingPieces pieces = simulate_fall(spec, robot, cascade);
  Reply reply{.text = {}, .integers = pieces.body_of, .numbers = {}};
  io::JsonStream json(reply.text, io::JsonStream::Layout::kCompact);
  json.begin_object();
  write_cascade_member(json, cascade);
  json.member("text", cascade_text(robot, cascade));
  json.member("frame_s", pieces.fall.frame_s);
  json.key("round_s");
  json.begin_array();
  for (const double begin : pieces.round_s) {
    json.value(begin);
  }
  json.end_array();
  json.end_object();
  const auto add = [&](const auto& numbers) {
    reply.numbers.insert(reply.numbers.end(), numbers.begin(), numbers.end());
  };
  std::ranges::for_each(pieces.fall.centres, add);
  for (const std::vector<fall::Pose>& frame : pieces.fall.frames) {
    for (const fall::Pose& pose : frame) {
      add(pose.moved);
      add(pose.turn);
    }
  }
  return reply;
}

}  // namespace holdfast::web
