// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "clusters.hpp"

namespace holdfast::agent {

/// Nothing is known yet; the choice comes piece by piece.
void Agent::begin_clusters() {
  new (&work_.clustered) ClusteredSteps;
  work_.clustered.piece = ClusterPiece::kChoose;
}

/// The round has ended, or has not come so far.
void Agent::leave_clusters() {
  if constexpr (kHasAllMethods) {
    is_clustered_ = false;
  }
}

/// At the begin of a step: children add theirs as they come.
void Agent::clear_clusters() {
  if (has_clusters()) {
    ClusteredSteps& work = work_.clustered;
    work.cluster.clear();
    work.awaited = work.children;
    work.is_shift_here = parent_ < 0;
  }
}

/// Does the step under way have clusters?
bool Agent::has_clusters() const {
  return order_.operation == wire::Operation::kStep && (order_.flags & kWithClusters) != 0;
}

/// Is something to be done before the report?
bool Agent::is_clustering() const {
  return kHasAllMethods && is_clustered_ &&
         (work_.clustered.piece == ClusterPiece::kChoose ||
          work_.clustered.piece == ClusterPiece::kLink);
}

/// Between the two polynomials?
bool Agent::is_coarse() const {
  return kHasAllMethods && is_clustered_ && work_.clustered.piece >= ClusterPiece::kStiffness;
}

/// The next piece; false if there is none, or if it has to wait.
bool Agent::do_cluster_piece() {
  if (!is_clustered_) {
    return false;
  }
  switch (work_.clustered.piece) {
    case ClusterPiece::kChoose:
      return choose_cluster();
    case ClusterPiece::kLink:
      return send_link();
    case ClusterPiece::kStiffness:
      return send_cluster_stiffness();
    case ClusterPiece::kLoad:
      send_cluster_load();
      return true;
    case ClusterPiece::kShift:
      return shift_cluster();
    case ClusterPiece::kNone:
      break;
  }
  return false;
}

bool Agent::choose_cluster() {
  const std::size_t slot = (tag_ + 1U) & 1U;
  if ((vectors_here_[slot] & nearer_) != nearer_) {
    return false;
  }
  const base::Cell& own = nodes_[0].cell;
  const base::Cell here = {own.x - root_cell_.x, own.y - root_cell_.y, own.z - root_cell_.z};
  clusters::Choice choice{.top = here, .parent_top = here};
  for (int face = base::kDirectionCount - 1; face >= 0; --face) {
    if ((nearer_ & bit(face)) == 0) {
      continue;
    }
    const auto theirs = clusters::decoded(vectors_[slot][static_cast<std::size_t>(face)]);
    const bool joins = clusters::may_join(here, theirs.top);
    if (joins || choice.top == here) {
      choice.top = joins ? theirs.top : here;
      choice.parent_top = joins ? theirs.parent_top : theirs.top;
      choice.parent_face = face;
    }
  }
  work_.clustered.parent = static_cast<std::uint8_t>(choice.parent_face);
  nodes_[0].shared = base::converted<float>(clusters::encoded(choice));
  work_.clustered.piece = ClusterPiece::kNone;
  start_exchange();
  return true;
}

/// All choices are here: who is what.
void Agent::meet_neighbours() {
  ClusteredSteps& work = work_.clustered;
  const auto own = clusters::decoded(nodes_[0].shared);
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((used_faces() & bit(face)) == 0) {
      continue;
    }
    const auto direction = static_cast<base::Direction>(face);
    const auto theirs = clusters::decoded(vectors_[tag_ & 1U][static_cast<std::size_t>(face)]);
    const bool is_child = theirs.parent_face == base::index(base::opposite(direction));
    const bool is_member = theirs.top == own.top;
    work.children = static_cast<std::uint8_t>(work.children | (is_child ? bit(face) : 0U));
    // What it sends may be here already.
    work.awaited =
        static_cast<std::uint8_t>(work.awaited ^ (is_child && is_member ? bit(face) : 0U));
    work.is_top = work.is_top && (face != work.parent || !is_member);
    if (!is_member && !(theirs.parent_top == own.top)) {
      work.cluster.add_to_link(mechanics::block_11(setup_.beam, direction));
      ++work.link_count;
      work.stray_count =
          static_cast<std::uint8_t>(work.stray_count + (theirs.top == own.parent_top ? 0 : 1));
    }
  }
  work.piece = ClusterPiece::kLink;
}

/// The link so far goes to the parent, or ends here.
bool Agent::send_link() {
  ClusteredSteps& work = work_.clustered;
  if (work.awaited != 0) {
    return false;
  }
  work.piece = ClusterPiece::kNone;
  if (!work.is_top) {
    Cluster::Parts parts;
    work.cluster.find_link_up(joint_to_cluster(), parts);
    send_parts(parts);
  } else if (parent_ >= 0) {
    work.cluster.close_link();
  }
  return true;
}

Joint Agent::joint_to_cluster() const {
  return {setup_.beam, static_cast<base::Direction>(work_.clustered.parent)};
}

void Agent::send_parts(const Cluster::Parts& parts) {
  for (int i = 0; i < Branch::kPartCount; ++i) {
    send(work_.clustered.parent, vector_message(wire::MessageType::kColumn,
                                                static_cast<std::uint8_t>(Branch::kColumnCount + i),
                                                parts[static_cast<std::size_t>(i)]));
  }
}

