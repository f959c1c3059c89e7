// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <new>

#include "bits.hpp"
#include "equilibrium.hpp"
#include "holdfast/agent/agent.hpp"

/// Elimination over the tree as messages; branch.hpp has the algebra.
///
///   kMass      with the reports: cuts that are open, so that each module knows its loops
///   kFactor    with the reports: columns of condensed stiffness, then condensed loads
///   kTreeStep  with the order: displacements and forces in cuts; with the reports: loads
///
/// Planned modules emulated here are leaves of the tree: they hang on this module or on each other.
namespace holdfast::agent {

namespace branches {

/// Columns of S', complete as soon as the first is; those of B', C' and P' follow.
inline constexpr int kStiffnessColumns = 6;

/// The planned modules of one host as a tree, parents before children.
struct Leaves {
  int count = 0;
  std::array<int, kPlannedMax> node{};    ///< Index into nodes_.
  std::array<int, kPlannedMax> parent{};  ///< The same; 0 is the host.
  std::array<base::Direction, kPlannedMax> to_parent{};
};

inline Leaves leaves_of(const Planned& planned) {
  Leaves leaves;
  std::uint8_t placed = 0;
  const auto place = [&](int node, int parent, base::Direction to_parent) {
    const auto i = static_cast<std::size_t>(leaves.count++);
    leaves.node[i] = node;
    leaves.parent[i] = parent;
    leaves.to_parent[i] = to_parent;
    placed = static_cast<std::uint8_t>(placed | bit(planned.hosted(node - 1)));
  };
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int face = planned.own_face(planned.hosted(i));
    if (face >= 0) {
      place(1 + i, 0, base::opposite(static_cast<base::Direction>(face)));
    }
  }
  for (int next = 0; next < leaves.count; ++next) {
    const int at = leaves.node[static_cast<std::size_t>(next)];
    for (const base::Direction direction : base::kDirections) {
      const int other = planned.neighbour_of(planned.hosted(at - 1), direction);
      const int node = other < 0 ? -1 : planned.node_of(other);
      if (node > 0 && (placed & bit(other)) == 0) {
        place(node, at, base::opposite(direction));
      }
    }
  }
  return leaves;
}

/// Connections between the planned modules of one host, and with it.
inline int leaf_connections(const Planned& planned) {
  int ends = 0;
  for (int i = 0; i < planned.hosted_count(); ++i) {
    const int k = planned.hosted(i);
    ends += planned.own_face(k) >= 0 ? 2 : 0;
    for (const base::Direction direction : base::kDirections) {
      ends += planned.neighbour_of(k, direction) >= 0 ? 1 : 0;
    }
  }
  return ends / 2;
}

}  // namespace branches

template <class Real>
void BasicAgent<Real>::begin_branch() {
  new (&work_.tree) BranchWork;
}

template <class Real>
void BasicAgent<Real>::take_loop(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  std::uint8_t& count = work_.tree.child_cut_count[static_cast<std::size_t>(face)];
  if (count < kLoopsMax) {
    Cut& cut = work_.tree.child_cuts[static_cast<std::size_t>(face)][count++];
    cut.cell = in.cell();
    cut.direction = static_cast<base::Direction>(in.u8() % base::kDirectionCount);
  }
}

/// Finds out which loops pass or close here, and tells the parent.
template <class Real>
std::uint8_t BasicAgent<Real>::survey_loops() {
  BranchWork& tree = work_.tree;
  bool has_too_many = branches::leaf_connections(planned_) != planned_.hosted_count();
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (is_cut(face)) {
      has_too_many = tree.branch.meet(cut_at(face)) < 0 || has_too_many;
    }
  }
  for (std::size_t face = 0; face < tree.child_cuts.size(); ++face) {
    for (std::size_t i = 0; i < tree.child_cut_count[face]; ++i) {
      const int slot = tree.branch.meet(tree.child_cuts[face][i]);
      tree.slot_of[face][i] = static_cast<std::int8_t>(slot);
      has_too_many = slot < 0 || has_too_many;
    }
  }
  if (has_too_many) {
    return kManyLoops;
  }
  for (int i = 0; i < tree.branch.open_count() && parent_ >= 0; ++i) {
    const Cut& cut = tree.branch.cut(tree.branch.open_slot(i));
    wire::Writer message(wire::MessageType::kLoop);
    message.cell(cut.cell);
    message.u8(static_cast<std::uint8_t>(cut.direction));
    send(parent_, message);
  }
  return 0;
}

