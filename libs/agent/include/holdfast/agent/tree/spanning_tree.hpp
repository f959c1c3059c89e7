// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "holdfast/agent/links/links.hpp"
#include "holdfast/agent/messages/messages.hpp"
#include "holdfast/agent/wire/round.hpp"
#include "holdfast/base/cell.hpp"

/// Three waves with echo [Segall 1983], one after the other, and what they leave: every module's
/// cell, and a spanning tree.
///
/// A wave starts at one module. Who hears of it first from a neighbour makes that its parent and
/// passes it on to all others; who has heard from all neighbours answers its parent (echo), adding
/// up what its children say. Two messages cross every connection.
///   1  from the starter: every module learns its cell; the echo counts modules, and names one that
///      is furthest away, A.
///   2  from A: names one that is furthest from A, B. (A path from A to B is nearly a longest one.)
///   3  from the module half way from B to A: near the topological centre. Its tree is used.
/// The double sweep finds the centre of any tree exactly [Handler 1973]. In a lattice there are
/// many shortest ways from B to A, and those along its edges have their middle in a corner, at the
/// end of everything: so of all of them one is taken that keeps to the straight line between the
/// two (test/waves_test.cpp measures how near the centre it is).
namespace holdfast::agent {

class SpanningTree {
 public:
  /// The wave that a module has taken part in last.
  enum class Wave : std::uint8_t {
    kNone,
    kFirst,  ///< From the starter: coordinates, census.
    kFar,    ///< From the module furthest from the starter.
    kTree,   ///< From the middle: the tree that is used.
  };

  /// What the echoes of a wave have added up.
  struct Census {
    std::uint32_t count = 0;     ///< Modules.
    std::uint16_t hops = 0;      ///< To the module furthest away, ...
    Doubt doubt = Doubt::kNone;  ///< The gravest.
    std::uint32_t id = 0;        ///< ... and the identity of that.
  };

  /// `id` differs for every module. The anchor knows its cell. There may be several anchors, if
  /// what they know agrees.
  SpanningTree(std::uint32_t id, bool is_anchor, const base::Cell& cell)
      : id_(id), is_anchor_(is_anchor), has_cell_(is_anchor), cell_(cell) {}

  // ---- What is known.

  Wave wave() const { return wave_; }

  /// Is this module the one where the wave has started?
  bool is_root() const { return parent_.is_empty(); }

  /// The face of the parent; none at the root.
  Faces parent() const { return parent_; }

  Faces children() const { return children_; }

  /// Faces of neighbours with fewer hops to the root.
  Faces nearer() const { return nearer_; }

  std::uint16_t hops() const { return hops_; }

  /// The most hops to where one of the round's waves began.
  std::uint16_t hops_max() const { return hops_max_; }

  bool has_cell() const { return has_cell_; }

  const base::Cell& cell() const { return cell_; }

  /// The cell of the module that started the wave; of the tree's root once set_root_cell() was
  /// told.
  const base::Cell& root_cell() const { return root_cell_; }

  void set_root_cell(const base::Cell& cell) { root_cell_ = cell; }

  const Census& census() const { return census_; }

  // ---- Waves.

  /// A round begins, of this stage of a step or 0: there is no tree.
  void leave(std::uint8_t stage = 0);

  /// Starts `wave` from this module.
  void start_wave(Links& links, const Round& round, Wave wave);

  /// May the neighbour at `face` lead now, being this module's parent in a wave that is over here?
  bool is_led_by(Direction face) const { return parent_.has(face) && awaited_.is_empty(); }

  /// Is this message of the present round from `face` to be expected now? `is_in_use`: the
  /// root has begun to give orders.
  bool expects_echo(Direction face) const { return awaited_.has(face); }

  bool expects_appointment(Direction face, std::span<const std::uint8_t> message,
                           bool is_in_use) const;
  bool expects_mark(Direction face, bool is_in_use) const;

  /// A join of the present round. False: a working neighbour would not have sent it.
  [[nodiscard]] bool take_join(Links& links, Direction face, const Join& join, bool is_in_use);
  void take_echo(Links& links, Direction face, const Echo& echo);
  /// Returns false if it came too late: the next wave was here before it.
  bool take_appointment(Links& links, const Round& round, const Appointment& appointment);
  void take_mark(Links& links, const Round& round, const Mark& mark);

  // ---- A module that comes after the waves.

  /// This module takes its place below the neighbour at `face`, as if the third wave had come.
  void adopt(Links& links, Direction face, const Adoption& adoption);

  /// A neighbour that has adopted this module as well, or stands beside it. One that is nearer to
  /// the root than the parent takes the parent's place.
  void take_adoption(Links& links, Direction face, const Adoption& adoption);

  /// What this module tells a neighbour that has come.
  Adoption adoption(const Round& round) const {
    return {.round = round, .sender = cell_, .root = root_cell_, .hops = hops_};
  }

  /// Has the wave come back to this module, where it started? Says so once.
  bool take_return();

  /// Appoints the module where the next wave starts.
  void appoint(Links& links, const Round& round);

 private:
  void begin_wave(Links& links, const Round& round, Wave wave, Faces parent, std::uint16_t hops);
  void send_join(Links& links, const Round& round, Faces faces) const;
  void settle(const Links& links, Direction face, const base::Cell& sender, bool is_first);
  Doubt doubt(const Links& links) const;
  void await_less(Links& links, const Round& round, Faces faces);
  void send_echo(Links& links, const Round& round) const;
  Faces towards_root(const Links& links, const base::Cell& end) const;

  std::uint32_t id_;
  Wave wave_ = Wave::kNone;
  bool is_anchor_;
  bool has_cell_;
  bool has_other_cell_ = false;  ///< In this round the module was told two cells.
  bool has_returned_ = false;
  std::uint8_t stage_ = 0;
  Faces parent_;
  Faces children_;
  Faces awaited_;  ///< Neighbours that have neither joined nor echoed.
  Faces nearer_;
  std::uint16_t hops_ = 0;
  std::uint16_t hops_max_ = 0;
  Census census_;
  base::Cell cell_;
  base::Cell root_cell_;
};

}  // namespace holdfast::agent
