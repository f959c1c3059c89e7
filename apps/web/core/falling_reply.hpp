// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/falling_pieces.hpp"
#include "reply.hpp"

namespace holdfast::web {

/// What follows the break of a robot, and how its pieces fall. Text: "cascade" as in a report,
/// "text" in words, "round_s" when each round begins, "frame_s" from one frame to the next.
/// Integers: the body of each module, -1 if it stands. Numbers: the centre of mass of each body,
/// mm; then for each frame and body how far that has moved, mm, and the quaternion (w, x, y, z) of
/// its turn.
Reply falling_reply(const model::RobotSpec& spec, const model::Robot& robot,
                    const plan::Cascade& cascade);

}  // namespace holdfast::web
