// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "holdfast/agent/equilibrium/front.hpp"
#include "holdfast/agent/world/surroundings.hpp"
#include "holdfast/base/algebra.hpp"

/// What goes up of a front's nodes, as messages of six reals (docs/wire.md, "front up").
namespace holdfast::agent {

/// Displacements of kept nodes go up in two parts, as in an exchange: the leading digits, and what
/// these leave.
inline constexpr int kPartsOfKept = 2;

base::Vec6<float> part_of(const base::Vec6<double>& u, bool is_low);

/// A node, without its displacement and the states of its facets.
base::Vec6<float> packed(const FrontNode& node);

/// Reads what packed() makes. False: no program of this version sends it.
bool unpack(const base::Vec6<float>& vector, FrontNode& node);

/// The states of a facet, in use and found, and what else modules know of it, in twelve bits.
std::uint16_t packed_state(const TouchingFacet& facet);

void unpack_state(std::uint16_t packed, TouchingFacet& facet);

/// The number of messages with the states of a node's facets; none unless it is kept.
int state_vectors(const FrontNode& node);

/// One of these messages, and what it says of a node.
base::Vec6<float> states_of(const FrontNode& node, int part);

void take_states(const base::Vec6<float>& vector, int part, FrontNode& node);

}  // namespace holdfast::agent
