// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "holdfast/agent/links/links.hpp"
#include "holdfast/base/algebra.hpp"

namespace holdfast::agent {

/// Exchanges of six reals between all neighbours, as many as an order asks for.
///
/// A neighbour nearer to the root may be one exchange ahead, never two: its next vector depends on
/// ours. So two buffers do, told apart by the lowest bit of the exchange's tag.
class Exchange {
 public:
  /// An order has come: so many exchanges, the last `behind` of which go on when its report has
  /// left.
  void plan(std::uint16_t count, std::uint16_t behind);

  /// The round is over.
  void leave() { is_under_way_ = false; }

  /// A round begins.
  void enter();

  /// Sends this module's own vector to all its neighbours.
  void start(Links& links, const base::Vec6<float>& own);

  /// A vector has come.
  void take(MoreFaces* more, Direction face, std::span<const std::uint8_t> message);

  bool is_under_way() const { return is_under_way_; }

  /// Exchanges of the order that are not over, the one under way included.
  int left() const { return left_; }

  /// How many of those are left before the report can leave.
  int left_before_report() const { return left_ - behind_; }

  /// Is the one under way the order's last, and one that the report waits for?
  bool is_last() const { return left_ == 1 && behind_ == 0; }

  /// Are all neighbours' vectors here?
  bool is_complete(Faces neighbours) const { return (neighbours - here_[slot(0)]).is_empty(); }

  /// What the neighbour at `face` has sent in the exchange under way.
  const base::Vec6<float>& vector(const MoreFaces* more, Direction face) const {
    return vector(more, face, 0);
  }

  /// Are these neighbours' vectors of the exchange to be started next here?
  bool is_next_complete(Faces neighbours) const { return (neighbours - here_[slot(1)]).is_empty(); }

  const base::Vec6<float>& next_vector(const MoreFaces* more, Direction face) const {
    return vector(more, face, 1);
  }

  /// The exchange is over.
  void end();

 private:
  std::size_t slot(unsigned ahead) const { return (tag_ + ahead) & 1U; }

  const base::Vec6<float>& vector(const MoreFaces* more, Direction face, unsigned ahead) const {
    const auto i = static_cast<std::size_t>(face);
    const std::size_t buffer = slot(ahead);
    return !kIsGeneral || i < vectors_[buffer].size()
               ? vectors_[buffer][i]
               : more->vectors[buffer][i - vectors_[buffer].size()];
  }

  bool is_under_way_ = false;
  std::uint8_t tag_ = 0;
  std::array<Faces, 2> here_{};  ///< Whose vectors have come, by the tag's lowest bit.
  std::uint16_t left_ = 0;
  std::uint16_t behind_ = 0;
  std::array<ByFace<base::Vec6<float>>, 2> vectors_{};
};

}  // namespace holdfast::agent