/// Is there a connection at this face that is not part of the tree?
template <class Real>
bool BasicAgent<Real>::is_cut(int face) const {
  const bool is_in_tree = face == parent_ || (children_ & bit(face)) != 0;
  return (used_faces() & bit(face)) != 0 && !is_in_tree;
}

/// The connection at a face, named from its lower end.
template <class Real>
Cut BasicAgent<Real>::cut_at(int face) const {
  const auto direction = static_cast<base::Direction>(face);
  const bool is_upper = face % 2 != 0;
  return is_upper ? Cut{base::neighbour(nodes_[0].cell, direction), base::opposite(direction)}
                  : Cut{nodes_[0].cell, direction};
}

/// This module's own part of its branch, in the contact states in use.
template <class Real>
void BasicAgent<Real>::factor_branch() {
  Branch& branch = work_.tree.branch;
  branch.clear_stiffness();
  column_ = 0;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if (is_cut(face)) {
      const Cut cut = cut_at(face);
      branch.add_end(branch.find(cut), face % 2 != 0,
                     rigid_transport(setup_.section.length, cut.direction));
    }
  }
  const branches::Leaves leaves = branches::leaves_of(planned_);
  const LeafStiffness stiffness = leaf_stiffness();
  if (nodes_[0].is_ground) {
    branch.add_stiffness(
        mechanics::contact_tangent(contact_.facet, nodes_[0].state, nodes_[0].is_held));
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(leaves.count); ++i) {
    if (leaves.parent[i] == 0) {
      branch.add_stiffness(stiffness_up(setup_.beam, leaves.to_parent[i],
                                        stiffness[static_cast<std::size_t>(leaves.node[i])]));
    }
  }
  work_.tree.load = {};  // Children add theirs as they come.
  work_.tree.columns_here = {};
}

/// By node: what holds a planned module from its own ground and the planned ones beyond it.
template <class Real>
typename BasicAgent<Real>::LeafStiffness BasicAgent<Real>::leaf_stiffness() const {
  LeafStiffness stiffness{};
  const branches::Leaves leaves = branches::leaves_of(planned_);
  for (int i = leaves.count - 1; i >= 0; --i) {
    const auto at = static_cast<std::size_t>(leaves.node[static_cast<std::size_t>(i)]);
    const auto parent = static_cast<std::size_t>(leaves.parent[static_cast<std::size_t>(i)]);
    if (nodes_[at].is_ground) {
      base::add_to(stiffness[at], mechanics::contact_tangent(contact_.facet, nodes_[at].state,
                                                             nodes_[at].is_held));
    }
    if (parent > 0) {
      base::add_to(
          stiffness[parent],
          stiffness_up(setup_.beam, leaves.to_parent[static_cast<std::size_t>(i)], stiffness[at]));
    }
  }
  return stiffness;
}

template <class Real>
void BasicAgent<Real>::take_column(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const int index = in.u8();
  const int part = index - Branch::kColumnCount;
  BranchWork& tree = work_.tree;
  std::uint8_t& here = tree.columns_here[static_cast<std::size_t>(face)];
  if (part < 0) {
    tree.branch.add_column(index, tree.slot_of[static_cast<std::size_t>(face)],
                           sweep::read_vector(in));
    here = static_cast<std::uint8_t>(index + 1);
  } else if (part < Branch::kPartCount) {
    tree.branch.add_part(part, sweep::read_vector(in));
    here = part + 1 == Branch::kPartCount ? std::uint8_t{6} : here;
  }
  send_columns();
}

/// Is all here that the next column needs?
template <class Real>
bool BasicAgent<Real>::is_column_ready() const {
  const BranchWork& tree = work_.tree;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    const auto at = static_cast<std::size_t>(face);
    if ((reports_awaited_ & bit(face)) != 0 &&
        (tree.branch.closes_loops() ||
         tree.columns_here[at] <
             tree.branch.columns_needed(column_, tree.slot_of[at], tree.child_cut_count[at]))) {
      return false;
    }
  }
  return true;
}

