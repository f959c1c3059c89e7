// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "holdfast/agent/groups/more_planned.hpp"
#include "holdfast/agent/groups/planned.hpp"
#include "holdfast/agent/groups/planned_exchange.hpp"
#include "holdfast/agent/links/exchange.hpp"
#include "holdfast/agent/links/links.hpp"
#include "holdfast/agent/setup.hpp"
#include "holdfast/agent/tree/reports.hpp"
#include "holdfast/agent/tree/spanning_tree.hpp"
#include "holdfast/agent/world/lent_memory.hpp"
#include "holdfast/agent/world/node.hpp"
#include "holdfast/agent/world/stages.hpp"

namespace holdfast::agent {

/// What one module is, apart from what all share.
struct Identity {
  std::uint32_t id = 0;    ///< Different for every module.
  bool is_fixed = false;   ///< Held from outside, does not move.
  bool is_anchor = false;  ///< Knows `cell` from the start; one module, or several that agree.
  base::Cell cell = {};    ///< The anchor's cell.
};

/// What the parts of a module's program work on: the module's lines, its place in the tree, the
/// planned modules that it has to do with, and the mechanics of itself and of those it emulates.
/// Each part owns its state and is changed through its functions alone; nodes are plain data of the
/// method in use.
struct Workspace {
  Workspace(const Setup& shared, const Identity& identity, const LentMemory* lent_memory = nullptr);

  /// This module, then those it emulates: indices of nodes run to node_count().
  int node_count() const { return 1 + planned.hosted_count(); }

  /// Is null where there are no fronts.
  FrontMemory* front_memory() const {
    return kHasAllMethods && lent != nullptr ? lent->fronts : nullptr;
  }

  /// What there is beside a floor, or null.
  const Environment* environment() const {
    const Environment* all = kIsGeneral && lent != nullptr ? lent->environment : nullptr;
    const bool is_left = all != nullptr && all->connected != nullptr && stage() == Stage::kConnect;
    return is_left ? all->connected : all;
  }

  /// Is null where steps are not judged in stages.
  Stages* stages() const { return kKeepsAnswers && lent != nullptr ? lent->stages : nullptr; }

  /// The stage of a step that is judged, or kNone.
  Stage stage() const { return stages() == nullptr ? Stage::kNone : stages()->stage(); }

  /// Is the module of a cell gone in the stage that is judged?
  bool is_gone(const base::Cell& cell) const {
    return stage() != Stage::kNone && stages()->is_gone(cell);
  }

  Node& node(int index) {
    return is_own_node(index) ? nodes[static_cast<std::size_t>(index)] : more_node(index);
  }

  const Node& node(int index) const {
    return is_own_node(index) ? nodes[static_cast<std::size_t>(index)] : more_node(index);
  }

  static bool is_own_node(int index) { return !kIsGeneral || index <= kPlannedMax; }

  /// The node of a planned module for which there is no room in the module itself.
  Node& more_node(int index) const {
    return lent->planned->nodes[static_cast<std::size_t>(index - kPlannedMax - 1)];
  }

  const base::Cell& cell_of(int node) const {
    return node == 0 ? tree.cell() : planned.cell(planned.hosted(node - 1));
  }

  /// Faces on which a node has a beam.
  Faces faces_of(int node) const;

  /// Is null where free faces are not judged.
  FreeFaces* free_faces() const {
    return kKeepsAnswers && lent != nullptr ? lent->free_faces : nullptr;
  }

  /// Is null where iterations are not deflated.
  KeptChanges* kept_changes() const {
    return kKeepsAnswers && lent != nullptr ? lent->changes : nullptr;
  }

  /// What the beam at a face carries in its middle.
  MiddleLoad& middle(Direction face) {
    return at_face(middle_own, links.more(), &MoreFaces::middle, face);
  }

  const MiddleLoad& middle(Direction face) const {
    return at_face(middle_own, links.more(), &MoreFaces::middle, face);
  }

  /// What connections with laws of their own carry besides, or null.
  AcrossLoads* across() const { return kIsGeneral && lent != nullptr ? lent->across : nullptr; }

  void clear_middle();

  /// Adds to across() what the beam at a face carries, given the force in its middle.
  void add_across(Direction face, const base::Vec6<double>& force) {
    if (AcrossLoads* loads = across(); loads != nullptr) {
      std::array<double, 3>& load = (*loads)[static_cast<std::size_t>(face)];
      load = {load[0] + force[0], load[1] + force[1], load[2] + force[5]};
    }
  }

  /// The cell next to `cell` in a direction of the lattice.
  base::Cell beside(const base::Cell& cell, Direction direction) const {
    return neighbour(links.more(), cell, direction);
  }

  /// Starts an exchange: this module's own vector goes out and, if they are part of it, those of
  /// planned modules emulated here.
  void start_exchange(PlannedPart part);

  /// Sets across() from nothing to what the beam at a face carries.
  void set_across(Direction face, const base::Vec6<double>& force) {
    if (AcrossLoads* loads = across(); loads != nullptr) {
      (*loads)[static_cast<std::size_t>(face)] = {force[0], force[1], force[5]};
    }
  }

  const Setup& setup;
  Links links;
  SpanningTree tree;
  Reports reports;
  Planned planned;
  Exchange exchange;
  PlannedExchange planned_exchange;
  const LentMemory* lent;  ///< Not owned; may be null.
  bool is_fixed;
  float own_load_ratio = 0;  ///< The largest of this module's own connections.
  std::array<Node, 1 + kPlannedMax> nodes{};
  ByFace<MiddleLoad> middle_own{};  ///< Loads by face of this module, see middle().
  ContactSetting contact;
};

}  // namespace holdfast::agent
