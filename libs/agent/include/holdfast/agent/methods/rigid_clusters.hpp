// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/algebra/cluster.hpp"
#include "holdfast/agent/equilibrium/workspace.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/agent/methods/condensing.hpp"
#include "holdfast/agent/methods/tree_elimination.hpp"

namespace holdfast::agent {

/// Rigid clusters as messages, for long thick robots; cluster.hpp has the algebra.
///
/// kClusters, which begins the equilibrium, finds them. A module joins the cluster of the first of
/// its neighbours nearer to the root whose top is near enough to it in each direction;
/// that neighbour is its parent. If there is none, it is the top of a new cluster and its first
/// neighbour nearer to the root the parent. So clusters are subtrees, and as boxes begin where
/// the robot enters them, no lattice of cells has to suit the robot. It takes one exchange, of
/// what everybody has chosen: a module chooses when the vectors of its nearer neighbours are
/// here, and sends its own. Then all beams are known for what they are: within a cluster, of the
/// joint to the parent's cluster, or stray, between clusters that are not parent and child. Stray
/// beams are added to the joint, as if the parent's cluster were behind them. Where there are many
/// the root, to which their number is reported, leaves the clusters alone.
///
/// An order kIterate kWithClusters has two polynomials S of small degree and between them the
/// clusters' exact solve C, so that M^-1 is symmetric:
///   z := S r,  z := z + C (r - K z),  z := z + S (r - K z)
/// The loads of C go up the clusters' tree behind the report, with the condensed stiffness, which
/// may have changed; the displacements come down before the next order.
class RigidClusters {
 public:
  bool begin(Workspace& ws, const Order& order, int piece);

  /// Messages of clusters may come as soon as there are clusters anywhere.
  static bool expects(const Workspace&, const Order&, Direction,
                      std::span<const std::uint8_t> message) {
    return static_cast<wire::MessageType>(message[0]) != wire::MessageType::kLoop;
  }

  void take(Workspace& ws, const Order& order, Direction face,
            std::span<const std::uint8_t> message);

  bool take_exchange(Workspace& ws, const Order& order, int piece);

  bool condense(Workspace& ws, const Order& order, int piece) {
    return condensing_.do_piece(ws, order, memory_, piece);
  }

  bool do_piece(Workspace& ws, const Order& order);

  Pending pending() const;

  static PlannedPart planned_part(const Workspace& ws, const Order& order);

  bool report(Workspace& ws, const Order& order, int piece, Report& sum);

 private:
  /// What a module does next: in kClusters, then in a kIterate.
  enum class Piece : std::uint8_t { kNone, kChoose, kJoin, kStiffness, kLoad, kShift };

  // Which clusters there are.
  bool choose(Workspace& ws);
  void meet_neighbours(const Workspace& ws);
  bool send_joint(Workspace& ws);

  // Their exact solve.
  Joint joint_to_parent(const Workspace& ws) const;
  void send_parts(Workspace& ws, const Cluster::Parts& parts) const;
  void take_part(const Order& order, Direction face, std::span<const std::uint8_t> message);
  void take_load(Direction face, std::span<const std::uint8_t> message);
  void take_shift(Workspace& ws, std::span<const std::uint8_t> message);
  void add_own(const Workspace& ws, int node_count);
  bool send_stiffness(Workspace& ws, const Order& order);
  bool send_load(Workspace& ws);
  bool shift(Workspace& ws, const Order& order);

  std::array<IterationMemory, 1 + kClusterPlannedMax> memory_{};
  Condensing condensing_;
  Cluster cluster_;
  float rho_ = 0;   ///< Coefficient of the polynomial.
  Faces parent_;    ///< In the clusters' tree.
  Faces children_;  ///< In the clusters' tree.
  Faces awaited_;   ///< Children that have something to send.
  Piece piece_ = Piece::kNone;
  bool is_top_ = true;
  bool is_shift_here_ = false;
  std::uint8_t beam_count_ = 0;   ///< Beams of this module to its parent's cluster, ...
  std::uint8_t stray_count_ = 0;  ///< ... and those of them that lead elsewhere.
};

}  // namespace holdfast::agent