/// Column `column_` for the parent; of a symmetric S' the part of that number, zeros beyond the
/// last.
template <class Real>
base::Vec6<float> BasicAgent<Real>::next_column() {
  BranchWork& tree = work_.tree;
  const auto to_parent = static_cast<base::Direction>(parent_);
  if (column_ >= branches::kStiffnessColumns) {
    return base::converted<float>(
        tree.branch.column_up(setup_.beam, to_parent, nodes_[0].is_fixed, column_));
  }
  if (column_ == 0) {
    const auto stiffness = tree.branch.stiffness_up(setup_.beam, to_parent, nodes_[0].is_fixed);
    for (std::size_t i = 0; i < stiffness.values.size(); ++i) {
      tree.stiffness_up.values[i] = static_cast<float>(stiffness.values[i]);
    }
    tree.is_symmetric = is_symmetric(tree.stiffness_up);
  }
  if (tree.is_symmetric) {
    return column_ < Branch::kPartCount ? part_of(tree.stiffness_up, column_) : base::Vec6<float>{};
  }
  base::Vec6<float> column;
  for (int row = 0; row < 6; ++row) {
    column[static_cast<std::size_t>(row)] = tree.stiffness_up.at(row, column_);
  }
  return column;
}

/// Columns of zeros need not be sent. False: more when there is room on the link, or when children
/// have sent more.
template <class Real>
bool BasicAgent<Real>::send_columns() {
  constexpr std::uint8_t kAllSent = Branch::kColumnCount + 1;
  Branch& branch = work_.tree.branch;
  if (column_ == kAllSent) {
    return true;
  }
  if (!is_streaming_ && branch.closes_loops()) {
    if (reports_awaited_ != 0) {
      return false;
    }
    branch.close_loops(setup_.beam);
  }
  is_streaming_ = true;
  for (; column_ < Branch::kColumnCount && parent_ >= 0; ++column_) {
    if (!is_column_ready()) {
      return false;
    }
    const base::Vec6<float> column = next_column();
    if (column == base::Vec6<float>{}) {
      continue;
    }
    // What follows must find room too.
    constexpr int kRoom = (2 + kLoopsMax) * wire::kVectorBytes + wire::kMessageBytesMax;
    if (!links_[static_cast<std::size_t>(parent_)].has_room(kRoom)) {
      return false;
    }
    const bool is_part = work_.tree.is_symmetric && column_ < branches::kStiffnessColumns;
    const int label = column_ + (is_part ? Branch::kColumnCount : 0);
    send(parent_, sweep::vector_message(wire::MessageType::kColumn,
                                        static_cast<std::uint8_t>(label), column));
  }
  is_streaming_ = false;
  column_ = kAllSent;
  return true;
}

template <class Real>
void BasicAgent<Real>::take_branch_up(int face, std::span<const std::uint8_t> message) {
  wire::Reader in(message);
  const int index = in.u8();
  BranchLoad& load = work_.tree.load;
  base::Vec6<double>* into = &load.load;
  if (index > 0 && index <= kLoopsMax) {
    const int slot =
        work_.tree.slot_of[static_cast<std::size_t>(face)][static_cast<std::size_t>(index - 1)];
    into = &load.gap[static_cast<std::size_t>(slot)];
  }
  base::add_to(*into, base::converted<double>(sweep::read_vector(in)));
}

/// The residuals here join the loads from below, and all go up.
template <class Real>
void BasicAgent<Real>::send_branch_up() {
  BranchWork& tree = work_.tree;
  const branches::Leaves leaves = branches::leaves_of(planned_);
  const LeafStiffness stiffness = leaf_stiffness();
  std::array<base::Vec6<double>, 1 + kPlannedMax> loads = leaf_loads(leaves, stiffness);
  base::add_to(tree.load.load, loads[0]);
  tree.branch.close_loops(tree.load);
  if (parent_ < 0) {
    return;
  }
  const BranchLoad up = tree.branch.load_up(setup_.beam, static_cast<base::Direction>(parent_),
                                            nodes_[0].is_fixed, tree.load);
  send(parent_,
       sweep::vector_message(wire::MessageType::kBranchUp, 0, base::converted<float>(up.load)));
  for (int i = 0; i < tree.branch.open_count(); ++i) {
    send(parent_,
         sweep::vector_message(wire::MessageType::kBranchUp, static_cast<std::uint8_t>(1 + i),
                               base::converted<float>(up.gap[static_cast<std::size_t>(i)])));
  }
}

