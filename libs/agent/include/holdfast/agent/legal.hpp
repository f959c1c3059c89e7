// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

/// What no module that works would ever say.
///
/// A checksum tells that a message is what the neighbour has sent, not that it makes sense. So
/// every number of a message that names one of several things, or a place in memory, is looked at
/// before anything is done with it: kinds, flags, indices, faces, cells, counts of exchanges. Reals
/// may be anything, what is not a number included: a method that diverges says so with them. The
/// limits are those of docs/wire.md. What may be said at a certain time only is the agent's to know
/// (src/guard.cpp).
namespace holdfast::agent::wire {

/// `message` is whole, as Link::next_message() gives it. False: no program of this version writes
/// it.
bool is_legal(std::span<const std::uint8_t> message);

}  // namespace holdfast::agent::wire
