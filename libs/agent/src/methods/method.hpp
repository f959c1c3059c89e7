// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <new>
#include <span>

#include "holdfast/agent/methods/sweep.hpp"

/// The methods that find an equilibrium, as the sweeps see them: the same few functions of each.
/// Which of them a program has features.hpp says.
namespace holdfast::agent {

/// A message's bytes, its type first.
using Message = std::span<const std::uint8_t>;

struct MethodTable {
  /// Begins a life in memory that another method may have used.
  void (*make)(MethodState& state);

  // In pieces, numbered from 0, of 5 ms of a Cortex-M0 at most; false after the last one. No
  // message comes in between.

  /// One of the method's orders has come.
  bool (*begin)(MethodState& state, Workspace& ws, const Order& order, int piece);

  /// Would a working neighbour send this message of the method's own now?
  bool (*expects)(const MethodState& state, const Workspace& ws, const Order& order, Direction face,
                  Message message);
  void (*take)(MethodState& state, Workspace& ws, const Order& order, Direction face,
               Message message);

  /// All vectors of the exchange under way are here.
  bool (*take_exchange)(MethodState& state, Workspace& ws, const Order& order, int piece);

  /// All forces on planned modules that are to be condensed (condensed.hpp) are here. Null where
  /// none ever is.
  bool (*condense)(MethodState& state, Workspace& ws, const Order& order, int piece);

  /// Does the next piece of work apart from exchanges, 5 ms of a Cortex-M0 at most; false if there
  /// is none, or if it has to wait.
  bool (*do_piece)(MethodState& state, Workspace& ws, const Order& order);
  Pending (*pending)(const MethodState& state);

  /// What part planned modules that touch several others have in the exchange under way, or in the
  /// one that starts next.
  PlannedPart (*planned_part)(const Workspace& ws, const Order& order);

  /// The sweep is over here: what this module reports, in pieces as well.
  bool (*report)(MethodState& state, Workspace& ws, const Order& order, int piece, Report& sum);
};

/// The functions of one class, whose object is a member of the state.
template <class Own, Own MethodState::*kOwn>
constexpr MethodTable table_of() {
  return {
      .make = [](MethodState& state) { new (&(state.*kOwn)) Own; },
      .begin = [](MethodState& state, Workspace& ws, const Order& order,
                  int piece) { return (state.*kOwn).begin(ws, order, piece); },
      .expects = [](const MethodState& state, const Workspace& ws, const Order& order,
                    Direction face,
                    Message message) { return (state.*kOwn).expects(ws, order, face, message); },
      .take = [](MethodState& state, Workspace& ws, const Order& order, Direction face,
                 Message message) { (state.*kOwn).take(ws, order, face, message); },
      .take_exchange = [](MethodState& state, Workspace& ws, const Order& order,
                          int piece) { return (state.*kOwn).take_exchange(ws, order, piece); },
      .condense = nullptr,
      .do_piece = [](MethodState& state, Workspace& ws,
                     const Order& order) { return (state.*kOwn).do_piece(ws, order); },
      .pending = [](const MethodState& state) { return (state.*kOwn).pending(); },
      .planned_part = [](const Workspace& ws,
                         const Order& order) { return Own::planned_part(ws, order); },
      .report = [](MethodState& state, Workspace& ws, const Order& order, int piece,
                   Report& sum) { return (state.*kOwn).report(ws, order, piece, sum); },
  };
}

/// The method of a course, or null if there is none, or none in this program.
const MethodTable* method_in(Course course);

}  // namespace holdfast::agent
