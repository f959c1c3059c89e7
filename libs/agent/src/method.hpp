// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <new>
#include <span>

#include "holdfast/agent/sweep.hpp"

/// The methods that find an equilibrium, as the sweeps see them: the same few functions of each.
///
/// Which methods a program has is decided by what it is linked with. all_methods.cpp names them
/// all. A module with little flash has elimination_only.cpp in its place: elimination over the tree
/// and nothing to fall back on, so that a robot with too many loops, or without a state under the
/// regularised law, ends as `undecided`. All modules of such a robot must be told:
/// Setup::only_elimination.
namespace holdfast::agent {

/// A message's bytes, its type first.
using Message = std::span<const std::uint8_t>;

struct MethodTable {
  /// Begins a life in memory that another method may have used.
  void (*make)(MethodState& state);

  /// One of the method's orders has come.
  void (*begin)(MethodState& state, Workspace& ws, const Order& order);

  /// Would a working neighbour send this message of the method's own now?
  bool (*expects)(const MethodState& state, const Workspace& ws, const Order& order, Direction face,
                  Message message);
  void (*take)(MethodState& state, Workspace& ws, const Order& order, Direction face,
               Message message);

  /// All vectors of the exchange under way are here.
  void (*take_exchange)(MethodState& state, Workspace& ws, const Order& order);

  /// Does the next piece of work apart from exchanges, 5 ms of a Cortex-M0 at most; false if there
  /// is none, or if it has to wait.
  bool (*do_piece)(MethodState& state, Workspace& ws, const Order& order);
  Pending (*pending)(const MethodState& state);

  /// What part planned modules that touch several others have in the exchange under way, or in the
  /// one that starts next.
  PlannedPart (*planned_part)(const Workspace& ws, const Order& order);

  /// The sweep is over here: what this module reports.
  Report (*report)(MethodState& state, Workspace& ws, const Order& order);

  /// What comes and goes between hosts and condensed planned modules (condensed.hpp); null where
  /// none is ever condensed.
  void (*pass_condensed)(Workspace& ws, const Order& order);
  void (*take_condensed)(Workspace& ws, Message message);
};

/// The functions of one class, whose object is a member of the state.
template <class Own, Own MethodState::*kOwn>
constexpr MethodTable table_of() {
  return {
      .make = [](MethodState& state) { new (&(state.*kOwn)) Own; },
      .begin = [](MethodState& state, Workspace& ws,
                  const Order& order) { (state.*kOwn).begin(ws, order); },
      .expects = [](const MethodState& state, const Workspace& ws, const Order& order,
                    Direction face,
                    Message message) { return (state.*kOwn).expects(ws, order, face, message); },
      .take = [](MethodState& state, Workspace& ws, const Order& order, Direction face,
                 Message message) { (state.*kOwn).take(ws, order, face, message); },
      .take_exchange = [](MethodState& state, Workspace& ws,
                          const Order& order) { (state.*kOwn).take_exchange(ws, order); },
      .do_piece = [](MethodState& state, Workspace& ws,
                     const Order& order) { return (state.*kOwn).do_piece(ws, order); },
      .pending = [](const MethodState& state) { return (state.*kOwn).pending(); },
      .planned_part = [](const Workspace& ws,
                         const Order& order) { return Own::planned_part(ws, order); },
      .report = [](MethodState& state, Workspace& ws,
                   const Order& order) { return (state.*kOwn).report(ws, order); },
      .pass_condensed = nullptr,
      .take_condensed = nullptr,
  };
}

/// The method of a course, or null if there is none, or none in this program.
const MethodTable* method_in(Course course);

}  // namespace holdfast::agent