void Agent::take_cluster_part(int face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  const int part = in.label - Branch::kColumnCount;
  ClusteredSteps& work = work_.clustered;
  if (part < 0 || part >= Branch::kPartCount) {
    return;
  }
  if (order_.operation == wire::Operation::kStep) {
    work.cluster.add_stiffness(part, in.vector);
    return;
  }
  work.cluster.add_to_link(part, in.vector);
  if (part + 1 == Branch::kPartCount) {
    work.awaited = static_cast<std::uint8_t>(work.awaited ^ bit(face));
  }
}

/// A child's load: all that comes from it.
void Agent::take_cluster_load(int face, std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  ClusteredSteps& work = work_.clustered;
  if (in.label == clusters::kHeld) {
    work.cluster.hold();
  }
  work.cluster.add_load(base::converted<double>(in.vector));
  work.awaited = static_cast<std::uint8_t>(work.awaited & ~bit(face));
}

/// What the first polynomial leaves here is part of the cluster's load. Planned modules emulated
/// here belong to this one's cluster.
void Agent::add_own_to_cluster() {
  Cluster& cluster = work_.clustered.cluster;
  if (nodes_[0].is_fixed) {
    cluster.hold();
  }
  const auto leaves = branches::leaves_of(planned_);
  for (int i = 0; i < joined_count(); ++i) {
    const Node& node = nodes_[static_cast<std::size_t>(i)];
    base::Vec6<double> load = steps_of(i).w;
    base::Mat6<double> stiffness;
    if (node.is_ground) {
      stiffness = mechanics::symmetric_tangent(contact_.facet, node.state, node.is_held);
    }
    // From leaf to leaf to this module.
    int at = i;
    for (int k = leaves.count - 1; k >= 0 && at > 0; --k) {
      const auto leaf = static_cast<std::size_t>(k);
      if (leaves.node[leaf] == at) {
        const Joint joint(setup_.beam, leaves.to_parent[leaf]);
        joint.hand_on(load);
        stiffness = carried(joint, stiffness);
        at = leaves.parent[leaf];
      }
    }
    cluster.add_load(load);
    if (node.is_ground) {
      cluster.add_stiffness(stiffness);
    }
  }
}

bool Agent::send_cluster_stiffness() {
  ClusteredSteps& work = work_.clustered;
  if (work.awaited != 0) {
    return false;
  }
  add_own_to_cluster();
  const bool is_hidden = work.cluster.is_held() && !work.is_top;
  if (parent_ >= 0 && !work.cluster.is_free() && !is_hidden) {
    Cluster::Parts parts;
    work.cluster.find_stiffness_up(joint_to_cluster(), work.is_top, parts);
    send_parts(parts);
  }
  work.piece = ClusterPiece::kLoad;
  return true;
}

void Agent::send_cluster_load() {
  ClusteredSteps& work = work_.clustered;
  work.piece = ClusterPiece::kShift;
  if (parent_ < 0) {
    base::Vec6<double> shift;
    work.cluster.find_displacement_of_root(shift);
    nodes_[0].shared = base::converted<float>(shift);
    return;
  }
  const bool is_hidden = work.cluster.is_held() && !work.is_top;
  base::Vec6<double> load;
  work.cluster.find_load_up(joint_to_cluster(), work.is_top, load);
  send(work.parent,
       vector_message(wire::MessageType::kBranchUp, is_hidden ? clusters::kHeld : std::uint8_t{0},
                      base::converted<float>(load)));
}

void Agent::take_cluster_shift(std::span<const std::uint8_t> message) {
  const auto in = decoded<LabelledVector>(message);
  if (in.label == 0 && work_.clustered.piece == ClusterPiece::kShift) {
    nodes_[0].shared = in.vector;
    work_.clustered.is_shift_here = true;
  }
}

/// The parent's displacement is here, and with it this module's; it becomes a term of M^-1 r.
bool Agent::shift_cluster() {
  ClusteredSteps& work = work_.clustered;
  if (!work.is_shift_here) {
    return false;
  }
  work.piece = ClusterPiece::kNone;
  if (parent_ >= 0) {
    auto shift = base::converted<double>(nodes_[0].shared);
    work.cluster.find_displacement(joint_to_cluster(), work.is_top, shift);
    nodes_[0].shared = base::converted<float>(shift);
  }
  share_term(nodes_[0], steps_of(0));
  for (int face = 0; face < base::kDirectionCount; ++face) {
    if ((work.children & bit(face)) != 0) {
      send(face, vector_message(wire::MessageType::kBranchDown, 0, nodes_[0].shared));
    }
  }
  const auto leaves = branches::leaves_of(planned_);
  for (std::size_t i = 0; i < static_cast<std::size_t>(leaves.count) && joined_count() > 1; ++i) {
    Node& node = nodes_[static_cast<std::size_t>(leaves.node[i])];
    auto shift = base::converted<double>(nodes_[static_cast<std::size_t>(leaves.parent[i])].shared);
    Joint(setup_.beam, leaves.to_parent[i]).carry(shift);
    node.shared = base::converted<float>(shift);
    share_term(node, steps_of(leaves.node[i]));
  }
  start_exchange();
  return true;
}

/// Behind the report of a step with clusters: the first polynomial and its image, the clusters'
/// displacements, the second polynomial.
void Agent::next_terms_with_clusters() {
  const int left = exchanges_left_;
  const int degree = order_.count;
  if (left > degree + 2 || left <= degree) {
    next_terms();
    return;
  }
  for (int i = 0; i < joined_count(); ++i) {
    subtract_facet(i);
    if (left == degree + 1) {
      first_term(i);
    }
  }
  if (left == degree + 2) {
    work_.clustered.piece = ClusterPiece::kStiffness;
  }
}

}  // namespace holdfast::agent
