// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/cells/occupied_cells.hpp"
#include "holdfast/agent/free_faces/load_way.hpp"
#include "holdfast/agent/messages/order.hpp"
#include "holdfast/base/faces.hpp"

/// Where next: would one more module at a free face of this one be safe? All faces of the robot are
/// judged together, by two orders behind the verdict.
///
/// `shape` adds up what every module has to know of its subtree: its box, its supports and how far
/// the nearest is, the largest load ratio, and the sum modulo 2 of a random label of each of its
/// connections that are not part of the tree. Where that sum is zero no such connection leaves the
/// subtree, so that the one to the parent is all that holds it, or that it holds.
///
/// `next` gathers the occupied cells of the box (up, then down, in parts), so that every module
/// knows which cells beside it are free, what else touches them, and where the feet are: stability
/// is then a matter of whole numbers, as for any verdict (feet.hpp). And it sends a LoadWay from
/// the supports outward through the tree. With it every module judges the candidates that hang on
/// it alone: such a candidate is a load, which goes the way inward.
///
/// Where the way is certain so are verdict and load ratio. Elsewhere a face is `safe` if the bounds
/// of load_way.hpp say so, and `overload` where a connection that holds alone what is beyond it
/// would break. All others are `undecided` until somebody plans a module there: the verdict on one
/// single plan is noted at the faces that it touches.
///
/// It takes memory that is lent, and only robots whose box has no more than
/// OccupiedCells::kCellsMax cells; in others all faces are `undecided`.
namespace holdfast::agent {

struct Workspace;

/// What is known of a free face.
struct FreeFace {
  Verdict verdict = Verdict::kNone;  ///< kNone: not a free face, or nobody has asked.
  bool has_load_ratio = false;
  bool has_margin = false;
  float load_ratio_max = 0;  ///< Of the whole robot with one more module there.
  float margin_mm = 0;       ///< Of the centre of mass from the edge of the support polygon.
};

class FreeFaces {
 public:
  /// What is known of the face at `direction`.
  const FreeFace& face(base::Direction direction) const { return faces_[at(direction)]; }

  /// The robot has changed: nothing is known.
  void forget() { *this = FreeFaces(); }

  /// There is a verdict on the robot with one planned module at these faces.
  void note(Faces touched, const Answer& answer);

  // ---- Orders.

  Report shape_report(const Workspace& ws) const;

  /// What a child has reported of the shape, and what all from here down have.
  void take_shape(base::Direction child, const Report& report);
  void take_shape_here(Report& sum);

  /// May this order come next?
  bool is_good_next(const Workspace& ws, const Order& order) const;

  void begin_next(const Workspace& ws, const Order& order);

  /// How many free faces are decided here, and how many are not.
  Report next_report() const;

  // ---- Messages of `next`.

  bool expects(const Workspace& ws, base::Direction face,
               std::span<const std::uint8_t> message) const;
  void take(const Workspace& ws, base::Direction face, std::span<const std::uint8_t> message);

  /// Does the next piece of work; false if there is none, or if it has to wait.
  bool do_piece(Workspace& ws);

  bool is_done() const { return !is_under_way_; }

 private:
  /// What one more module at a face would be.
  struct Candidate {
    base::Cell cell = {};
    base::Direction direction = base::Direction::kPlusX;
    int touching = 0;
    bool is_ground = false;
  };

  /// Hops that are more than any.
  static constexpr std::uint16_t kFar = 0xff;

  static constexpr int kRoomBytes = 4 * wire::kVectorBytes + wire::kPlainBytesMax;

  static std::size_t at(base::Direction direction) { return static_cast<std::size_t>(direction); }

  bool send_part_up(Workspace& ws);
  bool send_part_down(Workspace& ws);
  void take_part(base::Direction face, bool is_up, std::span<const std::uint8_t> message);
  void take_reach(const Workspace& ws, std::span<const std::uint8_t> message);
  std::uint16_t hops_from_here(const Workspace& ws, Faces left_out) const;
  bool send_outside(Workspace& ws);
  void find_inward(const Workspace& ws);
  bool continue_way(const Workspace& ws);
  bool is_alone(const Workspace& ws, base::Direction face) const;
  LoadWay way_of_support(const Workspace& ws) const;
  bool send_reach(Workspace& ws);
  float largest_but(const Workspace& ws, Faces left_out) const;
  bool has_all_parts(const Workspace& ws) const;
  bool judge_next(const Workspace& ws);
  bool find_candidate(const Workspace& ws, base::Direction direction, Candidate& candidate) const;
  FreeFace judge(const Workspace& ws, const Candidate& candidate) const;
  bool weigh(const Workspace& ws, const Candidate& candidate, FreeFace& face) const;
  void judge_load(const Workspace& ws, const Candidate& candidate, FreeFace& face) const;
  void judge_certain(const Workspace& ws, double alone, FreeFace& face) const;
  bool is_safe_by_bounds(const Workspace& ws, const base::Cell& away, double alone) const;

  std::array<FreeFace, base::kDirectionCount> faces_{};
  bool has_shape_ = false;
  bool is_under_way_ = false;
  Order order_ = {};

  // The shape, by child and of this module with all below it.
  std::array<std::uint32_t, base::kDirectionCount> supports_below_{};
  std::array<std::int64_t, base::kDirectionCount> label_below_{};
  std::array<float, base::kDirectionCount> ratio_below_{};
  std::array<std::uint8_t, base::kDirectionCount> hops_below_{};  ///< To the nearest support.
  std::uint32_t supports_here_ = 0;
  std::int64_t label_here_ = 0;
  base::Cell first_ = {};
  base::Cell last_ = {};

  // Parts of the occupied cells.
  OccupiedCells cells_;
  std::array<std::uint8_t, base::kDirectionCount> parts_from_{};  ///< From the children.
  std::uint8_t parts_up_ = 0;    ///< Sent, or complete at the root.
  std::uint8_t parts_down_ = 0;  ///< Handed on, or here at a leaf.
  std::uint8_t parts_here_ = 0;  ///< From the parent.

  // What is outside of this subtree, told by the parent.
  bool needs_outside_ = false;
  bool has_outside_ = false;
  bool has_sent_outside_ = false;
  bool leads_parent_ = false;  ///< The parent's way goes through this module.
  std::uint16_t hops_outside_ = kFar;
  float outside_ = kNoLoadRatio;  ///< The largest load ratio.

  // The way inward.
  Faces inward_;   ///< The face through which the way goes, none at a support.
  Faces outward_;  ///< Where the way goes on.
  std::uint8_t reach_parts_ = 0;
  bool has_way_ = false;
  bool has_sent_way_ = false;
  LoadWay way_;
  float elsewhere_ = kNoLoadRatio;  ///< The largest load ratio off the way and not beyond it here.

  std::uint8_t next_face_ = 0;  ///< To be judged.
};

}  // namespace holdfast::agent