/// By node: its residual and what planned ones beyond it hand on.
template <class Real>
std::array<base::Vec6<double>, 1 + kPlannedMax> BasicAgent<Real>::leaf_loads(
    const branches::Leaves& leaves, const LeafStiffness& stiffness) const {
  std::array<base::Vec6<double>, 1 + kPlannedMax> loads{};
  for (int i = 0; i < node_count(); ++i) {
    loads[static_cast<std::size_t>(i)] =
        residual(nodes_[static_cast<std::size_t>(i)], setup_, contact_);
  }
  for (int i = leaves.count - 1; i >= 0; --i) {
    const auto leaf = static_cast<std::size_t>(i);
    const auto at = static_cast<std::size_t>(leaves.node[leaf]);
    base::add_to(loads[static_cast<std::size_t>(leaves.parent[leaf])],
                 agent::load_up(setup_.beam, leaves.to_parent[leaf], stiffness[at], loads[at]));
  }
  return loads;
}

/// What comes down first; the root has it.
template <class Real>
void BasicAgent<Real>::begin_tree_step() {
  middle_ = {};
  down_awaited_ =
      parent_ < 0 ? std::uint8_t{0} : static_cast<std::uint8_t>(1 + work_.tree.branch.open_count());
  if (down_awaited_ == 0) {
    find_shifts();
    send_branch_down();
  }
}

template <class Real>
void BasicAgent<Real>::take_branch_down(std::span<const std::uint8_t> message) {
  if (!is_sweeping_ || down_awaited_ == 0) {
    return;
  }
  wire::Reader in(message);
  const int index = in.u8();
  BranchWork& tree = work_.tree;
  const auto vector = base::converted<double>(sweep::read_vector(in));
  if (index == 0) {
    tree.parent_shift = vector;
  } else if (index <= tree.branch.open_count()) {
    tree.forces[static_cast<std::size_t>(tree.branch.open_slot(index - 1))] = vector;
  }
  if (--down_awaited_ == 0) {
    find_shifts();
    send_branch_down();
    start_exchange();
    continue_sweep();
  }
}

/// M^-1 r of this module and of the planned ones here; then they move by it.
template <class Real>
void BasicAgent<Real>::find_shifts() {
  BranchWork& tree = work_.tree;
  const branches::Leaves leaves = branches::leaves_of(planned_);
  const LeafStiffness stiffness = leaf_stiffness();
  const auto loads = leaf_loads(leaves, stiffness);
  std::array<base::Vec6<double>, 1 + kPlannedMax> shifts{};
  if (nodes_[0].is_fixed) {
    tree.branch.find_forces(tree.load, {}, tree.forces);
  } else if (parent_ < 0) {
    shifts[0] = tree.branch.displacement_of_root(tree.load, tree.forces);
  } else {
    shifts[0] = tree.branch.displacement(setup_.beam, static_cast<base::Direction>(parent_),
                                         tree.parent_shift, tree.load, tree.forces);
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(leaves.count); ++i) {
    const auto at = static_cast<std::size_t>(leaves.node[i]);
    shifts[at] = agent::displacement(setup_.beam, leaves.to_parent[i], stiffness[at],
                                     shifts[static_cast<std::size_t>(leaves.parent[i])], loads[at]);
  }
  for (int i = 0; i < node_count(); ++i) {
    const auto at = static_cast<std::size_t>(i);
    Node<Real>& node = nodes_[at];
    base::add_to(node.u, shifts[at]);
    share_high_part(node);
  }
  tree.shift = base::converted<float>(shifts[0]);
}

template <class Real>
void BasicAgent<Real>::send_branch_down() {
  BranchWork& tree = work_.tree;
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((children_ & bit(face)) == 0) {
      continue;
    }
    const auto at = static_cast<std::size_t>(face);
    send(face, sweep::vector_message(wire::MessageType::kBranchDown, 0, tree.shift));
    for (std::size_t i = 0; i < tree.child_cut_count[at]; ++i) {
      const auto slot = static_cast<std::size_t>(tree.slot_of[at][i]);
      send(face,
           sweep::vector_message(wire::MessageType::kBranchDown, static_cast<std::uint8_t>(1 + i),
                                 base::converted<float>(tree.forces[slot])));
    }
  }
  tree.load = {};
}

}  // namespace holdfast::agent
